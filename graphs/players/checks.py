"""What code itself can check of a person's tasks: they must be executable in the home."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain

from coopera.core.affordances import affordances
from coopera.core.errors import ModelOutputError
from coopera.core.hour import Task
from coopera.core.household import Act, AgentId, FreeMotion, ObjectMap, PickPlace, plain
from coopera.core.protocols import Home
from coopera.memory import Search
from coopera.simulation.motions.library import load_library

_NOTHING = {"none", "nothing", "n/a", "na", "null", "no object", "empty"}

SearchIn = Callable[[Sequence[str]], Search]


def findings(tasks: Sequence[Task], home: Home, agent: AgentId, count: int) -> list[str]:
    """Say what is wrong with an agent's tasks, one sentence each; an empty list means that all can be tried."""
    found = [f"There must be {count} tasks, not {len(tasks)}."] if len(tasks) != count else []
    seen: set[str] = set()
    for task in tasks:
        if (text := task.act.describe()) in seen:
            found.append(f"Task {task.id} repeats an earlier task: {text}.")
        seen.add(text)
        if wrong := obstacle(task.act, home, agent):
            found.append(f"Task {task.id}: {wrong}")
    return found


def repair(
    tasks: Sequence[Task], home: Home, agent: AgentId, count: int, search: SearchIn
) -> tuple[list[Task], list[str]]:
    """Mend what is still wrong with an agent's tasks; repeats, surplus tasks and what cannot be mended go.

    A wrong name becomes the nearest valid object. What cannot be done at its furniture goes to furniture where it can,
    in the same room if there is any; else another thing is in hand, or another motion of the same posture is made.

    Returns:
        The executable tasks, and one sentence for each thing that was mended.

    Raises:
        ModelOutputError: If no task is left.
    """
    kept: list[Task] = []
    said: list[str] = []
    for task in tasks:
        wrong = obstacle(task.act, home, agent)
        act = _mended(task.act, home, agent, search) if wrong else task.act
        if act is None:
            said.append(f"Task {task.id} was dropped: {wrong}")
        elif act.describe() in {other.act.describe() for other in kept}:
            said.append(f"Task {task.id} was dropped: it repeats another task.")
        elif len(kept) == count:
            said.append(f"Task {task.id} was dropped: {count} tasks are enough.")
        else:
            if wrong:
                said.append(f"Task {task.id}: {task.act.describe()} -> {act.describe()}. {wrong}")
            kept.append(task.model_copy(update={"act": act}))
    if not kept:
        raise ModelOutputError("human/reflect_scene", str([t.act.describe() for t in tasks]), "no task can be done")
    return kept, said


def obstacle(act: Act, home: Home, agent: AgentId) -> str:
    """What stands against an act of an agent, as a sentence; empty where it can be tried."""
    if isinstance(act, FreeMotion) and _is_nothing(act.in_hand):
        return f'The thing in hand cannot be "{act.in_hand}".'
    return home.misfit(agent, act)


def _mended(act: Act, home: Home, agent: AgentId, search: SearchIn) -> Act | None:
    """The nearest act that can be tried: the one that its names mean, or else one like it; None where there is none."""
    meant = _meant(act, home, search)
    if meant is None:
        return None
    return next((one for one in chain([meant], _like(meant, home, search)) if not home.misfit(agent, one)), None)


def _meant(act: Act, home: Home, search: SearchIn) -> PickPlace | FreeMotion | None:
    """The act with the names and ids of objects that there are."""
    fixed, movable = home.objects("fixed"), home.objects("movable")
    if isinstance(act, PickPlace):
        carried = act.receptacle in movable and affordances().contains(home.class_of(act.receptacle))
        places = movable if carried else fixed  # things go into a basket, too
        thing, place = _valid(act.object, movable, search), _valid(act.receptacle, places, search)
        if thing is None or place is None:
            return None
        update = {
            "object": thing,
            "object_id": movable[thing][0],
            "receptacle": place,
            "receptacle_id": places[place][0],
        }
        return act.model_copy(update=update)
    if isinstance(act, FreeMotion) and not _is_nothing(act.in_hand):
        target = _valid(act.target, fixed, search)
        return act.model_copy(update={"target": target, "target_id": fixed[target][0]}) if target else None
    return None


def _like(act: PickPlace | FreeMotion, home: Home, search: SearchIn) -> Iterator[Act]:
    """What comes near to an act, the nearest first; whether it can be done is another question."""
    if isinstance(act, PickPlace):
        yield act.model_copy(update={"relation": "on" if act.relation == "inside" else "inside"})
        return
    fixed = home.objects("fixed")
    room = fixed[act.target][1]
    for name in sorted(fixed, key=lambda name: (fixed[name][1] != room, name)):
        yield act.model_copy(update={"target": name, "target_id": fixed[name][0]})
    motions = [caption for caption, _ in search(home.motions).top(plain(act.motion) or "wait", len(home.motions))]
    caption = act.motion if act.motion in motions else motions[0]
    for thing in affordances().names(affordances().of(caption).needs):
        yield act.model_copy(update={"in_hand": plain(thing)})
    library = load_library()
    posture = library.match(caption).posture
    for other in motions:
        if library.match(other).posture == posture:
            yield act.model_copy(update={"motion": other})


def _valid(name: str, objects: ObjectMap, search: SearchIn) -> str | None:
    if name in objects or not objects or not plain(name):
        return name if name in objects else None
    by_text = {plain(known): known for known in sorted(objects, reverse=True)}
    return by_text[search(list(by_text)).top(plain(name), 1)[0][0]]


def _is_nothing(text: str) -> bool:
    return text.strip().lower() in _NOTHING
