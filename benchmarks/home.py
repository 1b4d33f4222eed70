"""Does the home work, and what does a day of it cost? `python -m benchmarks.home [--scenes …] [--commands N]`.

1. Commands: random pick-and-place commands by the person and by each robot, in one life of each home. A command
   names a thing and a piece of furniture; those for which the furniture has no free place at all are drawn again and
   counted apart. Every path is checked against the furniture, and at the end the whole home as any home is (`coopera
   scenes check`): nothing floats, nothing is inside another, everything can still be reached.
2. A day: 13 hours of five acts of each body, the first of each hour watched by the robot. CPU seconds without pictures,
   and what eight pictures of two views an hour cost on top.
3. Memory: the same home lived in for many days, in one process; resident memory at the start and at the end.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

from coopera.core.errors import SimulationError
from coopera.core.household import HUMAN, ROBOT, Act, AgentId, FreeMotion, HandOver, PickPlace
from coopera.simulation import World, list_scenes, load_scene
from coopera.simulation.acts.plans import Walk
from coopera.simulation.bodies.robot import usable_robots
from coopera.simulation.homes.catalogue import blocks
from coopera.simulation.state.free_places import free_places
from coopera.simulation.ways.home_check import check
from coopera.simulation.ways.navigation import RADIUS, clearance, obstacle_boxes

AGENTS = (HUMAN, ROBOT)
HOURS, TASKS = 13, 5
BOX = ("mug", "book", "towel", "water bottle", "phone", "apple")


def random_pick_place(world: World, rng: np.random.Generator) -> tuple[PickPlace, bool]:
    """A random command, and whether the furniture has any free place for the thing."""
    scene = world.layout
    thing = scene.movable[rng.integers(len(scene.movable))]
    receptacle = scene.fixed[rng.integers(len(scene.fixed))]
    act = PickPlace(object_id=thing.id, object=thing.name, receptacle_id=receptacle.id, receptacle=receptacle.name)
    return act, bool(free_places(scene, world.state, thing, receptacle))


def lowest_clearance(world: World, agent: AgentId, act: Act) -> float:
    """The least distance from furniture and walls on all ways of a planned act, in metres."""
    scene = world.layout
    boxes = obstacle_boxes((thing for thing in scene.fixed if blocks(thing)), scene.walls())
    lowest = np.inf
    for step in world.plan(agent, act).steps:
        if isinstance(step, Walk):
            for a, b in zip(step.points, step.points[1:], strict=False):
                line = np.linspace(a, b, 2 + int(np.hypot(b[0] - a[0], b[1] - a[1]) / 0.02))
                lowest = min(lowest, float(clearance(line[:, 0], line[:, 1], boxes).min()))
    return lowest


def commands(scene: str, agent: AgentId, count: int, robot: str) -> None:
    """Give random commands in one home and print what came of them."""
    rng = np.random.default_rng([count, len(scene), AGENTS.index(agent)])
    reasons: Counter[str] = Counter()
    done, impossible, lowest = 0, 0, np.inf
    with World(load_scene(scene), robot=robot) as world:
        for _ in range(count):
            act, possible = random_pick_place(world, rng)
            while not possible:
                impossible += 1
                act, possible = random_pick_place(world, rng)
            try:
                lowest = min(lowest, lowest_clearance(world, agent, act))
            except SimulationError as err:
                reasons[f"{act.object} -> {act.receptacle}: {err}"] += 1
                continue
            done += world.perform(agent, act).ok
        problems = check(world.as_scene())
    who = robot if agent == ROBOT else "person"
    print(
        f"{scene:10} {who:11} {done}/{count} = {done / count:.1%} done; {impossible} without any place; "
        f"paths keep {lowest:.3f} m from furniture (body radius {RADIUS}); problems afterwards: {len(problems)}"
    )
    for line in [*reasons, *problems]:
        print(f"    {line}")


def live_a_day(world: World, rng: np.random.Generator, *, folder: Path | None = None) -> None:
    """One day of both; with a folder, the first act of each hour is rendered into it."""
    for _ in range(HOURS):
        for number in range(TASKS):
            for agent in AGENTS:
                watched = agent == HUMAN and number == 0
                world.perform(agent, random_act(world, agent, rng), record=watched)
                if watched:
                    world.percept(rng)
                    if folder is not None:
                        world.frames(8, folder)


def random_act(world: World, agent: AgentId, rng: np.random.Generator) -> Act:
    """Half pick-and-place, half of what the body does in type 2."""
    if rng.random() < 0.5:
        return random_pick_place(world, rng)[0]
    if agent == ROBOT:
        return HandOver(object=str(rng.choice(BOX)))
    target = world.layout.fixed[rng.integers(len(world.layout.fixed))]
    motion = str(rng.choice(world.motions))
    return FreeMotion(target_id=target.id, target=target.name, in_hand=str(rng.choice(BOX)), motion=motion)


def days(scene: str, count: int) -> None:
    """Print the cost of a day, with and without pictures, and the memory over many days."""
    with World(load_scene(scene)) as world, tempfile.TemporaryDirectory() as folder:
        live_a_day(world, np.random.default_rng(0))
        plain = _timed(world, None)
        small = _timed(world, Path(folder))
        world.frame_size = (1024, 768)
        large = _timed(world, Path(folder))
        world.frame_size = (320, 240)
        print(f"{scene:10} a day without pictures {plain:.1f} s CPU (median of 3); 8 pictures of 2 views an hour cost")
        print(f"{'':10} {small - plain:.1f} s more at 320x240 and {large - plain:.1f} s more at 1024x768")
        start = world.snapshot()
        before = _resident()
        for day in range(count):
            world.restore(start)
            live_a_day(world, np.random.default_rng(day))
        print(f"{'':10} resident memory {before:.0f} MB before {count} more days, {_resident():.0f} MB after")


def _timed(world: World, folder: Path | None) -> float:
    took = []
    for seed in range(3 if folder is None else 1):
        start = time.process_time()
        live_a_day(world, np.random.default_rng(seed), folder=folder)
        took.append(time.process_time() - start)
    return float(np.median(took))


def _resident() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def main() -> None:
    """Measure what the arguments ask for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default=",".join(list_scenes()), help="homes, separated by commas")
    parser.add_argument("--commands", type=int, default=200, help="commands to each body in each home")
    parser.add_argument("--days", type=int, default=100, help="days over which memory is watched")
    args = parser.parse_args()
    for scene in args.scenes.split(","):
        if args.commands:
            commands(scene, HUMAN, args.commands, usable_robots()[0])
            for robot in usable_robots():
                commands(scene, ROBOT, args.commands, robot)
    if args.days:
        days(args.scenes.split(",")[0], args.days)


if __name__ == "__main__":
    main()
