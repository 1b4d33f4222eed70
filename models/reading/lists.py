"""Lists as models write them: in which order their items stand, and lists of words that are only a hint."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from coopera.models.reading.loose_json import nested
from coopera.models.reading.words import is_blank

HINTS = frozenset({"wants"})
"""Lists of words that decide nothing: what cannot be used of one is left out, and never costs the whole reply."""
ITEM_NUMBER = re.compile(r"(?:.*\D)?(\d{1,3})\D*", re.DOTALL)
_PLACES = "id|index|n|no|number|item|task|offer|guess|question"
_PLACE = re.compile(rf"(?:{_PLACES}|rank)(?:[\W_]*(?:{_PLACES}))?", re.IGNORECASE)
_PLACE_SAID = re.compile(rf"(?:(?:{_PLACES})[\W_]*)?#?(\d{{1,3}})\W*", re.IGNORECASE)
_JUDGED = {"yes", "grade"}
_LEVELS = 4


def is_in_order(numbers: Sequence[int]) -> bool:
    """Whether numbers count upwards from 0 or 1."""
    return bool(numbers) and numbers[0] in (0, 1) and list(numbers) == [*range(numbers[0], numbers[0] + len(numbers))]


def out_of_order(items: Sequence[Any], known: Mapping[str, Any]) -> bool:
    """Whether items say by a number of their own that they stand in another order.

    Only a field that names a place counts, such as "id" or "offer number"; a rank does not among judgements, where it
    may say how good something is.

    Args:
        items: The items as they came.
        known: The fields that an item has.
    """
    objects = [one for one in items if isinstance(one, dict)]
    if not objects or len(objects) < len(items):
        return False
    for key in objects[0]:
        if key in known or not _PLACE.fullmatch(key) or (key.casefold() == "rank" and _JUDGED & set(known)):
            continue
        found = [_PLACE_SAID.fullmatch(str(one.get(key)).strip()) for one in objects]
        numbers = [int(one[1]) for one in found if one]
        if len(numbers) == len(items) and is_in_order(sorted(numbers)) and not is_in_order(numbers):
            return True
    return False


def words_in(value: Any, levels: int = _LEVELS) -> Iterator[str]:
    """Every text with a meaning in a list of words, whatever lists and objects it stands in; all else is left out."""
    if isinstance(value, dict) and isinstance(value.get("name"), str):
        value = value["name"]
    if isinstance(value, str):
        said = value.encode("utf-8", "ignore").decode().strip()
        if not is_blank(said, "wants"):
            yield said
    elif isinstance(value, dict | list) and levels:
        for part in value.values() if isinstance(value, dict) else value:
            yield from words_in(part, levels - 1)


def split(said: str) -> Any:
    """A list that was written as one text: as JSON inside it, or with commas or new lines."""
    try:
        inside = nested(said)
    except (ValueError, RecursionError):
        inside = None
    return inside if inside is not None else [part.strip() for part in re.split("[,;\n]", said) if part.strip()]
