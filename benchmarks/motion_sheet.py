"""A contact sheet of all motions: `python -m benchmarks.motion_sheet [--motions DIR] [--out docs/motions.webp]`.

Each motion is shown at three moments of its cycle, with a plain thing in hand. Sitting motions get a seat, lying
motions a bed, and motions at a worktop get a worktop.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from coopera.core.household import HUMAN, SceneId
from coopera.simulation.acts.plans import Placed
from coopera.simulation.homes.magic_box import shape_of
from coopera.simulation.homes.scene import Room, Scene, SceneObject
from coopera.simulation.motions.holding import grip
from coopera.simulation.motions.library import Motion
from coopera.simulation.motions.poses import Setting, pose_at
from coopera.simulation.motions.user_folder import load_motions
from coopera.simulation.sight.recording import Held, Moment
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.state.home_state import HomeState, PersonState

TILE = (104, 132)
COLUMNS = 4
SHARES = (0.0, 0.33, 0.66)
THING = "water bottle"
HEIGHTS = {"stand": (0.0, 0.9), "sit": (0.45, 0.75), "lie": (0.5, None), "floor": (0.0, None)}


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


def pictures(motion: Motion) -> list[Image.Image]:
    """The motion at its moments, seen from the front left."""
    support, worktop = HEIGHTS[motion.posture]
    setting = Setting(support, worktop, motion.posture)
    shape = shape_of(THING)
    setting, how = grip(motion, setting, [THING, shape.cls], shape.size, None)
    stage = Stage(studio(motion), [HUMAN], {})
    state = HomeState(scene="studio", agents={HUMAN: PersonState(spot=(0.0, 0.0), place=(0.0, 0.0))})
    low = motion.posture in ("lie", "floor")
    target = (0.1, 0.0, 0.55 if low else 0.8)
    distance = 2.7 if low else 2.4
    angle = math.radians(48)
    eye = (distance * math.cos(angle), distance * math.sin(angle), 1.6)
    found = []
    for share in SHARES:
        body = Placed(0.0, 0.0, 0.0, pose_at(motion, share * motion.keys.period, setting))
        stage.show(state, Moment({HUMAN: body}, {HUMAN: Held(THING, how)}, {}))
        image, _ = stage.picture(Camera(eye, target, 44.0), (TILE[0] * 2, TILE[1] * 2))
        found.append(Image.fromarray(image).resize(TILE, Image.Resampling.LANCZOS))
    stage.close()
    return found


def main() -> None:
    """Draw the sheet."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--motions", type=Path, help="a folder of clips of one's own")
    parser.add_argument("--out", type=Path, default=Path("docs/motions.webp"))
    args = parser.parse_args()
    motions = load_motions(args.motions).motions
    wide, high = TILE[0] * len(SHARES) + 8, TILE[1] + 20
    rows = math.ceil(len(motions) / COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * wide, rows * high), "white")
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(size=13)
    for number, motion in enumerate(motions):
        x, y = number % COLUMNS * wide, number // COLUMNS * high
        for k, picture in enumerate(pictures(motion)):
            sheet.paste(picture, (x + k * TILE[0], y))
        draw.text((x + 3, y + TILE[1] + 1), motion.caption, fill="black", font=font)
    sheet.save(args.out, "WEBP", quality=70, method=6)
    size = np.prod(sheet.size)
    print(f"{args.out}: {len(motions)} motions, {args.out.stat().st_size / 1e3:.0f} kB, {size / 1e6:.1f} megapixels")


if __name__ == "__main__":
    main()
