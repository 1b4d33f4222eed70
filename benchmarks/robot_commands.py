"""Pick-and-place commands to robots in homes: how many they do, and why not the others.

    python -m benchmarks.robot_commands [--robots stretch,tiago] [--scenes maple,oak] [--commands 200] [--seed 0]

Each command is a thing of the home and a piece of furniture to put it on or into, drawn at random among those that the
person of the home could do as it now stands; the home goes on from command to command. A command counts as done where
the home then has the thing there, and nothing else that can be carried has moved.
"""

from __future__ import annotations

import argparse
import re
import time
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from coopera.core.affordances import Relation
from coopera.core.errors import SimulationError
from coopera.core.household import HUMAN, ROBOT, PickPlace
from coopera.simulation import World, load_scene
from coopera.simulation.bodies.robot import usable_robots

MOST_DRAWN = 60
"""Commands drawn for each that is given, at most."""


@dataclass
class Tally:
    """What came of the commands."""

    given: int = 0
    done: int = 0
    seconds: float = 0.0
    reasons: Counter[str] = field(default_factory=Counter)


def feasible(world: World, rng: np.random.Generator) -> PickPlace | None:
    """A command that the person could do; None where none was found."""
    things, places = world.layout.movable, world.layout.fixed
    for _ in range(MOST_DRAWN):
        thing, place = things[int(rng.integers(len(things)))], places[int(rng.integers(len(places)))]
        relation: Relation = "inside" if rng.random() < 0.3 else "on"
        act = PickPlace(
            object_id=thing.id, object=thing.name, receptacle_id=place.id, receptacle=place.name, relation=relation
        )
        if world.place_of(thing.name) == f"{relation} {place.name}":
            continue
        try:
            world.plan(HUMAN, act)
        except SimulationError:
            continue
        return act
    return None


def places(world: World) -> dict[str, str]:
    """Where each thing is."""
    return {thing.name: world.place_of(thing.name) for thing in world.layout.movable}


def give(scene: str, robot: str, count: int, seed: int) -> Tally:
    """Give commands to one robot in one home."""
    tally, rng = Tally(), np.random.default_rng([seed, count])
    with World(load_scene(scene), robot=robot) as world:
        while tally.given < count and (act := feasible(world, rng)) is not None:
            before = places(world)
            start = time.process_time()
            outcome = world.perform(ROBOT, act)
            tally.seconds += time.process_time() - start
            after = places(world)
            moved = {name for name in after if after[name] != before[name]}
            tally.given += 1
            if outcome.ok and moved == {act.object} and act.receptacle in after[act.object]:
                tally.done += 1
            else:
                tally.reasons[re.sub(r"[\w ]+_\d+|\d+", "…", outcome.reason or f"moved {sorted(moved)}")] += 1
    return tally


def main() -> None:
    """Print a line for each robot and home, and the reasons."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", default=",".join(usable_robots()))
    parser.add_argument("--scenes", default="maple,oak")
    parser.add_argument("--commands", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    for robot in args.robots.split(","):
        for scene in args.scenes.split(","):
            tally = give(scene, robot, args.commands, args.seed)
            share, each = tally.done / max(tally.given, 1), 1000 * tally.seconds / max(tally.given, 1)
            print(f"{robot:12} {scene:8} {tally.done:4} of {tally.given} ({share:.1%}), {each:.0f} ms each", flush=True)
            for reason, times in tally.reasons.most_common(8):
                print(f"    {times:3} {reason}")


if __name__ == "__main__":
    main()
