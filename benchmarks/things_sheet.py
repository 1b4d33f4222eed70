"""Thirty things from the magic box on a sheet: `python -m benchmarks.things_sheet [--out docs/things.webp]`.

The last two are words that nothing is known of: labelled boxes. Also prints how many names of the shipped household
files have a shape of their own, how many look like another class, and how many are boxes.
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from pathlib import Path

import yaml
from PIL import Image, ImageDraw, ImageFont

from coopera import models
from coopera.core.household import SceneId
from coopera.simulation.homes.catalogue import SHAPES
from coopera.simulation.homes.magic_box import shape_of
from coopera.simulation.homes.scene import Room, Scene, SceneObject
from coopera.simulation.sight.recording import Moment
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.state.home_state import HomeState

THINGS = (
    *("fork", "whisk", "rolling pin", "jam jar", "milk carton", "flour bag", "bag of chips", "bread", "slice of cake"),
    *("egg carton", "pizza slice", "carrot", "hammer", "pliers", "cordless drill", "light bulb", "iron", "keyboard"),
    *("gardening gloves", "jeans", "umbrella", "reading glasses", "rubber duck", "chess board", "record player"),
    *("bucket", "vacuum cleaner", "drying rack", "Grandma's harp", "zorble"),
)
TILE, COLUMNS, LINE = (150, 130), 6, 18


def household_names() -> list[str]:
    """What people have in hand in the shipped household files."""
    names: set[str] = set()
    for name in ("household.yaml", "robot_household.yaml"):
        text = (Path(models.__path__[0]) / "offline" / name).read_text(encoding="utf-8")
        names.update(thing for row in yaml.safe_load(text)["activities"] for thing in row["things"])
    return sorted(names)


def room(things: tuple[str, ...]) -> Scene:
    """A bare room with things on its floor, two metres apart."""
    objects = []
    for number, text in enumerate(things, start=1):
        shape = shape_of(text)
        red, green, blue = (round(255 * channel) for channel in shape.rgb)
        place = (2.0 * (number % 6) + 1.0, 2.0 * (number // 6) + 1.0, 0.0)
        objects.append(
            SceneObject(
                id=number,
                name=f"thing_{number:02}",
                cls=shape.cls.replace("'", "")[:80],
                category="thing",
                fixed=False,
                room="studio",
                position=place,
                size=shape.size,
                colour=f"#{red:02x}{green:02x}{blue:02x}",
                yaw=0.0,
                on=None,
            )
        )
    whole = Room(name="studio", kind="laundry room", x0=-1, y0=-1, x1=14, y1=14)
    return Scene(id=SceneId("things"), rooms=[whole], objects=objects)


def main() -> None:
    """Draw the sheet and print the counts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("docs/things.webp"))
    args = parser.parse_args()
    scene = room(THINGS)
    stage = Stage(scene, [], {})
    stage.show(HomeState(scene="things", agents={}), Moment({}, {}, {}))
    rows = math.ceil(len(THINGS) / COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * TILE[0], rows * (TILE[1] + LINE)), "white")
    pen, font = ImageDraw.Draw(sheet), ImageFont.load_default(size=12)
    for number, (text, thing) in enumerate(zip(THINGS, scene.movable, strict=True)):
        x, y, _ = thing.position
        away = 0.75 * math.hypot(*thing.size) / math.tan(math.radians(16))
        eye, target = (x + 0.4 * away, y + 0.62 * away, 0.62 * away), (x, y, thing.size[2] / 2)
        image, _ = stage.picture(Camera(eye, target, 32.0), (2 * TILE[0], 2 * TILE[1]))
        at = (number % COLUMNS * TILE[0], number // COLUMNS * (TILE[1] + LINE))
        sheet.paste(Image.fromarray(image).resize(TILE, Image.Resampling.LANCZOS), at)
        pen.text((at[0] + 3, at[1] + TILE[1] + 1), text, fill="black", font=font)
    stage.close()
    sheet.save(args.out, "WEBP", quality=80, method=6)
    found = [shape_of(name) for name in household_names()]
    kinds = Counter("box" if one.cls not in SHAPES else "drawn" for one in found)
    print(f"{args.out}: {args.out.stat().st_size >> 10} kB; of {len(found)} names {dict(kinds)}")


if __name__ == "__main__":
    main()
