"""How far raters agree beyond chance: Cohen's and Fleiss' kappa, and Krippendorff's alpha for yes and no.

All take labels of any kind that can be compared. None comes out where agreement has no meaning: nothing in common, or
all labels the same, so that chance would agree as well.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Mapping, Sequence

Label = Hashable


def cohen(one: Sequence[Label], other: Sequence[Label]) -> float | None:
    """Cohen's kappa (1960) of two raters over the same items; items with a None are left out."""
    pairs = [(a, b) for a, b in zip(one, other, strict=True) if a is not None and b is not None]
    if not pairs:
        return None
    observed = sum(a == b for a, b in pairs) / len(pairs)
    first, second = Counter(a for a, _ in pairs), Counter(b for _, b in pairs)
    chance = sum(first[label] * second[label] for label in first) / len(pairs) ** 2
    return None if chance == 1 else (observed - chance) / (1 - chance)


def fleiss(items: Sequence[Sequence[Label]]) -> float | None:
    """Fleiss' kappa (1971): the labels of each item, by as many raters each; None where their numbers differ."""
    counts = {len(labels) for labels in items}
    if len(counts) != 1 or (raters := counts.pop()) < 2:
        return None
    agreeing = [sum(n * (n - 1) for n in Counter(labels).values()) / (raters * (raters - 1)) for labels in items]
    totals = Counter(label for labels in items for label in labels)
    chance = sum((n / (raters * len(items))) ** 2 for n in totals.values())
    return None if chance == 1 else (sum(agreeing) / len(items) - chance) / (1 - chance)


def krippendorff(items: Sequence[Sequence[Label]]) -> float | None:
    """Krippendorff's alpha for nominal labels (2011): any number of labels an item; those with one are left out."""
    paired = [Counter(labels) for labels in items if len(labels) > 1]
    totals: Counter[Label] = Counter()
    for counts in paired:
        totals.update(counts)
    n = totals.total()
    if n < 2:
        return None
    apart = sum(
        (counts.total() ** 2 - sum(one**2 for one in counts.values())) / (counts.total() - 1) for counts in paired
    )
    expected = (n**2 - sum(one**2 for one in totals.values())) / (n - 1)
    return None if expected == 0 else 1 - apart / expected


def pairwise(answers: Mapping[str, Mapping[str, Label]]) -> dict[tuple[str, str], float | None]:
    """Cohen's kappa of each two raters over the items that both answered; `answers` are by rater, then by item."""
    raters = sorted(answers)
    return {
        (one, other): cohen([answers[one].get(item) for item in shared], [answers[other].get(item) for item in shared])
        for place, one in enumerate(raters)
        for other in raters[place + 1 :]
        if (shared := sorted(answers[one].keys() & answers[other].keys()))
    }
