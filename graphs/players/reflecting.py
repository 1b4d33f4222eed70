"""Second thoughts on an hour's tasks: what a reflection would change, and what becomes of two that looked at one draft.

DEVIATES: in the paper the second reflection reads what the first has made of the draft. Here both read the draft at the
same time, since that saves a round trip. What protects: code checks what the two have made of it together, and the
second is asked again, with what code found, while something is wrong (at most `Numbers.SCENE_ROUNDS` times in all).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, NamedTuple, TypeAlias

from coopera.core.clock import Clock
from coopera.core.hour import Reasons, Reflection, Task, TaskVerdict
from coopera.core.people import Frozen
from coopera.core.replies import (
    FreeMotionDraft,
    FreeMotionReflectionReply,
    FreeMotionReview,
    PickPlaceDraft,
    PickPlaceReflectionReply,
    PickPlaceReview,
)

Draft: TypeAlias = PickPlaceDraft | FreeMotionDraft
Node: TypeAlias = Literal["reflect_profile", "reflect_scene"]


class Opinion(Frozen):
    """What one reflection says of the tasks that it was shown.

    Attributes:
        verdicts: Of each task.
        tasks: Each task as it should be, in the same order; None for one that should go.
        add: Tasks that are missing.
    """

    verdicts: list[TaskVerdict]
    tasks: list[Task | None]
    add: list[Task]


class Agreed(NamedTuple):
    """The tasks that two opinions make together, numbered anew, and a record of each opinion."""

    tasks: list[Task]
    reflections: list[Reflection]


def opinion(reply: PickPlaceReflectionReply | FreeMotionReflectionReply, shown: Sequence[Task]) -> Opinion:
    """Read a reply as what should become of the tasks that were shown.

    A task of which nothing is said stays. A changed one keeps the reasons that are not given anew: those of the task
    with the same act, if it was only moved, or else those of the task in whose place it comes.
    """
    reviews: Sequence[PickPlaceReview | FreeMotionReview] = reply.reviews[: len(shown)]
    said = {task.act.describe(): task.reasons for task in shown}
    tasks: list[Task | None] = list(shown)
    for n, review in enumerate(reviews):
        if not review.yes:
            tasks[n] = None if review.task is None else _changed(shown[n], review.task, said)
    return Opinion(
        verdicts=[TaskVerdict(ok=review.yes, comment=review.reason) for review in reviews],
        tasks=tasks,
        add=[as_task(draft) for draft in reply.add],
    )


def agreed(
    shown: Sequence[Task], opinions: Mapping[Node, Opinion], clock: Clock, count: int, wrong: Callable[[Task], str]
) -> Agreed:
    """Make one list of tasks of what the reflections say of a draft.

    A change of one reflection stands where the other leaves the task as it was. Where both change it, what the person
    wants (the first) stands if code finds nothing wrong with it, else what the second makes of it: the second has only
    mended a task that the person would not do. Missing tasks are added while there are fewer than `count`, the person's
    first, and none twice. Where the two together would leave nothing to do, the draft stands.

    Args:
        shown: The draft that all were shown.
        opinions: What each says, the first reflection's first; it may be one alone.
        clock: The hour, by which tasks are numbered.
        count: How many tasks an hour has.
        wrong: What stands against a task at home, as a sentence; empty where it can be tried.
    """
    chosen = [_chosen(task, [one.tasks[n] for one in opinions.values()], wrong) for n, task in enumerate(shown)]
    tasks = [task for task in chosen if task is not None]
    for task in (task for one in opinions.values() for task in one.add):
        if len(tasks) < count and task.act.describe() not in {other.act.describe() for other in tasks}:
            tasks.append(task)
    if not tasks:
        chosen, tasks = list(shown), list(shown)
    reflections = [_record(node, one, shown, chosen, tasks) for node, one in opinions.items()]
    return Agreed(numbered(tasks, clock), reflections)


def numbered(tasks: Sequence[Task], clock: Clock) -> list[Task]:
    """The tasks with ids "<hour>.<n>"."""
    return [task.model_copy(update={"id": f"{clock.hour}.{n}"}) for n, task in enumerate(tasks, start=1)]


def as_task(draft: Draft) -> Task:
    """A draft as a task that has no number yet."""
    why = Reasons(human=draft.reason_human, intentions=draft.reason_intentions, tasks=draft.reason_tasks)
    return Task(id="", thought=draft.thought, reasons=why, act=draft.act)


def _changed(before: Task, draft: Draft, said: Mapping[str, Reasons]) -> Task:
    """What a draft makes of a task; the very same task if it is only repeated."""
    after = as_task(draft)
    if after.act == before.act:
        return before
    given = {field: text for field, text in after.reasons.model_dump().items() if text}
    kept = said.get(after.act.describe(), before.reasons)
    return after.model_copy(update={"id": before.id, "reasons": kept.model_copy(update=given)})


def _chosen(task: Task, said: Sequence[Task | None], wrong: Callable[[Task], str]) -> Task | None:
    """What becomes of a task: the first change with which nothing is wrong, or else the last."""
    changes = [one for one in said if one is not task]
    if not changes:
        return task
    return next((one for one in changes if one is None or not wrong(one)), changes[-1])


def _record(
    node: Node, said: Opinion, shown: Sequence[Task], chosen: Sequence[Task | None], left: Sequence[Task]
) -> Reflection:
    """An opinion as it stands in the trace: which of its changes were made, and which not."""
    made: list[str] = []
    overruled: list[str] = []
    for before, wanted, became in zip(shown, said.tasks, chosen, strict=True):
        if wanted is not before:
            after = "dropped" if wanted is None else wanted.act.describe()
            (made if _same(became, wanted) else overruled).append(f"{before.id}: {before.act.describe()} -> {after}")
    for task in said.add:
        stands = any(_same(task, one) for one in left if one not in chosen)
        (made if stands else overruled).append(f"added: {task.act.describe()}")
    return Reflection(node=node, verdicts=said.verdicts, changes=made, overruled=overruled)


def _same(one: Task | None, other: Task | None) -> bool:
    """Whether both say the same is to be done, or both say nothing is."""
    return (one and one.act) == (other and other.act)
