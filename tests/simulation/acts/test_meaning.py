"""Which posture the words for a motion name, where several motions come equally near to them."""

from __future__ import annotations

import pytest

from coopera.simulation import World
from tests.simulation.kitchen import HOME, moves

NEAR = [("stand and wait", 0.50), ("sit and rest", 0.49), ("lie down", 0.48)]


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        ("hum", "stand and wait"),
        ("sit, humming", "sit and rest"),
        ("Sitting and humming", "sit and rest"),
        ("hum while seated.", "sit and rest"),
        ("lying down", "lie down"),
        ("hum, laid out", "lie down"),
        ("standing on one leg, then sit", "stand and wait"),
        ("do sit ups", "stand and wait"),
        ("sit-ups", "stand and wait"),
    ],
)
def test_the_first_posture_that_is_named_is_shown_and_sit_ups_name_none(words: str, shown: str) -> None:
    with World(HOME, match=lambda _: NEAR) as home:
        plan = home.plan("human", moves("sofa_1", "book", words))
    assert plan.meant is not None
    assert plan.meant.caption == shown
