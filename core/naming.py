"""How objects are called: names as words, and what words end with; and any text: on a terminal, and by its SHA-256."""

from __future__ import annotations

import hashlib
import re
from functools import lru_cache

_UNSEEN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
"""What moves a terminal's cursor or colours it, turns the direction of writing, or cannot be written at all."""


@lru_cache(maxsize=65_536)
def plain(name: str) -> str:
    """Return an object's name as words: "kitchen_table_2" becomes "kitchen table"."""
    words = name.replace("_", " ").split()
    if len(words) > 1 and words[-1].isdigit():
        words = words[:-1]
    return " ".join(words)


def ends_with(words: str, wanted: str) -> bool:
    """Whether words are some others or end with them: "green tea" with "tea", but not with "ea"; case counts."""
    return words == wanted or words.endswith(f" {wanted}")


def printable(text: str) -> str:
    """A text as it may be shown on a terminal: with its control characters written out, as JSON does.

    Line ends and tabs stay. JSON stays the same data.
    """
    return _UNSEEN.sub(lambda found: f"\\u{ord(found.group()):04x}", text)


def sha256(text: str) -> str:
    """What a text, as a file in UTF-8, is known by."""
    return hashlib.sha256(text.encode()).hexdigest()
