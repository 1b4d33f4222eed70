"""Draw the pictures of docs/: every class of thing on one sheet, and the homes that ship, from above and inside.

python -m benchmarks.home_pictures            # docs/objects.webp, docs/homes/*.webp, docs/renderers.webp
"""

from __future__ import annotations

import math
from pathlib import Path

from PIL import Image, ImageDraw

from coopera.core.household import SceneId, plain
from coopera.homes.statistics import draw
from coopera.simulation.drawing.context import Renderer as Name
from coopera.simulation.drawing.lens import Camera
from coopera.simulation.drawing.renderer import Renderer
from coopera.simulation.drawing.scenery import Scenery, shape_mesh
from coopera.simulation.homes.catalogue import FixedClass, MovableClass, catalogue
from coopera.simulation.homes.scene import Room, Scene, list_scenes, load_scene, rgb_of
from coopera.simulation.making.overview import inside, overview
from coopera.simulation.shapes.rotations import about_z

DOCS = Path(__file__).parents[1] / "docs"
_THUMB, _LINE, _COLUMNS = (132, 118), 14, 12
_FOV = 32.0
ROOMS = (("pine", "kitchen"), ("maple", "bedroom"), ("willow", "sunroom"), ("oak", "living room"))
RENDERERS: tuple[Name, ...] = ("tiny", "gl")


def sheet() -> Image.Image:
    """Every class of the catalogue from the front and above, each as large as fits, with its name."""
    kinds: list[tuple[str, FixedClass | MovableClass]] = [*catalogue().fixed.items(), *catalogue().movable.items()]
    rows = -(-len(kinds) // _COLUMNS)
    whole = Image.new("RGB", (_COLUMNS * _THUMB[0], rows * (_THUMB[1] + _LINE)), "white")
    pen = ImageDraw.Draw(whole)
    studio = Room(name="studio", kind="studio", x0=-9, y0=-9, x1=9, y1=9)
    scenery = Scenery(Scene(id=SceneId("studio"), rooms=[studio], objects=[]), {})
    drawer = Renderer(scenery)
    for number, (cls, kind) in enumerate(kinds):
        w, d, h = kind.size
        away = 0.62 * math.hypot(w, d, h) / math.tan(math.radians(_FOV / 2))
        camera = Camera((0.5 * away, 0.72 * away, h / 2 + 0.5 * away), (0.0, 0.0, h / 2), _FOV)
        scenery.add("it", shape_mesh(cls, kind.size, rgb_of(kind.colours[0])), 0, cls)
        scenery.put("it", (0.0, 0.0, 0.0), about_z(0.0))
        pixels = drawer.draw(camera, _THUMB).colour
        scenery.remove("it")
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


def old_and_new() -> Image.Image:
    """Some rooms as tiny draws them, and below each as gl does."""
    wide, high = 320, 240
    whole = Image.new("RGB", (wide * len(ROOMS), 2 * high + _LINE), "white")
    pen = ImageDraw.Draw(whole)
    for column, (home, room) in enumerate(ROOMS):
        for row, renderer in enumerate(RENDERERS):
            pixels = inside(load_scene(home), room, 2 * wide, 2 * high, renderer=renderer)
            small = Image.fromarray(pixels).resize((wide, high), Image.Resampling.LANCZOS)
            whole.paste(small, (column * wide, row * high))
        pen.text((column * wide + 4, 2 * high), f"{home}, {room}: tiny above, gl below", fill="black")
    return whole


def main() -> None:
    """Draw everything."""
    (DOCS / "homes").mkdir(exist_ok=True)
    sheet().save(DOCS / "objects.webp", quality=80, method=6)
    homes = [load_scene(home) for home in list_scenes()]
    for scene in homes:
        card(scene).save(DOCS / "homes" / f"{scene.id}.webp", quality=75, method=6)
    draw(homes, DOCS / "homes" / "statistics.png")
    old_and_new().save(DOCS / "renderers.webp", quality=78, method=6)
    for path in (DOCS / "objects.webp", DOCS / "renderers.webp", *sorted((DOCS / "homes").iterdir())):
        print(f"{path.relative_to(DOCS.parent)}: {path.stat().st_size >> 10} kB")


if __name__ == "__main__":
    main()
