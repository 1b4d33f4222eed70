"""Use a home without any graph: walk, carry, hand over, ask what is true, take pictures.

Run it with `.venv/bin/python examples/world_api.py`.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from coopera.core.household import FreeMotion, HandOver, PickPlace
from coopera.simulation import PersonAgent, RobotAgent, World, load_scene


def main() -> None:
    """Let one person and one robot do a few things in a shipped home, then two of each; print what came of it."""
    with World(load_scene("maple")) as world, tempfile.TemporaryDirectory() as folder:
        print(world.scene, "has", ", ".join(world.rooms))
        mug, table = world.layout.object("mug_1"), world.layout.object("coffee_table_1")
        assert mug is not None
        assert table is not None
        carry = PickPlace(object_id=mug.id, object=mug.name, receptacle_id=table.id, receptacle=table.name)
        print(world.perform("robot", carry))
        print("on(mug, coffee table):", world.holds("on(mug, coffee table)"))
        print(world.perform("robot", HandOver(object="book")))
        read = FreeMotion(target_id=0, target="sofa_1", in_hand="book", motion="sit and read")
        print(world.perform("human", read, record=True))
        print("near(human, sofa):", world.holds("near(human, sofa)"))
        print([path.name for path in world.frames(2, Path(folder))])
        start = world.snapshot()
        print(world.go_to("robot", "kitchen"), "->", world.room_of("robot"))
        world.restore(start)
        print("restored: the robot is in the", world.room_of("robot"))
    agents = [PersonAgent("ana"), PersonAgent("ben"), RobotAgent("tall", "fetch"), RobotAgent("low", "husky_panda")]
    with World(load_scene("maple"), agents=agents) as world:
        for robot, person in (("tall", "ana"), ("low", "ben")):
            print(world.perform(robot, HandOver(object="cup", receiver=person)))
            print(f"near({person}, sofa):", world.holds(f"near({person}, sofa)"))


if __name__ == "__main__":
    main()
