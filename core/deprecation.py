"""Old words that still work for a version: whoever uses one is told of the new word."""

from __future__ import annotations

import warnings


class OldWordWarning(FutureWarning):
    """An old word was used; its text is one sentence for the person who used it."""


def deprecated(old: str, new: str, gone: str) -> None:
    """Warn that a word goes.

    Args:
        old: The word that was used, such as "--who".
        new: What takes its place.
        gone: The version in which the old word is no longer known.
    """
    warnings.warn(f"{old} is deprecated and goes in version {gone}: use {new}.", OldWordWarning, stacklevel=3)
