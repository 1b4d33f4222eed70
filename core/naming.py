"""How objects are called: names as words, and what words end with."""

from __future__ import annotations


def plain(name: str) -> str:
    """Return an object's name as words: "kitchen_table_2" becomes "kitchen table"."""
    words = name.replace("_", " ").split()
    if len(words) > 1 and words[-1].isdigit():
        words = words[:-1]
    return " ".join(words)


def ends_with(words: str, wanted: str) -> bool:
    """Whether words are some others or end with them: "green tea" with "tea", but not with "ea"; case counts."""
    return words == wanted or words.endswith(f" {wanted}")
