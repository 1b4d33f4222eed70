"""The head as fields, in its own frame (x forward, y left, z up, the middle between chin and crown): face, ears, hair.

The hair's fields are whole bodies that hold the head; a face is left open where they are cut.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coopera.core.people import Beard, HairStyle
from coopera.simulation.people.fields import Array, Loft, ball, carve, cone, join, loft, within

EYE = (0.0680, 0.0315, 0.013)
"""The middle of the left eye."""
EYE_SIZE = 0.0125


@dataclass(frozen=True, slots=True)
class Face:
    """What differs between heads; 1 is usual."""

    width: float = 1.0
    length: float = 1.0
    jaw: float = 1.0
    nose: float = 1.0
    lips: float = 1.0
    soft: float = 0.0
    """A rounder brow and chin, 0 to 1."""


_JAW = (
    (-0.096, 0.058, 0.022, 0.032, 0.024),
    (-0.085, 0.046, 0.040, 0.042, 0.041),
    (-0.063, 0.032, 0.056, 0.062, 0.054),
    (-0.035, 0.018, 0.070, 0.082, 0.063),
    (0.000, 0.006, 0.080, 0.094, 0.068),
    (0.035, -0.006, 0.088, 0.090, 0.070),
)
_CRANIUM = ((-0.014, 0.0, 0.030), (0.097, 0.0755, 0.088))


def jaw(face: Face) -> Loft:
    """Chin to brow."""
    rows = []
    for z, x, front, back, side in _JAW:
        low = float(np.clip((-0.02 - z) / 0.07, 0.0, 1.0))
        rows.append([z * face.length, x, front, back, side * face.width * (1 + low * (face.jaw - 1))])
    return loft(rows, 2.15, (0.008, 0.03))


def mirrored(points: Array) -> Array:
    """Points brought to the left side."""
    return np.column_stack((points[:, 0], np.abs(points[:, 1]), points[:, 2]))


def bare(face: Face, jaw_: Loft, points: Array) -> Array:
    """The head without hair."""
    half = mirrored(points)
    (x, y, z), (deep, side, high) = _CRANIUM
    found = join(jaw_.at(points), ball(points, (x, y, z), (deep, side * face.width, high)), 0.03)
    nose, soft = face.nose, face.soft
    found = join(found, ball(half, (0.058, 0.036 * face.width, -0.020), (0.030, 0.027, 0.024)), 0.03)  # cheeks
    found = join(found, ball(half, (0.0745 - 0.004 * soft, 0.026, 0.037), (0.012, 0.028, 0.008)), 0.025)  # brows
    found = join(found, ball(points, (0.063, 0.0, -0.084), (0.025, 0.021 - 0.004 * soft, 0.014)), 0.025)  # chin
    found = join(found, ball(points, (0.064, 0.0, -0.050), (0.026, 0.028, 0.024)), 0.03)  # mouth
    found = carve(found, ball(half, (EYE[0] + 0.022, EYE[1], EYE[2]), (0.017, 0.0165, 0.0105)), 0.016)
    ridge = cone(points, ((0.080, 0, 0.021), (0.1005 + 0.004 * nose, 0, -0.017)), (0.006, 0.0090 * nose))
    wings = ball(half, (0.091, 0.0085 * nose, -0.0225), (0.011, 0.0085 * nose, 0.0075))
    found = join(found, join(ridge, wings, 0.008), 0.012)
    return join(found, ears(face, half), 0.006)


def ears(face: Face, half: Array) -> Array:
    """Both ears, of points on the left side."""
    y = 0.0735 * face.width
    outer = ball(half, (-0.012, y + 0.007, 0.000), (0.0185, 0.0125, 0.031))
    return carve(outer, ball(half, (-0.004, y + 0.019, 0.003), (0.010, 0.008, 0.019)), 0.006)


def _around_ears(half: Array) -> Array:
    """Where short hair leaves the ears free."""
    return ball(half, (-0.008, 0.080, -0.006), (0.022, 0.022, 0.036))


def _cap(skin: Array, points: Array, thick: float, top: float) -> Array:
    """The head made thicker, most at the crown."""
    up = np.clip((points[:, 2] + 0.01) / 0.10, 0.0, 1.0)
    return skin - thick - (top - thick) * up * up


_SIDES = np.array(((-0.10, -0.030), (-0.022, -0.028), (-0.012, 0.013), (0.03, 0.017), (0.055, 0.036), (0.09, 0.050)))
"""How far forward hair grows on the sides of the head: heights, and x."""


def _hairline(points: Array, recede: float, nape: float) -> Array:
    """Negative where hair grows: above the forehead, behind the temples and the ears, and above the nape."""
    x, z = points[:, 0], points[:, 2]
    temple = np.clip((np.abs(points[:, 1]) - 0.014) / 0.03, 0.0, 1.0)
    front = 0.080 + recede * (0.008 + 0.026 * temple) - z
    sides = x - np.interp(z, _SIDES[:, 0], _SIDES[:, 1]) + 0.055 * recede * np.clip((z - 0.025) / 0.05, 0.0, 1.0)
    return np.maximum(join(front, sides, 0.02), (nape - z + 0.6 * np.clip(x + 0.04, 0.0, 0.06)) * 0.8)


def hair(style: HairStyle, recede: float, skin: Array, points: Array, *, edges: bool = True) -> Array | None:
    """The hair of a style, None for a bald head; `skin` are the distances from the bare head.

    Without `edges` it does not end at the hairline.
    """
    if style == "bald":
        return None
    x, y, z = points.T
    line = np.full(len(points), -np.inf)
    if edges:
        line = np.maximum(_hairline(points, recede, -0.062), -_around_ears(mirrored(points)))
    if style == "ring":
        cap = np.maximum(_cap(skin, points, 0.007, 0.007), _hairline(points, 0.0, -0.062))
        return carve(cap, ball(points, (0.03, 0.0, 0.115), (0.115, 0.064, 0.066)), 0.01)
    if style == "cropped":
        return within(_cap(skin, points, 0.004, 0.007), line)
    if style == "short":
        return within(_cap(skin, points, 0.008, 0.018), line)
    if style == "parted":
        groove = ball(points, (0.03, 0.034, 0.122), (0.09, 0.005, 0.014))
        wave = 0.007 * np.clip(-(y - 0.03) / 0.05, 0, 1) * np.clip((z - 0.04) / 0.05, 0, 1)
        return within(carve(_cap(skin, points, 0.008, 0.019) - wave, groove, 0.014), line)
    if style == "curly":
        lumps = 0.004 * (np.sin(x * 150) * np.sin(y * 150 + 1) + np.sin(z * 150 + 2) * np.sin(x * 110 + y * 90))
        puff = ball(points, (-0.022, 0, 0.040), (0.118, 0.112, 0.110))
        face = ball(points, (0.112, 0.0, -0.022), (0.112, 0.074, 0.108 + 0.02 * recede))
        return within(carve(puff, face, 0.03) + lumps, (-0.075 - z) * 0.9)
    if style in ("bun", "ponytail"):
        cap = np.maximum(_cap(skin, points, 0.008, 0.012), line)
        if style == "bun":
            return join(cap, ball(points, (-0.105, 0, 0.075), (0.036, 0.038, 0.034)), 0.015)
        tail = cone(points, ((-0.105, 0, 0.05), (-0.135, 0, 0.0)), (0.022, 0.026))
        end = cone(points, ((-0.135, 0, 0.0), (-0.120, 0, -0.13)), (0.027, 0.012))
        return join(cap, join(tail, end, 0.02), 0.012)
    return _falling(style, recede, skin, points)


_BOB = (
    (-0.105, -0.034, 0.050, 0.056, 0.082),
    (-0.070, -0.032, 0.060, 0.068, 0.090),
    (0.000, -0.026, 0.078, 0.080, 0.086),
    (0.060, -0.018, 0.076, 0.086, 0.076),
)
_LONG = (
    (-0.250, -0.096, 0.018, 0.018, 0.070),
    (-0.190, -0.080, 0.036, 0.030, 0.092),
    (-0.100, -0.050, 0.056, 0.058, 0.090),
    (0.000, -0.026, 0.078, 0.080, 0.086),
    (0.060, -0.018, 0.076, 0.086, 0.076),
)
_OPEN = loft(
    (
        (-0.300, 0.100, 0.200, 0.110, 0.060),
        (-0.115, 0.100, 0.200, 0.092, 0.058),
        (-0.050, 0.100, 0.200, 0.086, 0.0585),
        (0.000, 0.100, 0.200, 0.082, 0.0590),
        (0.040, 0.100, 0.200, 0.072, 0.0545),
        (0.070, 0.100, 0.200, 0.052, 0.038),
        (0.084, 0.100, 0.200, 0.040, 0.016),
    ),
    caps=(0.02, 0.006),
)
"""Where hanging hair leaves the face open."""


def _falling(style: HairStyle, recede: float, skin: Array, points: Array) -> Array:
    """Hair that hangs beside the face: to the jaw, or to the shoulder blades."""
    curtain = loft(_BOB if style == "bob" else _LONG, 2.2, (0.008, 0.03))
    whole = join(_cap(skin, points, 0.009, 0.017), curtain.at(points), 0.02)
    parting = ball(points, (0.03, 0.018, 0.128), (0.085, 0.005, 0.014))
    neck = cone(points, ((0.03, 0, -0.08), (0.03, 0, -0.30)), (0.062, 0.075))
    opened = _OPEN.at(points + np.array((0.0, 0.0, -0.012 * recede)))
    return carve(carve(carve(whole, opened, 0.010), parting, 0.016), neck, 0.015)


def beard(kind: Beard, skin: Array, points: Array) -> Array | None:
    """A beard, None where there is none that stands out."""
    if kind == "shaven":
        return None
    x, _, z = points.T
    half = mirrored(points)
    mouth = ball(points, (0.095, 0, -0.050), (0.05, 0.024, 0.0085))
    lip = np.maximum(ball(half, (0.092, 0.012, -0.0375), (0.014, 0.020, 0.0065)), skin - 0.006)
    if kind == "moustache":
        return lip
    chin = ball(points, (0.072, 0, -0.084), (0.036, 0.032, 0.027))
    if kind == "goatee":
        return join(np.maximum(carve(np.maximum(chin, skin - 0.008), mouth, 0.006), z + 0.058), lip, 0.004)
    edge = (z + 0.036 - 0.45 * (0.088 - x)) * 0.9
    low = np.maximum(np.maximum(skin - 0.008, edge), -0.004 - x)
    return join(carve(low, mouth, 0.006), lip, 0.006)
