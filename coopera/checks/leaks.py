"""The audit of leaks: whatever the person is up to, a robot that is shown the same gets the same and does the same.

Two lives begin with the same day and its evening. On the second day they look alike, hour by hour: the same first task
in the same home. All that is hidden differs: who the person is, what they intend, and their other tasks. Until that
evening, everything that reaches the robot and everything that it does must be equal in both.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, cast

from coopera.core.clock import Clock
from coopera.core.errors import ConformanceError
from coopera.core.hour import DayAccount, DayPlan, Example, HumanHour, ModelCall, Proposal, RobotHour, Task
from coopera.core.household import Outcome
from coopera.core.people import BigFive, Persona
from coopera.core.protocols import Ask, Classifier, Reply, Role
from coopera.core.randomness import Address
from coopera.graphs import Robot, RobotView, Services, build_day_graph, first_day
from coopera.graphs.day import DayInput
from coopera.graphs.life import LivedNow
from coopera.graphs.robots.own_robot import OwnRobot

Hours = Mapping[tuple[int, int], HumanHour]
"""What a person does, by day of the run and hour."""


class Hidden(NamedTuple):
    """What cannot be seen of a life. Of each hour's tasks, the first one is seen."""

    persona: Persona
    hours: Hours


class Reached(NamedTuple):
    """Everything that reached a robot on a day, and everything that it did, each with its hour."""

    prompts: list[tuple[int, Any]]
    judged: list[tuple[int, Example]]
    views: list[tuple[int, Any]]
    did: list[tuple[int, RobotHour]]

    def difference(self, other: Reached) -> str | None:
        """Name the first thing that differs, and its hour."""
        parts: dict[str, tuple[Sequence[tuple[int, Any]], Sequence[tuple[int, Any]]]] = {
            "what its language model was asked": (self.prompts, other.prompts),
            "what its classifiers were shown": (self.judged, other.judged),
            "what it was given": (self.views, other.views),
            "what it did": (self.did, other.did),
        }
        for hour, _ in self.did:
            for what, lives in parts.items():
                one, two = ([thing for at, thing in life if at == hour] for life in lives)
                if one != two:
                    return f"{what} at {hour}:00"
        return None


def check_no_leak(one: Reached, other: Reached, name: str) -> None:
    """Compare what reached a robot in two lives that look alike.

    Raises:
        ConformanceError: Naming the method and what differs.
    """
    if what := one.difference(other):
        raise ConformanceError(
            f"{name}: in two lives that look alike, {what} differs with what the person hides; a robot may rest on "
            "its RobotView alone."
        )


def reached(services: Services, days: Sequence[DayPlan], before: Hidden, hidden: Hidden) -> Reached:
    """Live a day and its evening, then the hours of another day, and listen to the robot on that one.

    Args:
        services: Of a fresh run, which is changed by this.
        days: The two days, of one person in one home.
        before: The life on the first day: the same in lives that are compared.
        hidden: The life on the second day.

    Raises:
        ConformanceError: If an hour failed, so that nothing can be said.
    """
    heard = Reached([], [], [], [])
    services = _listening(services, heard)
    done = build_day_graph().invoke(first_day(days[0]), context=_living(services, before))
    for part in heard:
        part.clear()
    given = cast(DayInput, {"plan": days[1], **{key: done[key] for key in ("worlds", "beliefs", "learned")}})
    stream = build_day_graph().stream(given, context=_living(services, hidden), stream_mode="updates")
    left = len(days[1].hours)
    while left:
        left -= "hour" in next(stream)
    heard.prompts.sort(key=lambda asked: asked[1][:2])  # tasks are imagined in threads, in any order
    for hour in services.recorder.read_day(days[1].day):
        if hour.robot is None:
            raise ConformanceError(f"method {services.method.name}: day {hour.day} at {hour.hour}:00: {hour.reason}")
        tasks = [task.model_copy(update={"correct": None}) for task in hour.robot.tasks]
        heard.did.append((hour.hour, hour.robot.model_copy(update={"tasks": tasks})))
    return heard


def decided(services: Services, days: Sequence[DayPlan]) -> Hidden:
    """What the person of these days would do in a home that stays as it was built; nothing is done."""
    hours, now = {}, LivedNow()
    for plan in days:
        services.home(plan.scene).restore({})
        for position, hour in enumerate(plan.hours):
            clock = plan.clock(position)
            hours[plan.day, hour] = now.decide(services, plan, clock)
            now.end(services, plan, clock, hours[plan.day, hour])
    return Hidden(services.people[days[0].person], hours)


def alike(life: Hidden) -> Hidden:
    """A life that looks like this one: each hour begins with the same task and has another hour's secrets.

    Raises:
        ConformanceError: If the person wants the same in each hour.
    """
    hours = {}
    for when, mine in life.hours.items():
        others = [one for one in life.hours.values() if one.intention.text != mine.intention.text]
        if not others:
            raise ConformanceError("the audit of leaks needs a person who does not want the same in each hour.")
        other = others[0]
        first = other.tasks[0].model_copy(update={"act": mine.tasks[0].act})
        hours[when] = other.model_copy(update={"tasks": [first, *other.tasks[1:]]})
    hidden = {"name": "Noor", "profile": "I write poems at night.", "notes": "I write poems."}
    moods = BigFive(openness=1.5, neuroticism=4.5)
    return Hidden(life.persona.model_copy(update={**hidden, "big_five": moods}), hours)


class HiddenLife(LivedNow):
    """A life that is known beforehand. What comes after the first task is not seen, so it leaves the home alone."""

    def __init__(self, hours: Hours) -> None:
        self._hours = hours

    def decide(self, services: Services, plan: DayPlan, clock: Clock) -> HumanHour:
        """What is known."""
        services.memories("human", plan.episode, plan.person).forget_from(clock.now)
        return self._hours[plan.day, clock.hour]

    def finish(self, services: Services, plan: DayPlan, clock: Clock, left: Sequence[Task]) -> list[Outcome]:
        """Say that all of it was done."""
        return [Outcome(agent="human", act=task.act, ok=True) for task in left]


def _living(services: Services, hidden: Hidden) -> Services:
    return replace(services, people={hidden.persona.id: hidden.persona}, life=HiddenLife(hidden.hours))


def _listening(services: Services, heard: Reached) -> Services:
    """The same services, with an ear at each door to the robot."""
    learner, own = services.learner, services.own
    fresh = {kind: partial(_ListeningClassifier, make, heard.judged) for kind, make in learner.fresh.items()}
    return replace(
        services,
        ask=_ListeningAsk(services.ask, heard.prompts),
        learner=replace(learner, fresh=fresh),
        own=OwnRobot(partial(_ListeningRobot, own.make, heard.views), own.recorder, own.seed) if own else None,
    )


class _ListeningAsk:
    """A door that writes down what the robot asks, with file names instead of paths."""

    def __init__(self, ask: Ask, heard: list[tuple[int, Any]]) -> None:
        self._ask, self._heard = ask, heard

    def __call__(
        self,
        prompt: str,
        reply: type[Reply],
        /,
        *,
        at: Address,
        variables: Mapping[str, Any],
        images: Sequence[Path] = (),
    ) -> Reply:
        if prompt.startswith("robot/"):
            self._heard.append((at.hour, (prompt, at, dict(variables), [image.name for image in images])))
        return self._ask(prompt, reply, at=at, variables=variables, images=images)

    def sees(self, role: Role) -> bool:
        return self._ask.sees(role)

    def instant(self, role: Role) -> bool:
        return self._ask.instant(role)

    def take_calls(self, at: Address | None = None) -> list[ModelCall]:
        return self._ask.take_calls(at)


class _ListeningClassifier:
    """A classifier that writes down what it judges."""

    def __init__(self, make: Callable[[], Classifier], heard: list[tuple[int, Example]]) -> None:
        inner = make()
        self._inner, self._heard = inner, heard
        self.train, self.save, self.load = inner.train, inner.save, inner.load

    @property
    def gives_chances(self) -> bool:
        return bool(getattr(self._inner, "gives_chances", False))

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        self._heard.extend((example.hour, example) for example in examples)
        return self._inner.probabilities(examples)


class _ListeningRobot:
    """A robot of one's own that writes down what it is given."""

    def __init__(self, make: Callable[[], Robot], heard: list[tuple[int, Any]]) -> None:
        self._inner, self._heard = make(), heard

    def help(self, view: RobotView) -> Proposal:
        data = (view.clock, view.observation, view.person, view.belief, view.collab, view.home, view.looks)
        memories = [stream.records() for kept in (view.history, view.guesses) for stream in kept]
        self._heard.append((view.clock.hour, (*data, [picture.name for picture in view.pictures], memories)))
        return self._inner.help(view)

    def learn(self, account: DayAccount, /, *, seed: int) -> dict[str, Any]:
        return self._inner.learn(account, seed=seed)
