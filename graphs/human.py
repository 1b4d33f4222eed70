"""The person's hour as a state machine (PAPER §3.2): recall, propose, search, decompose, reflect twice, merge, mend.

Who decides in `propose` and `decompose` is the context's player: a language model, a log, or a real person.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from typing import Any, Literal

from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime

from coopera.core.affordances import affordances
from coopera.core.hour import Found, HumanHour, Task
from coopera.core.household import FreeMotion, ObjectMap, plain
from coopera.core.randomness import Address
from coopera.core.replies import FreeMotionReflectionReply, PickPlaceReflectionReply
from coopera.graphs.players.changes import felt
from coopera.graphs.players.checks import findings, obstacle, repair
from coopera.graphs.players.player import HumanContext, HumanInput, HumanState
from coopera.graphs.players.reflecting import Node, Opinion, agreed, as_task, numbered, opinion
from coopera.graphs.players.searching import Shelves
from coopera.graphs.players.variables import as_tasks, known, motions_here, when, who
from coopera.graphs.robots.method import Numbers
from coopera.graphs.robots.recall import as_memory, recall_both

REFLECTION_REPLY: dict[int, type[PickPlaceReflectionReply | FreeMotionReflectionReply]] = {
    1: PickPlaceReflectionReply,
    2: FreeMotionReflectionReply,
}

_KINDS, _NAMED = 8, 8
"""Of so many kinds of furniture it is said what can be done there, and so many motions: what a prompt can list."""


def build_human_graph() -> CompiledStateGraph[HumanState, HumanContext, HumanInput, HumanState]:
    """Compile the person's graph; invoke it with a `HumanInput` and a `HumanContext`.

    The two reflections read the same draft at the same time, and `merge` makes one list of tasks of them. Reflection 2
    comes again while code finds something wrong, at most `Numbers.SCENE_ROUNDS` times in all.
    """
    graph = StateGraph(HumanState, context_schema=HumanContext, input_schema=HumanInput)
    for node in (recall, propose, search, decompose, reflect_profile, reflect_scene, merge, mend):
        graph.add_node(node)
    graph.add_edge(START, "recall")
    graph.add_edge("recall", "propose")
    graph.add_conditional_edges("propose", stays, ["search", END])
    graph.add_edge("search", "decompose")
    graph.add_conditional_edges("decompose", reflects, ["reflect_profile", "reflect_scene", "mend"])
    graph.add_edge("reflect_profile", "merge")
    graph.add_edge("reflect_scene", "merge")
    graph.add_conditional_edges("merge", once_more, ["reflect_scene", "mend"])
    graph.add_edge("mend", END)
    return graph.compile(checkpointer=False, name="human")


def human_hour(state: HumanState) -> HumanHour:
    """The finished state as it stands in the trace."""
    return HumanHour(
        recalled=state["recalled"],
        intention=state["intention"],
        found=state.get("found", Found(fixed={}, movable={}, motions=[])),
        tasks=state.get("tasks", []),
        reflections=state.get("reflections", []),
        circumstances=state["circumstances"],
        repairs=state.get("repairs", []),
    )


def recall(state: HumanInput, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Retrieve what matters now of today. Reads `clock`; writes `recalled` and `today`.

    PAPER §3.2 "Varying Distribution": the history starts anew each day, so nothing older is recalled.
    DEVIATES: today's intentions are given in full besides the retrieved three, since "non-repetitive" asks for them.
    """
    memories, clock = runtime.context.memories, state["clock"]
    if not runtime.context.model.history:
        return {"recalled": [], "today": []}
    dawn = clock.day * 24
    query = f"What do I do at {clock.label} on a {clock.weekday}?"
    recalled = recall_both(memories, query, clock, since=dawn)
    today = [as_memory(r.text, r.hour, clock) for r in memories.intentions.records(since=dawn) if r.hour < clock.now]
    return {"recalled": recalled, "today": today}


def propose(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Decide what to do this hour. Reads `recalled`, `today`; writes `intention` and `circumstances`."""
    ctx, day = runtime.context, state["clock"].day
    return {
        "intention": ctx.player.intention(state, ctx),
        "circumstances": felt(ctx.changes(state["clock"]), day),
    }


def stays(state: HumanState) -> Literal["search", "__end__"]:
    """Go on to tasks, unless the person is away from home this hour."""
    return "__end__" if state["intention"].away else "search"


def search(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Find the objects and motions that fit the intention. Reads `intention`; writes `found`, and in type 2 `can`.

    The objects that the person wants, then the nearest ones (the fixed and, in type 1, the movable ones separately),
    and the nearest motions, as many as `HumanContext.sizes` says; `can` is what can be done at the first furniture.
    """
    ctx, query, wants = runtime.context, state["intention"].text, state["intention"].wants
    shelves = Shelves(ctx)
    ranked = ctx.search(ctx.home.motions).top(query, len(ctx.home.motions)) if ctx.collab == 2 else []
    motions = [caption for caption, _ in ranked]
    found = Found(
        fixed=shelves.offer("fixed", wants, query),
        movable=shelves.offer("movable", wants, query) if ctx.collab == 1 else {},
        motions=motions[: ctx.sizes.motions],
    )
    return {"found": found, "can": _can(ctx, found.fixed, motions)}


def decompose(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Break the intention into tasks. Reads `intention`, `found`, `recalled`; writes `tasks`, `stated` and `wrong`."""
    ctx = runtime.context
    drafts, stated = ctx.player.tasks(state, ctx)
    tasks = numbered([as_task(draft) for draft in drafts], state["clock"])
    return {"tasks": tasks, "stated": stated, "wrong": _wrong_with(tasks, ctx)}


def reflects(state: HumanState, runtime: Runtime[HumanContext]) -> list[str]:
    """Reflect, unless the person model does without, or a real person has said what the tasks are."""
    reflected = runtime.context.model.reflection and not state["stated"]
    return ["reflect_profile", "reflect_scene"] if reflected else ["mend"]


def reflect_profile(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """First reflection: does each task fit the person and the day so far? Reads `tasks`; writes `profile_says`."""
    ctx, found = runtime.context, state["found"]
    things = {"movable": found.movable} if ctx.collab == 1 else {}
    reply = ctx.ask(
        f"human/reflect_profile_type{ctx.collab}",
        REFLECTION_REPLY[ctx.collab],
        at=_at(state, ctx, "reflect_profile"),
        variables={
            **known(state, ctx),
            **things,
            "intention": state["intention"].text,
            "fixed": found.fixed,
            "tasks": as_tasks(state["tasks"]),
        },
    )
    return {"profile_says": opinion(reply, state["tasks"])}


def reflect_scene(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Second reflection: do the objects exist and the rules hold? Reads `tasks`, `wrong`; writes `scene_says`.

    The model is told what code found wrong.
    """
    ctx, found = runtime.context, state["found"]
    things = {"movable": found.movable, "now_at": _now_at(state, ctx)} if ctx.collab == 1 else motions_here(state)
    reply = ctx.ask(
        f"human/reflect_scene_type{ctx.collab}",
        REFLECTION_REPLY[ctx.collab],
        at=_at(state, ctx, "reflect_scene", _rounds(state)),
        variables={
            **when(state["clock"]),
            **who(ctx),
            **things,
            "intention": state["intention"].text,
            "fixed": found.fixed,
            "states": ctx.home.states(),
            "tasks": as_tasks(state["tasks"]),
            "n_tasks": Numbers.HUMAN_TASKS[ctx.collab],
            "findings": state["wrong"],
        },
    )
    return {"scene_says": opinion(reply, state["tasks"])}


def merge(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Make one list of what the reflections of this round say of `tasks`.

    Reads `profile_says` (in the first round) and `scene_says`; revises `tasks`; writes `reflections` and `wrong`.
    """
    ctx = runtime.context
    opinions: dict[Node, Opinion] = {} if _rounds(state) else {"reflect_profile": state["profile_says"]}
    opinions["reflect_scene"] = state["scene_says"]
    tasks, reflections = agreed(
        state["tasks"],
        opinions,
        state["clock"],
        Numbers.HUMAN_TASKS[ctx.collab],
        lambda task: obstacle(task.act, ctx.home, ctx.agent),
    )
    return {"tasks": tasks, "reflections": reflections, "wrong": _wrong_with(tasks, ctx)}


def once_more(state: HumanState) -> Literal["reflect_scene", "mend"]:
    """Reflect on the scene again while something is wrong, a bounded number of times."""
    return "reflect_scene" if state["wrong"] and _rounds(state) < Numbers.SCENE_ROUNDS else "mend"


def mend(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Mend what is still wrong to what is nearest and fits, so that each task can be tried in the home.

    Reads and revises `tasks`; writes `repairs`, a sentence for each thing mended.

    Raises:
        ModelOutputError: If no task is left.
    """
    ctx = runtime.context
    count = len(state["tasks"]) if state["stated"] else Numbers.HUMAN_TASKS[ctx.collab]
    tasks, repairs = repair(state["tasks"], ctx.home, ctx.agent, count, ctx.search)
    return {"tasks": tasks, "repairs": repairs}


def _wrong_with(tasks: Sequence[Task], ctx: HumanContext) -> list[str]:
    return findings(tasks, ctx.home, ctx.agent, Numbers.HUMAN_TASKS[ctx.collab])


def _now_at(state: HumanState, ctx: HumanContext) -> dict[str, str]:
    """Where the things of the drafted tasks are; what is not in the home is left out."""
    places = {
        task.act.object: ctx.home.place_of(task.act.object) for task in state["tasks"] if task.act.kind == "pick_place"
    }
    return {thing: place for thing, place in places.items() if place}


def _rounds(state: HumanState) -> int:
    return sum(reflection.node == "reflect_scene" for reflection in state.get("reflections", []))


def _at(state: HumanInput, ctx: HumanContext, node: str, draw: int = 0) -> Address:
    return Address(ctx.persona.id, state["clock"].day, state["clock"].hour, node, draw)


def _can(ctx: HumanContext, fixed: ObjectMap, ranked: Sequence[str]) -> dict[str, list[str]]:
    """The first of some motions that can be done at the furniture found first; what has none of them is left out."""
    can: dict[str, list[str]] = {}
    kinds = list(dict.fromkeys(map(plain, fixed)))[:_KINDS]
    for name, (number, _) in fixed.items():
        if plain(name) not in kinds:
            continue
        there = set(affordances().motions_at(ctx.home.class_of(name)))
        fitting = (caption for caption in ranked if caption in there and _fits(ctx, caption, name, number))
        if named := list(islice(fitting, _NAMED)):
            can[name] = named
    return can


def _fits(ctx: HumanContext, caption: str, name: str, number: int) -> bool:
    """Whether a motion can be done at a piece of furniture with what it needs in hand."""
    needed = affordances().names(affordances().of(caption).needs)
    in_hand = plain(needed[0]) if needed else "thing"
    return not ctx.home.misfit(ctx.agent, FreeMotion(target_id=number, target=name, in_hand=in_hand, motion=caption))
