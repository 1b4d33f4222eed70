"""What is kept of earlier days to be learned from again: a fixed number of examples, so that evenings stay short."""

from __future__ import annotations

from collections.abc import Iterable

from coopera.core.hour import Example
from coopera.core.randomness import seed_at

REPLAY = 320
"""Examples kept of each kind: about what the first four evenings of one person bring of intentions."""


def keep(examples: Iterable[Example], most: int = REPLAY) -> list[Example]:
    """Choose what to keep: for each person an equal share of `most`, drawn evenly from all that person's days.

    Each example has a fixed place in a random order of its own, so what is kept of what was kept before and of a new
    day is what would be kept of all days at once: the choice can be made again from the records, and never drifts.

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
