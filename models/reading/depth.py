"""How deep a text's brackets stand in each other, before anything reads them that calls itself for each level."""

from __future__ import annotations

import re

MOST_DEEP = 100
"""Levels of lists and objects in one another that a reply, or a server's answer, may have."""
_TEXT_OR_BRACKET = re.compile(r'"[^"\\]*(?:\\.[^"\\]*)*(?:"|\\?\Z)|[\[{]|[\]}]', re.DOTALL)


def too_deep(text: str, most: int = MOST_DEEP) -> bool:
    """Whether JSON has more than so many levels; brackets inside texts in double quotes do not count."""
    depth = 0
    for found in _TEXT_OR_BRACKET.finditer(text):
        mark = found.group()[:1]
        if mark in "[{":
            depth += 1
            if depth > most:
                return True
        elif mark in "]}":
            depth = max(0, depth - 1)
    return False
