"""A day as a supervisor graph: start_day -> hour (looped) -> feedback -> infer_traits -> learn -> end_day.

With a checkpointer, each pass through `hour` leaves a durable checkpoint. The state holds everything for the next hour:
the homes as they were left, and the robot's beliefs. So a stopped day goes on in another process.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from functools import partial
from typing import Annotated, Any, Literal

from langgraph.checkpoint.base import BaseCheckpointSaver
from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime
from typing_extensions import TypedDict

from coopera.core.errors import ModelOutputError
from coopera.core.hour import (
    DayPlan,
    Evening,
    FeedbackItem,
    HourRecord,
    IntentionCandidate,
    ModelCall,
    RobotHour,
    TaskCandidate,
)
from coopera.core.household import SceneId
from coopera.core.lazy import made_once
from coopera.core.people import Belief, PersonId
from coopera.core.randomness import Address
from coopera.graphs.events import say
from coopera.graphs.hour import HourInput, build_hour_graph, scored_at
from coopera.graphs.inside import with_inside
from coopera.graphs.players.evening import Lived
from coopera.graphs.players.player import Attending
from coopera.graphs.players.real_person import Verdict
from coopera.graphs.players.together import together
from coopera.graphs.recorded import forget_ahead, remember_day, take_over_hour, told
from coopera.graphs.robots.learning import account_of
from coopera.graphs.robots.traits import accounts, revise
from coopera.graphs.services import Services

_hour_graph = made_once()(build_hour_graph)


class DayInput(TypedDict):
    """What starts a day: its plan, and what earlier days left behind (empty on the first)."""

    plan: DayPlan
    worlds: dict[SceneId, dict[str, Any]]
    beliefs: dict[PersonId, Belief]
    learned: list[int]


class DayState(DayInput, total=False):
    """State of a day. `worlds`, `beliefs` and `learned` are handed on to the next day.

    `learned`: the days of this episode, in order, whose evenings the classifiers have learned from.
    """

    position: int  # by start_day and hour: the next hour's place in the plan
    feedback: list[FeedbackItem]  # by feedback
    traits_reasons: dict[str, str]  # by infer_traits
    measured: dict[str, Any]  # by learn
    calls: Annotated[list[ModelCall], operator.add]  # by feedback and infer_traits: asked of models this evening


def first_day(plan: DayPlan) -> DayInput:
    """The input of a day that no other came before."""
    return DayInput(plan=plan, worlds={}, beliefs={}, learned=[])


def build_day_graph(
    checkpointer: BaseCheckpointSaver[Any] | None = None,
) -> CompiledStateGraph[DayState, Services, DayInput, DayState]:
    """Compile the day; invoke it with a `DayInput` and `Services`, or use it as a node of the study.

    Its drawing with `get_graph(xray=True)` shows the hour inside, and in the hour the person and the robot.
    """
    graph = StateGraph(DayState, context_schema=Services, input_schema=DayInput)
    for node in (start_day, hour, feedback, infer_traits, learn, end_day):
        graph.add_node(node)
    graph.add_edge(START, "start_day")
    graph.add_edge("start_day", "hour")
    graph.add_conditional_edges("hour", next_hour, ["hour", "feedback", "end_day"])
    graph.add_edge("feedback", "infer_traits")
    graph.add_edge("infer_traits", "learn")
    graph.add_edge("learn", "end_day")
    graph.add_edge("end_day", END)
    return with_inside(graph.compile(checkpointer=checkpointer, name="day"), {"hour": _hour_graph()})


def start_day(state: DayInput, runtime: Runtime[Services]) -> dict[str, Any]:
    """Begin at the first hour, knowing nothing of what is yet to come. Writes `position`."""
    forget_ahead(runtime.context, state["plan"], sorted(runtime.context.people))
    say(state["plan"].day)
    return {"position": 0}


def hour(state: DayState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Live one hour, with the home and the classifiers as the state says. Writes `position` and `worlds`.

    An hour that stands in the trace is taken over from there, as an evening is by the nodes after it.
    """
    services, plan, position = runtime.context, state["plan"], state["position"]
    if lived := services.recorder.read_hour(plan.day, plan.hours[position]):
        return _after(state, take_over_hour(services, plan, lived))
    forget_ahead(services, plan, [plan.person])
    services.pupil.be_at(state["learned"])
    services.home(plan.scene).restore(state["worlds"].get(plan.scene, {}))
    services.home(plan.scene).inhabit(services.human_agent, services.people[plan.person])
    services.ask.take_calls()
    say(plan.day, plan.hours[position])
    belief = state["beliefs"].get(plan.person, Belief())
    given = HourInput(plan=plan, position=position, belief=belief, beliefs=state["beliefs"])
    done = _hour_graph().invoke(given, context=services.here())
    return _after(state, done["world"])


def next_hour(state: DayState, runtime: Runtime[Services]) -> Literal["hour", "feedback", "end_day"]:
    """Loop until the plan's hours are lived; an evening that stands in the trace needs no more than its end."""
    if state["position"] < len(state["plan"].hours):
        return "hour"
    return "end_day" if runtime.context.recorder.read_evening(state["plan"].day) else "feedback"


def feedback(state: DayState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Ask the person for feedback on all candidates of today, and take the measures left for now. Writes `feedback`.

    All of it goes out together; a real person is asked one thing after another, in the end. Adds to `calls`.

    PAPER §3.3: yes or no with a reason per task. DEVIATES: the person answers for the intention candidates too, and for
    the whole superset, not only for the tasks done. So the classifiers do not bias their own labels. How many questions
    are answered, and how many answers are slips, is set by `Services.answering` (the paper: all, and none).
    """
    services, plan = runtime.context.here(), state["plan"]
    if services.recorder.read_evening(plan.day):
        return {"feedback": []}
    ctx = services.human(plan)
    measures = [partial(_measure_late, services, plan, hour) for hour in _unmeasured(services, plan)]
    if measures:
        services.home(plan.scene).restore(state["worlds"].get(plan.scene, {}))
    heard = [(one.hour, one.human, one.robot) for one in _told(services, plan)]
    answered = [(hour, human, robot) for hour, human, robot in heard if human is not None and robot is not None]
    lived = [Lived(plan.clock(plan.hours.index(hour)), human, robot) for hour, human, robot in answered]
    questions = [partial(ctx.player.verdicts, clock, ctx, human, robot) for clock, human, robot in lived]
    if ctx.player.one_by_one:
        together(measures)
        there = ctx.player if isinstance(ctx.player, Attending) else None
        said = there.evening(ctx, lived) if there else [question() for question in questions]
    else:
        waits = bool(measures) or not services.ask.instant("human")
        said = together([*measures, *questions], waits=waits)[len(measures) :]
    meant = [_as_items(hour.clock.hour, hour.robot, verdicts) for hour, verdicts in zip(lived, said, strict=True)]
    items: list[FeedbackItem] = []
    for (hour, _, _), mean in zip(answered, meant, strict=True):
        items += services.answering.given(mean, services.rng(Address(plan.person, plan.episode_day, hour, "answering")))
    return {"feedback": items, "calls": services.ask.take_calls()}


def infer_traits(state: DayState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Revise the robot's belief about the person from today's accounts.

    Writes `beliefs` and `traits_reasons`; adds to `calls`. A reply that cannot be read leaves the belief as it was.
    """
    services, plan = runtime.context, state["plan"]
    if services.recorder.read_evening(plan.day):
        return {"traits_reasons": {}}
    past = accounts(_told(services, plan), plan.episode_day * 24)
    belief = state["beliefs"].get(plan.person, Belief())
    if not services.method.traits or not past:
        return {"traits_reasons": {}}
    clock = plan.clock(len(plan.hours) - 1)
    at = Address(plan.person, clock.day, clock.hour, "infer_traits")
    try:
        seen, reasons = revise(services.ask, at, clock, past, belief, evening=True)
    except ModelOutputError as err:
        return {"traits_reasons": {"failed": str(err)}, "calls": services.ask.take_calls()}
    return {
        "beliefs": {**state["beliefs"], plan.person: seen},
        "traits_reasons": reasons,
        "calls": services.ask.take_calls(),
    }


def learn(state: DayState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Train who learns from the day's truth. Writes `learned` and `measured`."""
    services, plan = runtime.context, state["plan"]
    if services.recorder.read_evening(plan.day) or not (services.method.robot and services.method.learns):
        return {"measured": {}}
    belief = state["beliefs"].get(plan.person, Belief())
    account = account_of(plan, _told(services, plan), state["feedback"], belief)
    measured = services.pupil.learn(plan.day, state["learned"], account)
    return {"measured": measured, "learned": [*state["learned"], plan.day]}


def end_day(state: DayState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Keep the day's truth as history and write the evening's trace, or take over what stands there.

    Then also writes `beliefs` and `learned`. All memories are on disk before the evening is: only the hours of a day
    that was broken off may be missing there, and those stand in the trace.
    """
    services, plan = runtime.context, state["plan"]
    if services.method.robot:
        remember_day(services, plan, _told(services, plan))
    services.memories("history", plan.episode, plan.person).flush()
    if past := services.recorder.read_evening(plan.day):
        return _as_it_was(services, state, past)
    services.recorder.write_evening(
        Evening(
            day=plan.day,
            episode=plan.episode,
            episode_day=plan.episode_day,
            person=plan.person,
            scene=plan.scene,
            feedback=state["feedback"],
            belief=state["beliefs"].get(plan.person, Belief()),
            traits_reasons=state["traits_reasons"],
            learned=state["measured"],
            calls=[*state.get("calls", []), *services.ask.take_calls()],
        )
    )
    say(plan.day)
    return {}


def _after(state: DayState, world: dict[str, Any]) -> dict[str, Any]:
    return {"position": state["position"] + 1, "worlds": {**state["worlds"], state["plan"].scene: world}}


def _as_it_was(services: Services, state: DayState, past: Evening) -> dict[str, Any]:
    """Have the robot know what it knew after an evening that stands in the trace."""
    plan, method = state["plan"], services.method
    learned = [day for day in state["learned"] if day != plan.day]
    learned += [plan.day] if method.robot and method.learns else []
    return {"beliefs": {**state["beliefs"], plan.person: past.belief}, "learned": learned}


def _told(services: Services, plan: DayPlan) -> list[HourRecord]:
    """The day's hours as the evening speaks of them: the person's own, or those of a stranger in their place."""
    return told(plan, services.recorder.read_day(plan.day), services.stranger)


def _unmeasured(services: Services, plan: DayPlan) -> list[HourRecord]:
    """The day's hours of which measures are still to be taken."""
    hours = services.recorder.read_day(plan.day)
    return [hour for hour in hours if hour.success and services.score.misses(hour.success)]


def _measure_late(services: Services, plan: DayPlan, hour: HourRecord) -> None:
    """Take the measures that an hour misses, and write its trace again, as a whole, with the calls that they took."""
    at = scored_at(plan, hour.hour)
    success = services.score.complete(services.home(plan.scene), at, hour)
    calls = [call.model_copy(update={"late": True}) for call in services.ask.take_calls(at)]
    services.recorder.write_hour(hour.model_copy(update={"success": success, "calls": [*hour.calls, *calls]}))


def _as_items(hour: int, robot: RobotHour, said: Sequence[Verdict]) -> list[FeedbackItem]:
    guesses, offers = [c.text for c in robot.intentions], [t.act.describe() for t in robot.tasks]
    return [
        *_items(hour, "intention", guesses, robot.intentions, said[: len(guesses)]),
        *_items(hour, "task", offers, robot.tasks, said[len(guesses) :]),
    ]


def _items(
    hour: int,
    kind: Literal["intention", "task"],
    texts: Sequence[str],
    candidates: Sequence[IntentionCandidate | TaskCandidate],
    answers: Sequence[Verdict],
) -> list[FeedbackItem]:
    return [
        FeedbackItem(
            hour=hour,
            kind=kind,
            text=text,
            accepted=bool(candidate.accepted),
            helpful=answer.yes,
            reason=answer.reason,
            grade=answer.grade,
            asked=answer.asked,
            answered_as=answer.answered_as,
        )
        for text, candidate, answer in zip(texts, candidates, answers, strict=True)
    ]
