"""How far automatic success is from the person's own answers in the evening (PAPER §4.4)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def l1(one: Sequence[float | None], other: Sequence[float | None]) -> float | None:
    """Mean absolute difference of two measures over the same hours (PAPER §4.4); hours without either are left out.

    None where no hour has both.
    """
    gaps = [abs(a - b) for a, b in zip(one, other, strict=True) if a is not None and b is not None]
    return float(np.mean(gaps)) if gaps else None
