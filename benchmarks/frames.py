"""What the frames of an hour show: `python -m benchmarks.frames [--robots fetch,husky_panda] [--scenes maple,oak]`.

Every motion that the offline people's common sense knows is done once in each home, at furniture that fits, and a
pick-and-place after every fifth. Of each act the frames are taken as a run takes them. What is seen is counted in those
of the act itself (not of the ways to it), how far frames differ in all. A hand counts as seen if the
picture's depth at its place is that of the hand, and what is there is the person or the thing in hand; the thing in
hand if it fills twelve pixels of 160x120. `--evenly` takes the frames at equal times in place of distinct ones.
"""

from __future__ import annotations

import argparse
import math
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from benchmarks.perception import acts
from coopera.core.household import HUMAN, ROBOT, FreeMotion, PickPlace, SceneId
from coopera.core.randomness import rng_at
from coopera.simulation import World, load_scene
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.shapes.rotations import Array, about_z, wrapped
from coopera.simulation.sight.engine import pybullet
from coopera.simulation.sight.recording import Moment
from coopera.simulation.sight.sampling import telling_ticks
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.sight.stage import Image as Picture
from coopera.simulation.sight.watching import Watcher

SIZE = (160, 120)
_NEAR, _FAR = 0.05, 30.0
_HAND = 0.06  # metres
_THING = 12
VIEWS = ("robot", "third person")


class Seen(NamedTuple):
    """One frame: which hands (right, left) are seen, the thing in hand (None: there is none), and shares of pixels."""

    hands: tuple[bool, bool]
    thing: bool | None
    person: float
    robot: float
    angle: float
    image: Picture
    doing: bool = True


def looked_at(stage: Stage, moment: Moment, camera: Camera) -> Seen:
    """Take one picture and find out what is in it; the stage must show the moment."""
    width, height = SIZE
    view = pybullet.computeViewMatrix(camera.eye, camera.target, (0.0, 0.0, 1.0))
    lens = pybullet.computeProjectionMatrixFOV(camera.fov, width / height, _NEAR, _FAR)
    _, _, colours, raw, mask = pybullet.getCameraImage(
        width, height, view, lens, shadow=0, renderer=pybullet.ER_TINY_RENDERER, physicsClientId=stage.client
    )
    depth = _FAR * _NEAR / (_FAR - (_FAR - _NEAR) * np.asarray(raw).reshape(height, width))
    bodies = np.asarray(mask).reshape(height, width)
    held = moment.held.get(HUMAN)
    thing = stage.home.bodies.get(held.name) if held is not None else None
    person = moment.bodies[HUMAN]
    frames = forward(person.pose)
    hands = [frames.place[f"{side}_hand"] for side in ("right", "left")]
    places = np.array(hands) @ about_z(person.yaw).T + np.array((person.x, person.y, 0.0))
    towards = math.atan2(camera.eye[1] - person.y, camera.eye[0] - person.x)
    ours = [stage.bodies[HUMAN], thing]
    right, left = (
        _at_depth(camera, place, depth, np.isin(bodies, [b for b in ours if b is not None])) for place in places
    )
    return Seen(
        hands=(right, left),
        thing=None if thing is None else bool((bodies == thing).sum() >= _THING),
        person=float((bodies == stage.bodies[HUMAN]).mean()),
        robot=float((bodies == stage.bodies[ROBOT]).mean()),
        angle=math.degrees(abs(wrapped(towards - person.yaw))),
        image=np.asarray(colours, dtype=np.uint8).reshape(height, width, 4)[:, :, :3],
    )


def _at_depth(camera: Camera, place: Array, depth: Array, ours: NDArray[np.bool_]) -> bool:
    """Whether a third of the pixels where a hand must be are the person's or the thing's, and no nearer than a hand."""
    width, height = SIZE
    ahead = np.array(camera.target) - np.array(camera.eye)
    ahead = ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    right = right / np.linalg.norm(right)
    line = place - np.array(camera.eye)
    away = float(line @ ahead)
    if away < _NEAR:
        return False
    scale = height / 2 / math.tan(math.radians(camera.fov) / 2) / away
    column = width / 2 + scale * float(line @ right)
    row = height / 2 - scale * float(line @ np.cross(right, ahead))
    rows, columns = np.mgrid[0:height, 0:width]
    disc = np.hypot(rows + 0.5 - row, columns + 0.5 - column) <= max(scale * _HAND, 1.0)
    if not (0 <= row < height and 0 <= column < width):
        return False
    return bool((disc & ours & (np.abs(depth - away) < 2 * _HAND)).sum() >= disc.sum() / 3)


def every_motion(world: World) -> list[FreeMotion | PickPlace]:
    """One act of each motion that the home has the furniture for, and some pick-and-place."""
    found: list[FreeMotion | PickPlace] = []
    known = set()
    for act in acts(world, 600, rng_at(0, "frames", world.scene)):
        if isinstance(act, PickPlace):
            if len(found) % 6 == 5:
                found.append(act)
        elif act.motion not in known:
            known.add(act.motion)
            found.append(act)
    return found


class Counted:
    """Counts what a stage is asked for."""

    def __init__(self) -> None:
        self.rays = self.small = 0
        rays, picture = Stage.rays, Stage.picture
        counted = self

        def count_rays(stage: Stage, starts: Array, ends: Array) -> NDArray[np.int64]:
            counted.rays += len(starts)
            return rays(stage, starts, ends)

        def count_pictures(stage: Stage, camera: Camera, size: tuple[int, int]) -> tuple[Picture, NDArray[np.int64]]:
            counted.small += size[0] <= SIZE[0] // 2
            return picture(stage, camera, size)

        Stage.rays, Stage.picture = count_rays, count_pictures  # type: ignore[method-assign, assignment]


def frames_of(watcher: Watcher, world: World, count: int, evenly: bool) -> Iterator[tuple[Seen, Seen]]:
    """The frames of the recording, from both views; the deed is in the middle of the act, after the way to it."""
    recording = world._recording
    assert recording is not None
    ticks = np.linspace(0, recording.ticks - 1, count).round().astype(int).tolist()
    if not evenly:
        ticks = telling_ticks(recording, world._ground.robots, count)
    views: dict[int, Camera] = {}
    for tick in ticks:
        index, within = recording.find(tick)
        shot = recording.shots[index]
        if index not in views:
            views[index] = watcher._view(recording, shot)
        moment = shot.at(within)
        watcher.drawn.show(recording.state, moment)
        doing = index == len(recording.shots) - 1 and within >= 2 * shot.deed - shot.ticks
        robot, third = (
            looked_at(watcher.drawn, moment, camera)._replace(doing=doing)
            for camera in (watcher._eyes(recording, moment), views[index])
        )
        yield robot, third


def main() -> None:
    """Print a line for each robot, home and view, and draw the contact sheet that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", default="fetch,husky_panda")
    parser.add_argument("--scenes", default="maple,oak")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--evenly", action="store_true", help="equal times in place of distinct frames")
    parser.add_argument("--acts", type=int, default=1000, help="at most so many in each home")
    parser.add_argument("--sheet", type=Path, help="a folder for contact sheets")
    options = parser.parse_args()
    counted = Counted()
    print(f"{'robot':12} {'home':6} {'view':12} acts both-hands one-hand thing person own-body behind difference alike")
    for robot in options.robots.split(","):
        for scene in options.scenes.split(","):
            seen: dict[str, list[list[Seen]]] = defaultdict(list)
            names: list[str] = []
            counted.rays = counted.small = 0
            with World(load_scene(SceneId(scene)), robot=robot, frame_size=SIZE, renderer="tiny") as world:
                for act in every_motion(world)[: options.acts]:
                    if not world.perform(HUMAN, act, record=True).ok:
                        continue
                    assert world._watcher is not None
                    pairs = list(frames_of(world._watcher, world, options.frames, options.evenly))
                    for view, frames in zip(VIEWS, zip(*pairs, strict=True), strict=True):
                        seen[view].append(list(frames))
                    names.append(act.describe())
            for view in VIEWS:
                print(f"{robot:12} {scene:6} {view:12} {figures(seen[view])}")
            rays, small = counted.rays / max(len(names), 1), counted.small / max(len(names), 1)
            print(f"{robot:12} {scene:6} {rays:.0f} rays, {small:.2f} small pictures an act")
            if options.sheet:
                options.sheet.mkdir(parents=True, exist_ok=True)
                sheet(seen, names, options.sheet / f"{robot}-{scene}.webp")


def figures(recordings: list[list[Seen]]) -> str:
    """Shares of the acts' frames; `alike`: of pairs of following frames that differ by less than 2 of 255 a pixel."""
    frames = [frame for one in recordings for frame in one if frame.doing]
    things = [frame.thing for frame in frames if frame.thing is not None]
    pairs = [pair for one in recordings for pair in zip(one, one[1:], strict=False)]
    differ = np.array([np.abs(a.image.astype(int) - b.image).mean() for a, b in pairs] or [0.0])
    values = (
        np.mean([all(frame.hands) for frame in frames]),
        np.mean([any(frame.hands) for frame in frames]),
        np.mean(things or [False]),
        np.mean([frame.person for frame in frames]),
        np.mean([frame.robot for frame in frames]),
        np.mean([frame.angle > 120 for frame in frames]),
    )
    return (
        f"{len(recordings):4} "
        + " ".join(f"{v:8.3f}" for v in values)
        + f" {differ.mean():8.2f} {(differ < 2).mean():8.3f}"
    )


def sheet(seen: dict[str, list[list[Seen]]], names: list[str], out: Path) -> None:
    """A line for each act: the robot's frames, then those of the third person."""
    width, height = SIZE
    longest = max(len(one) for one in seen[VIEWS[0]])
    image = Image.new("RGB", (2 * longest * width + 8, len(names) * (height + 16)), "white")
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(size=12)
    for row, name in enumerate(names):
        draw.text((3, row * (height + 16)), name, fill="black", font=font)
        for part, view in enumerate(VIEWS):
            for k, frame in enumerate(seen[view][row]):
                at = (part * (longest * width + 8) + k * width, row * (height + 16) + 16)
                image.paste(Image.fromarray(frame.image), at)
    image.save(out, "WEBP", quality=60)


if __name__ == "__main__":
    main()
