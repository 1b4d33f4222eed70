"""A real person in the simulated one's place: the hour is made of what they wrote down, or say when they are asked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal, TypeAlias

from coopera.core.clock import Clock
from coopera.core.errors import ModelOutputError
from coopera.core.hour import DayPlan, Found, HumanHour, Intention, LoggedHour, RobotHour
from coopera.core.household import HUMAN, AgentId, Collab, FreeMotion
from coopera.core.interview import Question
from coopera.core.protocols import Home
from coopera.graphs.players.checks import SearchIn, obstacle
from coopera.graphs.players.evening import MOST, Lived, evening_of
from coopera.graphs.players.player import Decomposed, HumanContext, HumanState, Player
from coopera.graphs.players.real_person import (
    Interview,
    Verdict,
    ask_here,
    ask_until_read,
    interviewer,
    read_choice,
    read_intention,
    read_step,
    read_steps,
    read_verdicts,
)
from coopera.graphs.players.reflecting import Draft
from coopera.graphs.players.simulated import Simulated, ask_for_tasks
from coopera.graphs.robots.method import Numbers
from coopera.simulation.acts.meaning import LEAST

Logs: TypeAlias = Callable[[DayPlan, Clock], LoggedHour | None]
"""What a real person wrote down of an hour; None for an hour that they left open."""


@dataclass(frozen=True, slots=True)
class Logged:
    """A person whose intentions, and tasks where given, are those of a log; a model does what the log leaves open.

    Of an hour without a word in the log the model makes the intention, too.
    """

    logs: Logs
    otherwise: Simulated = Simulated()
    one_by_one: ClassVar[bool] = False

    def intention(self, state: HumanState, ctx: HumanContext) -> Intention:
        """Take the intention from the log, if it has one of this hour; what is wanted stands in its tasks."""
        hour = self.logs(ctx.plan, state["clock"])
        if hour is None:
            return self.otherwise.intention(state, ctx)
        return Intention(text=hour.intention, continues=hour.continues, away=hour.away, wants=hour.tasks)

    def tasks(self, state: HumanState, ctx: HumanContext) -> Decomposed:
        """Take the tasks from the log, if it has any of this hour."""
        hour = self.logs(ctx.plan, state["clock"])
        if hour is None or not hour.tasks:
            return self.otherwise.tasks(state, ctx)
        return _taken_over(hour.tasks, state, ctx)

    def verdicts(self, clock: Clock, ctx: HumanContext, human: HumanHour, robot: RobotHour) -> list[Verdict]:
        """Have the model answer for the person."""
        return self.otherwise.verdicts(clock, ctx, human, robot)

    def present(self) -> Player:
        """The same: a log can always be read."""
        return self


@dataclass(frozen=True, slots=True)
class Interviewed:
    """A person in the loop: each question interrupts the run until they have answered it.

    Attributes:
        graded: Whether they answer with grades from 1 to 5 instead of yes or no.
        most: Questions of an evening at most.
        interview: How they are asked.
    """

    graded: bool = False
    most: int = MOST
    interview: Interview = ask_here
    one_by_one: ClassVar[bool] = True

    def intention(self, state: HumanState, ctx: HumanContext) -> Intention:
        """Ask what they want to do."""
        question = _question("intention", state["clock"], ctx, rooms=ctx.home.rooms, today=_today(state))
        return Intention(text=ask_until_read(self.interview, question, read_intention))

    def tasks(self, state: HumanState, ctx: HumanContext) -> Decomposed:
        """Ask for the steps, among what there is for them in the home."""
        found = state["found"]
        question = _question(
            "tasks",
            state["clock"],
            ctx,
            rooms=ctx.home.rooms,
            today=_today(state),
            intention=state["intention"].text,
            places={name: room for name, (_, room) in found.fixed.items()},
            things={name: room for name, (_, room) in found.movable.items()},
            motions=found.motions,
            can=state.get("can", {}),
            n_tasks=Numbers.HUMAN_TASKS[ctx.collab],
        )
        return _taken_over(
            ask_until_read(self.interview, question, lambda said: read_steps(said, question)), state, ctx
        )

    def verdicts(self, clock: Clock, ctx: HumanContext, human: HumanHour, robot: RobotHour) -> list[Verdict]:
        """Ask about one hour alone."""
        return self.evening(ctx, [Lived(clock, human, robot)])[0]

    def evening(self, ctx: HumanContext, hours: Sequence[Lived]) -> list[list[Verdict]]:
        """Ask about the whole day, at once; what says nearly the same is asked once, and at most so much in all."""
        if not hours:
            return []
        clock = hours[-1].clock
        asked = evening_of(hours, ctx.embeddings, most=self.most, address=(ctx.seed, ctx.persona.id, clock.day))
        about = {"items": asked.items, "cards": asked.cards, "of": asked.of, "graded": self.graded}
        question = _question("feedback", clock, ctx, **about)
        if not asked.items:
            return asked.handed_out([])
        return asked.handed_out(ask_until_read(self.interview, question, lambda said: read_verdicts(said, question)))

    def present(self) -> Player:
        """The person as the node that runs now reaches them."""
        return replace(self, interview=interviewer())


def checked_step(step: str, question: Question, home: Home, search: SearchIn, agent: AgentId = HUMAN) -> str:
    """Read one step of a person's, as `read_step` does; a choice must also be one that can be tried in the home.

    Raises:
        ValueError: Saying what is wrong, and what would do.
    """
    clean = read_step(step, question)
    if "|" in clean:
        fixed, movable = home.objects("fixed"), home.objects("movable")
        places = {name: fixed[name] for name in question.places if name in fixed}
        things = {name: movable[name] for name in question.things if name in movable}
        act = read_choice(clean, question.collab, places, things, question.motions).act
        if isinstance(act, FreeMotion):
            _must_mean_a_motion(act.motion, search(home.motions).top(act.motion, 3))
        if wrong := obstacle(act, home, agent):
            raise ValueError(wrong[:1].upper() + wrong[1:])
    return clean


def _must_mean_a_motion(said: str, near: Sequence[tuple[str, float]]) -> None:
    """Refuse words that no motion comes near to; the home would have the person stand there and do nothing."""
    if near and near[0][1] < LEAST:
        named = ", ".join(caption for caption, _ in near)
        raise ValueError(f'Nothing that you can do here comes near to "{said}"; the nearest are: {named}.')


def _taken_over(steps: Sequence[str], state: HumanState, ctx: HumanContext) -> Decomposed:
    """Take each step as it is where it is a choice of what there is; a model reads the others.

    Raises:
        ModelOutputError: If the model did not make one task of each of those.
    """
    choices = [_choice(step, ctx.collab, state["found"]) for step in steps]
    words = [step for step, choice in zip(steps, choices, strict=True) if choice is None]
    read = ask_for_tasks(state, ctx, words) if words else []
    if len(read) != len(words):
        said = str([draft.act.describe() for draft in read])
        wrong = f"it has {len(read)} tasks for {len(words)} steps of a person"
        raise ModelOutputError(f"human/tasks_type{ctx.collab}", said, wrong)
    rest = iter(read)
    return Decomposed([choice or next(rest) for choice in choices], stated=True)


def _choice(step: str, collab: Collab, found: Found) -> Draft | None:
    """The task of a step that is a choice of what there is; None for one in a person's own words."""
    try:
        return read_choice(step, collab, found.fixed, found.movable, found.motions)
    except ValueError:
        return None


def _today(state: HumanState) -> list[str]:
    return [f"{memory['when']}: {memory['text']}" for memory in state["today"]]


def _question(
    kind: Literal["intention", "tasks", "feedback"], clock: Clock, ctx: HumanContext, **about: Any
) -> Question:
    return Question(
        kind=kind,
        person=ctx.persona.id,
        name=ctx.persona.name,
        day=clock.day,
        hour=clock.hour,
        time=clock.label,
        weekday=clock.weekday,
        collab=ctx.collab,
        scene=ctx.plan.scene,
        **about,
    )
