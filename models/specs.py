"""What is known of a model by its spec alone, before any is opened, and how long a token of its texts is, about."""

from __future__ import annotations

from coopera.models.given import OBJECT

LETTERS = 4
"""Characters of English that make a token, about: a measure that is the same for all models."""
_HERE = ("offline", "smol", "huggingface")
_OBJECTS_HERE = ("OfflineChatModel", "HuggingFaceChat")


def runs_here(spec: str) -> bool:
    """Whether a model runs in this process, without any server: the offline one, or weights; also given as objects."""
    kind, _, name = spec.partition(":")
    return kind in _HERE or (kind == OBJECT and name.partition(":")[0] in _OBJECTS_HERE)
