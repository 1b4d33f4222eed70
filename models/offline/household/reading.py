"""Reading what a prompt's variables say: memories, hours, rooms and the objects of a home."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.core.people import TRAITS, BigFive

_HOUR = re.compile(r"(\d{1,2})\s*(am|pm)", re.IGNORECASE)


class Memory(NamedTuple):
    """One remembered text, with the hour of day it is of and whether that was today."""

    text: str
    hour: int
    hours_ago: int
    today: bool


class Piece(NamedTuple):
    """One object of the home."""

    name: str
    cls: str
    id: int
    room: str


class Surroundings:
    """The objects that a prompt offers, fixed or movable, by class and in a fixed order."""

    def __init__(self, objects: Mapping[str, Sequence[Any]]) -> None:
        self.pieces = [Piece(n, class_of(n), int(objects[n][0]), str(objects[n][1])) for n in sorted(objects)]
        self.by_name = {piece.name: piece for piece in self.pieces}
        self._by_class: dict[str, list[Piece]] = {}
        for piece in self.pieces:
            self._by_class.setdefault(piece.cls, []).append(piece)

    def of(self, cls: str) -> list[Piece]:
        """All objects of a class, by name."""
        return self._by_class.get(cls, [])


def class_of(name: str) -> str:
    """Return an object's class: "coffee_table" for "coffee_table_2"."""
    return re.sub(r"_\d+$", "", name)


def room_kind(room: str) -> str:
    """Return a room's kind: "bedroom" for "bedroom 2"."""
    return re.sub(r"[\s_]+\d+$", "", room.strip().lower())


def memories(items: Sequence[Any], hour: int) -> list[Memory]:
    """Read memories as `coopera.core.asks` describes them; a plain text is a memory of unknown age."""
    read = []
    for item in items:
        if not isinstance(item, Mapping):
            read.append(Memory(str(item), hour, 24, today=False))
            continue
        ago = int(item.get("hours_ago", 24))
        found = _HOUR.search(str(item.get("when", "")))
        when = _of_day(found) if found else (hour - ago) % 24
        read.append(Memory(said(item), when, ago, today=0 < ago <= hour))
    return read


def hour_of(label: str) -> int:
    """Return the hour of day of a label such as "9 am".

    Raises:
        ValueError: If it is none.
    """
    found = _HOUR.search(label)
    if found is None:
        raise ValueError(f"{label!r} is no hour of day")
    return _of_day(found)


def said(item: Any) -> str:
    """Return the words of a memory, a task or a candidate, whether it is plain text or data."""
    if not isinstance(item, Mapping):
        return str(item)
    for field in ("text", "intention", "thought"):
        if item.get(field):
            return str(item[field])
    return ""


def big_five_of(scores: Mapping[str, float] | None) -> BigFive:
    """Read Big-Five scores; none at all is the middle of the scale."""
    return BigFive(**{trait: float(scores[trait]) for trait in TRAITS if trait in scores}) if scores else BigFive()


def weighted_order(weights: Sequence[float] | NDArray[np.float64], rng: np.random.Generator) -> list[int]:
    """Return all places in an order drawn without replacement in proportion to the weights (all >= 0)."""
    noise = rng.gumbel(size=len(weights))
    scores = np.log(np.maximum(np.asarray(weights, dtype=np.float64), 1e-12)) + noise
    return [int(i) for i in np.argsort(-scores, kind="stable")]


def clip(text: str, limit: int) -> str:
    """Return one line of at most `limit` characters."""
    line = " ".join(text.split())
    return line if len(line) <= limit else line[: limit - 1].rstrip() + "…"


def _of_day(found: re.Match[str]) -> int:
    hour = int(found.group(1)) % 12
    return hour + 12 if found.group(2).lower() == "pm" else hour
