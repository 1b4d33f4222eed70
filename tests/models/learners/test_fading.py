from __future__ import annotations

import numpy as np
import pytest

from coopera.models.learners.fading import MOST, REMNANT, Fading


def lived(steps: int, *, changed_at: int | None) -> Fading:
    """Memories that begin after a change foretell well and the others badly; a young one knows less."""
    fading = Fading()
    for step in range(1, steps):
        fading.begin(step)
        valid = changed_at if changed_at is not None and step > changed_at else 0
        fading.learn([-0.2 - 0.5 / (1 + step - start) if start >= valid else -1.5 for start in fading.starts])
    return fading


def test_evidence_from_before_a_change_fades_and_that_of_after_it_does_not() -> None:
    kept = lived(40, changed_at=20).of(np.array([0, 19, 25, 39]))
    assert kept[:2] == pytest.approx(REMNANT, abs=0.02)
    assert kept[2:].min() > 0.9


def test_nothing_fades_where_nothing_changes() -> None:
    assert lived(100, changed_at=None).of(np.arange(99)).min() > 0.9


def test_newer_evidence_never_counts_less_than_older() -> None:
    assert (np.diff(lived(60, changed_at=30).of(np.arange(60))) >= 0).all()


def test_memories_stay_few_and_their_weights_sum_to_one() -> None:
    fading = lived(200, changed_at=90)
    assert len(fading.starts) == len(fading.weights) <= MOST
    assert fading.weights.sum() == pytest.approx(1.0)
    assert fading.starts == sorted(fading.starts)


def test_a_step_that_does_not_come_next_is_refused() -> None:
    fading = Fading()
    fading.begin(3)
    with pytest.raises(ValueError, match="step 3 does not come after step 3"):
        fading.begin(3)
