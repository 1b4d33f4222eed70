"""What HSSD calls things, in our words: classes that the catalogue knows look and work as ours do."""

from __future__ import annotations

import re
import zlib

from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.making.hssd.files import CatalogueRow

_SAME = {
    **{"couch": "sofa", "loveseat": "sofa", "settee": "sofa", "easy_chair": "armchair", "chair": "dining_chair"},
    **{"straight_chair": "dining_chair", "swivel_chair": "office_chair", "refrigerator": "fridge", "oven": "stove"},
    **{"cooker": "stove", "tub": "bathtub", "shower_stall": "shower", "sink": "washbasin", "bookcase": "bookshelf"},
    **{"chest_of_drawers": "dresser", "table": "dining_table", "cocktail_table": "coffee_table", "carpet": "rug"},
    **{"television_receiver": "television", "tv": "television", "washer": "washing_machine", "lamp": "floor_lamp"},
    **{"counter": "kitchen_counter", "cup": "mug", "pillow": "cushion", "trashcan": "trash_can", "ashcan": "trash_can"},
    **{"plant": "potted_plant", "houseplant": "potted_plant", "laptop_computer": "laptop", "shoe_shelf": "shoe_rack"},
    **{"bottle": "water_bottle", "pot": "cooking_pot", "painting": "picture_frame", "picture": "picture_frame"},
    **{"bike": "bicycle", "vacuum_cleaner": "broom", "cellular_telephone": "phone", "telephone": "phone"},
}
"""Names of HSSD and WordNet that mean a class of ours."""
_COLOURS = ("#8a6d4f", "#6f7f8a", "#9a8f7a", "#7a6a84", "#6d8570", "#a07a62")


def slug(text: str, keep: str = "_") -> str:
    """Write a name in small letters and digits, other characters as the first of `keep`."""
    joint = keep[0]
    return re.sub(rf"[^a-z0-9{re.escape(keep)}]+", joint, text.lower()).strip(joint)[:60]


def class_of(row: CatalogueRow) -> str:
    """The class of an object: its name, else its WordNet key, else its super-category (PAPER's code does so too)."""
    lemma = row.wnsynsetkey.partition(".")[0]
    words = [slug(name) for name in (row.name, lemma, row.super_category) if slug(name)]
    known = {**catalogue().fixed, **catalogue().movable}
    category = row.super_category.replace("_", " ")
    for word in words:
        ours = _SAME.get(word, word)
        if ours in known and catalogue().category(ours) == category:
            return ours
    named = next((word for word in words if word[0].isalpha()), "object")
    return named if named not in known else f"{named}_of_hssd"


def colour_of(cls: str, category: str) -> str:
    """A colour for an imported object, the same for all of its class."""
    known = catalogue().fixed.get(cls) or catalogue().movable.get(cls)
    return known.colours[0] if known else _COLOURS[zlib.crc32(f"{category} {cls}".encode()) % len(_COLOURS)]
