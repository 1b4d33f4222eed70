"""How a real person is asked: questions as interrupts, and how answers are read."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from contextvars import copy_context
from typing import NamedTuple, TypeAlias, TypeVar

from langgraph.types import interrupt

from coopera.core.household import Collab, FreeMotion, ObjectMap, PickPlace, plain
from coopera.core.interview import MOST_STEPS, Answer, Question
from coopera.core.replies import FreeMotionDraft, PickPlaceDraft
from coopera.graphs.players.answering import UNANSWERED

Interview: TypeAlias = Callable[[Question], Answer]
Read = TypeVar("Read")

HELPFUL = 3  # grade from which graded feedback is a yes
_GOOD = {"y": True, "yes": True, "n": False, "no": False}
_SKIPPED = {"skip", "s", "-"}
_VERDICT = re.compile(r"\s*(y|yes|n|no|[1-5])\b[\s,;:.–-]*(?:because\b)?\s*(.*)", re.IGNORECASE | re.DOTALL)


class Verdict(NamedTuple):
    """A person's answer to one thing the robot imagined; `grade` (1 to 5) only where feedback is graded."""

    yes: bool | None
    reason: str
    grade: int | None = None
    asked: bool = True
    """Whether they were asked, rather than spared a question too many."""
    answered_as: str = ""
    """What they were asked in its place, since it says nearly the same."""


def ask_here(question: Question) -> Answer:
    """Interrupt the graph until the question is answered.

    The node is done again with each answer, and the answers given before are handed out anew in their order; so
    whatever comes before a question must come out the same.
    """
    answer: Answer = interrupt(question.model_dump(mode="json"))
    return answer


def interviewer() -> Interview:
    """How the node that runs now asks its person, from graphs that it runs inside itself, too."""
    here = copy_context()
    return lambda question: here.run(ask_here, question)


def ask_until_read(interview: Interview, question: Question, read: Callable[[Answer], Read]) -> Read:
    """Ask, and say what is wrong and ask again until the answer can be read."""
    while True:
        try:
            return read(interview(question))
        except ValueError as err:
            question = question.model_copy(update={"problem": str(err)})


def read_intention(answer: Answer) -> str:
    """Read an intention.

    Raises:
        ValueError: If it is no text of 1 to 300 characters.
    """
    text = " ".join(answer.split()) if isinstance(answer, str) else ""
    if not 1 <= len(text) <= 300:
        raise ValueError("Please say in one sentence of at most 300 characters what you want to do.")
    return text


def read_steps(answer: Answer, question: Question) -> list[str]:
    """Read the steps of an hour; one with bars in it must name what there is.

    Raises:
        ValueError: If there is none, or one that cannot be read.
    """
    steps = [" ".join(str(step).split()) for step in ([answer] if isinstance(answer, str) else answer)]
    steps = [step for step in steps if step]
    if not 1 <= len(steps) <= MOST_STEPS:
        raise ValueError(f"Please give 1 to {MOST_STEPS} steps.")
    for step in steps:
        read_step(step, question)
    return steps


def read_step(step: str, question: Question) -> str:
    """Read one step; one with bars in it must name what there is, and comes back with names for numbers.

    Raises:
        ValueError: Saying what cannot be read.
    """
    step = " ".join(step.split())
    if not step:
        raise ValueError("Please say what you do.")
    if len(step) > 300:
        raise ValueError("Please keep each step under 300 characters.")
    if "|" not in step:
        return step
    draft = choice_of(step, question)
    if isinstance(draft, PickPlaceDraft):
        return f"{draft.act.object} | {draft.act.receptacle}"
    return f"{draft.act.target} | {draft.act.motion} | {draft.act.in_hand}"


def choice_of(step: str, question: Question) -> PickPlaceDraft | FreeMotionDraft:
    """The task of a step that is a choice among what the question lists; its ids are 0.

    Raises:
        ValueError: Naming the part that cannot be read.
    """
    places = {name: (0, room) for name, room in question.places.items()}
    things = {name: (0, room) for name, room in question.things.items()}
    return read_choice(step, question.collab, places, things, question.motions)


def read_choice(
    step: str, collab: Collab, places: ObjectMap, things: ObjectMap, motions: Sequence[str]
) -> PickPlaceDraft | FreeMotionDraft:
    """Read a step made by choice: "thing | place" in type 1, "place | motion | thing in hand" in type 2.

    Each part is a number from the list that was shown, counted from 1, or a name; motion and thing in hand may be
    any words.

    Raises:
        ValueError: Naming the part that cannot be read.
    """
    parts = [part.strip() for part in step.split("|")]
    wanted = "thing | place" if collab == 1 else "place | motion | thing in hand"
    if len(parts) != (2 if collab == 1 else 3) or not all(parts):
        raise ValueError(f'"{step}" should read: {wanted}.')
    if collab == 1:
        thing, place = _object(parts[0], things, "movable"), _object(parts[1], places, "fixed")
        put = PickPlace(object_id=things[thing][0], object=thing, receptacle_id=places[place][0], receptacle=place)
        return PickPlaceDraft(thought=_thought(put.describe()), act=put)
    place = _object(parts[0], places, "fixed")
    motion = _numbered(parts[1], motions, "motion") if parts[1].isdigit() else parts[1]
    move = FreeMotion(target_id=places[place][0], target=place, in_hand=parts[2][:120], motion=motion[:200])
    return FreeMotionDraft(thought=_thought(move.describe()), act=move)


def read_verdicts(answer: Answer, question: Question) -> list[Verdict]:
    """Read the evening's answers: "yes", "no" (or 1 to 5 where graded) or "skip", and perhaps a reason, for each item.

    Raises:
        ValueError: If an item has no answer, or one that is neither.
    """
    lines = answer.splitlines() if isinstance(answer, str) else answer
    if len(lines) != len(question.items):
        raise ValueError(f"Please answer each of the {len(question.items)} items, one per line.")
    return [read_verdict(str(line), number, question.graded) for number, line in enumerate(lines, 1)]


def read_verdict(line: str, number: int, graded: bool) -> Verdict:
    """Read the answer to one item, the `number`th.

    Raises:
        ValueError: If it is none.
    """
    if line.strip().lower() in _SKIPPED:
        return Verdict(None, UNANSWERED)
    found = _VERDICT.fullmatch(line)
    if found is None or found[1].isdigit() != graded:
        scale = "a grade from 1 to 5" if graded else "yes or no"
        raise ValueError(f'Item {number} needs {scale}, and may have a reason after it; "skip" leaves it open.')
    word, reason = found[1].lower(), " ".join(found[2].split())[:400]
    grade = int(word) if graded else None
    return Verdict(_GOOD[word] if grade is None else grade >= HELPFUL, reason, grade)


def _object(part: str, objects: Mapping[str, object], kind: str) -> str:
    names = list(objects)
    if part.isdigit():
        return _numbered(part, names, f"{kind} object")
    if part in objects:
        return part
    meant = [name for name in names if plain(name) == plain(part).lower()]
    if not meant:
        raise ValueError(f'There is no {kind} object "{part}" in the list.')
    return meant[0]


def _numbered(part: str, options: Sequence[str], kind: str) -> str:
    if not 1 <= int(part) <= len(options):
        raise ValueError(f"There is no {kind} number {part}; the list has {len(options)}.")
    return options[int(part) - 1]


def _thought(said: str) -> str:
    return f"I {said}."[:300]
