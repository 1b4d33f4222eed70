"""What a classifier is shown of an example: which fields, from when, and in which words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

from coopera.core.clock import hour_label
from coopera.core.hour import Example
from coopera.core.people import TRAITS, BigFive, PersonId

_NOBODY = PersonId("")
_NO_HOUR = 12
_HIGH, _LOW = 3.75, 2.25  # of 1 to 5
_SENTENCE_END = re.compile(r"(?<=[.!?])\s+")


@dataclass(frozen=True, slots=True)
class Inputs:
    """Which of the paper's fields (PAPER App. C.2) a method lets its classifiers see.

    Attributes:
        traits: The inferred profile and Big Five, and with them who the person is: in the paper a classifier knows
            the person by nothing else.
        context: The recalled earlier intentions and tasks.
        time: The hour.
        rank: The robot's own order of its candidates, and its evidence for them. DEVIATES: the paper's classifiers do
            not see it. They do not see the observation either, and the order sums it up.
    """

    traits: bool = True
    context: bool = True
    time: bool = True
    rank: bool = True

    @property
    def names(self) -> list[str]:
        """What may be seen, in fixed order."""
        return [field.name for field in fields(self) if getattr(self, field.name)]

    def show(self, example: Example) -> Example:
        """Return the example with every field blank that is not to be seen."""
        hidden: dict[str, object] = {}
        if not self.traits:
            hidden |= {"person": _NOBODY, "profile": "", "big_five": None}
        if not self.context:
            hidden |= {"intentions": [], "tasks": []}
        if not self.time:
            hidden |= {"hour": _NO_HOUR}
        if not self.rank:
            hidden |= {"rank": None, "evidence": {}}
        return example.model_copy(update=hidden) if hidden else example


class Lesson(NamedTuple):
    """Labelled examples in order of time, as they are to be learned from."""

    examples: list[Example]
    labels: list[bool]
    hours: list[int]
    """Global hour index of each, whatever the inputs hide; what stands in one hour is judged together."""

    @property
    def teaches(self) -> bool:
        """Whether there is at least one example of each label."""
        return len(set(self.labels)) == 2


def lesson(examples: Iterable[Example], inputs: Inputs, *, most: int | None = None) -> Lesson:
    """Prepare labelled examples for learning; those without a label are left out.

    All examples of a person get the newest profile and Big Five of this person. Otherwise an early belief would hide
    the lesson of the early feedback.
    # PAPER App. D, as in the authors' code.

    Args:
        examples: In any order; examples of one hour keep theirs.
        inputs: What may be seen.
        most: Keep the newest of each person, so many in all, shared evenly between people.
    """
    labelled = sorted((e for e in examples if e.label is not None), key=lambda e: (e.day, e.hour))
    if most is not None and len(labelled) > most:
        labelled = _newest_evenly(labelled, most)
    newest: dict[str, Example] = {}
    for example in labelled:
        if example.profile or example.big_five is not None or example.person not in newest:
            newest[example.person] = example
    shown = []
    for example in labelled:
        picture = newest[example.person]
        current = example.but(profile=picture.profile, big_five=picture.big_five)
        shown.append(inputs.show(current))
    return Lesson(shown, [bool(e.label) for e in labelled], [e.day * 24 + e.hour for e in labelled])


def _newest_evenly(examples: Sequence[Example], most: int) -> list[Example]:
    """Keep the last `most` examples when people take turns at being counted from the newest back."""
    seen: dict[str, int] = {}
    ranked = []
    for position in reversed(range(len(examples))):
        person = examples[position].person
        seen[person] = seen.get(person, 0) + 1
        ranked.append((seen[person], -position))
    kept = sorted(-position for _, position in sorted(ranked)[:most])
    return [examples[position] for position in kept]


def sentences(text: str) -> list[str]:
    """Split a profile into its sentences."""
    return [part for part in _SENTENCE_END.split(text.strip()) if part]


def sentence_pair(example: Example) -> tuple[str, str]:
    """Say an example as (who and when, what), for an encoder that reads two texts.

    DEVIATES: the paper's instruction (PAPER App. C.2) is for a causal model that follows instructions; an encoder reads
    short statements better, most telling first, since it reads only the beginning of a long text.
    """
    parts = [f"{hour_label(example.hour)}."]
    if example.rank is not None:
        parts.append(f"Guess {example.rank + 1}.")
    if example.intentions:
        parts.append(f"Earlier: {'; '.join(example.intentions)}.")
    if example.profile:
        parts.append(example.profile)
    if example.big_five is not None and (words := _big_five_words(example.big_five)):
        parts.append(f"{words}.")
    if example.tasks:
        parts.append(f"With: {'; '.join(example.tasks)}.")
    what = f"{example.candidate}, to {example.intention}" if example.intention else example.candidate
    return " ".join(parts), what


def _big_five_words(big_five: BigFive) -> str:
    """Name the traits that stand out, since an encoder does not read numbers."""
    scores = {trait: getattr(big_five, trait) for trait in TRAITS}
    high = [f"high {trait}" for trait, score in scores.items() if score >= _HIGH]
    low = [f"low {trait}" for trait, score in scores.items() if score <= _LOW]
    return ", ".join([*high, *low])
