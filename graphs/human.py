"""The person's hour as a state machine: recall, propose, search, decompose, reflect twice (PAPER §3.2)."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, TypeAlias

from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime
from typing_extensions import TypedDict

from core.clock import Clock
from core.hour import Found, HumanHour, Intention, Reasons, Recalled, Reflection, Task, TaskVerdict
from core.household import ObjectMap, plain
from core.randomness import Address
from core.replies import (
    FreeMotionDraft,
    FreeMotionReflectionReply,
    FreeMotionReply,
    IntentionReply,
    PickPlaceDraft,
    PickPlaceReflectionReply,
    PickPlaceReply,
)
from graphs.checks import findings, repair
from graphs.method import Numbers
from graphs.recall import as_memory, as_variables, recall_both
from graphs.services import HumanContext

Draft: TypeAlias = PickPlaceDraft | FreeMotionDraft


TASKS_REPLY: dict[int, type[PickPlaceReply | FreeMotionReply]] = {1: PickPlaceReply, 2: FreeMotionReply}
REFLECTION_REPLY: dict[int, type[PickPlaceReflectionReply | FreeMotionReflectionReply]] = {
    1: PickPlaceReflectionReply,
    2: FreeMotionReflectionReply,
}


class HumanInput(TypedDict):
    """What starts a person's hour."""

    clock: Clock


class HumanState(HumanInput, total=False):
    """Working state of the person's hour; a key is absent until its node has run."""

    recalled: list[Recalled]  # by recall; intentions first, best first
    today: list[dict[str, Any]]  # by recall; this day's intentions so far, in order
    intention: Intention  # by propose
    found: Found  # by search
    tasks: list[Task]  # by decompose, then revised by the reflections
    reflections: Annotated[list[Reflection], operator.add]  # by the reflections, in order
    repairs: list[str]  # by reflect_scene


def build_human_graph() -> CompiledStateGraph[HumanState, HumanContext, HumanInput, HumanState]:
    """Compile the person's graph; invoke it with `{"clock": Clock(...)}` and a `HumanContext`."""
    graph = StateGraph(HumanState, context_schema=HumanContext, input_schema=HumanInput)
    nodes = (recall, propose, search, decompose, reflect_profile, reflect_scene)
    for node in nodes:
        graph.add_node(node)
    for before, after in zip([START, *[n.__name__ for n in nodes]], [*[n.__name__ for n in nodes], END], strict=True):
        graph.add_edge(before, after)
    return graph.compile(checkpointer=False, name="human")


def human_hour(state: HumanState) -> HumanHour:
    """The finished state as it stands in the trace."""
    return HumanHour(
        recalled=state["recalled"],
        intention=state["intention"],
        found=state["found"],
        tasks=state["tasks"],
        reflections=state["reflections"],
        repairs=state["repairs"],
    )


def recall(state: HumanInput, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Retrieve what matters now of today. Reads `clock`; writes `recalled` and `today`.

    PAPER §3.2 "Varying Distribution": the history starts anew each day, so nothing older is recalled.
    DEVIATES: today's intentions are given in full besides the retrieved three, since "non-repetitive" asks for them.
    """
    memories, clock = runtime.context.memories, state["clock"]
    dawn = clock.day * 24
    query = f"What do I do at {clock.label} on a {clock.weekday}?"
    recalled = recall_both(memories, query, clock, since=dawn)
    today = [as_memory(r.text, r.hour, clock) for r in memories.intentions.records(since=dawn) if r.hour < clock.now]
    return {"recalled": recalled, "today": today}


def propose(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Decide what to do this hour. Reads `recalled`, `today`; writes `intention`."""
    ctx = runtime.context
    reply = ctx.ask(
        "human/intention",
        IntentionReply,
        at=_at(state, ctx, "propose"),
        variables={
            **_known(state, ctx),
            "rooms": ctx.home.rooms,
            "today": state["today"],
        },
    )
    reasons = Reasons(human=reply.reason_human, intentions=reply.reason_intentions, tasks=reply.reason_tasks)
    return {"intention": Intention(text=reply.intention, reasons=reasons)}


def search(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Find the objects and motions that fit the intention. Reads `intention`; writes `found`.

    Top 30 objects (the fixed and, in type 1, the movable ones separately) and 5 motions by cosine, as the authors do.
    """
    ctx, query = runtime.context, state["intention"].text
    movable = _nearest(ctx, query, ctx.home.objects("movable")) if ctx.collab == 1 else {}
    motions = ctx.search(ctx.home.motions).top(query, Numbers.SEARCH_MOTIONS) if ctx.collab == 2 else []
    found = Found(
        fixed=_nearest(ctx, query, ctx.home.objects("fixed")),
        movable=movable,
        motions=[text for text, _ in motions],
    )
    return {"found": found}


def decompose(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Break the intention into tasks. Reads `intention`, `found`, `recalled`; writes `tasks`."""
    ctx, found = runtime.context, state["found"]
    things = {"movable": found.movable} if ctx.collab == 1 else {"motions": found.motions}
    reply = ctx.ask(
        f"human/tasks_type{ctx.collab}",
        TASKS_REPLY[ctx.collab],
        at=_at(state, ctx, "decompose"),
        variables={
            **_known(state, ctx),
            **things,
            "intention": state["intention"].text,
            "fixed": found.fixed,
            "n_tasks": Numbers.HUMAN_TASKS[ctx.collab],
        },
    )
    return {"tasks": number(reply.tasks, state["clock"])}


def reflect_profile(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """First reflection: does each task fit the person and the day so far? Reads and revises `tasks`."""
    ctx, found = runtime.context, state["found"]
    things = {"movable": found.movable} if ctx.collab == 1 else {}
    reply = ctx.ask(
        f"human/reflect_profile_type{ctx.collab}",
        REFLECTION_REPLY[ctx.collab],
        at=_at(state, ctx, "reflect_profile"),
        variables={
            **_known(state, ctx),
            **things,
            "intention": state["intention"].text,
            "fixed": found.fixed,
            "tasks": as_tasks(state["tasks"]),
        },
    )
    return _revised(state, reply, "reflect_profile")


def reflect_scene(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Second reflection: do the objects exist and the rules hold? Reads and revises `tasks`; writes `repairs`.

    The model is told what code found wrong; what is still wrong afterwards is mended to the nearest
    valid object and said in `repairs`, so that the tasks that leave can be tried in the home.
    """
    ctx, found = runtime.context, state["found"]
    things = {"movable": found.movable} if ctx.collab == 1 else {"motions": found.motions}
    count = Numbers.HUMAN_TASKS[ctx.collab]
    reply = ctx.ask(
        f"human/reflect_scene_type{ctx.collab}",
        REFLECTION_REPLY[ctx.collab],
        at=_at(state, ctx, "reflect_scene"),
        variables={
            **when(state["clock"]),
            **things,
            "intention": state["intention"].text,
            "fixed": found.fixed,
            "tasks": as_tasks(state["tasks"]),
            "n_tasks": count,
            "findings": findings(state["tasks"], ctx.home, count),
        },
    )
    revised = _revised(state, reply, "reflect_scene")
    tasks, repairs = repair(revised["tasks"], ctx.home, count, ctx.search)
    return {**revised, "tasks": tasks, "repairs": repairs}


def when(clock: Clock) -> dict[str, Any]:
    """The time variables of `core.asks`."""
    return {"time": clock.label, "hour": clock.hour, "weekday": clock.weekday, "day": clock.day}


def who(ctx: HumanContext) -> dict[str, Any]:
    """The person variables of `core.asks`; only the person's own prompts get them."""
    persona = ctx.persona
    return {
        "person": persona.id,
        "name": persona.name,
        "big_five": persona.big_five.model_dump(),
        "profile": persona.profile,
    }


def number(drafts: Sequence[Draft], clock: Clock) -> list[Task]:
    """Turn drafts into tasks with ids "<hour>.<n>"."""
    return [
        Task(
            id=f"{clock.hour}.{n}",
            thought=draft.thought,
            reasons=Reasons(human=draft.reason_human, intentions=draft.reason_intentions, tasks=draft.reason_tasks),
            act=draft.act,
        )
        for n, draft in enumerate(drafts, start=1)
    ]


def as_tasks(tasks: Sequence[Task]) -> list[dict[str, Any]]:
    """Tasks as prompts read them."""
    return [
        {"id": t.id, "thought": t.thought, "text": t.act.describe(), "act": t.act.model_dump(exclude={"kind"})}
        for t in tasks
    ]


def _known(state: HumanState, ctx: HumanContext) -> dict[str, Any]:
    return {**when(state["clock"]), **who(ctx), **as_variables(state["recalled"], state["clock"])}


def _at(state: HumanInput, ctx: HumanContext, node: str) -> Address:
    return Address(ctx.persona.id, state["clock"].day, state["clock"].hour, node)


def _nearest(ctx: HumanContext, query: str, objects: ObjectMap) -> ObjectMap:
    by_text: dict[str, list[str]] = {}
    for name in objects:
        by_text.setdefault(plain(name), []).append(name)
    ranked = [name for text, _ in ctx.search(list(by_text)).top(query, len(by_text)) for name in by_text[text]]
    return {name: objects[name] for name in ranked[: Numbers.SEARCH_OBJECTS]}


def _with_reasons(task: Task, said: Mapping[str, Reasons]) -> Task:
    """A task that a reflection left as it was keeps its reasons where the reflection gave none."""
    if task.reasons == Reasons() and task.act.describe() in said:
        return task.model_copy(update={"reasons": said[task.act.describe()]})
    return task


def _revised(
    state: HumanState,
    reply: PickPlaceReflectionReply | FreeMotionReflectionReply,
    node: Literal["reflect_profile", "reflect_scene"],
) -> dict[str, Any]:
    before = state["tasks"]
    said = {task.act.describe(): task.reasons for task in before}
    after = [_with_reasons(task, said) for task in number(reply.tasks, state["clock"])]
    texts = [task.act.describe() for task in before]
    changes = [
        f"{new.id}: {old or 'nothing'} -> {new.act.describe()}"
        for old, new in zip([*texts, *[""] * len(after)], after, strict=False)
        if old != new.act.describe()
    ]
    changes += [f"{old.id}: {old.act.describe()} -> dropped" for old in before[len(after) :]]
    verdicts = [TaskVerdict(ok=v.yes, comment=v.reason) for v in reply.verdicts]
    return {"tasks": after, "reflections": [Reflection(node=node, verdicts=verdicts, changes=changes)]}
