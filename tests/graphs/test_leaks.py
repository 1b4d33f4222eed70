"""The audit of leaks: whatever the person is up to, a robot that sees the same is told the same and says the same.

Two lives are lived that look alike: the same first task, hour by hour. All that is hidden differs: who the person is,
what they intend, why, and their tasks after the first with their objects. Until the evening, everything that reaches
the robot must be equal in both.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import coopera.graphs.robot
from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, Example, HumanHour, Observation, Proposal, Task
from coopera.core.household import Collab, Outcome, SceneId
from coopera.core.people import BigFive, Persona
from coopera.evaluation import METHODS
from coopera.graphs import Services, build_study_graph
from coopera.graphs.learning import KINDS, Learner
from coopera.graphs.life import LivedNow
from coopera.graphs.own_robot import OwnRobot
from coopera.graphs.robot_view import RobotView
from tests.fakes import MARA, ScriptedAsk, TableClassifier, moving, placing, type2_answers
from tests.graphs.conftest import MakeServices

HOURS = 2


class Life(NamedTuple):
    """What cannot be seen of a life."""

    persona: Persona
    intention: str
    things: tuple[str, ...]
    places: tuple[str, ...]


BAKER = Life(MARA, "Bake for the village fair", ("spoon", "ladle", "whisk", "fork"), ("stove_1", "sofa_1"))
POET = Life(
    MARA.model_copy(
        update={
            "name": "Noor",
            "profile": "I write poems at night.",
            "notes": "I write poems.",
            "big_five": BigFive(openness=1.5, neuroticism=4.5),
        }
    ),
    "Write a poem about the rain",
    ("pen", "notebook", "lamp", "eraser"),
    ("desk_1", "stove_1"),
)
OFTEN = ("ours", "intention_agnostic", "frequency_prior")  # ways of their own; the others leave something out of ours
HIDING = [name for name, method in METHODS.items() if method.robot and method.intentions != "given"]


def tasks(life: Life, collab: Collab) -> list[dict[str, Any]]:
    """A first task that is the same in every life, then what only this one does."""
    if collab == 1:
        return [placing("mug_1", "desk_1", 5, 1), *(placing("book_1", place, 4) for place in life.places)]
    first = moving("stove_1", "pot", "stir a pot", 3)
    rest = [moving("stove_1", thing, f"stir a pot {thing}", 3) for thing in life.things]
    return [first, *({**task, "thought": f"To {life.intention}."} for task in rest)]


class Heard(NamedTuple):
    """Everything that reached the robot, and everything that it said."""

    prompts: list[Any]
    judged: list[Example]
    given: list[Any]
    said: list[Any]


class Listening:
    """A classifier that writes down what it is asked."""

    def __init__(self, heard: list[Example]) -> None:
        self._inner = TableClassifier()
        self._heard = heard
        self.train, self.save, self.load = self._inner.train, self._inner.save, self._inner.load

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        self._heard.extend(examples)
        return self._inner.probabilities(examples)


class Watched:
    """A robot of one's own that writes down what it is given and what its memories hold."""

    def __init__(self, inner: Any, heard: list[Any]) -> None:
        self._inner, self._heard = inner, heard

    def help(self, view: RobotView) -> Proposal:
        memories = [
            stream.recall("anything at all", view.clock.now, 9)
            for kept in (view.history, view.guesses)
            for stream in (kept.intentions, kept.tasks)
        ]
        self._heard.append((view.clock, view.observation, view.belief, view.person, view.home, memories))
        proposal: Proposal = self._inner.help(view)
        return proposal

    def learn(self, told: Any, *, seed: int) -> dict[str, Any]:
        learned: dict[str, Any] = self._inner.learn(told, seed=seed)
        return learned


def live(
    make_services: MakeServices,
    folder: Path,
    life: Life,
    *,
    method: str = "ours",
    collab: Collab = 2,
    days: int = 1,
    lived: LivedNow | None = None,
    **changed: bool,
) -> Heard:
    """Live some days; return what reached the robot by the last of them, before that day's evening."""
    answers = type2_answers() | {
        "human/intention": lambda v: {"intention": life.intention, "reason_human": life.persona.profile},
        **{f"human/tasks_type{n}": lambda v: {"tasks": tasks(life, collab)} for n in (1, 2)},
        **{
            f"human/reflect_{by}_type{n}": lambda v: {
                "verdicts": [{"yes": True, "reason": life.intention}] * len(tasks(life, collab)),
                "tasks": tasks(life, collab),
            }
            for by in ("profile", "scene")
            for n in (1, 2)
        },
        "robot/tasks_type1": lambda v: {"tasks": [placing("mug_2", "sofa_1", 6, 2)]},
    }
    ask, judged, given = ScriptedAsk(answers), list[Example](), list[Any]()
    services = make_services(ask=ask, method=method, folder=folder, **changed)
    services = replace(
        services,
        people={MARA.id: life.persona},
        life=lived or LivedNow(),
        learner=Learner(dict.fromkeys(KINDS, lambda: Listening(judged)), services.recorder),
    )
    if own := METHODS[method].own:
        services = replace(services, own=OwnRobot(lambda: Watched(own(), given), services.recorder))
    # in type 1 the person's tasks move what the robot then sees; so that a day is looked at for one hour
    hours = [9 + n for n in range(HOURS if collab == 2 else 1)]
    schedule = [
        DayPlan(day=day, episode_day=day, person=MARA.id, scene=SceneId("toy"), hours=hours, collab=collab)
        for day in range(days)
    ]
    build_study_graph().invoke({"schedule": schedule}, context=services)
    prompts = sorted(
        (
            (prompt, at, variables)
            for prompt, at, variables in ask.asked
            if prompt.startswith("robot/") and not variables.get("evening")
        ),
        key=lambda asked: asked[:2],  # tasks are imagined in threads, in any order
    )
    lived = [hour.robot for hour in services.recorder.read_day(days - 1)]
    assert len(lived) == len(hours)
    assert all(lived)
    said = [
        robot.model_copy(update={"tasks": [t.model_copy(update={"correct": None}) for t in robot.tasks]})
        for robot in lived
        if robot
    ]
    return Heard(prompts, judged, given, said)


@pytest.mark.parametrize("collab", [1, 2])
@pytest.mark.parametrize(
    "method", [name if name in OFTEN else pytest.param(name, marks=pytest.mark.slow) for name in HIDING]
)
def test_before_the_evening_nothing_that_was_not_seen_reaches_the_robot(
    make_services: MakeServices, tmp_path: Path, method: str, collab: Collab
) -> None:
    one, other = (
        live(make_services, tmp_path / name, life, method=method, collab=collab)
        for name, life in (("baker", BAKER), ("poet", POET))
    )
    assert one.prompts or one.given
    assert one == other


def test_traits_inferred_hour_by_hour_rest_on_the_robots_own_guesses_alone(
    make_services: MakeServices, tmp_path: Path
) -> None:
    one, other = (
        live(make_services, tmp_path / name, life, hourly_traits=True) for name, life in (("a", BAKER), ("b", POET))
    )
    [(_, _, variables)] = [asked for asked in one.prompts if asked[0] == "robot/traits"]
    assert [memory["text"] for memory in variables["intentions"]] == ["Cook a meal"]
    assert one == other
    assert [robot.belief.profile for robot in one.said] == [None, "Cooks a lot."]


def test_the_audit_sees_what_an_oracle_is_told_and_what_every_robot_is_told_in_the_evening(
    make_services: MakeServices, tmp_path: Path
) -> None:
    for method, days in (("oracle", 1), ("ours", 2), ("frequency_prior", 2)):
        one, other = (
            live(make_services, tmp_path / method / str(n), life, method=method, days=days)
            for n, life in enumerate((BAKER, POET))
        )
        assert one != other


Leak = Callable[[Services, DayPlan, Clock, HumanHour, Observation], Observation]


def in_words(services: Services, plan: DayPlan, clock: Clock, human: HumanHour, seen: Observation) -> Observation:
    return seen.model_copy(update={"first_task": human.intention.text})


def in_the_percept(services: Services, plan: DayPlan, clock: Clock, human: HumanHour, seen: Observation) -> Observation:
    assert seen.percept is not None
    thing = human.tasks[1].act.describe().split("with the ")[-1]
    return seen.model_copy(update={"percept": seen.percept.model_copy(update={"in_hand": thing})})


def in_memory(services: Services, plan: DayPlan, clock: Clock, human: HumanHour, seen: Observation) -> Observation:
    memories = services.memories("guesses", plan.episode, plan.person)
    memories.add("A guess", [human.tasks[2].act.describe()], clock.now - 1)
    return seen


class Leaky(LivedNow):
    """A life that lets the truth through to the robot."""

    def __init__(self, leak: Leak) -> None:
        self._leak = leak

    def decide(self, services: Services, plan: DayPlan, clock: Clock) -> HumanHour:
        self._human = super().decide(services, plan, clock)
        return self._human

    def show(self, services: Services, plan: DayPlan, clock: Clock, first: Task) -> tuple[Observation, Outcome]:
        seen, outcome = super().show(services, plan, clock, first)
        return self._leak(services, plan, clock, self._human, seen), outcome


@pytest.mark.parametrize("leak", [in_words, in_the_percept, in_memory])
def test_the_audit_finds_the_truth_where_it_is_let_through(
    make_services: MakeServices, tmp_path: Path, leak: Leak
) -> None:
    one, other = (
        live(make_services, tmp_path / str(n), life, lived=Leaky(leak)) for n, life in enumerate((BAKER, POET))
    )
    assert one.prompts != other.prompts


def test_the_audit_finds_the_truth_in_what_a_classifier_reads(
    make_services: MakeServices, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sound = coopera.graphs.robot.example
    found = []
    for life in (BAKER, POET):

        def leaky(*args: Any, life: Life = life, **fields: Any) -> Example:
            return sound(*args, **fields).model_copy(update={"tasks": [life.things[0]]})

        monkeypatch.setattr(coopera.graphs.robot, "example", leaky)
        found.append(live(make_services, tmp_path / life.intention, life))
    one, other = found
    assert one.prompts == other.prompts
    assert one.judged != other.judged
