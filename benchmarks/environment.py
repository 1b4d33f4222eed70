"""How many steps a second the environments make, beside a bare loop of the physics engine with the same home.

python -m benchmarks.environment [--seconds 10] [--scenes maple,oak]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

from coopera.core.household import HUMAN, ROBOT, Act, PickPlace
from coopera.simulation import World, load_scene
from coopera.simulation.env import HomeEnv, HomeParallelEnv, Planned
from coopera.simulation.env.life import Hour
from coopera.simulation.sight.engine import pybullet

from coopera.simulation.sight.build import build  # isort: skip  # after the engine

_HZ = 240


def main() -> None:
    """Print a table: steps a second of wall time, and simulated seconds a second."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--scenes", default="maple,oak")
    given = parser.parse_args()
    print("| home | loop | steps a second | simulated seconds a second |\n|---|---|---|---|")
    for scene in given.scenes.split(","):
        for name, loop in _LOOPS.items():
            steps, simulated, took = loop(scene, given.seconds)
            print(f"| {scene} | {name} | {steps / took:.1f} | {simulated / took:.0f} |")


Counted = tuple[int, float, float]


def _alone(watches: bool) -> Callable[[str, float], Counted]:
    def loop(scene: str, seconds: float) -> Counted:
        world = World(load_scene(scene))
        env = HomeEnv(world, _tidying(world), watches=watches, overlap=True)
        env.reset(seed=0)
        env.action_space.seed(0)
        steps, simulated, start = 0, 0.0, time.perf_counter()
        while time.perf_counter() - start < seconds:
            action = env.action_space.sample()
            action[0] = 0 if watches else 1 + steps % 2
            *_, over, _, info = env.step(action)
            steps, simulated = steps + 1, simulated + float(info["seconds"])
            if over:
                env.reset()
        env.close()
        return steps, simulated, time.perf_counter() - start

    return loop


def _both(scene: str, seconds: float) -> Counted:
    world = World(load_scene(scene))
    env = HomeParallelEnv(world, _tidying(world))
    env.reset(seed=0)
    steps, simulated, start = 0, 0.0, time.perf_counter()
    while time.perf_counter() - start < seconds:
        done = env.household.step({HUMAN: env.household.left[0], ROBOT: env.household.left[-1]})
        steps, simulated = steps + 1, simulated + max(done.seconds.values(), default=0.0)
        if len(env.household.left) < 2:
            env.household.next_hour()
        if env.household.over:
            env.household.begin(steps)
    env.close()
    return steps, simulated, time.perf_counter() - start


def _bare(scene: str, seconds: float) -> Counted:
    """The engine alone: the same bodies, nothing moves, nobody decides."""
    client = pybullet.connect(pybullet.DIRECT)
    build(load_scene(scene), client, drawn=False)
    steps, start = 0, time.perf_counter()
    while time.perf_counter() - start < seconds:
        pybullet.stepSimulation(physicsClientId=client)
        steps += 1
    pybullet.disconnect(client)
    return steps, steps / _HZ, time.perf_counter() - start


def _tidying(world: World) -> Planned:
    """Eight hours of three things each that can be put where they are meant to go."""
    fixed, movable = world.objects("fixed"), world.objects("movable")
    acts: list[Act] = []
    for at, thing in enumerate(sorted(movable)):
        place = sorted(fixed)[at * 7 % len(fixed)]
        act = PickPlace(object_id=movable[thing][0], object=thing, receptacle_id=fixed[place][0], receptacle=place)
        if not world.misfit(HUMAN, act):
            acts.append(act)
    return Planned({Hour(0, 9 + at): acts[3 * at : 3 * at + 3] for at in range(min(8, len(acts) // 3))})


_LOOPS = {
    "the robot acts, the person too": _alone(watches=False),
    "the robot watches": _alone(watches=True),
    "two learners": _both,
    "the engine alone (240 Hz)": _bare,
}

if __name__ == "__main__":
    main()
