"""The 50-item Big-Five test, its scoring, and the vote over several readings of one person (PAPER App. B).

Items and keys: IPIP Big-Five Factor Markers (Goldberg 1992; public domain, ipip.ori.org).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from coopera.core.people import TRAITS, BigFive

BIN = 0.5  # PAPER App. B: bins of 0.5 on the scale from 1 to 5
TRIALS = 5  # PAPER App. B: five inference trials

_STATEMENTS = """\
Am the life of the party. Feel little concern for others. Am always prepared. Get stressed out easily. \
Have a rich vocabulary. Don't talk a lot. Am interested in people. Leave my belongings around. \
Am relaxed most of the time. Have difficulty understanding abstract ideas. Feel comfortable around people. \
Insult people. Pay attention to details. Worry about things. Have a vivid imagination. Keep in the background. \
Sympathize with others' feelings. Make a mess of things. Seldom feel blue. Am not interested in abstract ideas. \
Start conversations. Am not interested in other people's problems. Get chores done right away. Am easily disturbed. \
Have excellent ideas. Have little to say. Have a soft heart. Often forget to put things back in their proper place. \
Get upset easily. Do not have a good imagination. Talk to a lot of different people at parties. \
Am not really interested in others. Like order. Change my mood a lot. Am quick to understand things. \
Don't like to draw attention to myself. Take time out for others. Shirk my duties. Have frequent mood swings. \
Use difficult words. Don't mind being the center of attention. Feel others' emotions. Follow a schedule. \
Get irritated easily. Spend time reflecting on things. Am quiet around strangers. Make people feel at ease. \
Am exacting in my work. Often feel blue. Am full of ideas."""
_ORDER = ("extroversion", "agreeableness", "conscientiousness", "neuroticism", "openness")  # of the items, in turn
_AGAINST = frozenset((2, 6, 8, 9, 10, 12, 16, 18, 19, 20, 22, 26, 28, 30, 32, 36, 38, 46))
"""Numbers of the items by which agreeing lowers the trait; the test's emotional stability is neuroticism reversed."""


class Item(NamedTuple):
    """One statement: what it says, the trait it marks, and whether agreeing speaks for (1) or against it (-1)."""

    says: str
    trait: str
    sign: int


ITEMS: tuple[Item, ...] = tuple(
    Item(f"{text.strip()}.", _ORDER[number % 5], -1 if number + 1 in _AGAINST else 1)
    for number, text in enumerate(_STATEMENTS.removesuffix(".").split(". "))
)
"""The fifty statements in the test's order."""


def score(answers: Sequence[int]) -> BigFive:
    """Score the fifty answers, each from 1 (disagree) to 5 (agree): ten items a trait, raw 0 to 40, as 1 + raw / 10.

    Raises:
        ValueError: If there are not fifty answers from 1 to 5.
    """
    if len(answers) != len(ITEMS) or not all(1 <= answer <= 5 for answer in answers):
        raise ValueError(f"the test has {len(ITEMS)} answers from 1 to 5")
    raw = dict.fromkeys(TRAITS, 0)
    for item, answer in zip(ITEMS, answers, strict=True):
        raw[item.trait] += answer - 1 if item.sign > 0 else 5 - answer
    return BigFive(**{trait: 1 + raw[trait] / 10 for trait in TRAITS})


def vote(readings: Sequence[BigFive]) -> BigFive:
    """Take per trait the bin that most readings fall into; of equals the one nearest to their mean, then the lower.

    Raises:
        ValueError: If there is no reading.
    """
    if not readings:
        raise ValueError("a vote needs at least one reading")
    return BigFive(**{trait: _elect([getattr(reading, trait) for reading in readings]) for trait in TRAITS})


def _elect(scores: Sequence[float]) -> float:
    bins = Counter(int(score / BIN + 0.5) for score in scores)
    mean = sum(Fraction(score) for score in scores) / len(scores)
    most = max(bins.values())
    tied = [number for number, count in bins.items() if count == most]
    return BIN * min(tied, key=lambda number: (abs(Fraction(number) * Fraction(BIN) - mean), number))
