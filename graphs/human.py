"""The person's hour as a state machine: recall, propose, search, decompose, reflect twice, mend (PAPER §3.2)."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime
from typing_extensions import TypedDict

from coopera.core.clock import Clock, hour_label
from coopera.core.errors import ModelOutputError
from coopera.core.hour import Found, HumanHour, Intention, Reasons, Recalled, Reflection, Task, TaskVerdict
from coopera.core.household import ObjectMap, plain
from coopera.core.randomness import Address
from coopera.core.replies import (
    DayReply,
    FreeMotionReflectionReply,
    FreeMotionReply,
    IntentionReply,
    PickPlaceReflectionReply,
    PickPlaceReply,
)
from coopera.graphs.checks import findings, repair
from coopera.graphs.method import Numbers
from coopera.graphs.recall import as_memory, as_variables, recall_both
from coopera.graphs.services import HumanContext
from coopera.graphs.stated import Draft, chosen, fill, stated_intention, stated_steps

TASKS_REPLY: dict[int, type[PickPlaceReply | FreeMotionReply]] = {1: PickPlaceReply, 2: FreeMotionReply}
REFLECTION_REPLY: dict[int, type[PickPlaceReflectionReply | FreeMotionReflectionReply]] = {
    1: PickPlaceReflectionReply,
    2: FreeMotionReflectionReply,
}


class HumanInput(TypedDict):
    """What starts a person's hour; `hours` are all hours of the day, in order."""

    clock: Clock
    hours: list[int]


class HumanState(HumanInput, total=False):
    """Working state of the person's hour; a key is absent until its node has run."""

    recalled: list[Recalled]  # by recall; intentions first, best first
    today: list[dict[str, Any]]  # by recall; this day's intentions so far, in order
    intention: Intention  # by propose
    found: Found  # by search
    tasks: list[Task]  # by decompose, then revised by the reflections
    stated: bool  # by decompose: a real person has said what the tasks are
    reflections: Annotated[list[Reflection], operator.add]  # by the reflections, in order
    wrong: list[str]  # by reflect_scene: what code still finds wrong after it
    repairs: list[str]  # by mend


def build_human_graph() -> CompiledStateGraph[HumanState, HumanContext, HumanInput, HumanState]:
    """Compile the person's graph; invoke it with a `HumanInput` and a `HumanContext`.

    Reflection 2 comes again while code finds something wrong, at most `Numbers.SCENE_ROUNDS` times in all.
    """
    graph = StateGraph(HumanState, context_schema=HumanContext, input_schema=HumanInput)
    for node in (recall, propose, search, decompose, reflect_profile, reflect_scene, mend):
        graph.add_node(node)
    for before, after in pairwise([START, "recall", "propose", "search", "decompose"]):
        graph.add_edge(before, after)
    graph.add_conditional_edges("decompose", reflects, ["reflect_profile", "mend"])
    graph.add_edge("reflect_profile", "reflect_scene")
    graph.add_conditional_edges("reflect_scene", once_more, ["reflect_scene", "mend"])
    graph.add_edge("mend", END)
    return graph.compile(checkpointer=False, name="human")


def human_hour(state: HumanState) -> HumanHour:
    """The finished state as it stands in the trace."""
    return HumanHour(
        recalled=state["recalled"],
        intention=state["intention"],
        found=state["found"],
        tasks=state["tasks"],
        reflections=state.get("reflections", []),
        repairs=state["repairs"],
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
    """Decide what to do this hour. Reads `recalled`, `today`; writes `intention`."""
    ctx = runtime.context
    if stated := stated_intention(ctx, state["clock"], _today(state)):
        return {"intention": stated}
    if ctx.model.hourly:
        reply = ctx.ask(
            "human/intention",
            IntentionReply,
            at=_at(state, ctx, "propose"),
            variables={**_known(state, ctx), "rooms": ctx.home.rooms, "today": state["today"]},
        )
    else:
        reply = _of_the_day(state, ctx)
    reasons = Reasons(human=reply.reason_human, intentions=reply.reason_intentions, tasks=reply.reason_tasks)
    return {"intention": Intention(text=reply.intention, reasons=reasons)}


def search(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Find the objects and motions that fit the intention. Reads `intention`; writes `found`.

    The nearest objects (the fixed and, in type 1, the movable ones separately) and motions by cosine, as many as
    `HumanContext.sizes` says.
    """
    ctx, query = runtime.context, state["intention"].text
    movable = _nearest(ctx, query, ctx.home.objects("movable")) if ctx.collab == 1 else {}
    motions = ctx.search(ctx.home.motions).top(query, ctx.sizes.motions) if ctx.collab == 2 else []
    found = Found(
        fixed=_nearest(ctx, query, ctx.home.objects("fixed")),
        movable=movable,
        motions=[text for text, _ in motions],
    )
    return {"found": found}


def decompose(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Break the intention into tasks. Reads `intention`, `found`, `recalled`; writes `tasks` and `stated`.

    Steps that a real person states are taken over: as they are where each is a choice, else as the model reads them.
    """
    ctx, found = runtime.context, state["found"]
    steps = stated_steps(ctx, state["clock"], _today(state), state["intention"], found)
    drafts = chosen(ctx, steps, found)
    own_words = [step for step, draft in zip(steps, drafts, strict=True) if draft is None]
    if steps and not own_words:
        return {"tasks": number(fill(drafts, [], ""), state["clock"]), "stated": True}
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
            "n_tasks": len(own_words) or Numbers.HUMAN_TASKS[ctx.collab],
            "steps": own_words,
        },
    )
    tasks = fill(drafts, reply.tasks, f"human/tasks_type{ctx.collab}") if steps else reply.tasks
    return {"tasks": number(tasks, state["clock"]), "stated": bool(steps)}


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


def reflects(state: HumanState, runtime: Runtime[HumanContext]) -> Literal["reflect_profile", "mend"]:
    """Reflect, unless the person model does without, or a real person has said what the tasks are."""
    return "reflect_profile" if runtime.context.model.reflection and not state["stated"] else "mend"


def reflect_scene(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Second reflection: do the objects exist and the rules hold? Reads and revises `tasks`; writes `wrong`.

    The model is told what code found wrong.
    """
    ctx, found = runtime.context, state["found"]
    things = {"movable": found.movable} if ctx.collab == 1 else {"motions": found.motions}
    count = Numbers.HUMAN_TASKS[ctx.collab]
    reply = ctx.ask(
        f"human/reflect_scene_type{ctx.collab}",
        REFLECTION_REPLY[ctx.collab],
        at=_at(state, ctx, "reflect_scene", _rounds(state)),
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
    return {**revised, "wrong": findings(revised["tasks"], ctx.home, count)}


def once_more(state: HumanState) -> Literal["reflect_scene", "mend"]:
    """Reflect on the scene again while something is wrong, a bounded number of times."""
    return "reflect_scene" if state["wrong"] and _rounds(state) < Numbers.SCENE_ROUNDS else "mend"


def mend(state: HumanState, runtime: Runtime[HumanContext]) -> dict[str, Any]:
    """Mend what is still wrong to the nearest valid object, so that each task can be tried in the home.

    Reads and revises `tasks`; writes `repairs`, a sentence for each thing mended.

    Raises:
        ModelOutputError: If no task is left.
    """
    ctx = runtime.context
    count = len(state["tasks"]) if state["stated"] else Numbers.HUMAN_TASKS[ctx.collab]
    tasks, repairs = repair(state["tasks"], ctx.home, count, ctx.search)
    return {"tasks": tasks, "repairs": repairs}


def when(clock: Clock) -> dict[str, Any]:
    """The time variables of `coopera.core.asks`."""
    return {"time": clock.label, "hour": clock.hour, "weekday": clock.weekday, "day": clock.day}


def who(ctx: HumanContext) -> dict[str, Any]:
    """The person variables of `coopera.core.asks`; only the person's own prompts get them."""
    persona = ctx.persona
    return {
        "person": persona.id,
        "name": persona.name,
        "big_five": persona.big_five.model_dump(),
        "profile": ctx.model.profile(persona),
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


def _today(state: HumanState) -> list[str]:
    return [f"{memory['when']}: {memory['text']}" for memory in state["today"]]


def _of_the_day(state: HumanState, ctx: HumanContext) -> IntentionReply:
    """This hour's place in the intentions of the whole day: the same question each hour, so the same answer."""
    clock, hours = state["clock"], state["hours"]
    dawn = clock.model_copy(update={"hour": hours[0]})
    reply = ctx.ask(
        "human/day",
        DayReply,
        at=Address(ctx.persona.id, dawn.day, dawn.hour, "propose"),
        variables={
            "weekday": dawn.weekday,
            "day": dawn.day,
            **who(ctx),
            "rooms": ctx.home.rooms,
            "hours": [hour_label(hour) for hour in hours],
        },
    )
    if len(reply.intentions) != len(hours):
        wrong = f"it has {len(reply.intentions)} intentions for a day of {len(hours)} hours"
        raise ModelOutputError("human/day", reply.model_dump_json(), wrong)
    return reply.intentions[hours.index(clock.hour)]


def _rounds(state: HumanState) -> int:
    return sum(reflection.node == "reflect_scene" for reflection in state.get("reflections", []))


def _at(state: HumanInput, ctx: HumanContext, node: str, draw: int = 0) -> Address:
    return Address(ctx.persona.id, state["clock"].day, state["clock"].hour, node, draw)


def _nearest(ctx: HumanContext, query: str, objects: ObjectMap) -> ObjectMap:
    by_text: dict[str, list[str]] = {}
    for name in objects:
        by_text.setdefault(plain(name), []).append(name)
    ranked = [name for text, _ in ctx.search(list(by_text)).top(query, len(by_text)) for name in by_text[text]]
    return {name: objects[name] for name in ranked[: ctx.sizes.objects]}


def _with_reasons(task: Task, said: Mapping[str, Reasons]) -> Task:
    """A task that a reflection left as it was keeps those of its reasons that the reflection does not give anew."""
    before = said.get(task.act.describe(), Reasons())
    given = {field: text for field, text in task.reasons.model_dump().items() if text}
    return task.model_copy(update={"reasons": before.model_copy(update=given)})


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
