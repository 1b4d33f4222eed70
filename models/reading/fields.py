"""What models call the fields of a reply, and the objects that they put around it."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable

_TYPO = 0.85
_ALIASES = {
    "yes": ("answer", "verdict", "ok", "decision", "judgement", "judgment"),
    "act": ("action",),
    "task": ("new_task", "revised_task", "changed_task", "revised", "revision", "replacement", "change"),
    "reason": ("reasoning", "explanation", "rationale", "comment", "why"),
    "comment": ("reason",),
    "in_hand": ("thing_in_hand", "object_in_hand"),
    "probability": ("likelihood",),
    "grade": ("score", "rating"),
}
"""Other names that models give a field."""
WRAPPERS = frozenset(
    (
        *("answer", "reply", "response", "result", "results", "output", "data", "json", "object", "final"),
        *("finalanswer", "arguments", "parameters", "args", "input", "value", "properties"),
        *("item", "task", "draft", "verdict", "offer", "act", "action", "pickplace", "freemotion", "handover"),
    )
)
"""What models call an object that they put around the answer, as `same` has it."""


def same(name: str) -> str:
    """A field's name without capitals, spaces and signs, a leading "is" and a trailing "name"."""
    bare = re.sub(r"[\W_]+", "", name[:80]).casefold()
    return bare.removeprefix("is").removesuffix("name") if len(bare) > 4 else bare


def meant(key: str, known: Iterable[str]) -> str | None:
    """The field that a key means: by its own spelling, by a usual other name, or but for a slip of the pen."""
    fields, bare = list(known), same(key)
    if key in fields:
        return key
    for one in fields:
        if bare == same(one):
            return one
    for one in fields:
        if bare in map(same, _ALIASES.get(one, ())):
            return one
    near = difflib.get_close_matches(bare, [same(one) for one in fields], n=2, cutoff=_TYPO)
    alike = [one for one in fields if same(one) in near and same(one)[0] == bare[0]]
    return alike[0] if len(alike) == 1 else None


def is_spelling(key: str, field: str) -> bool:
    """Whether a key is the field's own name, in another spelling."""
    return same(key) == same(field)
