"""Rehearsal: a fixed number of examples of earlier days is trained on again each evening, so evenings stay short."""

from __future__ import annotations

from collections.abc import Iterable

from coopera.core.hour import Example
from coopera.core.randomness import seed_at

REHEARSED = 320
"""Examples kept for rehearsal, of each kind: about the intention examples of one person's first four evenings."""


def keep(examples: Iterable[Example], most: int = REHEARSED) -> list[Example]:
    """Choose the examples to keep: for each person an equal share of `most`, drawn evenly from all days of that person.

    Each example has a fixed random place, drawn from its own content, and the first places are kept. So a choice day by
    day keeps the same examples as one choice from all days. It can be repeated from the records.

    Args:
        examples: Those kept so far and the new ones; those without a label are left out.
        most: Number of examples in all.

    Returns:
        The chosen ones in order of time.
    """
    of: dict[str, list[tuple[int, int, Example]]] = {}
    for number, example in enumerate(e for e in examples if e.label is not None):
        of.setdefault(example.person, []).append((_place(example), number, example))
    share = most // max(1, len(of))
    kept = [chosen for person in of.values() for chosen in sorted(person, key=lambda one: one[:2])[:share]]
    return [example for _, _, example in sorted(kept, key=lambda one: (one[2].day, one[2].hour, one[1]))]


def _place(example: Example) -> int:
    return seed_at(0, example.person, example.day, example.hour, example.intention, example.candidate)
