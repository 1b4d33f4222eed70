from __future__ import annotations

from coopera.simulation.homes.scene import Scene
from coopera.simulation.making.proof import prove
from tests.simulation.flat import flat


def with_ball_at(z: float) -> Scene:
    moved = [
        thing.model_copy(update={"position": (*thing.xy, z)}) if thing.name == "tennis_ball_1" else thing
        for thing in flat().objects
    ]
    return flat().model_copy(update={"objects": moved})


def test_a_home_in_which_both_take_everything_has_no_problem_but_those_of_its_plan() -> None:
    assert prove(flat()) == ["dining_table_1 and dining_chair_1 overlap."]


def test_what_is_too_high_for_a_body_is_named_with_body_and_reason() -> None:
    found = prove(with_ball_at(2.6))
    assert "tennis_ball_1 floats 2.60 m above the floor: `on` names nothing." in found
    assert "tennis_ball_1 in the living room: the robot cannot reach the tennis ball." in found


def test_a_home_without_room_to_stand_is_one_problem_and_no_crash() -> None:
    room = {"name": "cell", "kind": "cell", "x0": 0, "y0": 0, "x1": 1, "y1": 1}
    block = flat().object("sofa_1")
    assert block is not None
    full = block.model_copy(update={"room": "cell", "position": (0.5, 0.5, 0.0), "size": (0.9, 0.9, 1.0)})
    cell = Scene.model_validate({"id": "cell", "rooms": [room], "objects": [full]})
    assert prove(cell) == ["In the home 'cell' there is no room to stand anywhere."]
