"""How a person looks: drawn from the id and from what the profile says, and what they wear for what they do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from coopera.core.randomness import rng_at

Colour = tuple[float, float, float]
Outfit = Literal["day", "bath", "sleep", "sport"]


@dataclass(frozen=True, slots=True)
class Appearance:
    """A person's looks."""

    skin: Colour
    hair: Colour
    top: Colour
    bottom: Colour


def appearance_of(profile: str, person: str) -> Appearance:
    """How a person looks: the same for the same profile and id, in every process."""
    rng = rng_at(0, "appearance", person)
    skin, hair, top, bottom = (tuple(float(v) for v in rng.uniform(0.2, 0.8, 3)) for _ in range(4))
    return Appearance(skin, hair, top, bottom)  # type: ignore[arg-type]


def outfit_for(motion: str) -> Outfit:
    """What is worn while a motion is done, by its caption."""
    return "day"
