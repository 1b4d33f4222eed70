"""What does a picture cost, drawn by whom? `python -m benchmarks.renderers [--homes …] [--pictures N] [--only …]`.

In each home a person does something that a robot watches; its pictures are taken at moments that lie evenly in the
act, by turns from the robot's head and from the third-person camera. A picture counts whole: the scene is set to the
moment, the picture is drawn, read back and encoded as WebP as a run does it. Medians, in milliseconds of processor
time of all threads, and of wall time. Every renderer has a process of its own.

`--rays N` compares depth, classes and bodies with so many rays a home, cast at the triangles that are drawn.
"""

from __future__ import annotations

import argparse
import io
import multiprocessing
import statistics
import time
from collections.abc import Callable, Iterator
from importlib.util import find_spec

import numpy as np
from PIL import Image

from benchmarks import mujoco_home
from coopera.core.errors import ConfigError
from coopera.core.household import HUMAN, FreeMotion
from coopera.simulation.drawing.context import Renderer
from coopera.simulation.homes.scene import list_scenes, load_scene
from coopera.simulation.sight.cameras import robot_camera
from coopera.simulation.sight.recording import Moment, Recording
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.sight.video import WEBP
from coopera.simulation.sight.watching import Watcher
from coopera.simulation.world import World
from tests.simulation.drawing.rays import agreement

SIZES = ((320, 240), (1024, 768))
WAYS = ("tiny", "egl", "mujoco", "mujoco, shadow", "gl, no shadow", "gl")
DRAWN_BY: dict[str, Renderer] = {"tiny": "tiny", "egl": "egl", "gl, no shadow": "gl", "gl": "gl"}
Shot = Callable[[tuple[int, int]], np.ndarray]


def recorded(world: World) -> Recording:
    """A person reads a book on some seat while the robot looks."""
    for thing in world.layout.fixed:
        if thing.cls in ("sofa", "armchair", "dining_chair"):
            act = FreeMotion(target_id=thing.id, target=thing.name, in_hand="book", motion="sit and read")
            if world.perform(HUMAN, act, record=True).ok and world._recording is not None:
                return world._recording
    raise SystemExit(f"{world.scene}: nobody can sit anywhere")


def moments(watcher: Watcher, recording: Recording, count: int) -> Iterator[tuple[Moment, Camera]]:
    """Evenly spaced moments, each with the camera whose turn it is."""
    ground = watcher.ground
    views: dict[int, Camera] = {}
    for number, tick in enumerate(np.linspace(0, recording.ticks - 1, count).round().astype(int)):
        index, within = recording.find(int(tick))
        moment = recording.shots[index].at(within)
        if index not in views:
            views[index] = watcher._view(recording, recording.shots[index])
        robot = recording.robot
        yield moment, views[index] if number % 2 else robot_camera(ground.robots[robot], moment.bodies[robot])


def measure(way: str, home: str, count: int) -> list[tuple[float, float]]:
    """Median milliseconds of a picture of each of `SIZES`: processor time and wall time."""
    scene = load_scene(home)
    with World(scene, renderer="tiny") as world:
        recording = recorded(world)
        asked = list(moments(world._watching(), recording, count))
        ground = world._watching().ground
    if way.startswith("mujoco"):
        drawn = mujoco_home.Drawn(scene, shadow="shadow" in way)

        def shot(moment: Moment, camera: Camera, size: tuple[int, int]) -> np.ndarray:
            return drawn.picture(camera, size)

    else:
        stage = Stage(scene, ground.people, ground.robots, DRAWN_BY[way])
        if stage.drawer is not None:
            stage.drawer.shadow = way == "gl"

        def shot(moment: Moment, camera: Camera, size: tuple[int, int]) -> np.ndarray:
            stage.show(recording.state, moment)
            return stage.colours(camera, size)

    found = []
    for size in SIZES:
        shot(*asked[0], size)  # the first picture of a size makes what the others use
        cpu, wall = [], []
        for moment, camera in asked:
            before = time.process_time(), time.perf_counter()
            Image.fromarray(shot(moment, camera, size)).save(io.BytesIO(), "WEBP", **WEBP)
            cpu.append(time.process_time() - before[0])
            wall.append(time.perf_counter() - before[1])
        found.append((1e3 * statistics.median(cpu), 1e3 * statistics.median(wall)))
    return found


def agree(home: str, rays: int) -> None:
    """Print how well what a robot sees, and a camera in each of two rooms, agrees with rays."""
    with World(load_scene(home), renderer="gl") as world:
        first, second = (room.centre for room in world.layout.rooms[:2])
        cameras = (world.robots[0], Camera((*first, 1.6), (*second, 0.9)), Camera((*second, 1.9), (*first, 0.3)))
        views = [world.view(camera, (640, 480)) for camera in cameras]
        drawer = world._watching().drawn.drawer
        assert drawer is not None
        each = [agreement(view, drawer.scenery, rays // len(cameras) + 1) for view in views]
    off, classes, bodies = (np.concatenate(values) for values in zip(*each, strict=True))
    print(
        f"{home:10}{len(off)} rays: depth within 1 cm {(off < 0.01).mean():.2%} (99.9 % within "
        f"{1e3 * np.quantile(off, 0.999):.3f} mm), classes {classes.mean():.2%}, bodies {bodies.mean():.2%}"
    )


def main() -> None:
    """Print a table for each way to draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--homes", nargs="+", default=list_scenes())
    parser.add_argument("--pictures", type=int, default=20)
    parser.add_argument("--only", nargs="+", choices=WAYS, default=WAYS)
    parser.add_argument("--rays", type=int, default=0)
    args = parser.parse_args()
    if args.rays:
        for home in args.homes:
            agree(home, args.rays)
        return
    print(f"milliseconds a picture, CPU (wall): medians of {args.pictures}; scene update and WebP included")
    print(f"{'':16}{'':10}" + "".join(f"{f'{w}x{h}':>18}" for w, h in SIZES))
    for way in args.only:
        if way.startswith("mujoco") and find_spec("mujoco") is None:
            print(f"{way:16}skipped: mujoco is not installed")
            continue
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            for home in args.homes:
                try:
                    times = pool.apply(measure, (way, home, args.pictures))
                except ConfigError as err:
                    print(f"{way:16}skipped: {err}")
                    break
                print(f"{way:16}{home:10}" + "".join(f"{f'{cpu:.0f} ({wall:.0f})':>18}" for cpu, wall in times))


if __name__ == "__main__":
    main()
