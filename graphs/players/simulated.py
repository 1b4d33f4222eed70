"""A language model plays the person: it decides, breaks down and answers for them (PAPER §3.2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar, Literal

from coopera.core.clock import Clock, hour_label
from coopera.core.errors import ModelOutputError
from coopera.core.hour import HumanHour, Intention, Reasons, RobotHour
from coopera.core.randomness import Address
from coopera.core.replies import (
    DayReply,
    FreeMotionReply,
    GradesReply,
    IntentionReply,
    PickPlaceReply,
    VerdictsReply,
)
from coopera.graphs.players.player import Decomposed, HumanContext, HumanState, Player
from coopera.graphs.players.real_person import HELPFUL, Verdict
from coopera.graphs.players.reflecting import Draft
from coopera.graphs.players.together import together
from coopera.graphs.players.variables import all_of_the_home, as_tasks, known, living, motions_here, when, who
from coopera.graphs.players.variety import variety
from coopera.graphs.robots.method import Numbers

TASKS_REPLY: dict[int, type[PickPlaceReply | FreeMotionReply]] = {1: PickPlaceReply, 2: FreeMotionReply}


@dataclass(frozen=True, slots=True)
class Simulated:
    """A simulated person.

    Attributes:
        graded: Whether they answer with grades from 1 to 5 instead of yes or no.
    """

    graded: bool = False
    one_by_one: ClassVar[bool] = False

    def intention(self, state: HumanState, ctx: HumanContext) -> Intention:
        """Ask for the intention of this hour, or take it from the intentions of the whole day."""
        reply = _of_the_hour(state, ctx) if ctx.model.hourly else _of_the_day(state, ctx)
        reasons = Reasons(human=reply.reason_human, intentions=reply.reason_intentions, tasks=reply.reason_tasks)
        return Intention(
            text=reply.intention,
            reasons=reasons,
            continues=reply.continues and ctx.living.lasting and bool(state["today"]),
            away=reply.away and ctx.living.absence,
            wants=reply.wants,
        )

    def tasks(self, state: HumanState, ctx: HumanContext) -> Decomposed:
        """Ask for as many tasks as the paper has."""
        return Decomposed(ask_for_tasks(state, ctx), stated=False)

    def verdicts(self, clock: Clock, ctx: HumanContext, human: HumanHour, robot: RobotHour) -> list[Verdict]:
        """Ask about the intentions and about the tasks, at once."""
        about = {**when(clock), **who(ctx), "intention": human.intention.text}
        guesses = [candidate.text for candidate in robot.intentions]
        offers = [{"thought": t.thought, "text": t.act.describe()} for t in robot.tasks]
        asked = {**about, "tasks": as_tasks(human.tasks[1:]), "offers": offers}
        at = Address(ctx.persona.id, clock.day, clock.hour, "feedback")
        both = [
            partial(self._ask_verdicts, ctx, "intentions", at, {**about, "guesses": guesses}, len(guesses)),
            partial(self._ask_verdicts, ctx, "tasks", at, asked, len(offers)),
        ]
        return [verdict for said in together(both, waits=not ctx.ask.instant("human")) for verdict in said]

    def present(self) -> Player:
        """The same: a model can always be asked."""
        return self

    def _ask_verdicts(
        self,
        ctx: HumanContext,
        what: Literal["intentions", "tasks"],
        at: Address,
        variables: dict[str, Any],
        count: int,
    ) -> list[Verdict]:
        """An answer that cannot be read, or of another length, is no verdict on anything."""
        if count == 0:
            return []
        try:
            if self.graded:
                grades = ctx.ask(f"human/grade_{what}", GradesReply, at=at, variables=variables).grades
                said = [Verdict(g.grade >= HELPFUL, g.reason, g.grade) for g in grades]
            else:
                verdicts = ctx.ask(f"human/feedback_{what}", VerdictsReply, at=at, variables=variables).verdicts
                said = [Verdict(v.yes, v.reason) for v in verdicts]
        except ModelOutputError as err:
            return [Verdict(None, str(err))] * count
        if len(said) != count:
            return [Verdict(None, f"{len(said)} answers to {count} questions")] * count
        return said


def ask_for_tasks(state: HumanState, ctx: HumanContext, steps: Sequence[str] = ()) -> Sequence[Draft]:
    """Ask the model to break the intention into tasks, or to read the steps that a person gave in their own words."""
    found = state["found"]
    things = {"movable": found.movable} if ctx.collab == 1 else motions_here(state)
    reply = ctx.ask(
        f"human/tasks_type{ctx.collab}",
        TASKS_REPLY[ctx.collab],
        at=Address(ctx.persona.id, state["clock"].day, state["clock"].hour, "decompose"),
        variables={
            **known(state, ctx),
            **things,
            "intention": state["intention"].text,
            "fixed": found.fixed,
            "states": ctx.home.states(),
            "so_far": _so_far(state, ctx),
            "n_tasks": len(steps) or Numbers.HUMAN_TASKS[ctx.collab],
            "steps": list(steps),
        },
    )
    return reply.tasks


def _so_far(state: HumanState, ctx: HumanContext) -> list[str]:
    """The tasks of the hour before, if the person goes on with what they did then."""
    if not state["intention"].continues:
        return []
    now = state["clock"].now
    return [task.text for task in ctx.memories.tasks.records(since=now - 1) if task.hour == now - 1]


def _of_the_hour(state: HumanState, ctx: HumanContext) -> IntentionReply:
    clock, hours = state["clock"], state["hours"]
    return ctx.ask(
        "human/intention",
        IntentionReply,
        at=Address(ctx.persona.id, clock.day, clock.hour, "propose"),
        variables={
            **known(state, ctx),
            **living(ctx, clock),
            **variety(ctx, clock, clock.day * len(hours) + hours.index(clock.hour)),
            **all_of_the_home(ctx),
            "states": ctx.home.states(),
            "today": state["today"],
            "may_go_on": ctx.living.lasting and bool(state["today"]),
        },
    )


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
            **variety(ctx, dawn, dawn.day),
            **all_of_the_home(ctx),
            "hours": [hour_label(hour) for hour in hours],
            **living(ctx, dawn),
        },
    )
    if len(reply.intentions) != len(hours):
        wrong = f"it has {len(reply.intentions)} intentions for a day of {len(hours)} hours"
        raise ModelOutputError("human/day", reply.model_dump_json(), wrong)
    return reply.intentions[hours.index(clock.hour)]
