"""A person's Big Five, read from a self-description: directly, and by filling in the 50-item test.

Statements are compared by likeness of meaning; nothing is understood. Each reading attends to most of the sentences,
not always the same ones, so that several readings differ as much as the text leaves open.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
import yaml
from numpy.typing import NDArray
from pydantic import Field

from coopera.core.big_five_test import ITEMS
from coopera.core.lazy import made_once
from coopera.core.people import TRAITS, BigFive, Frozen
from coopera.core.replies import BigFiveReply, BigFiveTestReply
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.household.statements import sentences

ATTENDED = 0.8  # share of the sentences that one reading attends to
SPREAD = 0.8  # standard deviation of direct readings over people; PAPER App. B: 0.7-0.9 among real people
ITEM_SPREAD = 1.15  # the same of one item's answers; assumption
_STATEMENTS = [f"I {item.says[0].lower()}{item.says[1:-1]}" for item in ITEMS]


class Norm(Frozen):
    """Mean and standard deviation of a figure over published personas."""

    mean: float
    sd: Annotated[float, Field(gt=0)]


class Norms(Frozen):
    """What is usual among published personas: per trait the raw score, per item the nearest sentence's cosine."""

    traits: dict[str, Norm]
    items: Annotated[list[Norm], Field(min_length=len(ITEMS), max_length=len(ITEMS))]


def infer(sense: CommonSense, profile: str, rng: np.random.Generator) -> BigFiveReply:
    """Answer persona/big_five: how much nearer the text is to one pole's statements than to the other's.

    Each trait's score is centred and scaled by norms over published personas, so that 3 is an average persona.
    """
    near = nearest(sense, profile, rng)
    if near is None:
        return BigFiveReply(big_five=BigFive())
    scores = {trait: round(float(np.clip(score, 1, 5)), 2) for trait, score in _impression(near).items()}
    return BigFiveReply(big_five=BigFive(**scores))


def take_test(sense: CommonSense, profile: str, rng: np.random.Generator) -> BigFiveTestReply:
    """Answer persona/big_five_test, as people do: by what one takes oneself for, and by the statement itself.

    The latter counts the more, the nearer the text comes to the statement than texts usually do.
    """
    near = nearest(sense, profile, rng)
    if near is None:
        return BigFiveTestReply(answers=[3] * len(ITEMS))
    kind = _impression(near)
    own = (ITEM_SPREAD**2 - SPREAD**2) ** 0.5
    agreed = [
        3.0 + item.sign * (kind[item.trait] - 3.0) + own * (float(n) - norm.mean) / norm.sd
        for n, norm, item in zip(near, shipped_norms().items, ITEMS, strict=True)
    ]
    return BigFiveTestReply(answers=[int(np.clip(np.rint(answer), 1, 5)) for answer in agreed])


def nearest(sense: CommonSense, profile: str, rng: np.random.Generator) -> NDArray[np.float64] | None:
    """Return per item the cosine of the nearest attended sentence; None where nothing is said."""
    said = sentences(profile)
    if not said:
        return None
    attended = [sentence for sentence in said if rng.random() < ATTENDED] or said
    return np.asarray((sense.vectors(attended) @ sense.vectors(_STATEMENTS).T).max(axis=0), dtype=np.float64)


def raw_scores(near: Sequence[float] | NDArray[np.float64]) -> dict[str, float]:
    """Return per trait the mean cosine to the statements for it less that to those against it."""

    def mean(trait: str, sign: int) -> float:
        return float(np.mean([n for n, item in zip(near, ITEMS, strict=True) if item[1:] == (trait, sign)]))

    return {trait: mean(trait, 1) - mean(trait, -1) for trait in TRAITS}


def _impression(near: NDArray[np.float64]) -> dict[str, float]:
    """Return each trait's score, centred on 3 and scaled by the norms."""
    raw, norms = raw_scores(near), shipped_norms().traits
    return {trait: 3.0 + SPREAD * (raw[trait] - norms[trait].mean) / norms[trait].sd for trait in TRAITS}


@made_once()
def shipped_norms() -> Norms:
    """Return the norms in traits.yaml beside this file."""
    text = (Path(__file__).parent / "traits.yaml").read_text(encoding="utf-8")
    return Norms.model_validate(yaml.safe_load(text))
