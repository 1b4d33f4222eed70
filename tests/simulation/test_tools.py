from __future__ import annotations

import json

import pytest

from coopera.simulation.tools import world_tools
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, put


@pytest.fixture
def world():
    with World(flat()) as world:
        yield world


def call(world: World, agent: str, name: str, **given: str) -> str:
    tool = {tool.name: tool for tool in world_tools(world, agent)}[name]
    message = tool.invoke({"name": name, "args": given, "id": "1", "type": "tool_call"})
    return str(message.content)


def test_each_tool_tells_a_model_what_it_does_and_what_it_takes(world) -> None:
    for agent in ("human", "robot"):
        for tool in world_tools(world, agent):
            schema = tool.tool_call_schema.model_json_schema()
            assert len(tool.description) > 20
            assert all(field.get("description") for field in schema["properties"].values())


def test_a_thing_is_taken_carried_and_put_down_step_by_step(world) -> None:
    assert call(world, "robot", "pick", thing="book_1").startswith("You hold book_1.")
    assert world.holding("robot", "book")
    assert not world.on("book", "coffee_table")
    assert call(world, "robot", "go_to", target="kitchen").startswith("You are at the kitchen.")
    assert world.objects("movable")["book_1"][1] == "kitchen"  # it goes where its holder goes
    assert call(world, "robot", "place", receptacle="dining_table_1").startswith("It is on dining_table_1.")
    assert world.on("book", "dining_table")
    assert not world.holding("robot", "book")


@pytest.mark.parametrize(
    ("name", "given", "reason"),
    [
        ("pick", {"thing": "unicorn_1"}, "no unicorn"),
        ("pick", {"thing": "sofa_1"}, "cannot be carried"),
        ("place", {"receptacle": "sofa_1"}, "holds nothing"),
        ("go_to", {"target": "cellar"}, "no room and no object 'cellar'"),
    ],
)
def test_what_cannot_be_done_is_said_and_changes_nothing(world, name, given, reason) -> None:
    before = world.snapshot()
    answer = call(world, "robot", name, **given)
    assert answer.startswith("That failed: ")
    assert reason in answer
    assert world.snapshot() == before


def test_a_full_hand_takes_nothing_else_and_nothing_vanishes_from_it(world) -> None:
    assert world.pick("robot", "mug_1").ok
    assert "already holds the mug" in world.pick("robot", "apple_1").reason
    for act in (put("apple_1", "sofa_1"), bring("banana")):
        outcome = world.perform("robot", act)
        assert outcome.reason == "the robot must first put down the mug."
    assert world.holding("robot", "mug")


def test_what_somebody_holds_survives_a_snapshot(world) -> None:
    world.pick("human", "apple_1")
    kept = json.loads(json.dumps(world.snapshot()))
    world.restore({})
    assert not world.holding("human", "apple")
    world.restore(kept)
    assert world.place("human", "sofa_1").ok
    assert world.on("apple", "sofa")


def test_looking_around_shows_the_room_and_only_the_room(world) -> None:
    seen = json.loads(call(world, "robot", "look_around"))
    assert seen["you"]["room"] == world.room_of("robot")
    here = {name for name, (_, room) in world.objects("fixed").items() if room == seen["you"]["room"]}
    assert set(seen["furniture"]) == here
    everything = json.loads(call(world, "human", "list_objects"))
    assert sorted(everything) == world.rooms
    assert everything["kitchen"]["things"]["mug_1"] == "kitchen_counter_1"
    assert "There is no room 'attic'" in call(world, "human", "list_objects", room="attic")


def test_the_robot_brings_what_the_person_then_moves_with(world) -> None:
    assert "The person has the book" in call(world, "robot", "hand_over", thing="book")
    assert "You sit and read at sofa_1" in call(
        world, "human", "move", target="sofa_1", motion="sit and read", in_hand="book"
    )
    assert "That failed" in call(world, "human", "move", target="attic", motion="dance", in_hand="hat")
