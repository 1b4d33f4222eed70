"""What pictures show of a motion so that it can be told: what it is done to, what it is done with, what stands about.

A person may have in hand what a motion is done to (the plant that is watered, the tomato that is cut) or something
that merely goes with it. Then a picture of the body and of that thing alone does not say what is done. Nothing here is
true of the home: no percept, no plan and no trace knows of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from coopera.core.affordances import affordances
from coopera.simulation.motions.aids import Used, held_or_laid
from coopera.simulation.motions.holding import Grip, Laid, Worktop
from coopera.simulation.motions.library import Motion, Prop, Showing, along
from coopera.simulation.motions.poses import Setting, working_height
from coopera.simulation.shapes.rotations import about_z


class Shown(NamedTuple):
    """How pictures show what is in hand, None if they do not, and what else they show of the motion."""

    grip: Grip | None
    props: tuple[Used, ...] = ()


def shown(
    motion: Motion, setting: Setting, grip: Grip, names: Sequence[str], top: Worktop | None, seconds: float
) -> Shown:
    """What a picture shows at a moment.

    Args:
        motion: What is done.
        setting: The heights at which it is done.
        grip: How the thing in hand is held then.
        names: The thing's class, and its text if it has one.
        top: The surface before the person, if there is one, in the frame of the body that has stepped up to it.
        seconds: When.
    """
    share = seconds / motion.keys.period % 1.0
    said = next((one for one in motion.keys.shows if _fits_thing(one, names)), None)
    seen = [one for one in motion.keys.props if _fits_thing(one, names) and _fits_place(one, setting, grip, top)]
    props = (_used(one, setting, share) for one in seen)
    return Shown(
        grip if said is None or share < said.after else _instead(said, setting, grip, share),
        tuple(one for one in props if one is not None),
    )


def _fits_thing(one: Prop | Showing, names: Sequence[str]) -> bool:
    """Whether something is shown with what is in hand."""
    known = affordances()

    def is_of(kinds: list[str]) -> bool:
        return any(known.means_one_of(name, kinds) for name in names)

    return (not one.of or is_of(one.of)) and not (one.but and is_of(one.but))


def _fits_place(one: Prop, setting: Setting, grip: Grip, top: Worktop | None) -> bool:
    """Whether something is shown at such a surface."""
    how = "laid" if grip.laid is not None else grip.hold
    if one.only not in (None, how) or (one.over is not None and (one.over == "surface") != (top is not None)):
        return False
    if one.bare and top is not None and top.tools:
        return False
    return not one.fits or (top is not None and _is_free(one, setting, top))


def _is_free(one: Prop, setting: Setting, top: Worktop) -> bool:
    """Whether there is room on a surface for something that lies there."""
    assert one.at is not None
    x, y = one.at[0] + setting.reach[0], one.at[1] + setting.reach[1]
    across, along_it = about_z(top.yaw)[:2, :2].T @ np.array((x - top.x, y - top.y))
    inside = abs(across) <= top.half_x - one.fits and abs(along_it) <= top.half_y - one.fits
    return bool(inside) and all(math.dist((x, y), place) >= one.fits + radius for *place, radius in top.taken)


def _used(one: Prop, setting: Setting, share: float) -> Used | None:
    """How something is held, or where it lies, at a moment; None where it is not seen then."""
    how = held_or_laid(one, setting, share, eats=False)
    if how is None:
        return None
    return Used(one.thing, _tipped(how, one.tip, share) if how.laid is None else how)


def _instead(said: Showing, setting: Setting, grip: Grip, share: float) -> Grip | None:
    """How the thing in hand is shown in place of how it is held."""
    if said.at is not None:
        x, y, z, turn = said.at
        ahead, left = (0.0, 0.0) if said.floor else (setting.reach[0] + setting.step, setting.reach[1])
        high = setting.support if said.floor else working_height(setting)
        return Grip(laid=Laid(x + ahead, y + left, z + high, math.radians(turn)))
    if said.hand is None:
        return None
    return _tipped(grip._replace(hold=said.hand, laid=None, bitten=said.bitten), said.tip, share)


def _tipped(grip: Grip, tip: list[float], share: float) -> Grip:
    if not tip:
        return grip
    return grip._replace(tips=True, tip=float(along([(by, 0.0, 0.0) for by in tip], share)[0]))
