from __future__ import annotations

import numpy as np

from coopera.simulation.bodies.elbowroom import Elbowroom
from tests.simulation.flat import flat

SCENE = flat()
ROOM = Elbowroom(SCENE)
TABLE = SCENE.object("dining_table_1")


def arm(*points: tuple[float, float, float]) -> np.ndarray:
    return np.array([np.linspace(a, b, 8) for a, b in zip(points, points[1:], strict=False)]).reshape(-1, 3)


def test_an_arm_over_a_table_has_room_and_its_hand_may_touch_what_it_reaches_onto() -> None:
    over = arm((6.2, 4.2, 1.0), (6.2, 3.6, 1.0), (6.2, 3.4, 0.78))
    assert ROOM.hit(over, over[-1], TABLE) is None


def test_an_arm_that_comes_from_below_would_hit_the_table() -> None:
    below = arm((6.2, 4.2, 0.5), (6.2, 3.3, 0.5), (6.2, 3.2, 1.1))
    assert ROOM.hit(below, below[-1], TABLE) == "dining_table_1"


def test_an_arm_does_not_reach_through_a_wall_nor_through_other_furniture() -> None:
    through = arm((4.2, 1.0, 0.9), (4.9, 1.0, 0.9))
    assert ROOM.hit(through, through[-1], None) == "wall"
    counter = arm((7.9, 2.0, 0.5), (8.6, 2.0, 0.5))
    assert ROOM.hit(counter, counter[-1], None) == "kitchen_counter_1"
