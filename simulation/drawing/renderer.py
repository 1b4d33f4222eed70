"""Draws a scenery with OpenGL: colours, depth and numbers of what is seen, with one shadow from the sun.

Nothing but the state decides a picture: the same scenery and camera give the same bytes on one machine.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.drawing.context import on_context
from coopera.simulation.drawing.lens import Camera, metres_of, projection, reach_of, view_matrix
from coopera.simulation.drawing.light import apart, contact, gates, room_rows, sun_lens
from coopera.simulation.drawing.materials import SIDE, Material, pictures
from coopera.simulation.drawing.scenery import BODY_BITS, Scenery
from coopera.simulation.drawing.sight import in_view, rooms_seen
from coopera.simulation.drawing.stored import Stored
from coopera.simulation.drawing.unheld import finish, render_picture
from coopera.simulation.drawing.view import View
from coopera.simulation.shapes.rotations import Array

Image = NDArray[np.uint8]
Numbers = NDArray[np.int32]
_SHADERS = Path(__file__).parent / "shaders"
_TILE = 2048
"""Larger pictures are drawn in tiles of so many pixels a side."""
_SMALL = 400
"""In pictures of at most so many pixels a side the shadow's texels are about as large as they: fewer make its edge."""
_GROUND = (1.0, 1.0, 1.0)


class Drawn(NamedTuple):
    """A picture, the first row on top; what was not asked for is empty."""

    colour: Image
    """(height, width, 3)."""
    tags: Numbers
    """(height, width): see `scenery.BODY_BITS`; 0 where nothing is."""
    depth: NDArray[np.float32]
    """(height, width): metres along the viewing direction; infinite where nothing is."""


class _Target(NamedTuple):
    """What is drawn into, of one size."""

    frame: Any
    """With tags."""
    plain: Any
    """Colours alone."""
    smooth: Any
    """What `plain` is smoothed into."""
    colour: Any
    depth: Any
    tags: Any
    held: tuple[Any, ...]


class _Kit:
    """What all renderers of a context share: the programs and the pictures of the materials."""

    def __init__(self, context: Any) -> None:
        self.context = context
        text = {path.name: path.read_text(encoding="utf-8") for path in sorted(_SHADERS.iterdir())}
        self._text = text
        self._scenes: dict[tuple[int, bool, bool], Any] = {}
        self.shadow = context.program(vertex_shader=text["shadow.vert"], fragment_shader=text["shadow.frag"])
        self.copy = context.program(vertex_shader=text["copy.vert"], fragment_shader=text["copy.frag"])
        self.copying = context.vertex_array(self.copy, [])
        smooth = context.program(vertex_shader=text["copy.vert"], fragment_shader=text["smooth.frag"])
        self.smoothing = context.vertex_array(smooth, [])
        self.looks = context.texture_array((SIDE, SIDE, len(Material)), 3, pictures().tobytes())
        self.looks.build_mipmaps()
        self.looks.filter = (context.LINEAR_MIPMAP_NEAREST, context.LINEAR)
        self.targets: dict[tuple[int, int], _Target] = {}

    def scene(self, gates: int, *, soft: bool, lies: bool) -> Any:
        """The program that draws rooms into which the sun shines through so many windows at most.

        The processor that stands in for a graphics card works out every branch for every pixel, so what is never taken
        is not to be among them.
        """
        if (gates, soft, lies) not in self._scenes:
            vertices, light = self._text["scene.vert"], self._text["scene.frag"]
            for name, default, value in (("GATES", 3, gates), ("SOFT", True, soft), ("LIES", True, lies)):
                written, chosen = (f"{name} = {str(one).lower()};" for one in (default, value))
                vertices, light = vertices.replace(written, chosen), light.replace(written, chosen)
            program = self.context.program(vertex_shader=vertices, fragment_shader=light)
            for number, name in enumerate(("shadows", "floors", "looks")):
                if name in program:
                    program[name] = number
            self._scenes[gates, soft, lies] = program
        return self._scenes[gates, soft, lies]

    def target(self, size: tuple[int, int]) -> _Target:
        """What to draw a picture of a size into; a few are kept."""
        if size not in self.targets:
            if len(self.targets) >= 6:
                for one in self.targets.pop(next(iter(self.targets))).held:
                    one.release()
            colour = self.context.texture(size, 4)
            colour.repeat_x = colour.repeat_y = False
            smooth = self.context.framebuffer([self.context.renderbuffer(size, 4)])
            tags = self.context.texture(size, 1, dtype="i4")
            depth = self.context.depth_texture(size)
            frame = self.context.framebuffer([colour, tags], depth)
            plain = self.context.framebuffer([colour], depth)
            self.targets[size] = _Target(
                frame,
                plain,
                smooth,
                colour,
                depth,
                tags,
                (*smooth.color_attachments, smooth, frame, plain, colour, tags, depth),
            )
        return self.targets[size]


@lru_cache(maxsize=1)
def _kit(context: Any) -> _Kit:
    return _Kit(context)


def get_ready() -> None:
    """Make what all homes of this process are drawn with, which takes a sixth of a second.

    Raises:
        ConfigError: If there is no OpenGL here.
    """
    on_context(_kit)


class Renderer:
    """Draws one home; `close` it after use."""

    def __init__(self, scenery: Scenery, *, shadow: bool = True) -> None:
        """Bring the home to the graphics card.

        Raises:
            ConfigError: If there is no OpenGL here.
        """
        self.scenery, self.shadow = scenery, shadow
        self._sun = np.array(scenery.sun)
        on_context(self._start)

    def _start(self, context: Any) -> None:
        scene, kit = self.scenery.scene, _kit(context)
        self._kit, self._gates = kit, gates(self.scenery)
        self._fixed = Stored(context, kit.shadow, self.scenery.fixed)
        self._moving: Stored | None = None
        self._rooms = room_rows(self.scenery)
        floors = contact(self.scenery)
        self._floors = context.texture(floors.shape[::-1], 1, floors.tobytes(), alignment=1)
        self._floors.repeat_x = self._floors.repeat_y = False
        b = scene.bounds
        self._ground = (b.x0, b.y0, 1 / (b.x1 - b.x0), 1 / (b.y1 - b.y0))
        self._sunlens, self._deep, size = sun_lens(self.scenery)
        self._still = context.framebuffer(depth_attachment=_shadow_texture(context, size))
        self._all = context.framebuffer(depth_attachment=_shadow_texture(context, size))
        if self.shadow:
            self._cast_fixed(context)

    def _cast_fixed(self, context: Any) -> None:
        """Cast the shadows of all that stands fast."""
        self._still.use()
        context.enable_only(context.DEPTH_TEST)
        self._still.clear(depth=1.0)
        self._kit.shadow["lens"].write(_columns(self._sunlens))
        self._fixed.draw(self._fixed.cast, np.flatnonzero(self._fixed.casts))

    def close(self) -> None:
        """Give the graphics card's memory back; a second time does nothing."""
        if self._fixed.pieces:
            on_context(self._release)

    def _release(self, _: Any) -> None:
        self._fixed.set([])
        for store in (self._fixed, self._moving):
            if store is not None:
                store.release()
        self._floors.release()
        for frame in (self._still, self._all):
            frame.depth_attachment.release()
            frame.release()

    def draw(self, camera: Camera, size: tuple[int, int], *, tags: bool = False, depth: bool = False) -> Drawn:
        """Draw a picture of the scenery as it is now, with what else is asked for."""

        def drawn(context: Any) -> Drawn:
            self._update(context)
            return self._draw(context, camera, size, tags, depth)

        return on_context(drawn)

    def view(self, camera: Camera, size: tuple[int, int], names: Mapping[int, str]) -> View:
        """Draw a picture with all that is known of it; `names` are those of the bodies, by number."""
        drawn = self.draw(camera, size, tags=True, depth=True)
        classes = (drawn.tags >> BODY_BITS).astype(np.int64)
        return View(
            camera, drawn.colour, drawn.depth, bodies_of(drawn.tags), classes, dict(names), [*self.scenery.classes]
        )

    def _draw(self, context: Any, camera: Camera, size: tuple[int, int], tags: bool, depth: bool) -> Drawn:
        width, height = size
        found = Drawn(
            np.zeros((height, width, 3), dtype=np.uint8),
            np.zeros((height, width) if tags else (0, 0), dtype=np.int32),
            np.zeros((height, width) if depth else (0, 0), dtype=np.float32),
        )
        for top in range(0, height, _TILE):
            for left in range(0, width, _TILE):
                tile = (left, top, min(_TILE, width - left), min(_TILE, height - top))
                self._draw_tile(context, camera, size, tile, found)
        return found

    def _update(self, context: Any) -> None:
        """Bring what has moved to the graphics card, and cast its shadow."""
        stirred = self.scenery.stirred
        if stirred == []:
            return
        batch = self.scenery.moving()
        if self._moving is not None and self._moving.holds(batch):
            self._moving.rewrite(batch)
        else:
            if self._moving is not None:
                self._moving.release()
            self._moving = Stored(context, self._kit.shadow, batch) if len(batch.vertices) else None
        if self.shadow:
            self._cast_moving(context, stirred)

    def _cast_moving(self, context: Any, stirred: list[tuple[Any, Any]] | None) -> None:
        """Cast the shadows of what moves anew, where something has."""
        whole = (0, 0, *self._all.size)
        parts = [whole]
        if stirred is not None:
            low, high = self._on_map(np.array([box[0] for box in stirred]), np.array([box[1] for box in stirred]))
            parts = apart(np.concatenate((low, high), axis=1).clip(whole[:2] * 2, whole[2:] * 2))
        begin = end = np.zeros((0, 2), dtype=np.int64)
        if self._moving is not None and self._moving.pieces:
            begin, end = self._on_map(self._moving.low, self._moving.high)
        self._all.use()
        for x0, y0, x1, y1 in parts:
            self._all.scissor = (x0, y0, x1 - x0, y1 - y0)
            context.enable_only(context.DEPTH_TEST)
            context.depth_func = "1"
            self._still.depth_attachment.use(0)
            render_picture(self._kit.copying)
            context.depth_func = "<"
            self._kit.shadow["lens"].write(_columns(self._sunlens))
            if self._moving is not None and len(begin):
                near = (begin < (x1, y1)).all(axis=1) & (end > (x0, y0)).all(axis=1)
                self._moving.draw(self._moving.cast, np.flatnonzero(near & self._moving.casts))
        self._all.scissor = None

    def _on_map(self, low: Array, high: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The texels of the shadow map, from and to, that boxes cover."""
        sides = np.stack((low, high), axis=1)
        corners = np.stack([sides[:, pick, (0, 1, 2)] for pick in product((0, 1), repeat=3)], axis=1)
        flat = corners @ self._sunlens[:2, :3].T + self._sunlens[:2, 3]
        texels = (flat * 0.5 + 0.5) * np.array(self._all.size)
        begin, end = np.floor(texels.min(axis=1)) - 1, np.ceil(texels.max(axis=1)) + 1
        return begin.astype(np.int64), end.astype(np.int64)

    def _draw_tile(
        self, context: Any, camera: Camera, size: tuple[int, int], tile: tuple[int, int, int, int], found: Drawn
    ) -> None:
        reach = reach_of(camera)
        lens = projection(camera, size, tile, reach) @ view_matrix(camera)
        target = self._kit.target(tile[2:])
        frame = target.frame if found.tags.size else target.plain
        frame.use()
        frame.clear(*_GROUND, 1.0, depth=1.0)
        if found.tags.size:
            target.tags.write(bytes(4 * tile[2] * tile[3]))
        context.enable_only(context.DEPTH_TEST)
        (self._all if self.shadow else self._still).depth_attachment.use(0)
        self._floors.use(1)
        self._kit.looks.use(2)
        programs = [self._kit.scene(self._gates, soft=max(size) > _SMALL, lies=lies) for lies in (False, True)]
        sunwards = _columns(_TO_UNIT @ self._sunlens)
        for program in programs:
            program["lens"].write(_columns(lens))
            program["sunwards"].write(sunwards)
            program["sun"] = (*self._sun.tolist(), self._deep)
            program["eye"] = camera.eye
            program["shadowed"] = self.shadow
        programs[True]["ground"] = self._ground
        rooms = rooms_seen(self.scenery.scene, camera)
        for store in (self._moving, self._fixed):  # what is before the rest first: what it hides costs no light then
            if store is not None:
                seen = in_view(self.scenery.scene, camera, lens, store, rooms)
                for program, some in zip(programs, (seen[~store.lies[seen]], seen[store.lies[seen]]), strict=True):
                    self._draw_rooms(store, program, some)
        self._read_tile(context, target, tile, found, reach)

    def _draw_rooms(self, store: Stored, program: Any, chosen: NDArray[np.int64]) -> None:
        """Draw stretches by a program room by room, the room of the first one first."""
        rooms = store.room[chosen]
        for room in dict.fromkeys(rooms.tolist()):
            program["indoors"] = room >= 0
            program["room"].write(self._rooms[room].tobytes())
            store.draw(store.seen(program), chosen[rooms == room])

    def _read_tile(
        self,
        context: Any,
        target: _Target,
        tile: tuple[int, int, int, int],
        found: Drawn,
        reach: tuple[float, float],
    ) -> None:
        """Smooth what was drawn, and put it in its place."""
        left, top, width, height = tile
        part = (slice(top, top + height), slice(left, left + width))
        target.smooth.use()
        context.enable_only(context.NOTHING)
        target.colour.use(0)
        render_picture(self._kit.smoothing)
        finish(context)
        raw = np.frombuffer(target.smooth.read(components=3, alignment=1), dtype=np.uint8)
        found.colour[part] = raw.reshape(height, width, 3)[::-1]
        if found.tags.size:
            tags = np.frombuffer(target.tags.read(alignment=1), dtype=np.int32).reshape(height, width)
            found.tags[part] = tags[::-1]
        if found.depth.size:
            depth = np.frombuffer(target.depth.read(alignment=1), dtype=np.float32).reshape(height, width)[::-1]
            found.depth[part] = metres_of(depth, reach)


_TO_UNIT = np.array(((0.5, 0, 0, 0.5), (0, 0.5, 0, 0.5), (0, 0, 0.5, 0.5), (0, 0, 0, 1.0)))


def bodies_of(tags: Numbers) -> NDArray[np.int64]:
    """The body of each tag, -1 for none."""
    return (tags & ((1 << BODY_BITS) - 1)).astype(np.int64) - 1


def _columns(matrix: Array) -> bytes:
    """A matrix as OpenGL reads it."""
    return matrix.T.astype("f4").tobytes()


def _shadow_texture(context: Any, size: tuple[int, int]) -> Any:
    texture = context.depth_texture(size)
    texture.compare_func = ""
    texture.filter = (context.NEAREST, context.NEAREST)
    texture.repeat_x = texture.repeat_y = False
    return texture
