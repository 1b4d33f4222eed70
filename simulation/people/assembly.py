"""A dressed person as one mesh: body and clothes, head and hair, hands, feet, each with what carries its vertices."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.bodies.humanoid import ANKLE, SIDES, Frames, Side
from coopera.simulation.people import face as faces_
from coopera.simulation.people.appearance import Appearance
from coopera.simulation.people.clothes import Clothes, Layer, layers
from coopera.simulation.people.ends import Footwear, fingers, foot, palm, toes
from coopera.simulation.people.fields import Array, Field, slopes
from coopera.simulation.people.figure import Figure, Near, rest_frames
from coopera.simulation.people.head import bare, beard, hair, jaw
from coopera.simulation.people.nets import Box, Index, Mesh, clip, surface
from coopera.simulation.people.sweeps import Piece
from coopera.simulation.people.weights import PARTS, shares, strongest

Colour = tuple[float, float, float]

_BODY = Box((-0.34, -0.72, -0.95), (0.46, 0.72, 0.70), 0.026)
_HEAD = Box((-0.20, -0.16, -0.31), (0.14, 0.16, 0.17), 0.0115)
_HAND = Box((-0.06, -0.045, -0.045), (0.06, 0.045, 0.10), 0.0125)
_FOOT = Box((-0.10, -0.07, -0.06), (0.20, 0.07, 0.07), 0.017)
_SOLE = 0.016
_PALE_SOLE = (0.88, 0.87, 0.85)


class Parts(NamedTuple):
    """A mesh as `coopera.simulation.people.skin.Skin` has it; `material` counts in `materials`."""

    vertices: Array
    normals: Array
    colours: Array
    material: Index
    materials: tuple[str, ...]
    parts: NDArray[np.uint8]
    weights: NDArray[np.float32]
    faces: Index
    rest: Frames


class _Carried(NamedTuple):
    """A piece in the rest pose, and the share of each part in its vertices (V, 16)."""

    piece: Piece
    shares: Array


def dressed(appearance: Appearance, clothes: Clothes) -> Parts:
    """A person in clothes."""
    figure = Figure(appearance.measures)
    found = [*_body(figure, appearance.skin, clothes), *_head(appearance)]
    for side in SIDES:
        found += _hand(appearance, side)
        found += _foot(figure, appearance.skin, clothes, side)
    return _together(found)


def _together(found: Sequence[_Carried]) -> Parts:
    counts = [len(one.piece.vertices) for one in found]
    starts = np.cumsum([0, *counts[:-1]])
    names = tuple(sorted({one.piece.material for one in found}))
    parts, weights = strongest(np.concatenate([one.shares for one in found]))
    return Parts(
        np.concatenate([one.piece.vertices for one in found]),
        np.concatenate([one.piece.normals for one in found]),
        np.repeat([one.piece.colour for one in found], counts, axis=0),
        np.repeat([names.index(one.piece.material) for one in found], counts),
        names,
        parts,
        weights,
        np.concatenate([one.piece.faces + start for one, start in zip(found, starts, strict=True)]),
        rest_frames(),
    )


def _split(mesh: Mesh, fields: Callable[[Array], list[Array]]) -> list[Mesh]:
    """A surface cut where another of its fields lies outermost: one mesh for each field, in their order."""
    count = len(fields(mesh.vertices[:1]))
    rest, found = mesh, []
    for number in range(count - 1, 0, -1):

        def apart(points: Array, number: int = number) -> Array:
            values = fields(points)[: number + 1]
            found: Array = values[number] - np.min(values[:number], axis=0)
            return found

        own, rest = clip(rest, apart)
        found.append(own)
    return [rest, *reversed(found)]


def _normals(field: Field, mesh: Mesh) -> Array:
    found = slopes(field, mesh.vertices)
    found /= np.maximum(np.linalg.norm(found, axis=1), 1e-9)[:, None]
    return found


def _piece(mesh: Mesh, field: Field, colour: Colour, material: str) -> Piece:
    return Piece(mesh.vertices, _normals(field, mesh), mesh.faces, colour, material)


def _body(figure: Figure, skin: Colour, clothes: Clothes) -> Iterator[_Carried]:
    """The body and what is worn over it, but head, hands and feet."""
    worn = [Layer(skin, lambda near: near.body), *layers(clothes, figure)]

    def fields(points: Array) -> list[Array]:
        near = Near(figure, points)
        return [layer.at(near) for layer in worn]

    whole = surface(lambda points: np.min(fields(points), axis=0), _BODY)
    wide = 0.09 if clothes.bottom == "skirt" or clothes.top in ("dress", "towel") else 0.02
    for number, (layer, mesh) in enumerate(zip(worn, _split(whole, fields), strict=True)):
        if not len(mesh.faces):
            continue
        parts = [(mesh, layer.colour)]
        if layer.second is not None and layer.mark is not None:
            marked, plain = clip(mesh, partial(_at, figure, layer.mark))
            parts = [(plain, layer.colour), (marked, layer.second)]
        for part, colour in parts:
            piece = _piece(part, partial(_at, figure, layer.at, hems=False), colour, "cloth" if number else "skin")
            yield _Carried(piece, shares(Near(figure, part.vertices), wide if number else 0.02))


def _at(figure: Figure, layer: Callable[[Near], Array], points: Array, *, hems: bool = True) -> Array:
    return layer(Near(figure, points, hems=hems))


def _rigid(piece: Piece, part: str, *, flipped: bool = False) -> _Carried:
    """A piece in the frame of a part, brought to the rest pose and carried by that part alone; or its mirror image."""
    rest = rest_frames()
    vertices, normals, faces = piece.vertices, piece.normals, piece.faces
    if flipped:
        mirror = np.array((1.0, -1.0, 1.0))
        vertices, normals, faces = vertices * mirror, normals * mirror, faces[:, ::-1]
    turn = rest.turn[part]
    placed = piece._replace(vertices=vertices @ turn.T + rest.place[part], normals=normals @ turn.T, faces=faces)
    own = np.zeros((len(vertices), len(PARTS)))
    own[:, PARTS.index(part)] = 1.0
    return _Carried(placed, own)


@lru_cache(maxsize=8)
def _head(looks: Appearance) -> list[_Carried]:
    """The same in all that somebody wears."""
    return list(_parts_of_head(looks))


def _parts_of_head(looks: Appearance) -> Iterator[_Carried]:
    jaw_ = jaw(looks.face)

    def skin_at(points: Array) -> Array:
        return bare(looks.face, jaw_, points)

    def fields(points: Array, *, edges: bool = True) -> list[Array]:
        skin = skin_at(points)
        grown = (hair(looks.hair_style, looks.recede, skin, points, edges=edges), beard(looks.beard, skin, points))
        return [skin, *(one for one in grown if one is not None)]

    whole = surface(lambda points: np.min(fields(points), axis=0), _HEAD)
    for number, mesh in enumerate(_split(whole, fields)):
        if len(mesh.faces):
            colour, material = (looks.hair, "hair") if number else (looks.skin, "skin")
            at: Field = lambda points, number=number: fields(points, edges=False)[number]  # type: ignore[misc]  # noqa: E731
            yield _rigid(_piece(mesh, at, colour, material), "head")
    for piece in _features(looks, skin_at):
        yield _rigid(piece, "head")


def _features(looks: Appearance, skin_at: Field) -> Iterator[Piece]:
    brow = faces_.mixed(looks.hair, (0.12, 0.09, 0.08), 0.35)
    yield from faces_.eyes(looks.skin, looks.iris, brow)
    yield from faces_.brows(skin_at, brow, 1.0 - 0.25 * looks.face.soft)
    yield from faces_.lips(skin_at, looks.skin, looks.face)
    if looks.lined:
        yield from faces_.folds(skin_at, looks.skin)
    if looks.glasses is not None:
        yield from faces_.spectacles(skin_at, (0.10, 0.09, 0.10), looks.glasses == "round")


@lru_cache(maxsize=1)
def _palm() -> tuple[Mesh, Array]:
    mesh = surface(palm, _HAND)
    return mesh, _normals(palm, mesh)


def _hand(looks: Appearance, side: Side) -> Iterator[_Carried]:
    size = (1 + 0.4 * (looks.measures.girth - 1)) * (1 - 0.07 * looks.measures.curves)
    mesh, normals = _palm()
    made = [(mesh.vertices * np.array((size, size, 1.0)), normals, mesh.faces), *fingers(size)]
    for vertices, turned, faces in made:
        piece = Piece(vertices, turned, faces, looks.skin, "skin")
        yield _rigid(piece, f"{side}_hand", flipped=side == "right")


@lru_cache(maxsize=4)
def _shoe(wear: Footwear) -> list[tuple[Mesh, Array, bool]]:
    """The left foot in the ankle's frame: its upper, and, but for a bare foot, its sole."""

    def at(points: Array) -> Array:
        return foot(points, wear)

    whole = surface(at, _FOOT)
    if wear == "bare":
        return [(whole, _normals(at, whole), False)]
    sole, upper = clip(whole, lambda points: points[:, 2] + ANKLE - _SOLE)
    return [(upper, _normals(at, upper), False), (sole, _normals(at, sole), True)]


def _foot(figure: Figure, skin: Colour, clothes: Clothes, side: Side) -> Iterator[_Carried]:
    wear = clothes.footwear
    colour, material = (skin, "skin") if wear == "bare" else (clothes.shoe_colour, "shoe")
    sole = _PALE_SOLE if wear == "trainers" else faces_.mixed(clothes.shoe_colour, (0.05, 0.05, 0.05), 0.6)
    made = [
        Piece(mesh.vertices, normals, mesh.faces, sole if is_sole else colour, material)
        for mesh, normals, is_sole in _shoe(wear)
    ]
    if wear == "bare":
        made += [Piece(*one, skin, "skin") for one in toes()]
    if wear == "slippers":
        made += [Piece(mesh.vertices, normals, mesh.faces, skin, "skin") for mesh, normals, _ in _shoe("bare")]
    for piece in made:
        placed = _rigid(piece, f"{side}_ankle", flipped=side == "right").piece
        yield _Carried(placed, shares(Near(figure, placed.vertices)))
