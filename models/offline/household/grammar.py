"""A grammar of wordings: one template with alternatives stands for many ways of putting the same intention.

`"{Have|Enjoy} a {quiet|slow|} breakfast"` has two slots and six expansions. An alternative may be empty; slots do not
stand in slots. A text without braces stands for itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from math import prod

MOST = 400
"""Expansions that a template may have: more than anybody could proof-read."""
SHORTEST, LONGEST = 2, 200
"""Characters that an expansion may have."""

_SLOT = re.compile(r"\{([^{}]*)\}")
_BREAK = re.compile(r"[,:;\u2013\u2014]")
_PARTS = 8  # parts of a text among which a wording is sought; nobody's wording with a touch has more


@dataclass(frozen=True, slots=True)
class Template:
    """A parsed wording: its pieces in order, each with its alternatives; what is fixed has a single one."""

    pieces: tuple[tuple[str, ...], ...]

    @property
    def count(self) -> int:
        """How many expansions there are."""
        return prod(len(piece) for piece in self.pieces)

    @property
    def canonical(self) -> str:
        """The usual expansion: the first alternative of each slot."""
        return self.filled([0] * len(self.pieces))

    def filled(self, chosen: Sequence[int]) -> str:
        """Return the expansion with one alternative chosen for each piece, by its place."""
        return self._tidy("".join(piece[place] for piece, place in zip(self.pieces, chosen, strict=True)))

    def expansions(self) -> Iterator[str]:
        """Yield all expansions, the last slot varying fastest."""
        return map(self._tidy, map("".join, product(*self.pieces)))

    def _tidy(self, text: str) -> str:
        """Close the gaps that empty alternatives leave; a text without slots stays as it is."""
        if len(self.pieces) == 1 and len(self.pieces[0]) == 1:
            return text
        text = " ".join(text.split()).replace(" ,", ",")
        return text[:1].upper() + text[1:]


@lru_cache(maxsize=2048)
def parse(text: str) -> Template:
    """Read a wording with or without alternatives.

    Raises:
        ValueError: In one sentence, if braces do not match, a slot says nothing, there are too many expansions, or one
            of them is too short or too long.
    """
    if _nested(text):
        raise ValueError(f"{text!r} has braces within braces: alternatives cannot stand in alternatives")
    fixed_and_slots = _SLOT.split(text)
    if any(brace in piece for piece in fixed_and_slots[::2] for brace in "{}"):
        raise ValueError(f"{text!r} has a brace without its partner: alternatives are written {{one|another}}")
    pieces = [tuple(piece.split("|")) if slot % 2 else (piece,) for slot, piece in enumerate(fixed_and_slots)]
    if any(not any(alternative.strip() for alternative in piece) for piece in pieces[1::2]):
        raise ValueError(f"{text!r} has braces with nothing in them: at least one alternative must say something")
    template = Template(tuple(piece for piece in pieces if piece != ("",)) or (("",),))
    if template.count > MOST:
        raise ValueError(f"{text!r} has {template.count} expansions: at most {MOST}; make two templates of it")
    for expansion in template.expansions():
        if not SHORTEST <= len(expansion) <= LONGEST:
            raise ValueError(f"{expansion!r} has {len(expansion)} characters: {SHORTEST} to {LONGEST} are expected")
    return template


def _nested(text: str) -> bool:
    """Whether a brace is opened within an open one, and both are closed."""
    return re.search(r"\{[^}]*\{[^}]*\}[^{]*\}", text) is not None


def cores(text: str) -> Iterator[str]:
    """Yield what a person may have put a touch around: the text itself, then its parts between commas and colons.

    "Carry on: take a nap, at ease" is also "Carry on: take a nap", "take a nap, at ease", "Carry on", "take a nap" and
    "at ease": the longer ones first, of equals the first. Nothing is known here of anybody's touches.
    """
    yield text
    breaks = [found.span() for found in _BREAK.finditer(text)][: _PARTS - 1]
    starts = [0, *(end for _, end in breaks)]
    ends = [*(start for start, _ in breaks), len(text)]
    for length in range(len(breaks), 0, -1):
        for first in range(len(starts) - length + 1):
            yield text[starts[first] : ends[first + length - 1]].strip()
