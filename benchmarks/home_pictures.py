"""Draw the pictures of docs/: every class of thing on one sheet, and the homes that ship, from above and inside.

python -m benchmarks.home_pictures            # docs/objects.webp, docs/homes/*.webp, docs/homes.png
"""

from __future__ import annotations

import math
from pathlib import Path

from PIL import Image, ImageDraw

from coopera.core.household import plain
from coopera.homes.statistics import draw
from coopera.simulation.homes.catalogue import FixedClass, MovableClass, catalogue
from coopera.simulation.homes.scene import Scene, list_scenes, load_scene, rgb_of
from coopera.simulation.making.overview import inside, overview, picture
from coopera.simulation.sight.build import BuiltHome
from coopera.simulation.sight.engine import pybullet

DOCS = Path(__file__).parents[1] / "docs"
_THUMB, _LINE, _COLUMNS = (132, 118), 14, 12
_FOV = 32.0


def sheet() -> Image.Image:
    """Every class of the catalogue from the front and above, each as large as fits, with its name."""
    kinds: list[tuple[str, FixedClass | MovableClass]] = [*catalogue().fixed.items(), *catalogue().movable.items()]
    rows = -(-len(kinds) // _COLUMNS)
    whole = Image.new("RGB", (_COLUMNS * _THUMB[0], rows * (_THUMB[1] + _LINE)), "white")
    pen = ImageDraw.Draw(whole)
    for number, (cls, kind) in enumerate(kinds):
        client = pybullet.connect(pybullet.DIRECT)
        try:
            home = BuiltHome(client)
            home.add("it", cls, kind.size, rgb_of(kind.colours[0]))
            home.move("it", (0.0, 0.0, 0.0), 0.0)
            w, d, h = kind.size
            away = 0.62 * math.hypot(w, d, h) / math.tan(math.radians(_FOV / 2))
            eye = (0.5 * away, 0.72 * away, h / 2 + 0.5 * away)
            pixels = picture(client, eye, (0.0, 0.0, h / 2), _FOV, _THUMB)
        finally:
            pybullet.disconnect(client)
        x, y = number % _COLUMNS * _THUMB[0], number // _COLUMNS * (_THUMB[1] + _LINE)
        whole.paste(Image.fromarray(pixels), (x, y))
        pen.text((x + 4, y + _THUMB[1]), plain(cls), fill="black")
    return whole


def card(scene: Scene) -> Image.Image:
    """A home from above and, below it, each of its rooms from inside."""
    size = (320, 240)
    rows = -(-len(scene.rooms) // 3)
    whole = Image.new("RGB", (960, 720 + rows * (size[1] + _LINE)), "white")
    whole.paste(Image.fromarray(overview(scene)), (0, 0))
    pen = ImageDraw.Draw(whole)
    for number, room in enumerate(scene.rooms):
        x, y = number % 3 * size[0], 720 + number // 3 * (size[1] + _LINE)
        whole.paste(Image.fromarray(inside(scene, room.name, *size)), (x, y))
        pen.text((x + 4, y + size[1]), room.name, fill="black")
    return whole


def main() -> None:
    """Draw everything."""
    (DOCS / "homes").mkdir(exist_ok=True)
    sheet().save(DOCS / "objects.webp", quality=80, method=6)
    homes = [load_scene(home) for home in list_scenes()]
    for scene in homes:
        card(scene).save(DOCS / "homes" / f"{scene.id}.webp", quality=75, method=6)
    draw(homes, DOCS / "homes" / "statistics.png")
    for path in (DOCS / "objects.webp", *sorted((DOCS / "homes").iterdir())):
        print(f"{path.relative_to(DOCS.parent)}: {path.stat().st_size >> 10} kB")


if __name__ == "__main__":
    main()
