"""What models say for yes, for nothing and for numbers."""

from __future__ import annotations

import re
from typing import Any

_YES = "yes y true yep yeah ja oui sí si sì sim ✓ ✔ ✅"
_NO = "no n false nope nein non não ✗ ✘ ❌"
_BOOLEANS = {**dict.fromkeys(_YES.split(), True), **dict.fromkeys(_NO.split(), False)}
_NOTHING = frozenset(("", "null", "none", "nil", "n/a", "na", "-", "–", "—", "not applicable", "undefined"))
_PLACEHOLDER = re.compile(r"\.{2,}|…|string|str|<[^<>]*>")
_NUMBER = re.compile(r"[+-]?\d{1,12}(?:[.,]\d{1,12})?")
_OF = re.compile(r"(?P<part>\S+?)\s*(?:/|out of|of)\s*(?P<whole>\d{1,12})", re.IGNORECASE)
_EXPLAINS = re.compile(r"reasons?(_\w+)?|comment|thought|seen")

_THINGS = {"in_hand", "object", "wants"}
_RELATIONS = {"in": "inside", "into": "inside", "on top of": "on", "onto": "on"}


def explains(field: str) -> bool:
    """Whether a text gives reasons or describes, and decides nothing: only such a text may be cut or left empty.

    An intention, a movement, a profile or a name says what is to be done or who somebody is; its end may hold the
    point of it ("..., but not on the stove"), so one that is too long is asked for again.
    """
    return _EXPLAINS.fullmatch(field) is not None


def as_boolean(said: str) -> bool | None:
    """What a word for yes or no means; None for all else, such as "maybe" or "yes and no"."""
    return _BOOLEANS.get(said.strip(" \t\n\"'*_.!,`").casefold())


def as_verdict(value: Any) -> bool | None:
    """What a value means as yes or no: a word for it, 1 or 0; None for all else."""
    if isinstance(value, str):
        return as_boolean(value) if value.strip() not in ("0", "1") else value.strip() == "1"
    return bool(value) if isinstance(value, int) and value in (0, 1) else None


def contradict(one: Any, other: Any) -> bool:
    """Whether two values of a field by several names mean yes and no, or two numbers."""
    verdicts = [as_verdict(value) for value in (one, other)]
    numbers = [as_number(str(value), None) for value in (one, other)]
    return any(None not in pair and pair[0] != pair[1] for pair in (verdicts, numbers))


def is_nothing(said: str) -> bool:
    """Whether a word stands for a text that is not there."""
    return said.strip(" \t\n\"'*.").casefold() in _NOTHING


def is_placeholder(said: str) -> bool:
    """Whether a text is the form that was to be filled in, such as "string" or "..."."""
    return _PLACEHOLDER.fullmatch(said.strip()) is not None


def is_blank(said: str, field: str) -> bool:
    """Whether a text that must say something says nothing; a piece of string, though, is a thing, to hold or bring."""
    return (is_nothing(said) or is_placeholder(said)) and not (field in _THINGS and said.strip() == "string")


def as_number(said: str, most: float | None) -> float | int | None:
    """The number that a text states: "34", "0.7", "3,5", "70 %", or "4/5" where 5 is the most; None for all else."""
    text = said.strip(" \t\n\"'*`")
    if part := _OF.fullmatch(text):
        return as_number(part["part"], None) if most is not None and float(part["whole"]) == most else None
    if text.endswith("%"):
        share = as_number(text[:-1], None)
        return None if share is None else share / 100
    if _NUMBER.fullmatch(text) is None:
        return None
    return float(text.replace(",", ".")) if re.search("[.,]", text) else int(text)


def as_choice(said: Any, choices: list[Any]) -> Any:
    """The choice that is meant where only capitals or spaces differ, or "in" is said for inside; None if none is."""
    if not isinstance(said, str):
        return None
    bare = " ".join(said.casefold().replace("_", " ").split())
    meant = [one for one in choices if isinstance(one, str) and one.casefold() in (bare, _RELATIONS.get(bare))]
    return meant[0] if len(meant) == 1 else None


def cut(text: str, most: int) -> str:
    """The beginning of a text, up to a word's end, with an ellipsis; at most so many characters."""
    room = text[: most - 1]
    whole = room.rpartition(" ")[0]
    return f"{(whole if len(whole) > most // 2 else room).rstrip(' ,;:')}…"
