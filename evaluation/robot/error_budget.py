"""The error budget: where each of the person's tasks without help was lost, and why help was of no use.

A task without help was lost at the last step that it reached on the robot's way through the hour: imagine and classify
intentions, imagine and classify tasks, act. Which intention was right is what the person says in the evening; where
that was a slip, what they meant. This is evaluation: it sees what no robot sees.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from coopera.core.hour import Evening, HourRecord, HumanHour, RobotHour, TaskCandidate
from coopera.core.household import Act

LOST = {
    "not_imagined": "intention not imagined",
    "intention_rejected": "intention imagined, but rejected",
    "not_among_tasks": "intention accepted, but the thing not among its tasks",
    "task_rejected": "task proposed, but rejected",
    "not_done": "task accepted, but the act failed or came too late",
    "unknown": "the person did not say which intention was right",
}
"""Where a task is lost, by name, in the order of the hour. Every missed task is in exactly one of them."""

FALSE = {
    "in_hand": "the thing was in the person's hand already",
    "already_done": "the person had done it already",
    "wrong_thing": "right intention, wrong thing",
    "wrong_intention": "wrong intention",
    "unsaid": "the person did not say whether the intention was right",
}
"""Why a successful act was of no use, by name. Every useless act is in exactly one of them."""

FAILED = "failed"
"""What became of an accepted act that was not done, or came too late."""

Helps = Callable[[Act, Act], bool]
"""The predicate: whether an act of the robot helps with an act of the person."""


class Budget(NamedTuple):
    """The account of some hours; the fields of `LOST` add up to `missed`, those of `FALSE` to `useless`.

    Attributes:
        hours: Hours with a robot that were scored.
        remaining: The person's tasks after the first.
        helped: Those of them that a successful act helped with.
        lost: The others, by where they were lost.
        accepted: The robot's accepted acts.
        failed: Those of them that failed.
        false: Those of them that were done and of no use, by why.
    """

    hours: int
    remaining: int
    helped: int
    lost: dict[str, int]
    accepted: int
    failed: int
    false: dict[str, int]

    @property
    def missed(self) -> int:
        """Remaining tasks without help."""
        return self.remaining - self.helped

    @property
    def useless(self) -> int:
        """Acts that were done and of no use."""
        return sum(self.false.values())

    def figures(self) -> dict[str, Any]:
        """As plain data."""
        return {**self._asdict(), "missed": self.missed, "useless": self.useless}


class Fates(NamedTuple):
    """What became of each task and each act of an hour.

    Attributes:
        tasks: Of each of the person's tasks after the first, where it was lost (of `LOST`); None if it was helped.
        acts: Each of the robot's accepted acts and why it was of no use: of `FALSE`, `FAILED`, or None if it helped.
    """

    tasks: list[str | None]
    acts: list[tuple[TaskCandidate, str | None]]


class DayBudget(NamedTuple):
    """The account of a person's day; `day` is the day of the episode."""

    day: int
    episode: int
    person: str
    scene: str
    budget: Budget


def pool(budgets: Iterable[Budget]) -> Budget:
    """Add up accounts."""
    every = list(budgets)
    return Budget(
        hours=sum(one.hours for one in every),
        remaining=sum(one.remaining for one in every),
        helped=sum(one.helped for one in every),
        lost={name: sum(one.lost[name] for one in every) for name in LOST},
        accepted=sum(one.accepted for one in every),
        failed=sum(one.failed for one in every),
        false={name: sum(one.false[name] for one in every) for name in FALSE},
    )


def by_day(days: Iterable[DayBudget]) -> dict[int, Budget]:
    """Accounts by day of the episode, all people and episodes together."""
    found: dict[int, list[Budget]] = {}
    for one in days:
        found.setdefault(one.day, []).append(one.budget)
    return {day: pool(found[day]) for day in sorted(found)}


def budgets(
    hours: Sequence[HourRecord],
    evenings: Iterable[Evening],
    helps: Callable[[HourRecord], Helps],
    *,
    imagines: bool = True,
) -> list[DayBudget]:
    """The account of each day; hours that failed, without a robot, or away from home are left out.

    Args:
        hours: Of a run, in order.
        evenings: Of the same days; without its evening a day has no verdicts on intentions.
        helps: The predicate, in the home of an hour.
        imagines: Whether the robot imagines intentions; if not, no task is lost on them.
    """
    told = {evening.day: evening for evening in evenings}
    found: dict[int, list[HourRecord]] = {}
    for hour in hours:
        found.setdefault(hour.day, []).append(hour)
    return [
        DayBudget(
            day=of_day[0].episode_day,
            episode=of_day[0].episode,
            person=of_day[0].person,
            scene=of_day[0].scene,
            budget=pool(
                hour_budget(hour.human, hour.robot, meant(hour, told.get(day)), helps(hour), imagines=imagines)
                for hour in of_day
                if hour.human and hour.robot and hour.status == "ok" and not hour.human.intention.away
            ),
        )
        for day, of_day in sorted(found.items())
    ]


def hour_budget(
    human: HumanHour, robot: RobotHour, right: Mapping[str, bool | None], helps: Helps, *, imagines: bool = True
) -> Budget:
    """The account of an hour.

    Args:
        human: What the person did.
        robot: What the robot proposed and did.
        right: Whether each intention that it imagined was right, by text; None where that is not known.
        helps: The predicate.
        imagines: Whether the robot imagines intentions.
    """
    found = hour_fates(human, robot, right, helps, imagines=imagines)
    lost, false = Counter(found.tasks), Counter(why for _, why in found.acts)
    return Budget(
        hours=1,
        remaining=len(found.tasks),
        helped=lost[None],
        lost={name: lost[name] for name in LOST},
        accepted=len(found.acts),
        failed=false[FAILED],
        false={name: false[name] for name in FALSE},
    )


def hour_fates(
    human: HumanHour, robot: RobotHour, right: Mapping[str, bool | None], helps: Helps, *, imagines: bool = True
) -> Fates:
    """What became of each task and each act of an hour; arguments as of `hour_budget`."""
    done = _outcomes(robot)
    remaining = [task.act for task in human.tasks[1:]]
    helped = [any(ok and helps(task.act, wanted) for task, ok in done) for wanted in remaining]
    stage = _reached(robot, right, imagines=imagines)
    tasks = [
        None if yes else _lost(robot.tasks, wanted, helps) or stage
        for wanted, yes in zip(remaining, helped, strict=True)
    ]
    acts: list[tuple[TaskCandidate, str | None]] = []
    for task, ok in done:
        useful = any(helps(task.act, wanted) for wanted in remaining)
        why = None if useful else _why_false(task, human, right, helps, imagines=imagines)
        acts.append((task, why if ok else FAILED))
    return Fates(tasks, acts)


def _outcomes(robot: RobotHour) -> list[tuple[TaskCandidate, bool]]:
    """The accepted tasks, and whether each was done; one that has no outcome came too late."""
    left = list(robot.outcomes)
    found = []
    for task in (task for task in robot.tasks if task.accepted):
        outcome = next((one for one in left if one.act == task.act), None)
        if outcome is not None:
            left.remove(outcome)
        found.append((task, outcome is not None and outcome.ok))
    return found


def _lost(tasks: Sequence[TaskCandidate], wanted: Act, helps: Helps) -> str | None:
    """Where a task was lost whose help was proposed, whatever it was proposed for; None where it was not."""
    proposed = [task for task in tasks if helps(task.act, wanted)]
    if any(task.accepted for task in proposed):
        return "not_done"
    return "task_rejected" if proposed else None


def _reached(robot: RobotHour, right: Mapping[str, bool | None], *, imagines: bool) -> str:
    """Where a task was lost whose help was not proposed."""
    if not imagines or not robot.intentions:
        return "not_among_tasks"
    verdicts = [(right.get(one.text), one.accepted) for one in robot.intentions]
    if any(yes and accepted for yes, accepted in verdicts):
        return "not_among_tasks"
    if any(yes for yes, _ in verdicts):
        return "intention_rejected"
    return "unknown" if any(yes is None for yes, _ in verdicts) else "not_imagined"


def _why_false(
    task: TaskCandidate, human: HumanHour, right: Mapping[str, bool | None], helps: Helps, *, imagines: bool
) -> str:
    if human.tasks and helps(task.act, human.tasks[0].act):
        return "in_hand" if task.act.kind == "hand_over" else "already_done"
    if not imagines or task.intention == human.intention.text:
        return "wrong_thing"
    return {True: "wrong_thing", False: "wrong_intention", None: "unsaid"}[right.get(task.intention)]


def meant(hour: HourRecord, evening: Evening | None) -> dict[str, bool | None]:
    """What the person meant in the evening of each intention that was imagined; the true one's own words are right."""
    items = evening.feedback if evening else []
    said = {
        item.text: None if item.helpful is None else item.helpful != item.slip
        for item in items
        if item.hour == hour.hour and item.kind == "intention"
    }
    return {**said, hour.human.intention.text: True} if hour.human else said
