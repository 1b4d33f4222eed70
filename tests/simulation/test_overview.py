from __future__ import annotations

import numpy as np

from simulation.overview import overview
from simulation.scene import Scene, load_scene


def test_the_overview_shows_the_home_on_a_white_ground_and_is_the_same_each_time() -> None:
    first, second = overview(load_scene("maple"), 160, 120), overview(load_scene("maple"), 160, 120)
    assert first.shape == (120, 160, 3)
    assert (first == second).all()
    assert (first[0] == 255).all()
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 200


def test_a_home_without_furniture_is_shown_too() -> None:
    room = {"name": "cell", "kind": "cell", "x0": 0, "y0": 0, "x1": 2, "y1": 2}
    assert len(np.unique(overview(Scene.model_validate({"id": "cell", "rooms": [room]}), 80, 60))) > 1
