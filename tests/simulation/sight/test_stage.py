"""What a stage shows, as the engine has it: where bodies are put."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coopera.core.household import HUMAN
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.bodies.humanoid_reach import standing
from coopera.simulation.homes.opened import opened
from coopera.simulation.homes.scene import load_scene
from coopera.simulation.sight.engine import pybullet
from coopera.simulation.sight.recording import Moment
from coopera.simulation.sight.stage import Stage
from coopera.simulation.sight.stances import Held
from coopera.simulation.state.home_state import HomeState, PersonState, ThingState

AT = (1.0, 1.0)


@pytest.fixture(scope="module")
def stage():
    stage = Stage(load_scene("pine"), [HUMAN], {}, renderer=None)
    yield stage
    stage.close()


def state(**more) -> HomeState:
    return HomeState(scene="pine", agents={HUMAN: PersonState(spot=AT, place=AT)}, **more)


def moment(**more) -> Moment:
    return Moment({HUMAN: Placed(*AT, 0.0, standing())}, more.pop("held", {}), more.pop("moved", {}), **more)


def place(stage: Stage, name: str) -> tuple[float, float, float]:
    return pybullet.getBasePositionAndOrientation(stage.home.bodies[name], physicsClientId=stage.client)[0]


def test_a_thing_out_of_the_magic_box_that_was_put_down_is_shown_there_until_it_is_gone(stage) -> None:
    lying = ThingState(position=(2.0, 1.0, 0.75), yaw=0.0, on=None)
    home = state(box={"kettle_1": {"id": 900, "text": "kettle"}}, moved={"kettle_1": lying})
    stage.show(home, moment())
    assert place(stage, "kettle_1") == pytest.approx((2.0, 1.0, 0.75))
    stage.show(home, moment(held={HUMAN: Held("kettle_1")}))
    assert math.dist(place(stage, "kettle_1")[:2], AT) < 1.0
    stage.show(state(), moment())
    assert place(stage, "kettle_1")[2] < -10


def test_two_things_of_one_kind_out_of_the_magic_box_are_two_bodies(stage) -> None:
    box = {f"cup_{k}": {"id": 900 + k, "text": "cup"} for k in (1, 2)}
    moved = {f"cup_{k}": ThingState(position=(2.0, float(k), 0.5), yaw=0.0, on=None) for k in (1, 2)}
    stage.show(state(box=box, moved=moved), moment())
    assert place(stage, "cup_1")[1] == pytest.approx(1.0)
    assert place(stage, "cup_2")[1] == pytest.approx(2.0)


def test_many_things_out_of_the_magic_box_are_all_shown(stage) -> None:
    box = {f"candle_{k}": {"id": 900 + k, "text": f"candle {k}"} for k in range(12)}
    moved = {name: ThingState(position=(2.0, 1.0, 0.1 * k), yaw=0.0, on=None) for k, name in enumerate(box)}
    stage.show(state(box=box, moved=moved), moment())
    for k, name in enumerate(box):
        assert place(stage, name)[2] == pytest.approx(0.1 * k)


def test_a_hat_is_worn_on_the_head_and_is_nowhere_else(stage) -> None:
    home = state(box={"hat_9": {"id": 909, "text": "hat"}})
    stage.show(home, moment(worn={HUMAN: ("hat_9",)}))
    head = forward(standing()).place["head"]
    x, y, z = place(stage, "hat_9")
    assert math.dist((x - AT[0], y - AT[1], z), head) < 0.12


def test_a_worn_shirt_of_the_home_is_out_of_sight_and_comes_back(stage) -> None:
    thing = stage.scene.movable[0]
    stage.show(state(), moment(worn={HUMAN: (thing.name,)}))
    assert place(stage, thing.name)[2] < -10 or thing.cls in ("hat", "headphones")
    stage.show(state(), moment())
    assert place(stage, thing.name) == pytest.approx(thing.position)


def test_what_is_inside_a_basket_that_is_carried_is_out_of_sight(stage) -> None:
    box = {"laundry_basket_9": {"id": 909, "text": "laundry basket"}, "towel_9": {"id": 910, "text": "towel"}}
    towel = ThingState(position=(0.0, 0.0, 0.1), yaw=0.0, on=None, inside="laundry_basket_9")
    basket = ThingState(position=(2.0, 1.0, 0.0), yaw=0.0, on=None)
    stage.show(state(box=box, moved={"towel_9": towel, "laundry_basket_9": basket}), moment())
    assert place(stage, "towel_9") == pytest.approx((2.0, 1.0, 0.1))
    stage.show(state(box=box, moved={"towel_9": towel}), moment(held={HUMAN: Held("laundry_basket_9")}))
    assert place(stage, "towel_9")[2] < -10


def test_what_is_in_a_hand_that_is_not_looked_at_is_in_nobodys_way(stage) -> None:
    thing = stage.scene.movable[0]
    stage.show(state().with_held(HUMAN, thing.name), moment())
    assert place(stage, thing.name)[2] < -10
    stage.show(state(), moment())
    assert place(stage, thing.name) == pytest.approx(thing.position)


def test_open_furniture_shows_its_doors_until_it_is_closed(stage) -> None:
    fridge = next(thing for thing in stage.scene.fixed if thing.cls == "fridge")
    door = f"{fridge.name}:open"
    stage.show(state(), moment(opened=frozenset((fridge.name,))))
    assert place(stage, door) == pytest.approx(fridge.position)
    stage.show(state(), moment())
    assert place(stage, door)[2] < -10


@pytest.mark.parametrize(
    "cls", ["fridge", "wardrobe", "dresser", "kitchen_cabinet", "bathroom_cabinet", "dishwasher", "microwave"]
)
def test_what_is_open_is_before_the_front_and_no_higher_than_the_inside(cls: str) -> None:
    piece = next(thing for name in ("oak", "maple") for thing in load_scene(name).fixed if thing.cls == cls)
    inside, leaves = opened(piece)
    assert leaves
    for part in inside:
        assert part.position[1] - part.around[1] > piece.size[1] / 2 - 0.01
    for leaf in leaves:
        for place, turn in leaf.ways:
            corners = np.array([(0.0, 0.0, 0.0), *(np.array(part.position) + part.half for part in leaf.parts)])
            placed = corners @ turn.T + place
            assert (placed[:, 1] > piece.size[1] / 2 - 0.06).all()
            assert placed[:, 2].min() > -0.03
            assert placed[:, 2].max() <= piece.size[2] + 0.03


def test_furniture_without_an_inside_looks_the_same_when_open(stage) -> None:
    window = next(thing for thing in stage.scene.fixed if thing.cls == "curtain")
    assert opened(window) == ([], [])
    stage.show(state(), moment(opened=frozenset((window.name,))))
    assert f"{window.name}:open" not in stage.home.bodies


def test_things_out_of_the_magic_box_that_come_and_go_leave_nothing_behind(stage) -> None:
    """The engine keeps a shape when its body is removed, and a person's weeks bring the same kinds of things again."""

    def next_shape() -> int:
        made: int = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.1, physicsClientId=stage.client)
        pybullet.removeCollisionShape(made, physicsClientId=stage.client)
        return made

    def come_and_go(number: int) -> None:
        lying = ThingState(position=(2.0, 1.0, 0.75), yaw=0.0, on=None)
        name = f"cup_{number}"
        stage.show(state(box={name: {"id": 900 + number, "text": "cup"}}, moved={name: lying}), moment())

    come_and_go(1)
    before = next_shape()
    for number in range(2, 30):
        come_and_go(number)
    assert next_shape() == before
