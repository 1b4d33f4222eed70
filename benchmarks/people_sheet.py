"""A contact sheet of the people that ship: `python -m benchmarks.people_sheet [--count 8] [--out docs/people.webp]`.

Each is seen from before, from behind and near, and doing four things, dressed for each.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from coopera.core.household import HUMAN, SceneId
from coopera.core.people import Persona
from coopera.people.shipped import SHIPPED, read_persona
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid_reach import standing
from coopera.simulation.homes.scene import Room, Scene, SceneObject
from coopera.simulation.motions.library import Motion, load_library
from coopera.simulation.motions.poses import Setting, pose_at
from coopera.simulation.people.appearance import appearance_of, outfit_for
from coopera.simulation.people.skin import skinned
from coopera.simulation.shapes.rotations import Array
from coopera.simulation.sight.recording import Moment
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.sight.walks import walking
from coopera.simulation.state.home_state import HomeState, PersonState

TILE = (120, 216)
HEIGHTS = {"stand": (0.0, 0.9), "sit": (0.45, 0.75), "lie": (0.5, None), "floor": (0.0, None)}
FINER = 3
SHOWN = ("do yoga", "meditate", "take a shower", "lie down")


def block(number: int, x: float, size: tuple[float, float, float]) -> SceneObject:
    """A plain piece of furniture of which the body sits, lies or works."""
    name = f"block_{number}"
    where = {"room": "studio", "position": (x, 0.0, 0.0), "size": size, "colour": "#9c8468"}
    return SceneObject.model_validate(
        {"id": number, "name": name, "cls": "block", "category": "block", "fixed": True, **where}
    )


def studio(motion: Motion) -> Scene:
    """A bare room with what a motion needs."""
    support, worktop = HEIGHTS[motion.posture]
    blocks = []
    if motion.posture == "sit":
        blocks.append(block(1, -0.05, (0.42, 0.5, support)))
    if motion.posture == "lie":
        blocks.append(block(1, 0.0, (2.0, 0.9, support)))
    paths = (motion.keys.right, motion.keys.left)
    if worktop is not None and any(path is not None and "surface" in path.frames for path in paths):
        blocks.append(block(2, 0.53, (0.5, 1.1, worktop)))
    room = Room(name="studio", kind="study", x0=-3, y0=-3, x1=3, y1=3)
    return Scene(id=SceneId("studio"), rooms=[room], objects=blocks)


def view(stage: Stage, shown: tuple[Array, str], camera: Camera, yaw: float = 0.0) -> Image.Image:
    """One picture of the person in a pose and a motion's clothes."""
    pose, motion = shown
    moment = Moment({HUMAN: Placed(0.0, 0.0, yaw, pose)}, {}, {}, outfits={HUMAN: outfit_for(motion)})
    state = HomeState(scene="studio", agents={HUMAN: PersonState(spot=(0.0, 0.0), place=(0.0, 0.0))})
    stage.show(state, moment)
    image, _ = stage.picture(camera, (TILE[0] * FINER, TILE[1] * FINER))
    return Image.fromarray(image).resize(TILE, Image.Resampling.LANCZOS)


def around(degrees: float, height: float, distance: float, target: tuple[float, float, float]) -> Camera:
    """A camera that looks at a point from a side; 0 is before the person."""
    angle = math.radians(degrees)
    return Camera((distance * math.cos(angle), distance * math.sin(angle), height), target, 40.0)


def pictures(persona: Persona) -> list[Image.Image]:
    """A person from before, from behind, near, walking, and at each of `SHOWN`."""
    looks = {HUMAN: appearance_of(persona.profile, persona.id, persona.appearance)}
    library = load_library()
    stand = library["stand and wait"]
    stage = Stage(studio(stand), [HUMAN], {}, looks=looks)
    upright = (0.0, 0.0, 0.83)
    found = [
        view(stage, (standing(), ""), around(18, 1.3, 2.5, upright)),
        view(stage, (standing(), ""), around(20, 1.3, 2.5, upright), math.pi),
        view(stage, (standing(), ""), around(22, 1.5, 1.0, (0.0, 0.0, 1.44))),
        view(stage, (walking(0.42, carries=False), ""), around(60, 1.3, 2.5, upright)),
    ]
    stage.close()
    for caption in SHOWN:
        motion = library[caption]
        setting = Setting(*HEIGHTS[motion.posture], motion.posture)
        stage = Stage(studio(motion), [HUMAN], {}, looks=looks)
        low = motion.posture in ("lie", "floor")
        camera = around(50, 1.7, 2.9, (0.0, 0.0, 0.5)) if low else around(40, 1.3, 2.6, (0.1, 0.0, 0.8))
        pose = pose_at(motion, 0.4 * motion.keys.period, setting)
        found.append(view(stage, (pose, caption), camera))
        stage.close()
    return found


def made(people: list[Persona]) -> str:
    """What it takes to make the people's day clothes: medians of vertices, triangles and CPU seconds."""
    skinned.cache_clear()
    found = []
    for persona in people:
        looks = appearance_of(persona.profile, persona.id, persona.appearance)
        start = time.process_time()
        skin = skinned(looks, "day")
        found.append((len(skin.vertices), len(skin.faces), time.process_time() - start))
    vertices, triangles, seconds = (float(np.median(column)) for column in zip(*found, strict=True))
    return f"{vertices:.0f} vertices, {triangles:.0f} triangles, {seconds:.2f} s of CPU for each (medians)"


def main() -> None:
    """Draw the sheet."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=8, help="how many of the people that ship")
    parser.add_argument("--out", type=Path, default=Path("docs/people.webp"))
    args = parser.parse_args()
    people = [read_persona(path) for path in sorted(SHIPPED.glob("*.yaml"))[: args.count]]
    columns, font = 2, ImageFont.load_default(size=13)
    wide, high = TILE[0] * (4 + len(SHOWN)) + 8, TILE[1] + 20
    sheet = Image.new("RGB", (columns * wide, math.ceil(len(people) / columns) * high), "white")
    draw = ImageDraw.Draw(sheet)
    for number, persona in enumerate(people):
        x, y = number % columns * wide, number // columns * high
        for k, picture in enumerate(pictures(persona)):
            sheet.paste(picture, (x + k * TILE[0], y))
        draw.text((x + 3, y + TILE[1] + 1), persona.name, fill="black", font=font)
    sheet.save(args.out, "WEBP", quality=78, method=6)
    size = np.prod(sheet.size)
    print(f"{args.out}: {len(people)} people, {args.out.stat().st_size / 1e3:.0f} kB, {size / 1e6:.1f} megapixels")
    print(made(people))


if __name__ == "__main__":
    main()
