"""Confusion counts over a task superset, and their rates (PAPER §4.3)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from coopera.core.success import Counts


def count(accepted: Sequence[bool], correct: Sequence[bool | None]) -> Counts:
    """Count verdicts against truth; `None` is unscored and enters nothing else.

    F1 is None where it has no meaning: nothing scored, or nothing accepted while nothing was correct.
    Precision is None where nothing was accepted, recall where nothing was correct.
    """
    pairs = [(a, c) for a, c in zip(accepted, correct, strict=True) if c is not None]
    tp = sum(a and c for a, c in pairs)
    fp = sum(a and not c for a, c in pairs)
    fn = sum(c and not a for a, c in pairs)
    return _rates(tp, fp, fn, len(pairs) - tp - fp - fn, len(correct) - len(pairs))


def pool(counts: Iterable[Counts]) -> Counts:
    """Add up hours and take the rates of the sum, so that an hour weighs by its candidates."""
    every = list(counts)
    tp, fp, fn, tn, unscored = (sum(getattr(c, f) for c in every) for f in ("tp", "fp", "fn", "tn", "unscored"))
    return _rates(tp, fp, fn, tn, unscored)


def _rates(tp: int, fp: int, fn: int, tn: int, unscored: int) -> Counts:
    def ratio(part: int, whole: int) -> float | None:
        return part / whole if whole else None

    return Counts(
        tp=tp,
        fp=fp,
        fn=fn,
        tn=tn,
        unscored=unscored,
        f1=ratio(2 * tp, 2 * tp + fp + fn),
        precision=ratio(tp, tp + fp),
        recall=ratio(tp, tp + fn),
    )
