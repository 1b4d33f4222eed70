"""Every method is audited: in two lives that look alike it gets the same and does the same (`coopera.checks.leaks`)."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from types import FrameType, FunctionType
from typing import Any

import pytest

import coopera.graphs.robot
from coopera.checks.leaks import Hidden, HiddenLife, Reached, check_no_leak, reached
from coopera.core.clock import Clock
from coopera.core.errors import ConformanceError
from coopera.core.hour import (
    DayAccount,
    DayPlan,
    Example,
    Found,
    HourRecord,
    HumanHour,
    Intention,
    IntentionCandidate,
    Observation,
    Proposal,
    Task,
    TaskCandidate,
)
from coopera.core.household import Collab, FreeMotion, HandOver, Outcome, PickPlace, SceneId
from coopera.core.people import BigFive, Circumstance
from coopera.evaluation import METHODS
from coopera.graphs import Method, RobotView, Services
from coopera.graphs.robots.own_robot import OwnRobot
from coopera.memory import MemoryStream
from coopera.memory.ram import RamClient
from tests.fakes import MARA, LetterEmbeddings, ScriptedAsk, TableClassifier, placing, type2_answers
from tests.graphs.conftest import MakeServices

HOURS = (9, 10)
HIDING = [name for name, method in METHODS.items() if method.robot and not method.told_the_truth]
NOOR = MARA.model_copy(
    update={"name": "Noor", "profile": "I write poems.", "notes": "", "big_five": BigFive(openness=1.5)}
)


def baker(collab: Collab = 2) -> Hidden:
    things = [("spoon", "stove_1"), ("ladle", "sofa_1"), ("whisk", "sofa_1")]
    return Hidden(MARA, hours("Bake for the village fair", things, collab))


def poet(collab: Collab = 2) -> Hidden:
    """Begins each hour as the baker does; on the first day it is the baker's life."""
    things = [("pen", "desk_1"), ("notebook", "stove_1"), ("lamp", "stove_1")]
    low = Circumstance(kind="mood", text="I feel low today", strength=1.0)
    return Hidden(NOOR, hours("Write a poem about the rain", things, collab, [low]))


def hours(
    intention: str, things: Sequence[tuple[str, str]], collab: Collab, felt: Sequence[Circumstance] = ()
) -> dict[tuple[int, int], HumanHour]:
    """A first task that is the same in every life, then what only this one does."""
    places = {"desk_1": 1, "sofa_1": 2, "stove_1": 3}
    acts: list[PickPlace | FreeMotion]
    if collab == 1:
        acts = [PickPlace(object_id=5, object="mug_1", receptacle_id=1, receptacle="desk_1")]
        acts += [PickPlace(object_id=4, object="book_1", receptacle_id=places[p], receptacle=p) for _, p in things]
    else:
        acts = [FreeMotion(target_id=3, target="stove_1", in_hand="pot", motion="stir a pot")]
        acts += [FreeMotion(target_id=places[p], target=p, in_hand=thing, motion="stand") for thing, p in things]
    tasks = [Task(id=f"9.{n}", thought=intention, act=act) for n, act in enumerate(acts, 1)]
    found = Found(fixed={}, movable={}, motions=[])
    hour = HumanHour(
        recalled=[],
        intention=Intention(text=intention),
        found=found,
        tasks=tasks,
        reflections=[],
        circumstances=list(felt),
    )
    return {(day, hour_of_day): hour for day in (0, 1) for hour_of_day in HOURS}


def live(
    make_services: MakeServices,
    folder: Path,
    hidden: Hidden,
    *,
    method: str | Method = "ours",
    collab: Collab = 2,
    before: Hidden | None = None,
    **changed: Any,
) -> Reached:
    answers = type2_answers()
    answers["robot/tasks_type1"] = lambda v: {"tasks": [placing("mug_2", "sofa_1", 6, 2)]}
    services = make_services(ask=ScriptedAsk(answers), folder=folder, **changed)
    services = replace(services, stream=streams_in_ram())
    method = METHODS[method] if isinstance(method, str) else method
    own = OwnRobot(method.own, services.recorder) if method.own else None
    services = replace(services, method=method, own=own)
    if method.judge:
        fresh = {kind: lambda kind=kind: method.judge(kind) for kind in services.learner.fresh}  # type: ignore[misc]
        services = replace(services, learner=replace(services.learner, fresh=fresh))
    days = [
        DayPlan(day=day, episode_day=day, person=MARA.id, scene=SceneId("toy"), hours=list(HOURS), collab=collab)
        for day in (0, 1)
    ]
    return reached(services, days, before or baker(collab), hidden)


def streams_in_ram() -> Callable[[str], MemoryStream]:
    client, opened = RamClient(), dict[str, MemoryStream]()

    def stream(name: str) -> MemoryStream:
        if name not in opened:
            opened[name] = MemoryStream.open(client, name, LetterEmbeddings())
        return opened[name]

    return stream


def audit(make_services: MakeServices, folder: Path, **options: Any) -> tuple[Reached, Reached]:
    collab: Collab = options.get("collab", 2)
    one, other = (live(make_services, folder / str(n), life(collab), **options) for n, life in enumerate((baker, poet)))
    return one, other


@pytest.mark.parametrize("collab", [1, 2])
@pytest.mark.parametrize("method", HIDING)
def test_nothing_that_was_not_seen_reaches_the_robot(
    make_services: MakeServices, tmp_path: Path, method: str, collab: Collab
) -> None:
    one, other = audit(make_services, tmp_path, method=method, collab=collab)
    assert one.prompts or one.views
    assert len(one.did) == len(HOURS)
    check_no_leak(one, other, method)


def test_traits_inferred_hour_by_hour_rest_on_the_robots_own_guesses_alone(
    make_services: MakeServices, tmp_path: Path
) -> None:
    one, other = audit(make_services, tmp_path, hourly_traits=True)
    [variables] = [variables for _, (prompt, _, variables, _) in one.prompts if prompt == "robot/traits"]
    assert [memory["text"] for memory in variables["intentions"]] == ["Cook a meal"]
    check_no_leak(one, other, "ours")


def test_the_audit_hears_what_an_oracle_is_told(make_services: MakeServices, tmp_path: Path) -> None:
    one, other = audit(make_services, tmp_path, method="oracle")
    with pytest.raises(ConformanceError, match="oracle: .* what its language model was asked at 9:00"):
        check_no_leak(one, other, "oracle")


@pytest.mark.parametrize("method", ["ours", "frequency_prior"])
def test_the_audit_hears_what_is_told_in_the_evening_before(
    make_services: MakeServices, tmp_path: Path, method: str
) -> None:
    one, other = (
        live(make_services, tmp_path / str(n), baker(), before=life(), method=method)
        for n, life in enumerate((baker, poet))
    )
    assert one.difference(other)


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


@pytest.mark.parametrize("leak", [in_words, in_the_percept, in_memory])
def test_the_audit_finds_the_truth_where_it_is_let_through(
    make_services: MakeServices, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, leak: Leak
) -> None:
    class Leaky(HiddenLife):
        def show(self, services: Services, plan: DayPlan, clock: Clock, first: Task) -> tuple[Observation, Outcome]:
            seen, outcome = super().show(services, plan, clock, first)
            return leak(services, plan, clock, self.decide(services, plan, clock), seen), outcome

    monkeypatch.setattr("coopera.checks.leaks.HiddenLife", Leaky)
    one, other = audit(make_services, tmp_path)
    assert one.difference(other) == "what its language model was asked at 9:00"


def test_the_audit_finds_the_truth_in_what_a_classifier_reads(
    make_services: MakeServices, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sound = coopera.graphs.robot.example
    found = []
    for n, life in enumerate((baker(), poet())):

        def leaky(*args: Any, life: Hidden = life, **fields: Any) -> Example:
            return sound(*args, **fields).model_copy(update={"tasks": [life.hours[1, 9].intention.text]})

        monkeypatch.setattr(coopera.graphs.robot, "example", leaky)
        found.append(live(make_services, tmp_path / str(n), life))
    one, other = found
    assert one.difference(other) == "what its classifiers were shown at 9:00"


def truth_on_the_stack() -> HumanHour:
    """What the person hides, from the hour that is being lived."""
    frame: FrameType | None = sys._getframe()
    while frame is not None:
        state = frame.f_locals.get("state")
        if isinstance(state, dict) and "human" in state:
            human: HumanHour = state["human"]
            return human
        frame = frame.f_back
    raise AssertionError("nobody lives an hour")


class Peeker:
    """Offers what it finds out, and nothing else."""

    def peek(self, view: RobotView) -> str:
        """What cannot be known."""
        raise NotImplementedError

    def help(self, view: RobotView) -> Proposal:
        return Proposal(intentions=[IntentionCandidate(text=self.peek(view), accepted=True)])

    def learn(self, account: DayAccount, /, *, seed: int) -> dict[str, Any]:
        return {}


class ReadsTheStack(Peeker):
    """Looks at who called it."""

    def peek(self, view: RobotView) -> str:
        return truth_on_the_stack().intention.text


class ReadsTheRun(Peeker):
    """Goes from the pictures that it is shown to the trace of the hour before."""

    def peek(self, view: RobotView) -> str:
        trace = next(folder for folder in view.pictures[0].parents if folder.name == "frames").parent / "trace"
        hours = [HourRecord.model_validate_json(path.read_text()) for path in sorted(trace.glob("day-01/*.json"))]
        return " ".join(["They wanted to", *(hour.human.intention.text for hour in hours if hour.human)])


class WeighsTheTruth(Peeker):
    """Says in all lives the same words, and lets the truth decide how sure it is."""

    def help(self, view: RobotView) -> Proposal:
        sure = len(truth_on_the_stack().tasks[1].act.describe()) / 1000
        return Proposal(intentions=[IntentionCandidate(text="Something", probability=sure, accepted=True)])


class BringsTheTruth(Peeker):
    """Does what it cannot know to be of use."""

    def help(self, view: RobotView) -> Proposal:
        act = truth_on_the_stack().tasks[1].act
        assert isinstance(act, FreeMotion)
        task = TaskCandidate(intention="It", thought="", act=HandOver(object=act.in_hand), accepted=True)
        return Proposal(intentions=[IntentionCandidate(text="It", accepted=True)], tasks=[task])


@pytest.mark.parametrize(
    ("robot", "hour"), [(ReadsTheStack, 9), (ReadsTheRun, 10), (WeighsTheTruth, 9), (BringsTheTruth, 9)]
)
def test_a_robot_that_peeks_is_caught_by_what_it_does(
    make_services: MakeServices, tmp_path: Path, robot: type[Peeker], hour: int
) -> None:
    one, other = audit(make_services, tmp_path, method=Method(name="peeker", own=robot), frames=1)
    with pytest.raises(ConformanceError, match=f"peeker: in two lives that look alike, what it did at {hour}:00"):
        check_no_leak(one, other, "peeker")


def test_a_classifier_that_peeks_is_caught_by_what_the_robot_does(make_services: MakeServices, tmp_path: Path) -> None:
    class Peeking(TableClassifier):
        def probabilities(self, examples: Sequence[Example]) -> list[float]:
            return [float("poem" in truth_on_the_stack().intention.text)] * len(examples)

    method = Method(name="peeking", judge=lambda kind: Peeking())
    one, other = audit(make_services, tmp_path, method=method)
    assert one.difference(other) == "what its language model was asked at 9:00"
    assert one.did != other.did


def test_nothing_of_the_hour_hangs_on_a_view(make_services: MakeServices, tmp_path: Path) -> None:
    """Nothing public or private that a view's objects hold leads to the person, the home's state or their files."""
    held: list[str] = []

    class Walker(Peeker):
        def help(self, view: RobotView) -> Proposal:
            held.extend(sorted({type(one).__module__ for one in reachable(view)}))
            return Proposal()

    live(make_services, tmp_path, poet(), method=Method(name="walker", own=Walker))
    ours = {module for module in held if module.startswith(("coopera", "tests"))}
    assert ours == {"coopera.core.clock", "coopera.core.hour", "coopera.core.household", "coopera.core.people"} | {
        "coopera.graphs.robots.robot_view"
    }


def reachable(thing: Any) -> list[Any]:
    """What attributes and items lead to; what a function closes over is left out, since Python hides nothing there."""
    found, ahead = dict[int, Any](), [thing]
    while ahead:
        one = ahead.pop()
        if id(one) in found or isinstance(one, (str, int, float, type(None))):
            continue
        found[id(one)] = one
        if isinstance(one, dict):
            ahead += [*one.keys(), *one.values()]
        elif isinstance(one, (list, tuple, set)):
            ahead += one
        names = [name for kind in type(one).__mro__ for name in getattr(kind, "__slots__", ())]
        if not isinstance(one, (FunctionType, type)):
            ahead += [getattr(one, name) for name in [*names, *getattr(one, "__dict__", {})] if hasattr(one, name)]
    return list(found.values())
