"""How a text is drawn: a least temperature, the likeliest tokens alone, and no sequence of words twice.

Small models repeat themselves ("This is a task that is not a lie"). What keeps them from it holds for a reply's free
text alone: a name that may stand in a list of tasks five times, and JSON's own signs, are drawn as ever.
"""

from __future__ import annotations

from typing import NamedTuple


class Manner(NamedTuple):
    """How free text is drawn; without anything given, as the model's probabilities and the temperature have it."""

    least_temperature: float = 0.0
    top_p: float = 1.0
    repetition_penalty: float = 1.0
    no_repeat: int = 0


PLAIN = Manner()
SMALL = Manner(least_temperature=0.7, top_p=0.9, repetition_penalty=1.15, no_repeat=4)
"""For models of a few hundred million weights; tried with SmolLM2-135M-Instruct."""
