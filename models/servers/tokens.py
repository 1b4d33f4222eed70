"""Counts of tokens as servers tell them, which decide what a run may spend: believed where they can be true."""

from __future__ import annotations

from typing import NamedTuple

TOKENS = "tokens"
"""What a count that was put right is called among the leniencies of a call."""
MOST_TOKENS = 10**9
"""Tokens that one count may have."""
CHARACTERS = 4
"""Characters that a token has where nobody can say better."""


class Count(NamedTuple):
    """How many tokens a text has, and whether that is an estimate."""

    tokens: int
    estimated: bool = False


def believe(said: object, characters: int) -> Count:
    """Take a server's count of a text's tokens, or estimate it.

    Args:
        said: What the server says; anything at all.
        characters: How long the text is.

    Returns:
        What it says, where that is a whole number from 0 (from 1 for a text that is not empty) to `MOST_TOKENS`; else
        a quarter of the characters, rounded up.
    """
    least = 1 if characters else 0
    if isinstance(said, int) and not isinstance(said, bool) and least <= said <= MOST_TOKENS:
        return Count(said)
    return Count(-(-characters // CHARACTERS), estimated=characters > 0)
