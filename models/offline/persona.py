"""From a published persona to a person of ours: a self-introduction and Big-Five scores. Honest, not imaginative."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import yaml
from pydantic import Field

from core.people import TRAITS, BigFive, Frozen
from core.replies import BigFiveReply, ProfileReply
from models.offline.reading import clip
from models.offline.sense import CommonSense
from models.offline.statements import sentences

SAID_ALREADY = 0.75  # cosine from which a sentence of the conversation says nothing new
SPREAD = 0.8  # standard deviation over people; PAPER App. B: 0.7-0.9 among real people
LONGEST = 6000

_FACT = re.compile(r"^(?:i|my|we|our)\b|^i['’]", re.IGNORECASE)
_SMALL_TALK = re.compile(
    r"\b(?:glad|hope|sure|sorry|agree|thanks?|thank you|nice|good to|see what|know what|think so|guess|bet|mean|"
    r"meet(?:ing)?|you|your|that|those|it|them|too|also|will|would|should|could|try|never heard|know)\b|[\[\]]",
    re.IGNORECASE,
)


class _Marker(Frozen):
    says: str
    trait: str
    sign: Annotated[int, Field(ge=-1, le=1)]


class _Norm(Frozen):
    mean: float
    sd: Annotated[float, Field(gt=0)]


class _Markers(Frozen):
    norms: dict[str, _Norm]
    markers: list[_Marker]


def profile(sense: CommonSense, variables: Mapping[str, Any]) -> ProfileReply:
    """Answer persona/profile: the person's own sentences and what they say of themselves in the conversation.

    DEVIATES: PAPER §3.2 has a language model invent a fuller life; a routine model has no imagination, and what
    nobody said is not added.
    """
    own = sentences(_lines(variables["profile_1"]))
    kept = list(own)
    for sentence in _facts(_lines(variables["conversation"])):
        known = max((sense.similarity(sentence, other) for other in kept), default=0.0)
        if known < SAID_ALREADY:
            kept.append(sentence)
    text = " ".join(_sentence(part) for part in kept)
    return ProfileReply(profile=clip(text or "I say nothing of myself.", LONGEST))


def big_five(sense: CommonSense, variables: Mapping[str, Any]) -> BigFiveReply:
    """Answer persona/big_five: how much nearer the profile is to one pole's statements than to the other's.

    Each trait's score is centred and scaled by norms measured over 424 published personas, so that 3 is an average
    persona and people spread as real ones do. Statements are compared by likeness of meaning; nothing is understood.
    """
    said = sentences(str(variables["profile"]))
    if not said:
        return BigFiveReply(big_five=BigFive())
    known = shipped_markers()
    raw = raw_scores(sense, said)
    scores = {
        trait: round(
            float(np.clip(3.0 + SPREAD * (raw[trait] - known.norms[trait].mean) / known.norms[trait].sd, 1, 5)), 2
        )
        for trait in TRAITS
    }
    return BigFiveReply(big_five=BigFive(**scores))


def raw_scores(sense: CommonSense, said: Sequence[str]) -> dict[str, float]:
    """Return per trait the mean best cosine to the positive statements less that to the negative ones."""
    markers = shipped_markers().markers
    nearest = (sense.vectors(said) @ sense.vectors([marker.says for marker in markers]).T).max(axis=0)
    return {
        trait: float(
            np.mean([n for n, m in zip(nearest, markers, strict=True) if m.trait == trait and m.sign > 0])
            - np.mean([n for n, m in zip(nearest, markers, strict=True) if m.trait == trait and m.sign < 0])
        )
        for trait in TRAITS
    }


@lru_cache(maxsize=1)
def shipped_markers() -> _Markers:
    """Return the trait-marking statements and their norms, from traits.yaml beside this file."""
    text = (Path(__file__).parent / "traits.yaml").read_text(encoding="utf-8")
    return _Markers.model_validate(yaml.safe_load(text))


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
