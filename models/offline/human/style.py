"""How a person puts things: which of a household file's alternatives they favour, and the touches of their own.

A person says "Enjoy" wherever others say "Have", is brief or wordy, and has habits for each activity besides. Where a
trait's direction comes from: Mairesse & Walker 2007 (PERSONAGE: extraverts are verbose, the conscientious to the point)
and Pennebaker & King 1999 (open people choose less usual words). All sizes are coopera's assumption.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from coopera.core.people import TRAITS, BigFive
from coopera.models.offline.household.grammar import LONGEST, Template
from coopera.models.offline.household.knowledge import Activity, Floats

TEMPLATE = 0.9  # scale of the Gumbel draws behind favourites among an activity's wordings
HABIT = 0.5  # the same for an alternative in one activity
WORD = 0.9  # the same for an alternative wherever it is offered
BREVITY = 0.25  # standard deviation of what a further word adds or takes, in logits
RARITY = 0.1  # standard deviation of what a place further down the alternatives adds or takes, in logits
OPEN, WORDY = 0.18, 0.12  # what a point of openness adds per place, and one of extroversion per word
STEADY = 0.2  # share by which a point of conscientiousness sharpens all favourites
TOUCHES = 0.3  # share of intentions that the middle of the scale gives a touch of its own
CHATTY = 0.05  # by how much a point of extroversion raises that share
MIDDLING = 0.3  # points by which a trait in the middle of the scale still colours the touches

Rng = Callable[..., np.random.Generator]
"""Returns a fresh generator for an address: the same person and address, the same draws."""

GAP = "…"
_TOUCHES: dict[tuple[str, int], tuple[str, ...]] = {
    ("openness", 1): (
        "…, in a new way today",
        "…, with a curious mind",
        "For a change, …",
        "…, a little differently than usual",
        "…, and see where it leads",
        "Just to see what comes of it, …",
        "…, with fresh eyes",
        "Why not: …",
    ),
    ("openness", -1): (
        "…, just the usual way",
        "…, the way I always do",
        "As always, …",
        "…, nothing fancy",
        "…, as on any other day",
        "The tried and tested way: …",
        "…, like last time",
        "Once more, …",
    ),
    ("conscientiousness", 1): (
        "…, properly",
        "…, with care",
        "As planned, …",
        "…, one step after the other",
        "…, from start to finish",
        "One thing at a time: …",
        "…, and do it right",
        "Next on the list: …",
    ),
    ("conscientiousness", -1): (
        "…, without any hurry",
        "…, as far as I get",
        "On a whim, …",
        "…, more or less",
        "…, unless something comes up",
        "Well then, …",
        "…, it need not be perfect",
        "For lack of a better plan, …",
    ),
    ("extroversion", 1): (
        "…, in high spirits",
        "…, in the best of moods",
        "Here we go: …",
        "…, with a big smile",
        "…, and enjoy every minute of it",
        "Come on, …",
        "…, and tell everybody about it later",
        "Off we go: …",
    ),
    ("extroversion", -1): (
        "…, undisturbed",
        "…, away from any bustle",
        "Quietly, …",
        "…, without any fuss",
        "…, behind closed doors",
        "Far from any crowd, …",
        "…, without making much of it",
        "…, and not a word about it",
    ),
    ("agreeableness", 1): (
        "…, in a friendly mood",
        "…, at peace with everybody",
        "Gladly, …",
        "…, with a warm heart",
        "…, without disturbing anybody",
        "If nobody minds, …",
        "…, with a kind thought for others",
        "With pleasure, …",
    ),
    ("agreeableness", -1): (
        "…, my own way",
        "…, just as I please",
        "Whatever others say, …",
        "…, on my own terms",
        "…, and no arguing",
        "Like it or not, …",
        "…, no matter what anybody thinks",
        "Without asking anybody, …",
    ),
    ("neuroticism", 1): (
        "…, to calm down",
        "…, to think of something else",
        "To feel better, …",
        "…, before the worries come back",
        "…, and hope that it goes well",
        "To steady the nerves, …",
        "…, just to be on the safe side",
        "To be over and done with it, …",
    ),
    ("neuroticism", -1): (
        "…, without a worry",
        "…, at ease",
        "Calmly, …",
        "…, with an easy mind",
        "…, come what may",
        "No rush: …",
        "…, nice and easy",
        "With all the time in the world, …",
    ),
}
"""What may be put around any intention, a lively or a restful one, by trait and its direction.

The gap is for the wording; a comma or a colon sets it off, so that `household.grammar.cores` finds it again.
"""


class _Favour(NamedTuple):
    """A person's weights for one activity: of its templates, and of each template's alternatives by piece."""

    templates: Floats
    pieces: tuple[tuple[Floats, ...], ...]


class Style:
    """One person's way of putting things. The generators' addresses and the Big Five determine all of it.

    Openness brings in rarer alternatives (those further down), extroversion longer ones and more touches;
    conscientiousness makes the favourites firmer.
    """

    def __init__(self, rng: Rng, big_five: BigFive) -> None:
        self._rng = rng
        self._deviation = {trait: getattr(big_five, trait) - 3.0 for trait in TRAITS}
        own = rng("bent")
        self._per_word = float(own.normal(0.0, BREVITY)) + WORDY * self._deviation["extroversion"]
        self._per_place = float(own.normal(0.0, RARITY)) + OPEN * self._deviation["openness"]
        self._steadiness = 1.0 + STEADY * self._deviation["conscientiousness"]
        self._words: dict[str, float] = {}
        self._favours: dict[str, _Favour] = {}
        self._touches = self._favourite_touches()

    def word(self, activity: Activity, rng: np.random.Generator) -> str:
        """Put an intention into words: an expansion of one of the activity's wordings, often with a touch around it.

        It has at most 200 characters, a capital first letter and no full stop.
        """
        favour = self._favour(activity)
        chosen = _drawn(favour.templates, rng)
        places = [_drawn(weights, rng) if len(weights) > 1 else 0 for weights in favour.pieces[chosen]]
        core = activity.templates[chosen].filled(places).rstrip(". ")
        touched = self._touched(core, rng)
        text = touched if len(touched) <= LONGEST else core
        return text[:1].upper() + text[1:]

    def _touched(self, core: str, rng: np.random.Generator) -> str:
        frames, weights = self._touches
        frame = frames[_drawn(weights, rng)]
        if rng.random() >= TOUCHES + CHATTY * self._deviation["extroversion"]:
            return core
        inside = core if frame.startswith(GAP) or core[1:2].isupper() else core[:1].lower() + core[1:]
        return frame.replace(GAP, inside)

    def _favour(self, activity: Activity) -> _Favour:
        if activity.id not in self._favours:
            rng = self._rng("wording", activity.id)
            lengths = [sum(map(_length, template.pieces)) for template in activity.templates]
            logits = TEMPLATE * rng.gumbel(size=len(lengths)) + self._bent(lengths)
            pieces = tuple(self._piece_weights(template, rng) for template in activity.templates)
            self._favours[activity.id] = _Favour(_softmax(self._steadiness * logits), pieces)
        return self._favours[activity.id]

    def _piece_weights(self, template: Template, rng: np.random.Generator) -> tuple[Floats, ...]:
        return tuple(self._alternatives(piece, rng) for piece in template.pieces)

    def _alternatives(self, piece: Sequence[str], rng: np.random.Generator) -> Floats:
        if len(piece) == 1:
            return np.ones(1)
        own = HABIT * rng.gumbel(size=len(piece)) + [WORD * self._liked(text.strip()) for text in piece]
        return _softmax(self._steadiness * (own + self._bent([float(len(text.split())) for text in piece])))

    def _bent(self, lengths: Sequence[float]) -> Floats:
        """Logits for being brief or wordy, given lengths in words, and for the usual or the rare, by place."""
        words, places = np.array(lengths), np.arange(len(lengths), dtype=np.float64)
        bent = self._per_word * (words - words.mean()) + self._per_place * (places - places.mean())
        return np.asarray(bent, dtype=np.float64)

    def _liked(self, text: str) -> float:
        """How much this person likes a turn of phrase, wherever it is offered."""
        if text not in self._words:
            self._words[text] = float(self._rng("word", text).gumbel())
        return self._words[text]

    def _favourite_touches(self) -> tuple[tuple[str, ...], Floats]:
        """The touches that suit the person, with their weights: those of the outstanding traits above all."""
        frames: list[str] = []
        logits: list[float] = []
        for (trait, way), texts in _TOUCHES.items():
            strength = way * self._deviation[trait] + MIDDLING
            if strength > 0:
                frames += texts
                logits += list(2 * np.log(strength) + self._rng("touch", trait).gumbel(size=len(texts)))
        return tuple(frames), _softmax(np.array(logits))


def _length(piece: Sequence[str]) -> float:
    """Mean number of words over the alternatives."""
    return sum(len(text.split()) for text in piece) / len(piece)


def _softmax(logits: Floats) -> Floats:
    weights = np.exp(logits - logits.max())
    return np.asarray(weights / weights.sum(), dtype=np.float64)


def _drawn(weights: Floats, rng: np.random.Generator) -> int:
    return int(rng.choice(len(weights), p=weights))
