"""What a memory stream is asked, checked, and what it answers."""

from __future__ import annotations

import operator
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from coopera.core.errors import ConfigError

MAX_TEXT = 100_000
"""Characters per record or query."""

_FAR = 10**9  # hours; a hundred thousand years


class Recollection(NamedTuple):
    """A record recalled: score = relevance x recency.

    Attributes:
        text: As it was added.
        hour: Global hour index it was added for.
        relevance: Cosine of record and query, in [-1, 1].
        recency: decay^(now - hour), in (0, 1].
        score: relevance x recency, in float64.
        metadata: As it was added; empty if there was none.
    """

    text: str
    hour: int
    relevance: float
    recency: float
    score: float
    metadata: Mapping[str, Any]


class Texts(NamedTuple):
    """All records of some hours, oldest first, as columns, without what else was added with them.

    Attributes:
        texts: As they were added.
        hours: Global hour index of each.
    """

    texts: list[str]
    hours: list[int]


class Relevances(NamedTuple):
    """All records of some hours, oldest first, as columns: many are compared, and few of them are looked at.

    Attributes:
        texts: As they were added.
        hours: Global hour index of each.
        relevances: The cosine of each query with each record, in [-1, 1], shape (queries, records).
    """

    texts: list[str]
    hours: list[int]
    relevances: npt.NDArray[np.float64]


def check_text(text: str, what: str) -> None:
    """Refuse what is no text, empty or too long."""
    if not isinstance(text, str) or not text.strip():
        raise ConfigError(f"{what} must be a text that is not empty, not {text!r:.80}")
    if len(text) > MAX_TEXT:
        raise ConfigError(f"{what} may have at most {MAX_TEXT} characters, not {len(text)}")
    try:
        text.encode()
    except UnicodeEncodeError as err:
        raise ConfigError(f"{what} must be valid Unicode, not {text!r:.80}") from err


def check_bounds(within: tuple[float, float] | None) -> None:
    """Refuse what are no two numbers, the lower one first."""
    try:
        low, high = within or (0.0, 0.0)
        ordered = bool(float(low) <= float(high))
    except (TypeError, ValueError):
        ordered = False
    if not ordered:
        raise ConfigError(f"bounds of relevance must be two numbers, the lower one first, not {within!r:.80}")


def whole(number: int, what: str) -> int:
    """Return a whole number as an int, whatever type of integer it is."""
    if isinstance(number, bool) or not hasattr(number, "__index__"):
        raise ConfigError(f"{what} must be a whole number, not {number!r:.80}")
    value = operator.index(number)
    if abs(value) > _FAR:
        raise ConfigError(f"{what} must lie within ±{_FAR}, not at {value}")
    return value
