"""The variables of `coopera.core.asks` that many prompts share: when it is, who the person is, what their tasks are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coopera.core.clock import Clock
from coopera.core.hour import Task
from coopera.graphs.players.changes import as_variables as as_variables_of_today
from coopera.graphs.players.player import HumanContext, HumanState
from coopera.graphs.robots.recall import as_variables


def when(clock: Clock) -> dict[str, Any]:
    """The time variables."""
    return {"time": clock.label, "hour": clock.hour, "weekday": clock.weekday, "day": clock.day}


def who(ctx: HumanContext) -> dict[str, Any]:
    """The person variables; only the person's own prompts get them."""
    persona = ctx.persona
    return {
        "person": persona.id,
        "name": persona.name,
        "big_five": persona.big_five.model_dump(),
        "profile": ctx.model.profile(persona),
    }


def living(ctx: HumanContext, clock: Clock) -> dict[str, Any]:
    """What is different these days, and whether the person may leave the home."""
    return {"changes": as_variables_of_today(ctx.changes(clock), clock.day), "may_leave": ctx.living.absence}


def all_of_the_home(ctx: HumanContext) -> dict[str, Any]:
    """The rooms and all that is in them; of things only where tasks may move them, in type 1."""
    things = ctx.home.objects("movable") if ctx.collab == 1 else {}
    return {"rooms": ctx.home.rooms, "fixed": ctx.home.objects("fixed"), "movable": things}


def known(state: HumanState, ctx: HumanContext) -> dict[str, Any]:
    """The time, the person and what they recall."""
    return {**when(state["clock"]), **who(ctx), **as_variables(state["recalled"], state["clock"])}


def motions_here(state: HumanState) -> dict[str, Any]:
    """The motions that were found, and those that can be done at each of the furniture."""
    return {"motions": state["found"].motions, "can": state["can"]}


def as_tasks(tasks: Sequence[Task]) -> list[dict[str, Any]]:
    """Tasks as prompts read them."""
    return [
        {"id": t.id, "thought": t.thought, "text": t.act.describe(), "act": t.act.model_dump(exclude={"kind"})}
        for t in tasks
    ]
