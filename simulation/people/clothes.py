"""What is worn over the body: fields a little outside those of the figure, ended by hems, necklines and cuffs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from coopera.simulation.bodies.humanoid import SHIN, SIDES, THIGH
from coopera.simulation.people.ends import Footwear
from coopera.simulation.people.fields import Array, ball, carve, cone, join, loft
from coopera.simulation.people.figure import Figure, Near

Colour = tuple[float, float, float]
Top: TypeAlias = Literal[
    "nothing",
    "tee",
    "polo",
    "jumper",
    "shirt",
    "blouse",
    "cardigan",
    "hoodie",
    "tank",
    "dress",
    "pyjamas",
    "swimsuit",
    "towel",
]
Bottom: TypeAlias = Literal["nothing", "trousers", "slim", "shorts", "skirt", "trunks"]


@dataclass(frozen=True, slots=True)
class Clothes:
    """What somebody wears, and its colours; `accent` is that of a band, an undershirt or a collar."""

    top: Top = "nothing"
    bottom: Bottom = "nothing"
    footwear: Footwear = "bare"
    top_colour: Colour = (0.5, 0.5, 0.5)
    bottom_colour: Colour = (0.2, 0.2, 0.3)
    shoe_colour: Colour = (0.1, 0.1, 0.1)
    accent: Colour = (0.9, 0.9, 0.9)
    banded: bool = False


class Layer(NamedTuple):
    """One thing worn: where it is, and where it has its second colour (negative there), if it has one."""

    colour: Colour
    at: Callable[[Near], Array]
    second: Colour | None = None
    mark: Callable[[Near], Array] | None = None


class _Cut(NamedTuple):
    """How a top is cut: looseness (metres), sleeves, where it ends below, and its neckline."""

    ease: float
    sleeves: Literal["long", "short", "bare"]
    hem: float = -0.055
    neck: Literal["crew", "vee", "scoop", "strapless"] = "crew"
    fill: float = 0.6
    """How much of the waist it hides."""


_CUTS: dict[str, _Cut] = {
    "tee": _Cut(0.010, "short"),
    "polo": _Cut(0.010, "short", neck="vee"),
    "jumper": _Cut(0.017, "long", fill=0.8),
    "shirt": _Cut(0.013, "long", neck="vee"),
    "blouse": _Cut(0.011, "long", -0.03, "vee", 0.3),
    "cardigan": _Cut(0.018, "long", -0.07, fill=0.7),
    "hoodie": _Cut(0.019, "long", -0.05, fill=0.9),
    "tank": _Cut(0.010, "bare", -0.03, "scoop", 0.1),
    "dress": _Cut(0.010, "short", -0.03, "scoop", 0.15),
    "pyjamas": _Cut(0.020, "long", -0.065, "vee", 0.9),
    "swimsuit": _Cut(0.006, "bare", -0.20, "scoop", 0.0),
    "towel": _Cut(0.012, "bare", -0.10, "strapless", 0.7),
}
_COLLARED = ("polo", "shirt", "pyjamas")


def layers(clothes: Clothes, figure: Figure) -> list[Layer]:
    """Everything worn but shoes."""
    found: list[Layer] = []
    if clothes.bottom != "nothing":
        found.append(Layer(clothes.bottom_colour, _bottom(clothes.bottom)))
    if clothes.top == "nothing":
        return found
    cut = _CUTS[clothes.top]
    body = Torso(figure, cut, None if clothes.bottom == "nothing" else _bottom(clothes.bottom))
    shade = (0.90 * clothes.top_colour[0], 0.90 * clothes.top_colour[1], 0.90 * clothes.top_colour[2])
    if clothes.top == "cardigan":
        under = Torso(figure, _Cut(0.007, "bare", -0.02))
        found.append(Layer(clothes.accent, under.at))
        found.append(Layer(clothes.top_colour, lambda near: near.cut(body.at(near), -_opening(near))))
    elif clothes.top in _COLLARED:
        trim = clothes.accent if clothes.top != "shirt" else shade
        found.append(Layer(clothes.top_colour, body.at, trim, _placket))
        found.append(Layer(clothes.top_colour if clothes.top == "shirt" else clothes.accent, _collar))
    elif clothes.top == "hoodie":
        found.append(Layer(clothes.top_colour, lambda near: _hooded(near, body.at(near)), shade, _pocket))
    elif clothes.top in ("dress", "towel"):
        skirt = _skirt(0.34 if clothes.top == "dress" else 0.20, cut.ease)
        found.append(Layer(clothes.top_colour, lambda near: join(body.at(near), skirt(near), 0.03)))
    else:
        band = clothes.accent if clothes.banded else None
        found.append(Layer(clothes.top_colour, body.at, band, _band if clothes.banded else None))
    return found


class Torso:
    """A top over a figure's trunk and arms."""

    def __init__(self, figure: Figure, cut: _Cut, over: Callable[[Near], Array] | None = None) -> None:
        """Widen the figure's cross-sections, and let the cloth hang over waist and belly, and over trousers."""
        self.figure, self.cut, self._over = figure, cut, over
        rows = np.array(figure.trunk_rows)
        z = rows[:, 0]
        for column in (2, 3, 4):
            low, high = np.interp((0.02, 0.37), z, rows[:, column])
            hull = np.interp(z, (0.02, 0.37), (low, high))
            hangs = (z > 0.02) & (z < 0.37)
            rows[hangs, column] += cut.fill * np.maximum(hull - rows[:, column], 0.0)[hangs]
        rows[:, 2:] += cut.ease
        self.loft = loft(rows.tolist(), 2.3, (0.05, 0.03))

    def at(self, near: Near) -> Array:
        """How far points are from it."""
        cut, ease = self.cut, self.cut.ease
        found = join(self.loft.at(near.points), near.girdle - ease, 0.05)
        for centre, radii in self.figure.balls():
            wider = tuple(radius + ease for radius in radii)
            found = join(found, ball(near.points, centre, wider), 0.07)
        z = near.points[:, 2]
        if cut.sleeves == "bare":
            found = near.cut(found, self._armholes(near))
        else:
            found = join(found, self._sleeves(near), 0.05)
        below = near.legs - ease - 0.003 if self._over is None else self._over(near) - 0.005
        found = join(found, below, 0.04)
        found = near.cut(found, cut.hem - z if cut.hem > -0.15 else _legholes(near))
        open_ = _neckline(cut.neck, near)
        close = np.clip(1.0 - open_ / 0.05, 0.0, 1.0)  # cloth lies close to the skin where it ends at the neck
        found = found + close * close * (near.body - 0.004 - found)
        return near.cut(found, -open_)

    def _sleeves(self, near: Near) -> Array:
        ends: list[Array] = []
        for side in SIDES:
            down = np.clip(-near.local(f"{side}_shoulder")[:, 2] / 0.12, 0.0, 1.0)
            arm = near.arm(side) - self.cut.ease * (0.35 + 0.65 * down)
            if self.cut.sleeves == "long":
                thick = self.cut.ease * 0.5 + 0.032
                cuff = cone(near.local(f"{side}_elbow"), ((0, 0, -0.02), (0, 0, -0.25)), (thick + 0.010, thick))
                end = -0.236 - near.local(f"{side}_elbow")[:, 2]
                ends.append(near.cut(join(arm, cuff, 0.02), end))
            else:
                local = near.local(f"{side}_shoulder")
                wide = cone(local, ((0, 0, -0.06), (0, 0, -0.2)), (0.050, 0.060))
                ends.append(near.cut(join(arm, wide, 0.02), -0.150 - local[:, 2]))
        return np.minimum(*ends)

    def _armholes(self, near: Near) -> Array:
        """Positive outside what a top without sleeves covers at the shoulders."""
        if self.cut.neck == "strapless":
            return np.full(len(near.points), -1.0)
        beyond = np.abs(near.points[:, 1]) - 0.135 * self.figure.measures.shoulders
        below = 0.30 - near.points[:, 2]
        return np.minimum(beyond, -below * 0.7 + 0.02)


def _neckline(kind: str, near: Near) -> Array:
    """Negative where a top leaves the neck open."""
    points = near.points
    if kind == "strapless":
        return 0.335 - points[:, 2]
    around = ball(points, (0.010, 0.0, 0.514), (0.078, 0.078, 0.070))
    if kind == "vee":
        slot = np.maximum(np.abs(points[:, 1]) * 0.9 - (points[:, 2] - 0.375) * 0.42, -points[:, 0])
        return join(around, slot, 0.01)
    if kind == "scoop":
        return join(around, ball(points, (0.09, 0, 0.475), (0.09, 0.088, 0.095)), 0.02)
    return around


def _legholes(near: Near) -> Array:
    """Positive beyond a swimsuit's end at the hips: high at the sides, low between the legs."""
    points = near.points
    found: Array = (-0.095 + 0.62 * np.abs(points[:, 1]) - points[:, 2]) * 0.8
    return found


def _collar(near: Near) -> Array:
    """A folded collar, open ahead."""
    local = near.local("neck")
    x, y, z = local.T
    band = near.neck - 0.010 - 0.22 * np.maximum(0.062 - z, 0.0)
    ends = np.maximum(0.012 - z - 0.45 * np.maximum(x, 0.0), z - 0.064 + 0.40 * x)
    open_ = np.maximum(0.010 - x, np.abs(y) - 0.006 - 0.35 * np.maximum(z + 0.04, 0.0))
    return near.cut(near.cut(band, ends), -open_)


def _placket(near: Near) -> Array:
    """The strip of the buttons."""
    return np.maximum(np.abs(near.points[:, 1]) - 0.011, -near.points[:, 0])


def _band(near: Near) -> Array:
    """Two bands across the chest."""
    z = near.points[:, 2]
    return np.minimum(np.abs(z - 0.335) - 0.022, np.abs(z - 0.262) - 0.022)


def _pocket(near: Near) -> Array:
    """A hoodie's pocket."""
    y, z = np.abs(near.points[:, 1]), near.points[:, 2]
    return np.maximum(
        np.maximum(np.abs(z - 0.065) - 0.060, y - 0.115 + 0.6 * np.maximum(z - 0.04, 0)), -near.points[:, 0]
    )


def _opening(near: Near) -> Array:
    """The open front of a cardigan."""
    points = near.points
    wide = 0.035 + 0.10 * np.maximum(points[:, 2] - 0.2, 0.0)
    return np.maximum(np.abs(points[:, 1]) - wide, -points[:, 0])


def _hooded(near: Near, body: Array) -> Array:
    """A hood that lies on the shoulders."""
    points = near.points
    fold = ball(points, (-0.070, 0.0, 0.475), (0.052, 0.098, 0.050))
    return carve(join(body, fold, 0.03), near.neck - 0.010, 0.01)


def _bottom(kind: Bottom) -> Callable[[Near], Array]:
    if kind == "skirt":
        return _skirt(0.34, 0.008)
    ease, straight, end = {
        "trousers": (0.009, 0.059, -0.385),
        "slim": (0.004, 0.0, -0.375),
        "shorts": (0.010, 0.0, -0.27),
        "trunks": (0.008, 0.0, -0.17),
    }[kind]

    def at(near: Near) -> Array:
        """How far points are from the trousers."""
        legs = []
        for side in SIDES:
            leg, shin = near.leg(side) - ease, near.local(f"{side}_knee")
            thigh = near.local(f"{side}_hip")
            if straight:
                above = cone(thigh, ((0, 0, -0.22), (0, 0, -THIGH)), (straight + 0.006, straight + 0.001))
                below = cone(shin, ((0, 0, 0), (0.002, 0, -SHIN)), (straight + 0.001, straight - 0.004))
                leg = join(leg, np.minimum(above, below), 0.02)
            if kind in ("shorts", "trunks"):
                wide = cone(thigh, ((0, 0, -0.05), (0, 0, end)), (0.088, 0.088))
                leg = near.cut(join(leg, wide, 0.03), end - thigh[:, 2])
            else:
                leg = near.cut(leg, end - shin[:, 2])
            legs.append(leg)
        whole = join(join(legs[0], legs[1], 0.012), near.trunk - ease, 0.05)
        return near.cut(whole, near.points[:, 2] - 0.115)

    return at


def _skirt(length: float, ease: float) -> Callable[[Near], Array]:
    """A skirt that hangs from the waist round both thighs, so far along them."""

    def at(near: Near) -> Array:
        """How far points are from the skirt."""
        flares = []
        for side in SIDES:
            thigh = near.local(f"{side}_hip")
            flare = cone(thigh, ((0, 0, 0.0), (0, 0, -length)), (0.085, 0.098))
            flares.append(join(near.leg(side) - ease, flare, 0.03))
        whole = join(join(flares[0], flares[1], 0.16), near.trunk - ease, 0.05)
        ends = np.minimum(*(near.local(f"{side}_hip")[:, 2] for side in SIDES)) + length
        return near.cut(near.cut(whole, -ends), near.points[:, 2] - 0.115)

    return at
