"""The colours of a person whom pybullet draws, of balls and rods (person.urdf): skin, hair, clothes."""

from __future__ import annotations

from coopera.simulation.people.appearance import Appearance, Outfit
from coopera.simulation.people.clothes import Colour

PAINTS: dict[str, Colour] = {
    "shirt": (0.80, 0.27, 0.22),
    "trousers": (0.16, 0.21, 0.36),
    "skin": (0.87, 0.68, 0.55),
    "hair": (0.22, 0.13, 0.08),
    "shoe": (0.12, 0.12, 0.13),
    "dark": (0.07, 0.06, 0.06),
    "lips": (0.70, 0.36, 0.34),
}
"""The colours in person.urdf, by their names there."""


def painted(looks: Appearance, outfit: Outfit) -> dict[str, Colour]:
    """What takes the place of each of `PAINTS`."""
    clothes = looks.wears(outfit)
    whole = clothes.top in ("dress", "swimsuit", "towel")
    return {
        "shirt": looks.skin if clothes.top == "nothing" else clothes.top_colour,
        "trousers": clothes.top_colour if whole else clothes.bottom_colour,
        "skin": looks.skin,
        "hair": looks.skin if looks.hair_style == "bald" else looks.hair,
        "shoe": looks.skin if clothes.footwear == "bare" else clothes.shoe_colour,
        "dark": PAINTS["dark"],
        "lips": (0.7 * looks.skin[0] + 0.18, 0.6 * looks.skin[1] + 0.06, 0.6 * looks.skin[2] + 0.06),
    }
