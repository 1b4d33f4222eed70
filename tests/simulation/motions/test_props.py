from __future__ import annotations

import math

import pytest

from coopera.core.household import HUMAN
from coopera.simulation import World
from coopera.simulation.motions.holding import Grip, Worktop
from coopera.simulation.motions.library import load_library
from coopera.simulation.motions.poses import Setting
from coopera.simulation.motions.props import shown
from tests.simulation.flat import flat, move

LIBRARY = load_library()
COUNTER = Setting(worktop=0.9)
RIGHT = Grip("right")
TABLE = Worktop(0.8, 0.0, 0.0, 0.6, 1.0)


def seen(motion: str, thing: str, top: Worktop | None = TABLE, share: float = 0.5, grip: Grip = RIGHT):
    """How the thing in hand is shown, and what else is, by what it is called."""
    how = shown(LIBRARY[motion], COUNTER, grip, [thing], top, share * LIBRARY[motion].keys.period)
    return how.grip, {one.thing: one.grip for one in how.props}


@pytest.fixture(scope="module")
def home():
    with World(flat(), frame_size=(96, 72), renderer="tiny") as world:
        yield world


def deed(world: World):
    shot = world._recording.shots[-1]
    return shot.at(shot.deed)


def test_a_tomato_that_is_cut_lies_there_and_a_knife_is_in_hand() -> None:
    grip, props = seen("chop vegetables", "tomato", grip=Grip("surface"))
    assert grip.laid is not None
    assert props["kitchen knife"].hold == "right"
    assert "cutting board" in props


def test_with_a_knife_in_hand_there_is_no_second_one() -> None:
    grip, props = seen("chop vegetables", "kitchen_knife", grip=Grip("surface"))
    assert grip.laid is None
    assert "kitchen knife" not in props
    assert "staged slices" in props


def test_where_a_board_lies_already_none_is_laid_beside_it() -> None:
    there = TABLE._replace(tools=((0.42, 0.02),))
    assert "cutting board" not in seen("chop vegetables", "tomato", there)[1]


def test_a_plant_in_hand_stands_there_and_a_can_is_tipped_over_it() -> None:
    grip, props = seen("water plants", "potted_plant")
    assert grip.laid is not None
    assert props["watering can"].tips
    assert "staged plant" not in props
    held, others = seen("water plants", "watering_can")
    assert held.tips
    assert "watering can" not in others
    assert "staged plant" in others


def test_where_there_is_no_surface_a_plant_has_a_stand() -> None:
    assert "staged plant stand" in seen("water plants", "watering_can", None)[1]
    assert "staged plant stand" not in seen("water plants", "watering_can")[1]


def test_a_second_place_is_laid_where_the_table_is_long_and_free() -> None:
    assert "staged place" in seen("set the table", "plate")[1]
    assert "staged place" not in seen("set the table", "plate", TABLE._replace(half_y=0.4))[1]
    taken = TABLE._replace(taken=((0.48, 0.54, 0.05),))
    assert "staged place" not in seen("set the table", "plate", taken)[1]


def test_a_pet_is_fed_out_of_the_bag_at_its_bowl() -> None:
    grip, props = seen("feed the pet", "pet food bag")
    assert grip.tip > 0
    assert {"staged cat", "staged full bowl"} <= set(props)
    assert "staged dog" in seen("feed the pet", "dog treat")[1]


def test_a_blanket_is_spread_once_it_is_put_down() -> None:
    early, late = seen("make the bed", "blanket", share=0.1), seen("make the bed", "blanket", share=0.6)
    assert early[0] is not None
    assert "staged spread blanket" not in early[1]
    assert late[0] is None
    assert "staged spread blanket" in late[1]


def test_who_dresses_holds_a_garment_up_draws_it_over_the_head_and_then_wears_it() -> None:
    ways = [seen("put on clothes", "shirt", share=share, grip=Grip("both")) for share in (0.1, 0.4, 0.8)]
    assert [[grip.hold for grip in props.values()] for _, props in ways] == [["both"], ["head"], ["torso"]]
    assert not any(grip for grip, _ in ways)
    assert not seen("put on clothes", "hat", grip=Grip("both"))[1]


@pytest.mark.parametrize(("top", "hangs"), [(None, True), (TABLE, False)])
def test_a_garment_hangs_where_the_hands_left_it_and_stays_in_hand_at_a_radiator(top, hangs) -> None:
    early, late = (seen("hang up clothes", "shirt", top, share, Grip("both"))[1] for share in (0.3, 0.7))
    assert early["staged garment hung"].hold == "both"
    assert (late["staged garment hung"].laid is not None) == hangs


def test_dishes_go_into_a_rack_and_laundry_does_not() -> None:
    assert "staged dish rack" in seen("load the machine", "plate", grip=Grip("both"))[1]
    assert "staged dish rack" not in seen("load the machine", "shirt", grip=Grip("both"))[1]


@pytest.mark.parametrize(("thing", "other"), [("reading glasses", True), ("book", True), ("magazine", False)])
def test_who_reads_has_something_open_in_both_hands(thing, other) -> None:
    grip, props = seen("sit and read", thing, grip=Grip("both"))
    assert ("staged open book" in props) == other
    assert (grip is None) == other


def test_what_is_eaten_out_of_the_hand_comes_to_the_mouth() -> None:
    assert seen("eat a meal", "apple", grip=Grip("surface"))[0].bitten
    assert not seen("eat a meal", "fork", grip=Grip("surface"))[0].bitten


def test_props_are_in_pictures_and_in_no_rays_way(home) -> None:
    assert home.perform(HUMAN, move("kitchen_counter_1", "tomato", "chop vegetables"), record=True).ok
    recording, moment = home._recording, deed(home)
    blind, drawn = home._watcher.stage, home._watcher.drawn
    for stage in (blind, drawn):
        stage.show(recording.state, moment)
    assert "human staged slices" in drawn.home.bodies
    assert not [name for name in blind.home.bodies if "staged" in name]


def test_what_is_true_of_the_thing_in_hand_is_another_matter_than_how_it_is_drawn(home) -> None:
    home.restore({})
    assert home.perform(HUMAN, move("kitchen_counter_1", "tomato", "chop vegetables"), record=True).ok
    held = deed(home).held[HUMAN]
    assert held.grip.laid is None
    assert held.drawn.grip.laid is not None


@pytest.mark.parametrize(
    ("act", "lowest", "highest"),
    [
        (move("kitchen_counter_1", "tomato", "chop vegetables"), 1.1, 2.0),
        (move("sofa_1", "mug", "do squats"), 1.8, 3.2),
    ],
    ids=lambda value: value if isinstance(value, float) else value.describe(),
)
def test_the_camera_across_the_room_is_close_to_hands_at_work_and_has_all_of_who_does_sport(
    home, act, lowest, highest
) -> None:
    home.restore({})
    assert home.perform(HUMAN, act, record=True).ok
    camera = home._watcher._view(home._recording, home._recording.shots[-1])
    tall = 2 * math.tan(math.radians(camera.fov) / 2) * math.dist(camera.eye, camera.target)
    assert lowest < tall < highest


def test_what_was_put_on_is_seen_on_the_body_until_the_act_is_over(home) -> None:
    assert home.perform(HUMAN, move("bed_1", "shirt", "put on clothes"), record=True).ok
    shot = home._recording.shots[-1]
    end = shot.at(shot.ticks - 1)
    assert "shirt" in str(end.worn[HUMAN])
    assert [one.grip.hold for one in end.held[HUMAN].drawn.props] == ["torso"]
    assert HUMAN not in shot.at(0).worn
    assert home.state.person().thing is None
