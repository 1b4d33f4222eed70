"""What a face has beside its skin: eyes with lids, brows, lips, and spectacles; in the head's own frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coopera.simulation.people.fields import Array, Field
from coopera.simulation.people.head import EYE, EYE_SIZE, Face
from coopera.simulation.people.sweeps import Piece, grid_faces, ordered, patch, tube

Colour = tuple[float, float, float]

_WHITE, _PUPIL = (0.93, 0.92, 0.90), (0.04, 0.03, 0.03)
_RINGS = ((0.0, 15.0), (15.0, 33.0), (33.0, 85.0))
"""Pupil, iris and white, in degrees from where the eye looks."""


def mixed(first: Colour, second: Colour, share: float) -> Colour:
    """A colour between two."""
    return tuple(float(a + share * (b - a)) for a, b in zip(first, second, strict=True))  # type: ignore[return-value]


def eyes(skin: Colour, iris: Colour, brow: Colour) -> Iterator[Piece]:
    """Both eyes, their lids and lashes."""
    for sign in (1.0, -1.0):
        centre = np.array(EYE) * (1.0, sign, 1.0)
        for (start, stop), colour in zip(_RINGS, (_PUPIL, iris, _WHITE), strict=True):
            yield _cup(centre, EYE_SIZE, (start, stop), colour)
        lid = mixed(skin, (0.35, 0.2, 0.18), 0.18)
        yield _lid(centre, EYE_SIZE * 1.10, (88.0, 27.0), lid)
        yield _lid(centre, EYE_SIZE * 1.12, (33.0, 24.0), mixed(brow, (0.05, 0.04, 0.04), 0.6))
        yield _lid(centre, EYE_SIZE * 1.08, (-30.0, -80.0), lid)


def _cup(centre: Array, radius: float, between: tuple[float, float], colour: Colour) -> Piece:
    """A ring of a ball that looks ahead."""
    angles, rounds = np.radians(np.linspace(*between, 3)), np.linspace(0, 2 * np.pi, 12, endpoint=False)
    out, around = np.meshgrid(angles, rounds, indexing="ij")
    normals = np.stack((np.cos(out), np.sin(out) * np.cos(around), np.sin(out) * np.sin(around)), axis=-1)
    normals = normals.reshape(-1, 3)
    return Piece(*ordered((centre + radius * normals, normals, grid_faces(3, 12, closed=True))), colour, "eye")


def _lid(centre: Array, radius: float, between: tuple[float, float], colour: Colour) -> Piece:
    """A part of a ball between two heights (degrees), ahead."""
    heights, turns = np.radians(np.linspace(*between, 4)), np.radians(np.linspace(80.0, -80.0, 9))
    up, turn = np.meshgrid(heights, turns, indexing="ij")
    up = up * np.cos(turn * 0.8)
    normals = np.stack((np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)), axis=-1).reshape(-1, 3)
    return Piece(*ordered((centre + radius * normals, normals, grid_faces(4, 9, closed=False))), colour, "skin")


def brows(field: Field, colour: Colour, thick: float) -> Iterator[Piece]:
    """Both brows."""
    share = np.linspace(0.0, 1.0, 8)
    for sign in (1.0, -1.0):
        y = sign * (0.0125 + 0.037 * share)
        z = 0.0365 + 0.0085 * np.sin(share * 2.3) - 0.003 * share
        half = 0.0042 * thick * (1.0 - 0.65 * share**1.5)
        middle = np.stack((y, z), axis=1)
        if sign > 0:
            middle, half = middle[::-1], half[::-1]
        yield Piece(*ordered(patch(field, middle[::-1], half[::-1], 0.0035)), colour, "hair")


def lips(field: Field, skin: Colour, face: Face) -> Iterator[Piece]:
    """Upper and lower lip, and the line between them."""
    red = mixed(skin, (0.62, 0.20, 0.20), 0.40)
    share = np.linspace(-1.0, 1.0, 11)
    y, bow = 0.0235 * share, 1.0 - share**2
    line = -0.0478 + 0.0020 * share**2
    full = 0.0046 * face.lips
    upper = full * bow**0.7 * (1.0 - 0.25 * np.exp(-((share / 0.16) ** 2))) * 0.55 + 0.0002
    lower = full * bow**0.6 * 0.72 + 0.0002
    for middle, half, lift in ((line + upper, upper, 0.0030), (line - lower, lower, 0.0036)):
        yield Piece(*ordered(patch(field, np.stack((y, middle), axis=1), half, lift * face.lips)), red, "skin")
    thin = np.full(len(y), 0.0009)
    dark = mixed(red, (0.15, 0.05, 0.05), 0.6)
    yield Piece(*ordered(patch(field, np.stack((y * 1.04, line), axis=1), thin, 0.0026)), dark, "skin")


def folds(field: Field, skin: Colour) -> Iterator[Piece]:
    """The lines from nose to mouth, and on the forehead, of old age."""
    dark = mixed(skin, (0.25, 0.12, 0.10), 0.30)
    share = np.linspace(0.0, 1.0, 6)
    for sign in (1.0, -1.0):
        middle = np.stack((sign * (0.019 + 0.014 * share), -0.020 - 0.028 * share), axis=1)
        yield Piece(*ordered(patch(field, middle, 0.0016 * np.sin(share * 2.6 + 0.3), 0.0008)), dark, "skin")
    for z in (0.055, 0.064):
        y = np.linspace(-0.032, 0.032, 8)
        half = 0.0011 * np.cos(y / 0.022)
        yield Piece(*ordered(patch(field, np.stack((y, z - y * y * 2), axis=1), half, 0.0006)), dark, "skin")


def spectacles(field: Field, colour: Colour, round_: bool) -> Iterator[Piece]:
    """Two rims, a bridge, and the temples to the ears."""
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    power = 1.0 if round_ else 0.6
    y = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** power * 0.0225
    z = np.sign(np.sin(angle)) * np.abs(np.sin(angle)) ** power * (0.0195 if round_ else 0.0155)
    ahead = EYE[0] + EYE_SIZE + 0.010
    for sign in (1.0, -1.0):
        x = ahead - 0.006 * ((y + 0.0225) / 0.045) ** 2
        rim = np.stack((x, sign * (EYE[1] + 0.001 + y), EYE[2] - 0.002 + z), axis=1)
        yield Piece(*ordered(tube(rim, np.full(16, 0.0017), 5, closed=True)), colour, "glasses")
        side = np.array(
            ((ahead - 0.006, 0.055, 0.015), (0.062, 0.0735, 0.015), (0.0, 0.0795, 0.017), (-0.02, 0.080, 0.010))
        )
        side = side * (1.0, sign, 1.0)
        yield Piece(*ordered(tube(side, np.full(4, 0.0017), 5)), colour, "glasses")
    bridge = np.array(((ahead, 0.0095, 0.015), (ahead + 0.003, 0.0, 0.017), (ahead, -0.0095, 0.015)))
    yield Piece(*ordered(tube(bridge, np.full(3, 0.0016), 5)), colour, "glasses")
