"""The robot's hour as a state machine: observe, imagine and classify intentions, imagine and classify tasks, act.

PAPER §3.3. Nothing true about the hour is an input: what the robot knows is its `RobotView`, and the graph starts from
nothing else. A robot of one's own has a graph of two nodes over the same view: propose, act.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, Any, TypeVar

from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime
from langgraph.types import Send
from typing_extensions import TypedDict

from coopera.core.errors import ModelOutputError
from coopera.core.hour import (
    IntentionCandidate,
    Observation,
    Reasons,
    Recalled,
    RobotHour,
    TaskCandidate,
)
from coopera.core.household import ROBOT, AgentId, Outcome
from coopera.core.people import Belief
from coopera.core.protocols import Home
from coopera.core.randomness import Address
from coopera.core.replies import HandOverReply, IntentionsReply, PickPlaceReply
from coopera.graphs.players.contexts import GivenByCode
from coopera.graphs.players.variables import when
from coopera.graphs.robots.evidence import weights_for
from coopera.graphs.robots.learning import Known, Learner, example
from coopera.graphs.robots.method import Method, Numbers
from coopera.graphs.robots.own_robot import Robot, checked
from coopera.graphs.robots.proposing import (
    Imagined,
    evidence_of,
    how_many,
    like_hours,
    most_telling,
    superset_of,
    with_evidence,
)
from coopera.graphs.robots.recall import as_variables, recall_hours, recall_weeks
from coopera.graphs.robots.robot_view import RobotView
from coopera.graphs.robots.sight import as_percept, in_words
from coopera.graphs.robots.told import ToldHour, as_told, held, likeness, told_hours
from coopera.graphs.robots.verdicts import judge

TASKS_REPLY: dict[int, type[PickPlaceReply | HandOverReply]] = {1: PickPlaceReply, 2: HandOverReply}


@dataclass(frozen=True, slots=True)
class Helping(GivenByCode):
    """What any robot works with in an hour: what it knows, and the home that it acts in once it has decided."""

    view: RobotView
    home: Home
    method: Method
    agent: AgentId = field(default=ROBOT, kw_only=True)
    """Whose body in the home the robot has."""
    film: Callable[[int], None] | None = field(default=None, kw_only=True)
    """Keeps pictures of the act that was recorded last, by its number in the hour; None: no act is recorded."""


@dataclass(frozen=True, slots=True)
class RobotContext(Helping):
    """What our robot's graph works with."""

    learner: Learner


@dataclass(frozen=True, slots=True)
class OwnRobotContext(Helping):
    """What the graph of a robot of one's own works with. The robot itself is given the view and nothing else."""

    robot: Robot


Context = TypeVar("Context", RobotContext, OwnRobotContext)


class RobotInput(TypedDict):
    """What starts the robot's hour: nothing, since all that it knows is its view."""


class OracleInput(RobotInput):
    """What starts an oracle's hour: the truth. Only the graph of a method that says so has this input."""

    true_intention: str


class RobotState(RobotInput, total=False):
    """Working state of the robot's hour; a key is absent until its node has run."""

    true_intention: str  # the true intention, of an oracle alone
    recalled: list[Recalled]  # by observe; again by imagine_intentions, of a robot that looks at pictures
    told: list[ToldHour]  # likewise: what was told of earlier days, oldest first
    seen: str  # by imagine_intentions: what the robot's model says it saw
    intentions: list[IntentionCandidate]  # by imagine_intentions; verdicts by classify_intentions
    alike: dict[str, list[float]]  # by imagine_intentions: how like each of these is to that of each told hour
    imagined: Annotated[list[Imagined], operator.add]  # by each imagine_tasks, in any order
    tasks: list[TaskCandidate]  # by classify_tasks; in the order of their intentions, without repeats
    outcomes: list[Outcome]  # by act, one per accepted task
    fallbacks: Annotated[list[str], operator.add]  # by whichever node had to fall back


class TaskRequest(TypedDict):
    """What one imagine_tasks gets: an accepted intention, what was seen, and what was recalled."""

    seen: str
    recalled: list[Recalled]
    told: list[ToldHour]
    alike: list[float]  # how like the intention is to that of each told hour
    intention: IntentionCandidate
    rank: int


def build_robot_graph(
    given: type[RobotInput] = RobotInput,
) -> CompiledStateGraph[RobotState, RobotContext, RobotInput, RobotState]:
    """Compile the robot's graph; invoke it with {} (an oracle's: with an `OracleInput`) and a `RobotContext`."""
    graph = StateGraph(RobotState, context_schema=RobotContext, input_schema=given)
    for node in (observe, imagine_intentions, classify_intentions, imagine_tasks, classify_tasks):
        graph.add_node(node)
    graph.add_node(act)
    graph.add_edge(START, "observe")
    graph.add_edge("observe", "imagine_intentions")
    graph.add_edge("imagine_intentions", "classify_intentions")
    graph.add_conditional_edges("classify_intentions", one_per_accepted, ["imagine_tasks"])
    graph.add_edge("imagine_tasks", "classify_tasks")
    graph.add_edge("classify_tasks", "act")
    graph.add_edge("act", END)
    return graph.compile(checkpointer=False, name="robot")


def build_own_robot_graph() -> CompiledStateGraph[RobotState, OwnRobotContext, RobotInput, RobotState]:
    """Compile the graph of a robot of one's own: it says what would help, and what it accepted is done as ours is."""
    graph = StateGraph(RobotState, context_schema=OwnRobotContext, input_schema=RobotInput)
    graph.add_node(propose)
    graph.add_node(act)
    graph.add_edge(START, "propose")
    graph.add_edge("propose", "act")
    graph.add_edge("act", END)
    return graph.compile(checkpointer=False, name="own_robot")


def robot_hour(state: RobotState, seen: Observation) -> RobotHour:
    """The finished state as it stands in the trace, with what the robot saw."""
    return RobotHour(
        observation=seen,
        seen=state.get("seen", ""),
        recalled=state["recalled"],
        intentions=state["intentions"],
        tasks=state["tasks"],
        outcomes=state["outcomes"],
        fallbacks=sorted(state.get("fallbacks", [])),
    )


def propose(state: RobotInput, runtime: Runtime[OwnRobotContext]) -> dict[str, Any]:
    """Ask a robot of one's own. Writes `recalled`, `intentions`, `tasks` and `fallbacks`.

    Raises:
        RunError: If what it proposes breaks the rules of `coopera.graphs.robots.own_robot`.
    """
    ctx = runtime.context
    said = checked(ctx.robot.help(ctx.view), ctx.view.collab, ctx.method.name)
    return {"recalled": said.recalled, "intentions": said.intentions, "tasks": said.tasks, "fallbacks": said.fallbacks}


def observe(state: RobotInput, runtime: Runtime[RobotContext]) -> dict[str, Any]:
    """Recall what the robot knows that resembles what it sees. Writes `recalled` and `told`.

    Earlier days come from the person's accounts, today from the robot's own guesses. A robot that looks at the pictures
    has not yet done so, and goes by the time alone.
    """
    return _recall(runtime.context)


def imagine_intentions(state: RobotState, runtime: Runtime[RobotContext]) -> dict[str, Any]:
    """Say what is seen, and propose what the person may be up to.

    Reads `recalled` and `told`; writes `intentions`, `alike` and `seen`. A robot that looked at the pictures now
    recalls by what it saw in them, for all that comes after: it writes `recalled` and `told` again.

    Raises:
        ModelOutputError: If no reply could be read; the hour is then unscored, not wrong.
    """
    ctx, view = runtime.context, runtime.context.view
    clock, seen = view.clock, view.observation
    if ctx.method.intentions != "inferred":
        seems = in_words(seen) or "what the pictures show"
        text = state["true_intention"] if ctx.method.intentions == "given" else seems
        [alike] = likeness(view, state["told"], [text])
        return {"intentions": [IntentionCandidate(text=text)], "alike": {text: alike}}
    count = ctx.method.n_intentions or Numbers.ROBOT_INTENTIONS[view.collab]
    reply = view.ask(
        "robot/intentions",
        IntentionsReply,
        at=_at(view, "imagine_intentions"),
        images=view.pictures if view.looks else (),
        variables={
            **when(clock),
            **_belief(ctx),
            **as_variables(state["recalled"], clock),
            "told": as_told(most_telling(ctx.method, state["told"]), clock),
            "rooms": view.home.rooms,
            "percept": as_percept(seen),
            "first_task": seen.first_task,
            "n_intentions": count,
        },
    )
    replies = reply.intentions[:count]
    again = _recall(ctx, reply.seen) if in_words(seen, reply.seen) != in_words(seen) else {}
    told = again.get("told", state["told"])
    compared = likeness(view, told, [item.intention for item in replies])
    evidence = evidence_of(ctx.method, told, compared, replies)
    candidates = {
        item.intention: IntentionCandidate(
            text=item.intention,
            evidence=known,
            reasons=Reasons(
                human=item.reason_human,
                intentions=item.reason_intentions,
                tasks=item.reason_tasks,
                vision=item.reason_vision,
            ),
        )
        for item, known in reversed(list(zip(replies, evidence, strict=True)))
    }
    return {
        "intentions": list(reversed(candidates.values())),
        "alike": {item.intention: alike for item, alike in zip(replies, compared, strict=True)},
        "seen": reply.seen,
        **again,
    }


def classify_intentions(state: RobotState, runtime: Runtime[RobotContext]) -> dict[str, Any]:
    """Keep the likely intentions. Reads and completes `intentions`.

    Where none is accepted the most probable one goes on, and that is said. An intention that was given or skipped
    needs no verdict.
    DEVIATES: the authors' code then takes one at random.
    """
    ctx, candidates = runtime.context, state["intentions"]
    if ctx.method.intentions != "inferred":
        return {"intentions": [c.model_copy(update={"probability": 1.0, "accepted": True}) for c in candidates]}
    known = _known(state, ctx.view)
    asked = [example(known, intention=c.text, evidence=c.evidence) for c in candidates]
    probabilities, accepted = judge(ctx.method, ctx.learner, "intention", asked)
    fallbacks = []
    if not any(accepted):
        accepted[probabilities.index(max(probabilities))] = True
        fallbacks = ["no intention was accepted: the most probable one went on"]
    judged = [
        c.model_copy(update={"probability": p, "accepted": a})
        for c, p, a in zip(candidates, probabilities, accepted, strict=True)
    ]
    return {"intentions": judged, "fallbacks": fallbacks}


def one_per_accepted(state: RobotState, runtime: Runtime[RobotContext]) -> list[Send]:
    """Fan out: one imagine_tasks per accepted intention."""
    return [
        Send(
            "imagine_tasks",
            TaskRequest(
                seen=in_words(runtime.context.view.observation, state.get("seen", "")),
                recalled=state["recalled"],
                told=state["told"],
                alike=state["alike"][intention.text],
                intention=intention,
                rank=rank,
            ),
        )
        for rank, intention in enumerate(state["intentions"])
        if intention.accepted
    ]


def imagine_tasks(state: TaskRequest, runtime: Runtime[RobotContext]) -> dict[str, Any]:
    """Propose tasks for one accepted intention. Reads a `TaskRequest`; adds to `imagined`.

    A reply that cannot be read leaves this intention without tasks, and that is said.
    """
    ctx, view, intention = runtime.context, runtime.context.view, state["intention"]
    home, direct = view.home, ctx.method.intentions == "skipped"
    in_hand = held(view.observation) if ctx.method.skips_held else None
    weights = weights_for(state["told"], state["alike"])
    count = Numbers.DIRECT_TASKS if direct else how_many(ctx.method, view, state["told"], weights)
    extra: dict[str, Any] = {"in_hand": in_hand.thing if in_hand else None, "seen": state["seen"] or None}
    if view.collab == 1:
        extra = {"movable": home.objects("movable"), "first_task": view.observation.first_task}
    try:
        reply = view.ask(
            f"robot/tasks_type{view.collab}",
            TASKS_REPLY[view.collab],
            at=_at(view, "imagine_tasks", draw=state["rank"]),
            images=view.pictures if direct and view.looks else (),
            variables={
                **when(view.clock),
                **_belief(ctx),
                **as_variables(state["recalled"], view.clock),
                **extra,
                "told": as_told(like_hours(ctx.method, state["told"], weights), view.clock, without=in_hand),
                "intention": intention.text,
                "direct": direct,
                "fixed": home.objects("fixed"),
                "states": view.states,
                "n_tasks": count,
            },
        )
    except ModelOutputError as err:
        return {"imagined": [], "fallbacks": [f'no tasks for "{intention.text}": {err}']}
    tasks = [
        TaskCandidate(
            intention=intention.text,
            thought=draft.thought,
            reasons=Reasons(human=draft.reason_human, intentions=draft.reason_intentions, tasks=draft.reason_tasks),
            act=draft.act,
        )
        for draft in reply.tasks[:count]
    ]
    return {"imagined": [Imagined(rank=state["rank"], tasks=tasks, weights=weights)]}


def classify_tasks(state: RobotState, runtime: Runtime[RobotContext]) -> dict[str, Any]:
    """Keep the likely tasks of the superset. Reads `imagined`; writes `tasks`.

    A task that cannot be done in this home is dropped before it is judged, and that is said. One imagined for several
    intentions counts once, for the most likely of them. Where there is none at all the robot does nothing this hour,
    and that is said.
    """
    ctx = runtime.context
    imagined = sorted(state.get("imagined", []), key=lambda batch: batch["rank"])
    superset, dropped = superset_of(ctx.method, ctx.view, imagined)
    known = _known(state, ctx.view)
    if ctx.method.evidence:
        superset = with_evidence(ctx.view, state["told"], state["intentions"], imagined, superset)
    asked = [example(known, intention=t.intention, task=t.act.describe(), evidence=t.evidence) for t in superset]
    probabilities, accepted = judge(ctx.method, ctx.learner, "task", asked)
    watches = [] if superset else ["no valid task was imagined: the robot only watches"]
    tasks = [
        task.model_copy(update={"probability": p, "accepted": yes})
        for task, p, yes in zip(superset, probabilities, accepted, strict=True)
    ]
    return {"tasks": tasks, "fallbacks": [*dict.fromkeys(dropped), *watches]}


def act(state: RobotState, runtime: Runtime[Context]) -> dict[str, Any]:
    """Do the accepted tasks in the home, most probable first. Reads `tasks`; writes `outcomes`."""
    ctx, outcomes = runtime.context, list[Outcome]()
    for task in sorted((t for t in state["tasks"] if t.accepted), key=lambda t: -(t.probability or 0.0)):
        outcomes.append(ctx.home.perform(ctx.agent, task.act, record=ctx.film is not None))
        if ctx.film is not None and outcomes[-1].ok:
            ctx.film(len(outcomes) - 1)
    return {"outcomes": outcomes}


def _recall(ctx: RobotContext, saw: str = "") -> dict[str, Any]:
    """`recalled` and `told`, by the time and by what is seen; `saw` is what was seen in the pictures, in words."""
    view, method = ctx.view, ctx.method
    if not method.context:
        return {"recalled": [], "told": []}
    query = f"{view.clock.label}, {view.clock.weekday}. {in_words(view.observation, saw)}"
    return {
        "recalled": recall_weeks(view, query) if method.remembers == "days" else recall_hours(view, query),
        "told": told_hours(view, saw, turns=method.turns) if method.told or method.evidence else [],
    }


def _belief(ctx: RobotContext) -> dict[str, Any]:
    """The inferred traits as prompts read them; nothing where the method goes without."""
    known = ctx.view.belief if ctx.method.traits else Belief()
    return {"big_five": known.big_five.model_dump() if known.big_five else None, "profile": known.profile}


def _known(state: RobotState, view: RobotView) -> Known:
    return Known(view.person, view.clock, view.belief, state["recalled"], state["intentions"])


def _at(view: RobotView, node: str, draw: int = 0) -> Address:
    return Address(view.person, view.clock.day, view.clock.hour, node, draw)
