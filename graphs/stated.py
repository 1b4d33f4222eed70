"""What a real person states of an hour: the question that asks for it, and the tasks made of the answer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from coopera.core.clock import Clock
from coopera.core.errors import ModelOutputError
from coopera.core.hour import Found, Intention
from coopera.core.interview import Question
from coopera.core.replies import FreeMotionDraft, PickPlaceDraft
from coopera.graphs.method import Numbers
from coopera.graphs.real_person import ask_until_read, read_choice, read_intention, read_steps
from coopera.graphs.services import HumanContext

Draft: TypeAlias = PickPlaceDraft | FreeMotionDraft


def stated_intention(ctx: HumanContext, clock: Clock, today: Sequence[str]) -> Intention | None:
    """The intention that a real person wrote down or gives now; None where the person is simulated."""
    if ctx.logged:
        return Intention(text=ctx.logged.intention)
    if ctx.interview:
        question = Question(kind="intention", **_when_and_where(ctx, clock, today))
        return Intention(text=ask_until_read(ctx.interview, question, read_intention))
    return None


def stated_steps(
    ctx: HumanContext, clock: Clock, today: Sequence[str], intention: Intention, found: Found
) -> list[str]:
    """The steps of this hour in a real person's words; none where the model is to find them."""
    if ctx.logged:
        return ctx.logged.tasks
    if ctx.interview:
        question = Question(
            kind="tasks",
            **_when_and_where(ctx, clock, today),
            intention=intention.text,
            places={name: room for name, (_, room) in found.fixed.items()},
            things={name: room for name, (_, room) in found.movable.items()},
            motions=found.motions,
            n_tasks=Numbers.HUMAN_TASKS[ctx.collab],
        )
        return ask_until_read(ctx.interview, question, lambda answer: read_steps(answer, question))
    return []


def chosen(ctx: HumanContext, steps: Sequence[str], found: Found) -> list[Draft | None]:
    """The task of each step that is a choice of what there is; None for one in a person's own words."""
    return [_choice(ctx, step, found) for step in steps]


def fill(drafts: Sequence[Draft | None], read: Sequence[Draft], prompt: str) -> list[Draft]:
    """Put what a model read of a person's own words in its places among the choices.

    Raises:
        ModelOutputError: If the model did not make one task of each step.
    """
    gaps = sum(draft is None for draft in drafts)
    if len(read) != gaps:
        said = str([draft.act.describe() for draft in read])
        raise ModelOutputError(prompt, said, f"it has {len(read)} tasks for {gaps} steps of a person")
    rest = iter(read)
    return [draft or next(rest) for draft in drafts]


def _choice(ctx: HumanContext, step: str, found: Found) -> Draft | None:
    try:
        return read_choice(step, ctx.collab, found.fixed, found.movable, found.motions)
    except ValueError:
        return None


def _when_and_where(ctx: HumanContext, clock: Clock, today: Sequence[str]) -> dict[str, object]:
    return {
        "person": ctx.persona.id,
        "name": ctx.persona.name,
        "day": clock.day,
        "hour": clock.hour,
        "time": clock.label,
        "weekday": clock.weekday,
        "collab": ctx.collab,
        "rooms": ctx.home.rooms,
        "today": list(today),
    }
