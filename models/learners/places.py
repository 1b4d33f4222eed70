"""Where a thing belongs, from where a few others were put: prototypes of places among sentence embeddings.

What is to be put away lies there all at once. So vectors are centred on the things of this one occasion, which leaves
what tells them apart, and things to be placed help to find each place's prototype (soft k-means with known members).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
from langchain_core.embeddings import Embeddings

from coopera.memory.embeddings import as_array

Floats = npt.NDArray[np.float64]

PHRASES = ("{}", "things like {}", "{} (category)")
"""In which words a thing is looked up: their mean says more of its kind than its name alone."""
_STEEP = 10.0
_ROUNDS = 10


def places(
    seen: Mapping[str, str], things: Sequence[str], embeddings: Embeddings, *, together: bool = True
) -> dict[str, str]:
    """Return the place of each thing.

    Args:
        seen: The place of each thing that was put away; at least one.
        things: What is to be placed.
        embeddings: Give a text the same vector every time.
        together: False places each thing as if it were the only one.

    Raises:
        ValueError: If nothing was seen.
    """
    if not seen:
        raise ValueError("nothing was seen, so no place is known")
    if not together:
        return {thing: places(seen, [thing], embeddings)[thing] for thing in things}
    if not things:
        return {}
    names = sorted(set(seen.values()))
    vectors = _vectors([*seen, *things], embeddings)
    known, asked = vectors[: len(seen)], vectors[len(seen) :]
    member = np.array([[place == name for name in names] for place in seen.values()], np.float64)
    centres = _unit(member.T @ known)
    for _ in range(_ROUNDS):
        odds = _STEEP * (asked @ centres.T)
        share = np.exp(odds - odds.max(1, keepdims=True))
        share /= share.sum(1, keepdims=True)
        centres = _unit(member.T @ known + share.T @ asked)
    return {thing: names[place] for thing, place in zip(things, (asked @ centres.T).argmax(1), strict=True)}


def nearest(seen: Mapping[str, str], things: Sequence[str], embeddings: Embeddings) -> dict[str, str]:
    """Return for each thing the place of the thing seen whose name is most alike: the yardstick."""
    vectors = as_array(embeddings, [*seen, *things]).astype(np.float64)
    best = (vectors[len(seen) :] @ vectors[: len(seen)].T).argmax(1) if things else []
    known = list(seen.values())
    return {thing: known[place] for thing, place in zip(things, best, strict=True)}


def _vectors(things: Sequence[str], embeddings: Embeddings) -> Floats:
    """Return unit vectors of n things, centred on their mean, shape (n, d)."""
    spoken = [phrase.format(thing) for phrase in PHRASES for thing in things]
    table = as_array(embeddings, spoken).astype(np.float64).reshape(len(PHRASES), len(things), -1)
    found = _unit(table - table.mean(1, keepdims=True)).mean(0)
    return _unit(found - found.mean(0))


def _unit(vectors: Floats) -> Floats:
    found: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)
    return found
