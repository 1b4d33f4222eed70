"""What a language model may answer: one type per prompt, named in the prompt's front matter.

Code shows or enforces the JSON schema and parses the answer with these types, so a reworded
prompt cannot break parsing. Every text and list is bounded, so that constrained decoding ends.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field
from pydantic.json_schema import SkipJsonSchema

from coopera.core.household import FreeMotion, HandOver, PickPlace
from coopera.core.people import BigFive, Frozen

Sentence = Annotated[str, Field(min_length=1, max_length=300)]
Reason = Annotated[str, Field(max_length=400)]
Want = Annotated[str, Field(min_length=1, max_length=80)]
Remark = Annotated[str, Field(max_length=200)]


class IntentionReply(Frozen):
    """human/intention: what the person wants to do this hour, and why."""

    intention: Sentence
    reason_human: Reason = ""
    reason_intentions: Reason = ""
    reason_tasks: Reason = ""
    continues: bool = False
    """Whether it goes on with what was begun in an earlier hour of the day."""
    away: bool = False
    """Whether it is done outside the home."""
    wants: Annotated[list[Want], Field(max_length=12)] = []
    """The furniture and the small things that it is done with, in a few plain words each."""


class DayReply(Frozen):
    """human/day: the intentions of a whole day, one per hour, in order (the single-shot ablation)."""

    intentions: Annotated[list[IntentionReply], Field(min_length=1, max_length=24)]


class _TaskDraft(Frozen):
    thought: Sentence
    reason_human: Reason = ""
    reason_intentions: Reason = ""
    reason_tasks: Reason = ""


class PickPlaceDraft(_TaskDraft):
    """A proposed pick-and-place task."""

    act: PickPlace


class FreeMotionDraft(_TaskDraft):
    """A proposed free-form task."""

    act: FreeMotion


class HandOverDraft(_TaskDraft):
    """A proposed task to bring one thing."""

    act: HandOver


class PickPlaceReply(Frozen):
    """human/tasks_type1 and robot/tasks_type1: tasks in the order they would be done."""

    tasks: Annotated[list[PickPlaceDraft], Field(min_length=1, max_length=8)]


class FreeMotionReply(Frozen):
    """human/tasks_type2: tasks in the order they will be done."""

    tasks: Annotated[list[FreeMotionDraft], Field(min_length=1, max_length=8)]


class HandOverReply(Frozen):
    """robot/tasks_type2: one thing to bring per imagined task."""

    tasks: Annotated[list[HandOverDraft], Field(min_length=1, max_length=8)]


class VerdictReply(Frozen):
    """A yes or no with its reason, which comes first: decoding writes keys in this order, and a later one defends."""

    reason: Reason = ""
    yes: bool


class _Review(Frozen):
    """Second thoughts on one drafted task: why, the verdict, and only then the task as it should be.

    A model that is held to a schema writes its fields in this order.
    """

    reason: Remark = ""
    yes: bool
    """Whether it stays as it was drafted; what is given as `task` then counts for nothing."""


class PickPlaceReview(_Review):
    """`task`: with a no, what it becomes; None where it goes."""

    task: PickPlaceDraft | None = None


class FreeMotionReview(_Review):
    """`task`: with a no, what it becomes; None where it goes."""

    task: FreeMotionDraft | None = None


class PickPlaceReflectionReply(Frozen):
    """human/reflect_*_type1: a review of each given task, in the given order, and tasks that are missing."""

    reviews: Annotated[list[PickPlaceReview], Field(max_length=8)]
    add: Annotated[list[PickPlaceDraft], Field(max_length=8)] = []


class FreeMotionReflectionReply(Frozen):
    """human/reflect_*_type2: a review of each given task, in the given order, and tasks that are missing."""

    reviews: Annotated[list[FreeMotionReview], Field(max_length=8)]
    add: Annotated[list[FreeMotionDraft], Field(max_length=8)] = []


def _probability(value: Any) -> float | None:
    """Take what is no probability for one that was left out, since no decoder can be held to a range."""
    known = isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value <= 1
    return float(value) if known else None


Probability = Annotated[float | SkipJsonSchema[None], BeforeValidator(_probability)]


class ImaginedIntention(Frozen):
    """One intention that the robot thinks possible."""

    intention: Sentence
    reason_human: Reason = ""
    reason_intentions: Reason = ""
    reason_tasks: Reason = ""
    reason_vision: Reason = ""
    probability: Probability = None
    """How likely it is; may be left out."""


class IntentionsReply(Frozen):
    """robot/intentions: what was seen, then possible intentions, most likely first."""

    seen: Annotated[str, Field(max_length=300)] = ""
    """What can be seen of the first task, in words. It comes first, so that what is guessed rests on it."""
    intentions: Annotated[list[ImaginedIntention], Field(min_length=1, max_length=8)]


class VerdictsReply(Frozen):
    """human/feedback_intentions, human/feedback_tasks and judge/tasks: one verdict per item, in the given order."""

    verdicts: Annotated[list[VerdictReply], Field(max_length=64)]


class Grade(Frozen):
    """How helpful something was, from 1 (of no use) to 5 (just what was needed), after the reason."""

    reason: Reason = ""
    grade: int = Field(ge=1, le=5)


class GradesReply(Frozen):
    """human/grade_intentions and human/grade_tasks: one grade per item, in the given order."""

    grades: Annotated[list[Grade], Field(max_length=64)]


class TraitsReply(Frozen):
    """robot/traits: who this person seems to be."""

    big_five: BigFive
    profile: Annotated[str, Field(min_length=1, max_length=900)]
    reasons_big_five: Annotated[str, Field(max_length=900)] = ""
    reasons_profile: Annotated[str, Field(max_length=900)] = ""


class ProfileReply(Frozen):
    """persona/profile: a first-person self-introduction."""

    profile: Annotated[str, Field(min_length=1, max_length=6000)]


class BigFiveReply(Frozen):
    """persona/big_five: Big-Five scores read from a profile."""

    big_five: BigFive


class BigFiveTestReply(Frozen):
    """persona/big_five_test: the fifty answers in order, each from 1 (disagree) to 5 (agree)."""

    answers: Annotated[list[Annotated[int, Field(ge=1, le=5)]], Field(min_length=50, max_length=50)]


REPLIES: dict[str, type[Frozen]] = {
    reply.__name__: reply
    for reply in (
        IntentionReply,
        DayReply,
        PickPlaceReply,
        FreeMotionReply,
        HandOverReply,
        PickPlaceReflectionReply,
        FreeMotionReflectionReply,
        IntentionsReply,
        VerdictsReply,
        GradesReply,
        TraitsReply,
        ProfileReply,
        BigFiveReply,
        BigFiveTestReply,
    )
}
"""The reply types a prompt's front matter may name."""
