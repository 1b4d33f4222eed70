"""An hour as pages show it: its record joined with the evening's answers, what was done, and what was missed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from coopera.core.clock import hour_label
from coopera.core.errors import CooperaError
from coopera.core.hour import (
    Evening,
    FeedbackItem,
    HourRecord,
    IntentionCandidate,
    ModelCall,
    RobotHour,
    Task,
    TaskCandidate,
)
from coopera.core.household import Outcome
from coopera.evaluation.robot.error_budget import FAILED, FALSE, LOST, Fates, Helps, hour_fates, meant
from coopera.report.changes import Change, changes_of
from coopera.report.plan import Plan
from coopera.rundir.trace_files import human_outcomes, intention_verdicts

FLAGS = {
    "wrong": "False help",
    "miss": "Missed",
    "unimagined": "Not imagined",
    "repaired": "Repaired",
    "slow": "Slow",
    "failed": "Failed",
}
"""What hours can be filtered by: accepted candidates that were wrong; declined ones that were right; no intention that
was right among the robot's; a reply or task that had to be put right; a long wait for models; hours that failed."""
_SLOW_SECONDS, _SLOW_TIMES = 1.0, 2.0


@dataclass(frozen=True, slots=True)
class TaskView:
    """One imagined task with all that is known of it.

    `kind` is hit, wrong (accepted, but of no use), miss (declined, but right), declined or unscored.
    """

    task: TaskCandidate
    kind: str
    answer: FeedbackItem | None
    outcome: Outcome | None


@dataclass(frozen=True, slots=True)
class CandidateView:
    """One imagined intention, whether it was right (None: unknown), and its tasks."""

    candidate: IntentionCandidate
    right: bool | None
    tasks: list[TaskView]


@dataclass(frozen=True, slots=True)
class OwnTask:
    """A task of the person: what came of it, and of the robot's help with it.

    `fate` is "watched" for the first task, "helped", a name of `LOST`, or None where that is not known.
    """

    task: Task
    outcome: Outcome | None
    fate: str | None

    @property
    def why(self) -> str:
        """Why nobody helped, in words."""
        return LOST.get(self.fate or "", "")


@dataclass(frozen=True, slots=True)
class ActView:
    """An act of the robot; `fate` is "helped", "failed", a name of `FALSE`, or None where that is not known.

    `view` names the pictures of it among the hour's.
    """

    task: TaskCandidate
    outcome: Outcome | None
    fate: str | None
    view: str = ""

    @property
    def why(self) -> str:
        """Why it was of no use, in words."""
        return FALSE.get(self.fate or "", "")


@dataclass(frozen=True, slots=True)
class HourView:
    """One hour as the page shows it; `flags` are what the filters ask for, `views` its pictures by view."""

    record: HourRecord
    anchor: str
    label: str
    candidates: list[CandidateView]
    flags: list[str]
    f1: float | None
    views: dict[str, list[str]] = field(default_factory=dict)
    tasks: list[OwnTask] = field(default_factory=list)
    acts: list[ActView] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    answers: list[FeedbackItem] = field(default_factory=list)
    plan: Plan | None = None
    missing: list[str] = field(default_factory=list)

    @property
    def away(self) -> bool:
        """Whether the person was away from home, so that there was nothing to help with."""
        return self.record.human is not None and self.record.human.intention.away

    @property
    def helped(self) -> tuple[int, int] | None:
        """How many of the tasks that the person had before them were helped, and how many there were."""
        given = self.record.success.help if self.record.success else None
        return (given.helped, given.remaining) if given else None


def hour_view(
    record: HourRecord,
    evening: Evening | None,
    *,
    helps: Callable[[HourRecord], Helps] | None = None,
    imagines: bool = True,
    plan: Plan | None = None,
) -> HourView:
    """Gather what is known of an hour: its candidates joined with the evening's answers and with what was done.

    Args:
        record: The hour.
        evening: Of its day, if the day has ended.
        helps: The predicate, which says which tasks were helped; without it that stays open.
        imagines: Whether the robot imagines intentions.
        plan: The hour on the floor plan.
    """
    candidates = _candidates(record.robot, evening, record.hour) if record.robot else []
    fates = _fates(record, evening, helps, imagines=imagines)
    return HourView(
        record=record,
        anchor=f"d{record.day}h{record.hour}",
        label=hour_label(record.hour),
        candidates=candidates,
        flags=_flags(record, candidates),
        f1=record.success.predicate.f1 if record.success else None,
        tasks=_own_tasks(record, fates),
        acts=_acts(record.robot, fates) if record.robot else [],
        changes=changes_of(record.human) if record.human else [],
        answers=[one for one in evening.feedback if one.hour == record.hour] if evening else [],
        plan=plan,
    )


def waits(calls: Sequence[ModelCall]) -> float:
    """How long an hour's calls took together, in seconds; those from the cache and of the evening are left out."""
    return math.fsum(call.seconds for call in calls if not call.cached and not call.late)


def slow_from(seconds: Sequence[float]) -> float:
    """From how many seconds on an hour of a run is slow: twice as long as the hour in the middle, and no blink."""
    middle = sorted(seconds)[len(seconds) // 2] if seconds else 0.0
    return max(_SLOW_TIMES * middle, _SLOW_SECONDS)


def is_repaired(record: HourRecord) -> bool:
    """Whether code mended a task, or a reply had to be asked for again or put right."""
    mended = bool(record.human and record.human.repairs)
    return mended or any(call.faults or call.leniencies or call.attempts > 1 for call in record.calls)


def _flags(record: HourRecord, candidates: Sequence[CandidateView]) -> list[str]:
    kinds = {task.kind for guess in candidates for task in guess.tasks}
    flags: list[str] = [kind for kind in ("wrong", "miss") if kind in kinds]
    judged = [guess.right for guess in candidates if guess.right is not None]
    flags += ["failed"] if record.status == "failed" else []
    flags += ["unimagined"] if judged and not any(judged) else []
    return flags + (["repaired"] if record.status != "failed" and is_repaired(record) else [])


def _fates(
    record: HourRecord, evening: Evening | None, helps: Callable[[HourRecord], Helps] | None, *, imagines: bool
) -> Fates | None:
    human, robot = record.human, record.robot
    if helps is None or human is None or robot is None or record.status != "ok" or human.intention.away:
        return None
    try:
        return hour_fates(human, robot, meant(record, evening), helps(record), imagines=imagines)
    except CooperaError:  # a home that cannot be found any more
        return None


def _own_tasks(record: HourRecord, fates: Fates | None) -> list[OwnTask]:
    if record.human is None:
        return []
    left = human_outcomes(record)
    found = []
    for number, task in enumerate(record.human.tasks):
        outcome = next((one for one in left if one.act == task.act), None)
        if outcome is not None:
            left.remove(outcome)
        fate = "watched" if number == 0 else None
        if number and fates is not None:
            fate = fates.tasks[number - 1] or "helped"
        found.append(OwnTask(task, outcome, fate))
    return found


def _acts(robot: RobotHour, fates: Fates | None) -> list[ActView]:
    """The accepted tasks in the order in which they were done, those that came to nothing last."""
    left = [*robot.tasks]
    found: list[ActView] = []
    why = [(task, fate) for task, fate in fates.acts] if fates else []
    for number, outcome in enumerate(robot.outcomes):
        task = next((one for one in left if one.accepted and one.act == outcome.act), None)
        if task is None:
            continue
        left.remove(task)
        found.append(ActView(task, outcome, _fate(task, why, known=fates is not None), f"help-{number}"))
    rest = [ActView(task, None, FAILED) for task in left if task.accepted]
    return [*found, *rest]


def _fate(task: TaskCandidate, why: list[tuple[TaskCandidate, str | None]], *, known: bool) -> str | None:
    """What became of an act; what is told of it is taken out, for the same act may stand there twice."""
    if not known:
        return None
    one = next((one for one in why if one[0] == task), None)
    if one is None:
        return None
    why.remove(one)
    return one[1] or "helped"


def _candidates(robot: RobotHour, evening: Evening | None, hour: int) -> list[CandidateView]:
    right = intention_verdicts(evening, hour)
    tasks = _tasks(robot, evening, hour)
    candidates = [
        CandidateView(
            candidate, right.get(candidate.text), [one for one in tasks if one.task.intention == candidate.text]
        )
        for candidate in robot.intentions
    ]
    known = {candidate.text for candidate in robot.intentions}
    loose = [one for one in tasks if one.task.intention not in known]
    if loose:  # a method that skips intentions
        candidates.append(CandidateView(IntentionCandidate(text="no intention"), None, loose))
    return candidates


def _tasks(robot: RobotHour, evening: Evening | None, hour: int) -> list[TaskView]:
    items = [one for one in evening.feedback if one.hour == hour and one.kind == "task"] if evening else []
    in_order = len(items) == len(robot.tasks)  # the evening asks for every task of the hour, in order
    left = list(robot.outcomes)
    views = []
    for number, task in enumerate(robot.tasks):
        outcome = next((one for one in left if one.act == task.act), None) if task.accepted else None
        if outcome is not None:
            left.remove(outcome)
        views.append(TaskView(task, _kind(task), items[number] if in_order else None, outcome))
    return views


def _kind(task: TaskCandidate) -> str:
    if task.correct is None:
        return "unscored"
    if task.accepted:
        return "hit" if task.correct else "wrong"
    return "miss" if task.correct else "declined"


def mark_slow(hours: Sequence[HourView]) -> None:
    """Put the flag of slow hours to those of a run that are."""
    seconds = {hour.anchor: waits(hour.record.calls) for hour in hours}
    least = slow_from(list(seconds.values()))
    for hour in hours:
        if seconds[hour.anchor] >= least:
            hour.flags.append("slow")


def poses_before(records: Sequence[HourRecord]) -> dict[tuple[int, int], Mapping[str, object]]:
    """`world.poses` of the hour before each hour of a run, by (day, hour), within an episode and a home."""
    found: dict[tuple[int, int], Mapping[str, object]] = {}
    for one, other in zip(records, records[1:], strict=False):
        poses = one.world.get("poses")
        if poses and (one.episode, one.scene) == (other.episode, other.scene):
            found[other.day, other.hour] = poses
    return found
