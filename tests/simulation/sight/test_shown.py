"""What pictures show otherwise than it is: an open fridge that is reached into, and no thing twice."""

from __future__ import annotations

import numpy as np
import pytest

from coopera.simulation import load_scene
from coopera.simulation.acts.plans import Play
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.sight.engine import pybullet
from coopera.simulation.sight.recording import Filming, Moment
from coopera.simulation.sight.stage import Stage
from coopera.simulation.state.home_state import BoxThing, HomeState, PersonState
from coopera.simulation.world import World


@pytest.fixture(scope="module")
def ground():
    with World(load_scene("maple"), frame_size=(64, 48)) as world:
        yield world._ground, HomeState.model_validate(world.snapshot())


def played(ground, at: SceneObject, motion: str, text: str) -> Moment:
    """The deed of somebody who stands before furniture with a thing out of the magic box."""
    known, start = ground
    x, y, _ = at.to_world(0.0, at.size[1] / 2 + 0.35)
    body = PersonState(
        spot=(x, y), place=(x, y), yaw=at.facing + np.pi, worktop=at.top, posture="stand", thing="brought_9", at=at.name
    )
    state = start.model_copy(update={"box": {"brought_9": BoxThing(id=900, text=text)}}).put("human", body)
    shot = Filming(known, state, "robot", "human").film([Play("human", body, known.motions[motion])], "human").shots[-1]
    return shot.at(shot.deed)


def height(stage: Stage, name: str) -> float:
    return pybullet.getBasePositionAndOrientation(stage.home.bodies[name], physicsClientId=stage.client)[0][2]


def of_class(ground, cls: str) -> SceneObject:
    return next(thing for thing in ground[0].scene.objects if thing.cls == cls)


@pytest.mark.parametrize("motion", ["put things away on a shelf", "look for something on the shelves"])
def test_a_fridge_is_shown_open_and_reached_into_while_the_body_is_what_it_was(ground, motion: str) -> None:
    fridge = of_class(ground, "fridge")
    moment = played(ground, fridge, motion, "milk")
    assert fridge.name in moment.opened
    drawn, there = moment.drawn["human"], moment.bodies["human"]
    assert forward(drawn.pose).place["right_hand"][2] < fridge.top - 0.1
    assert drawn._replace(pose=there.pose) == there


def test_shelves_without_doors_are_reached_into_as_ever(ground) -> None:
    moment = played(ground, of_class(ground, "bookshelf"), "put things away on a shelf", "milk")
    assert not moment.opened
    assert not moment.drawn


def test_what_is_brought_to_where_its_like_stands_is_shown_once(ground) -> None:
    laptop = of_class(ground, "laptop")
    desk = ground[0].scene.object(laptop.on)
    assert desk is not None
    assert played(ground, desk, "type on a keyboard", "laptop").unseen == {laptop.name}
    assert played(ground, desk, "type on a keyboard", "work laptop").unseen == {laptop.name}
    assert played(ground, desk, "type on a keyboard", "kettle").unseen == frozenset()


def test_what_is_not_to_be_seen_is_left_out_of_pictures_alone(ground) -> None:
    known, start = ground
    laptop = of_class(ground, "laptop")
    for renderer, hidden in (("tiny", True), (None, False)):
        stage = Stage(known.scene, known.people, known.robots, renderer=renderer)
        moment = Filming(known, start, "robot", "human").now()
        stage.show(start, moment._replace(unseen=frozenset((laptop.name,))))
        assert (height(stage, laptop.name) < 0) is hidden
        stage.show(start, moment)
        assert height(stage, laptop.name) > 0
        stage.close()
