"""What foreign homes call their things, in our words: classes that the catalogue knows look and work as ours do."""

from __future__ import annotations

import re
import zlib
from collections import Counter
from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import NamedTuple, TypeAlias

from coopera.core.household import plain
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.magic_box import looks
from coopera.simulation.making.habitat.schema import CatalogueRow
from coopera.simulation.making.report import PLAIN

Nearest: TypeAlias = Callable[[str, tuple[str, ...]], tuple[str, float] | None]
"""Which of some words come nearest to a text in meaning, and how near in [0, 1]; None where none is near."""

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
_ALSO = {
    **{"sofa_chair": "armchair", "table_lamp": "lamp", "end_table": "side_table", "bedside_table": "nightstand"},
    **{
        "cabinet": "kitchen_cabinet",
        "cupboard": "kitchen_cabinet",
        "shelf": "storage_shelf",
        "shelves": "storage_shelf",
    },
    **{"drawers": "dresser", "drawer": "dresser", "closet": "wardrobe", "basket": "laundry_basket", "bin": "trash_can"},
    **{"mat": "rug", "cloth": "towel", "remote": "remote_control", "mattress": "bed", "monitor": "television"},
    **{"can": "coffee_can", "ball": "tennis_ball", "box": "cracker_box", "clock": "alarm_clock", "pan": "frying_pan"},
    **{"handbag": "handbag", "bag": "handbag", "knife": "kitchen_knife", "shoe": "shoes", "photo": "picture_frame"},
}
"""Further words that names of files are made of; only where nobody says more."""
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_LARGER = 4.0
_LONGEST, _LARGEST = 0.45, 0.015  # of what is carried, metres and cubic metres


class Guess(NamedTuple):
    """What a thing is taken for: its class, its super-category, and why."""

    cls: str
    category: str
    why: str


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


def words_of(name: str) -> list[str]:
    """The words that a file's name is made of: "frl_apartment_tvStand_02" is "frl", "apartment", "tv" and "stand"."""
    return [word.lower() for word in _WORD.findall(name)]


def said_by_all(names: Iterable[str]) -> frozenset[str]:
    """Words in more than half of four or more names: they tell the data set, not the thing."""
    each = [set(words_of(name)) for name in set(names)]
    count = Counter(word for words in each for word in words)
    return frozenset(word for word, times in count.items() if len(each) >= 4 and 2 * times > len(each))


class Guesser:
    """Guess what things are, from the names of their templates and their sizes."""

    def __init__(self, names: Iterable[str], nearest: Nearest | None = None) -> None:
        """Look at all names of a scene; `nearest` knows words by their meaning."""
        self._noise = said_by_all(names)
        self._nearest = nearest

    def guess(self, name: str, label: str, size: tuple[float, float, float]) -> Guess:
        """The nearest class of ours whose size is not wholly different; its own words where there is none.

        Args:
            name: Of the template.
            label: What a lexicon calls it; may be empty.
            size: Width, depth and height in metres.
        """
        texts = [words_of(label), [word for word in words_of(name) if word not in self._noise]]
        for words in texts:
            found = _known(words)
            if found is not None and _like(found[0], size):
                said = f"{found[1]!r} in its name" if words is texts[1] else f"the lexicon calls it {label!r}"
                return Guess(found[0], catalogue().category(found[0]), f"taken for: {plain(found[0])} ({said})")
        for words in (words for words in texts if words and self._nearest is not None):
            assert self._nearest is not None
            near = self._nearest(" ".join(words), tuple(sorted(plain(cls) for cls in _classes())))
            cls = near[0].replace(" ", "_") if near is not None else ""
            if near is not None and _like(cls, size):
                why = f"taken for: {near[0]}, the class nearest in meaning ({near[1]:.2f})"
                return Guess(cls, catalogue().category(cls), why)
        own = "_".join(texts[0] or texts[1])[:50].strip("_") or "object"
        own = own if own not in _classes() else f"{own}_of_another_size"
        small = carried(own, size)
        what = "a small thing" if small else "furniture, for its size"
        return Guess(own, "decor" if small else "unknown", f"no class of ours; taken for {what}")


def carried(cls: str, size: tuple[float, float, float]) -> bool:
    """Whether a thing is no larger than what is carried: about as large as its class, or small."""
    known = catalogue().movable.get(cls)
    if known is not None:
        return max(size) <= 1.6 * max(known.size)
    return max(size) <= _LONGEST and size[0] * size[1] * size[2] <= _LARGEST


def colour_of(cls: str, category: str) -> str:
    """A colour for an imported object, the same for all of its class."""
    known = catalogue().fixed.get(cls) or catalogue().movable.get(cls)
    return known.colours[0] if known else PLAIN[zlib.crc32(f"{category} {cls}".encode()) % len(PLAIN)]


def _classes() -> frozenset[str]:
    return frozenset(catalogue().fixed) | frozenset(catalogue().movable)


@lru_cache(maxsize=1)
def _spoken() -> dict[str, str]:
    """Words without spaces, and the class that they mean."""
    named = {words: look for words, look in looks().items() if isinstance(look, str)}
    meant = {**_ALSO, **named, **_SAME, **{cls: cls for cls in _classes()}}
    meant = {words: _SAME.get(cls, cls) for words, cls in meant.items()}
    return {re.sub("[^a-z]", "", words): cls for words, cls in meant.items()}


def _known(words: list[str]) -> tuple[str, str] | None:
    """The class that the longest run of words means, the last one of two as long, and that run."""
    for size in range(len(words), 0, -1):
        for start in range(len(words) - size, -1, -1):
            run = words[start : start + size]
            joined = "".join(run)
            for said in (joined, joined.removesuffix("s"), joined.removesuffix("es")):
                if said in _spoken():
                    return _spoken()[said], " ".join(run)
    return None


def _like(cls: str, size: tuple[float, float, float]) -> bool:
    """Whether a thing's longest side is that of its class, within a factor."""
    known = catalogue().fixed.get(cls) or catalogue().movable.get(cls)
    share = max(size) / max(known.size) if known else 0.0
    return 1 / _LARGER <= share <= _LARGER
