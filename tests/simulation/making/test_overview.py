from __future__ import annotations

import numpy as np
import pytest

from coopera.core.errors import ConfigError
from coopera.simulation.homes.scene import Scene, load_scene
from coopera.simulation.making.overview import inside, overview


def test_the_overview_shows_the_home_on_a_white_ground_and_is_the_same_each_time() -> None:
    first, second = overview(load_scene("maple"), 160, 120), overview(load_scene("maple"), 160, 120)
    assert first.shape == (120, 160, 3)
    assert (first == second).all()
    assert (first[0] == 255).all()
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 200


def test_a_home_without_furniture_is_shown_too() -> None:
    room = {"name": "cell", "kind": "cell", "x0": 0, "y0": 0, "x1": 2, "y1": 2}
    assert len(np.unique(overview(Scene.model_validate({"id": "cell", "rooms": [room]}), 80, 60))) > 1


def test_a_room_is_shown_from_inside_in_the_colours_of_its_walls_and_not_of_another() -> None:
    home = load_scene("pine")
    kitchen, bathroom = inside(home, "kitchen", 160, 120), inside(home, "bathroom", 160, 120)
    assert kitchen.shape == (120, 160, 3)
    assert (kitchen != bathroom).mean() > 0.5
    assert (kitchen == 255).all(axis=2).mean() < 0.3


def test_a_room_that_is_not_there_is_refused_with_those_that_are() -> None:
    with pytest.raises(ConfigError, match=r"no room 'dungeon' \(it has living room, kitchen"):
        inside(load_scene("pine"), "dungeon")
