"""From a published persona to a fuller profile: the person's own statements, and fitting ones for the open sides."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import yaml
from pydantic import Field

from coopera.core.lazy import made_once
from coopera.core.people import BigFive, Frozen
from coopera.core.replies import ProfileReply
from coopera.models.offline.household.knowledge import Loadings
from coopera.models.offline.household.reading import clip
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.household.statements import sentences, statements
from coopera.models.offline.human.big_five import infer

SAID_ALREADY = 0.75  # cosine from which a sentence of the conversation says nothing new
KINSHIP = 6.0  # logits per unit of cosine between a statement and what the person says
TRAIT_PULL = 1.1  # logits per point of (trait - 3) x loading 1, as for activities
AVERSE = 0.45  # cosine to something the person dislikes from which a statement is not made
NEVER = -50.0  # logit of a statement that is not made
LONGEST = 6000

_FACT = re.compile(r"^(?:i|my|we|our)\b|^i['’]", re.IGNORECASE)
_SMALL_TALK = re.compile(
    r"\b(?:glad|hope|sure|sorry|agree|thanks?|thank you|nice|good to|see what|know what|think so|guess|bet|mean|"
    r"meet(?:ing)?|you|your|that|those|it|them|too|also|will|would|should|could|try|never heard|know)\b|[\[\]]",
    re.IGNORECASE,
)


class _Statement(Frozen):
    says: Annotated[str, Field(min_length=2)]
    big_five: Loadings


class Aspect(Frozen):
    """A side of life that a profile should speak of; `words` in a sentence show that it does."""

    name: str
    words: Annotated[list[str], Field(min_length=1)]
    statements: Annotated[list[_Statement], Field(min_length=2)]

    def covered(self, said: Sequence[str]) -> bool:
        """Whether a sentence speaks of this aspect."""
        found = re.compile(rf"\b(?:{'|'.join(map(re.escape, self.words))})(?!\w)", re.IGNORECASE)
        return any(found.search(sentence) for sentence in said)


def profile(sense: CommonSense, variables: Mapping[str, Any], rng: np.random.Generator) -> ProfileReply:
    """Answer persona/profile: the person's own sentences, what they say in the conversation, and the rest of a life.

    DEVIATES: PAPER §3.2 has a language model imagine the life around the facts; a routine model draws a statement from
    aspects.yaml for each aspect of which the person says nothing. Of who says nothing at all, nothing is made up.
    """
    kept = sentences(_lines(variables["profile_1"]))
    for sentence in _facts(_lines(variables["conversation"])):
        if max((sense.similarity(sentence, other) for other in kept), default=0.0) < SAID_ALREADY:
            kept.append(sentence)
    if not kept:
        return ProfileReply(profile="I say nothing of myself.")
    kept += extension(sense, kept, rng)
    return ProfileReply(profile=clip(" ".join(_sentence(part) for part in kept), LONGEST))


def extension(sense: CommonSense, said: Sequence[str], rng: np.random.Generator) -> list[str]:
    """Draw a statement for each aspect that is not covered, fitting what is said and how the person seems to be."""
    seems = infer(sense, " ".join(_sentence(part) for part in said), rng).big_five
    opinions = statements("\n".join(said))
    added = []
    for aspect in shipped_aspects():
        if aspect.covered(said):
            continue
        logits = np.array([_fit(sense, one, opinions.habits, opinions.aversions, seems) for one in aspect.statements])
        weights = np.exp(logits - logits.max())
        choice = int(rng.choice(len(weights), p=weights / weights.sum()))
        if logits[choice] > NEVER:
            added.append(aspect.statements[choice].says)
    return added


@made_once()
def shipped_aspects() -> tuple[Aspect, ...]:
    """Return the aspects of a life, from aspects.yaml beside this file."""
    text = (Path(__file__).parent / "aspects.yaml").read_text(encoding="utf-8")
    return tuple(Aspect.model_validate(one) for one in yaml.safe_load(text)["aspects"])


def _fit(sense: CommonSense, one: _Statement, habits: Sequence[str], aversions: Sequence[str], seems: BigFive) -> float:
    """Logit of a statement for a person; it is not made of one who dislikes what it speaks of."""
    if any(sense.similarity(one.says, other) >= AVERSE for other in aversions):
        return NEVER
    near = max((sense.similarity(one.says, other) for other in habits), default=0.0)
    pull = sum(load * (getattr(seems, trait) - 3.0) for trait, load in one.big_five.items())
    return float(KINSHIP * near + TRAIT_PULL * pull)


def _facts(conversation: str) -> list[str]:
    """What user 1 states of themselves: no questions, no small talk."""
    facts: list[str] = []
    for line in conversation.splitlines():
        speaker, _, words = line.partition(":")
        if speaker.strip().lower() != "user 1":
            continue
        for sentence in sentences(words):
            stated = _FACT.search(sentence) and "?" not in sentence and len(sentence.split()) >= 4
            if stated and not _SMALL_TALK.search(sentence):
                facts.append(sentence)
    return list(dict.fromkeys(facts))


def _lines(text: Any) -> str:
    return "\n".join(map(str, text)) if isinstance(text, list | tuple) else str(text)


def _sentence(text: str) -> str:
    line = text.strip()
    line = line[:1].upper() + line[1:]
    return line if line.endswith((".", "!", "?")) else f"{line}."
