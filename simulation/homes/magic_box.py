"""What a thing from the magic box looks like: any text names a thing, and known words lead to known shapes."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from coopera.core.randomness import seed_at
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.scene import rgb_of

Point3: TypeAlias = tuple[float, float, float]
_SIZE: Point3 = (0.12, 0.10, 0.12)
_COLOURS = ("#c8503c", "#3c78b4", "#d2a03c", "#5a9650", "#8c5aa0")

LOOKS_LIKE = {
    "bag": "handbag",
    "ball": "tennis_ball",
    "basket": "laundry_basket",
    "bathrobe": "towel",
    "bottle": "water_bottle",
    "brush": "hairbrush",
    "bucket": "trash_can",
    "can": "tomato_soup_can",
    "cap": "hat",
    "cloth": "towel",
    "comb": "hairbrush",
    "controller": "game_controller",
    "cream": "soap_dispenser",
    "cup": "mug",
    "detergent": "bleach_bottle",
    "duster": "feather_duster",
    "folder": "notebook",
    "fork": "spoon",
    "game": "board_game",
    "jug": "watering_can",
    "kit": "sewing_kit",
    "knife": "kitchen_knife",
    "lotion": "soap_dispenser",
    "mat": "yoga_mat",
    "mop": "broom",
    "newspaper": "magazine",
    "novel": "book",
    "paint": "paint_box",
    "pan": "frying_pan",
    "pencil": "pen",
    "pillow": "cushion",
    "plant": "potted_plant",
    "pot": "cooking_pot",
    "remote": "remote_control",
    "rope": "jump_rope",
    "shampoo": "soap_dispenser",
    "smartphone": "phone",
    "soap": "soap_dispenser",
    "socks": "scarf",
    "textbook": "book",
    "tissue": "tissue_box",
    "tool": "toolbox",
    "weight": "dumbbell",
    "wine": "wine_bottle",
}
"""Words of things that the catalogue has no shape for, and the class that looks most like them."""


class Shape(NamedTuple):
    """What a thing looks like: its class in the catalogue (or its own text), size and colour."""

    cls: str
    size: Point3
    rgb: Point3


def shape_of(text: str) -> Shape:
    """How a thing looks: a class that its text names, else one that looks like its last words, else a plain box.

    A plain box has a colour of its own that follows from the text.
    """
    known = catalogue().movable
    words = text.lower().replace("_", " ").split()
    for size in range(len(words), 0, -1):
        for start in range(len(words) - size, -1, -1):
            cls = "_".join(words[start : start + size])
            for name in (cls, cls.removesuffix("s")):
                if name in known:
                    return Shape(name, known[name].size, rgb_of(known[name].colours[0]))
    for word in reversed(words):
        like = LOOKS_LIKE.get(word) or LOOKS_LIKE.get(word.removesuffix("s"))
        if like in known:
            return Shape(like, known[like].size, rgb_of(known[like].colours[0]))
    return Shape("_".join(words), _SIZE, rgb_of(_COLOURS[seed_at(0, "magic box", text.lower()) % len(_COLOURS)]))
