"""JSON as language models write it: quotes of all kinds, trailing commas, comments, words of Python.

Only the form is mended. What could be read in two ways is an error, as are NaN, a field that stands twice with
different values, and a text that simply ends.
"""

from __future__ import annotations

import json
import re
from typing import Any, NoReturn

MAX_DEPTH = 60
_MAX_DIGITS = 40
_MAX_QUOTES = 100  # inside one text
_SPACE = re.compile(r"(?:\s|//[^\n]*|#[^\n]*|/\*.*?\*/)*", re.DOTALL)
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![\w.])")
_WORD = re.compile(r"[A-Za-z_][\w-]*")
_WORDS: dict[str, Any] = {
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys(("null", "None", "none", "NULL", "nil", "undefined"), None),
    **{word: word for word in ("yes", "Yes", "YES", "no", "No", "NO")},
}
_QUOTES = {'"': '"', "'": "'", "“": "”“", "”": "”", "„": "“”", "‘": "’‘", "’": "’", "«": "»", "`": "`"}
"""Quotes that begin a text, with those that end it."""
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f"}
_KEY_FOLLOWS = re.compile(r"[\"'“”„‘’«`]\s*[:：]")
_NEXT_KEY = re.compile(r"\s*\n\s*[\"'“„‘«`]?[A-Za-z_][\w -]*[\"'”“’»`]?\s*[:：]")


class LooseJSONError(ValueError):
    """A text is no JSON even to a patient reader.

    Attributes:
        reached: How many characters could be read.
        begun: Whether a field had been read, so that what follows may belong to what is broken.
    """

    def __init__(self, message: str, reached: int = 0, *, begun: bool = True) -> None:
        """Say what is wrong."""
        super().__init__(message)
        self.reached, self.begun = reached, begun


def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Make an object of its fields in order; for `json.JSONDecoder`.

    Raises:
        LooseJSONError: If a field stands twice with different values.
    """
    made: dict[str, Any] = {}
    for name, value in pairs:
        if name in made and made[name] != value:
            raise LooseJSONError(f"the field {name[:80]} stands twice, with different values")
        made[name] = value
    return made


def read_loosely(text: str, at: int) -> tuple[Any, int]:
    """Read the object or list that begins at a position.

    Returns:
        The value, and the position after it.

    Raises:
        LooseJSONError: If there is none.
    """
    reader = _Reader(text, at)
    return reader.value(0), reader.at


class _Reader:
    def __init__(self, text: str, at: int) -> None:
        self.text, self.start, self.at = text, at, at
        self.begun = False

    def value(self, depth: int, *, listed: bool = False) -> Any:
        if depth > MAX_DEPTH:
            self._fail("it is nested too deeply")
        begins = self._next()
        if begins == "{":
            return self._object(depth)
        if begins == "[":
            return self._list(depth)
        if begins in _QUOTES:
            return self._string(",，}]", listed=listed)
        if number := _NUMBER.match(self.text, self.at):
            return self._number(number)
        if word := _WORD.match(self.text, self.at):
            if word.group() in ("NaN", "Infinity"):
                self._fail(f"{word.group()} is not a JSON number")
            if word.group() not in _WORDS:
                self._fail(f"{word.group()[:40]} is not in quotes")
            self.at = word.end()
            return _WORDS[word.group()]
        return self._fail("a value is missing" if begins else "it ends too early")

    def _object(self, depth: int) -> dict[str, Any]:
        pairs: list[tuple[str, Any]] = []
        self.at += 1
        while self._next() != "}":
            key = self._key()
            if self._next() not in (":", "："):
                self._fail(f"there is no colon after {key[:40]}")
            self.at += 1
            self.begun = True
            pairs.append((key, self.value(depth + 1)))
            self._comma("}")
        self.at += 1
        return once(pairs)

    def _list(self, depth: int) -> list[Any]:
        items: list[Any] = []
        self.at += 1
        while self._next() != "]":
            items.append(self.value(depth + 1, listed=True))
            self._comma("]")
        self.at += 1
        return items

    def _comma(self, closing: str) -> None:
        """Pass over a comma; one may be missing before the closing bracket, or where a new line or object begins."""
        before = self.at
        following = self._next()
        if following in (",", "，"):
            self.at += 1
        elif following != closing:
            new = following == "{" or (following in ('"', "“") and "\n" in self.text[before : self.at])
            if not new:
                self._fail("a comma is missing" if following else "it ends too early")

    def _key(self) -> str:
        if self._next() in _QUOTES:
            return self._string(":：")
        word = _WORD.match(self.text, self.at)
        if word is None:
            self._fail("the name of a field is missing" if self._next() else "it ends too early")
        self.at = word.end()
        return word.group()

    def _string(self, terminators: str, *, listed: bool = False) -> str:
        """Read a text in quotes; quotes inside it that do not end it are its own.

        In a list, a quote that another text follows ends its own: a comma is missing, and is mended at a line's end.
        """
        ends, at = _QUOTES[self.text[self.at]], self.at + 1
        parts: list[str] = []
        own_quotes = 0
        while True:
            found = re.compile(f"[{re.escape(ends)}\\\\]").search(self.text, at)
            if found is None:
                self._fail("a text has no end")
            parts.append(self.text[at : found.start()])
            at = found.end()
            if found.group() == "\\":
                at = self._escape(at, parts)
            elif self._ends(at, terminators) or (listed and self._another_follows(at)):
                break
            else:
                parts.append(found.group())
                own_quotes += 1
                if own_quotes > _MAX_QUOTES:
                    self._fail("a text has too many quotes")
        said = "".join(parts)
        if own_quotes and _KEY_FOLLOWS.search(said):
            self._fail("a quote or a comma is missing")
        self.at = at
        return said

    def _ends(self, at: int, terminators: str) -> bool:
        after = _SPACE.match(self.text, at)
        assert after is not None  # it matches the empty text
        following = self.text[after.end() : after.end() + 1]
        return not following or following in terminators or bool(_NEXT_KEY.match(self.text, at))

    def _another_follows(self, at: int) -> bool:
        """Whether a further text begins after a quote; two quotes without a space between are those of one text."""
        after = _SPACE.match(self.text, at)
        assert after is not None  # it matches the empty text
        return after.end() > at and self.text[after.end() : after.end() + 1] in _QUOTES

    def _escape(self, at: int, parts: list[str]) -> int:
        mark = self.text[at : at + 1]
        code = self.text[at + 1 : at + 5]
        if mark == "u" and re.fullmatch(r"[0-9a-fA-F]{4}", code):
            parts.append(chr(int(code, 16)))
            return at + 5
        parts.append(_ESCAPES.get(mark, mark))
        return at + 1

    def _number(self, found: re.Match[str]) -> int | float:
        said = found.group().removeprefix("+")
        if len(said) > _MAX_DIGITS:
            self._fail("a number is too long")
        self.at = found.end()
        return int(said) if re.fullmatch(r"-?\d+", said) else float(said)

    def _next(self) -> str:
        """The next character that counts; empty at the end."""
        space = _SPACE.match(self.text, self.at)
        assert space is not None  # it matches the empty text
        self.at = space.end()
        return self.text[self.at : self.at + 1]

    def _fail(self, why: str) -> NoReturn:
        reached = self.at - self.start
        raise LooseJSONError(f"{why} at character {reached}", reached, begun=self.begun)


def nested(text: str) -> Any:
    """The object or list that is written inside a text, as in the arguments of some tool calls; None if there is none.

    Raises:
        LooseJSONError: If it begins like one and is none.
    """
    said = text.strip()
    if not said.startswith(("{", "[")):
        return None
    try:
        return json.loads(said, object_pairs_hook=once)
    except (ValueError, RecursionError):
        value, _ = read_loosely(said, 0)
        return value
