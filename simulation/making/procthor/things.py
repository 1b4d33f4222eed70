"""What an object of ProcTHOR is in our words: by its type, or by the nearest meaning of its asset's name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from coopera.core.foreign.files import read_text
from coopera.core.household import plain
from coopera.core.lazy import made_once
from coopera.core.strict_yaml import load_yaml
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.categories import DYNAMIC, STATIC
from coopera.simulation.homes.untrusted import Loose
from coopera.simulation.making.procthor.files import Asset, Item
from coopera.simulation.shapes.kit import Size

FILE = Path(__file__).parent / "things.yaml"
_UNKNOWN_SIZE: Size = (0.3, 0.3, 0.3)
_LEAST, _MOST = 0.002, 20.0


class Kind(NamedTuple):
    """What an object is: its class and super-category, whether it moves, its size, and how that was found out.

    `leave` is why it is left out. `guess` is what was guessed of it; both are empty otherwise.
    """

    cls: str
    category: str
    fixed: bool
    size: Size
    leave: str = ""
    guess: str = ""


class _Row(Loose):
    as_: str = ""
    category: str = ""
    moves: bool | None = None
    size: Size = _UNKNOWN_SIZE
    leave: str = ""


@made_once()
def _table() -> dict[str, _Row]:
    rows = load_yaml(read_text(FILE))
    table = {name: _Row.model_validate({**row, "as_": row.get("as", "")}) for name, row in rows.items()}
    wrong = [name for name, row in table.items() if not row.leave and _category(row) not in (*DYNAMIC, *STATIC)]
    if wrong:
        raise ValueError(f"{FILE}: {wrong[0]} needs a known category")
    return table


def kind_of(item: Item, assets: Mapping[str, Asset]) -> Kind:
    """What an object is, and how large."""
    asset = assets.get(item.asset)
    type_, guess = _type_of(item, asset)
    row = _table().get(type_)
    if row is not None and row.leave:
        return Kind(plain(type_), "", True, row.size, leave=row.leave)
    size, sized = (row.size if row else _UNKNOWN_SIZE), True
    if asset is not None and asset.box is not None:
        size, sized = (asset.box.x, asset.box.z, asset.box.y), False
    size = (*(round(min(max(side, _LEAST), _MOST), 4) for side in size),)  # type: ignore[assignment]
    if row is None:
        cls = "_".join(_words(item.asset))[:60] or "object"
        return Kind(cls, "decor", False, size, guess="a box that can be carried, for its type is not known")
    if sized:
        guess = f"{guess}; " * bool(guess) + "the usual size of its type"
    known = catalogue().fixed.get(row.as_) or catalogue().movable.get(row.as_)
    fixed = row.as_ in catalogue().fixed if known else not row.moves
    return Kind(row.as_, _category(row), fixed, size, guess=guess)


def _category(row: _Row) -> str:
    return row.category or catalogue().category(row.as_)


def _type_of(item: Item, asset: Asset | None) -> tuple[str, str]:
    """The type of an object, and what was guessed to get it: that of its asset, of its id, or of the asset's name."""
    if asset is not None and asset.type:
        return asset.type, ""
    said = next((part for part in item.id.split("|") if part in _table()), None)
    if said:
        return said, ""
    name = "".join(_words(item.asset))
    inside = [type_ for type_ in _table() if type_.lower() in name]
    if inside:
        return max(inside, key=lambda type_: (len(type_), type_)), ""
    nearest = next((_MEANT[word] for word in _words(item.asset) if word in _MEANT), "")
    return nearest, f"its name means a {nearest}" if nearest else ""


_MEANT = {
    **{"bin": "GarbageCan", "trash": "GarbageCan", "wall": "Painting", "poster": "Painting", "picture": "Painting"},
    **{"couch": "Sofa", "loveseat": "Sofa", "armchair": "ArmChair", "recliner": "ArmChair", "bench": "Ottoman"},
    **{"shelf": "ShelvingUnit", "bookcase": "ShelvingUnit", "bookshelf": "ShelvingUnit", "cabinet": "Dresser"},
    **{"wardrobe": "Dresser", "drawer": "Dresser", "drawers": "Dresser", "table": "DiningTable", "tv": "Television"},
    **{
        "lamp": "FloorLamp",
        "plant": "HousePlant",
        "refrigerator": "Fridge",
        "counter": "CounterTop",
        "stove": "CounterTop",
    },
    **{
        "ball": "BasketBall",
        "racket": "TennisRacket",
        "phone": "CellPhone",
        "cushion": "Pillow",
        "remote": "RemoteControl",
    },
    **{"cup": "Cup", "jar": "Bottle", "boot": "Boots", "shoe": "Boots", "rack": "ShelvingUnit", "statue": "Statue"},
    **{"dog": "Statue", "computer": "Desktop", "basket": "LaundryHamper", "towel": "Towel", "paper": "Newspaper"},
}
"""Words of assets' names whose type is not said, and the type that comes nearest."""


def _words(name: str) -> list[str]:
    """The words of an asset's name in small letters, without numbers and the name of its collection."""
    parts = re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)
    return [part.lower() for part in parts if part not in ("Robo", "THOR", "RoboTHOR") and len(part) > 1]
