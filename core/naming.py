"""How objects are called: names as words."""

from __future__ import annotations


def plain(name: str) -> str:
    """Return an object's name as words: "kitchen_table_2" becomes "kitchen table"."""
    words = name.replace("_", " ").split()
    if len(words) > 1 and words[-1].isdigit():
        words = words[:-1]
    return " ".join(words)
