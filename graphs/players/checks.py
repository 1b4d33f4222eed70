"""What code itself can check of a person's tasks: they must be executable in the home."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from coopera.core.errors import ModelOutputError
from coopera.core.hour import Task
from coopera.core.household import Act, FreeMotion, ObjectMap, PickPlace, plain
from coopera.core.protocols import Home
from coopera.memory import Search

_NOTHING = {"none", "nothing", "n/a", "na", "null", "no object", "empty"}


def findings(tasks: Sequence[Task], home: Home, count: int) -> list[str]:
    """Say what is wrong with the tasks, one sentence each; an empty list means that all can be tried."""
    found = [f"There must be {count} tasks, not {len(tasks)}."] if len(tasks) != count else []
    fixed, movable = home.objects("fixed"), home.objects("movable")
    seen: set[str] = set()
    for task in tasks:
        if (text := task.act.describe()) in seen:
            found.append(f"Task {task.id} repeats an earlier task: {text}.")
        seen.add(text)
        found += [f"Task {task.id}: {problem}" for problem in _problems(task.act, fixed, movable)]
    return found


def repair(
    tasks: Sequence[Task], home: Home, count: int, search: Callable[[Sequence[str]], Search]
) -> tuple[list[Task], list[str]]:
    """Mend what is still wrong: wrong names become the nearest valid object, repeats and surplus tasks go.

    Returns:
        The executable tasks, and one sentence for each thing that was mended.

    Raises:
        ModelOutputError: If no task is left.
    """
    fixed, movable = home.objects("fixed"), home.objects("movable")
    kept: list[Task] = []
    said: list[str] = []
    for task in tasks:
        act = _mended(task.act, fixed, movable, search)
        if act is None:
            said.append(f"Task {task.id} was dropped: {'; '.join(_problems(task.act, fixed, movable))}")
        elif act.describe() in {other.act.describe() for other in kept}:
            said.append(f"Task {task.id} was dropped: it repeats another task.")
        elif len(kept) == count:
            said.append(f"Task {task.id} was dropped: {count} tasks are enough.")
        else:
            if act != task.act:
                said.append(f"Task {task.id}: {task.act.describe()} -> {act.describe()}.")
            kept.append(task.model_copy(update={"act": act}))
    if not kept:
        raise ModelOutputError("human/reflect_scene", str([t.act.describe() for t in tasks]), "no task can be done")
    return kept, said


def _problems(act: Act, fixed: ObjectMap, movable: ObjectMap) -> list[str]:
    if isinstance(act, PickPlace):
        return [
            *_reference(act.object, act.object_id, movable, "movable"),
            *_reference(act.receptacle, act.receptacle_id, fixed, "fixed"),
        ]
    if isinstance(act, FreeMotion):
        empty = [f'the thing in hand cannot be "{act.in_hand}".'] if _is_nothing(act.in_hand) else []
        return [*_reference(act.target, act.target_id, fixed, "fixed"), *empty]
    return ["a person does not hand things over."]


def _reference(name: str, number: int, objects: ObjectMap, kind: str) -> list[str]:
    if name not in objects:
        return [f'there is no {kind} object "{name}".']
    if objects[name][0] != number:
        return [f'"{name}" has the id {objects[name][0]}, not {number}.']
    return []


def _mended(act: Act, fixed: ObjectMap, movable: ObjectMap, search: Callable[[Sequence[str]], Search]) -> Act | None:
    if isinstance(act, PickPlace):
        thing, place = _valid(act.object, movable, search), _valid(act.receptacle, fixed, search)
        if thing is None or place is None:
            return None
        update = {
            "object": thing,
            "object_id": movable[thing][0],
            "receptacle": place,
            "receptacle_id": fixed[place][0],
        }
        return act.model_copy(update=update)
    if isinstance(act, FreeMotion) and not _is_nothing(act.in_hand):
        target = _valid(act.target, fixed, search)
        return act.model_copy(update={"target": target, "target_id": fixed[target][0]}) if target else None
    return None


def _valid(name: str, objects: ObjectMap, search: Callable[[Sequence[str]], Search]) -> str | None:
    if name in objects or not objects:
        return name if name in objects else None
    by_text = {plain(known): known for known in sorted(objects, reverse=True)}
    return by_text[search(list(by_text)).top(plain(name) or name, 1)[0][0]]


def _is_nothing(text: str) -> bool:
    return text.strip().lower() in _NOTHING
