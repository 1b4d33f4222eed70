"""What a motion moves besides the body: what is put down or tipped in its course, and the fork that a meal takes."""

from __future__ import annotations

import math
from typing import NamedTuple

from coopera.core.household import plain
from coopera.simulation.motions.holding import Grip, Laid
from coopera.simulation.motions.library import Aid, Motion, along
from coopera.simulation.motions.poses import Setting, working_height

_THICK = 0.02
"""What one eats from is this thick."""


class Used(NamedTuple):
    """A thing that is no thing of the home: what it is called, and how it is held or where it lies."""

    thing: str
    grip: Grip


def now(motion: Motion, setting: Setting, grip: Grip, seconds: float) -> Grip:
    """How the thing in hand is held at a moment: tipped as the motion tips it, or put down already."""
    keys = motion.keys
    share = seconds / keys.period % 1.0
    if keys.lays is not None and grip.hold == "right" and grip.laid is None and share >= keys.lays.after:
        x, y, turn = keys.lays.at
        return grip._replace(laid=_laid(setting, x, y, 0.0, turn))
    if keys.tip and grip.tips:
        return grip._replace(tip=float(along([(tipped, 0.0, 0.0) for tipped in keys.tip], share)[0]))
    return grip


def aids(motion: Motion, setting: Setting, grip: Grip, seconds: float, thing: str) -> list[Used]:
    """What else is seen of a motion at a moment; `thing` is the class of what is in hand."""
    share = seconds / motion.keys.period % 1.0
    how = "laid" if grip.laid is not None else grip.hold
    kept = [aid for aid in motion.keys.aids if aid.thing != plain(thing) and aid.only in (None, how)]
    eats = motion.keys.right is not None and "mouth" in motion.keys.right.frames
    held = (held_or_laid(aid, setting, share, eats=eats) for aid in kept)
    return [Used(aid.thing, how) for aid, how in zip(kept, held, strict=True) if how is not None]


def held_or_laid(aid: Aid, setting: Setting, share: float, *, eats: bool) -> Grip | None:
    """How one of them is held, or where it lies; None before it comes into play and after it is out of it."""
    first, last = aid.when
    if share < first:
        return None
    if aid.hand == "both" and share <= last:
        return Grip("both")
    if aid.hand is not None and share <= last:
        return Grip(aid.hand, surface=working_height(setting) + (_THICK if eats else 0.0), eaten=eats, flat=True)
    if aid.at is None or (aid.hand is None and share > last):
        return None
    x, y, z, turn = aid.at
    if aid.floor:
        return Grip(laid=Laid(x, y, z + setting.support, math.radians(turn)))
    return Grip(laid=_laid(setting, x, y, z, turn))


def _laid(setting: Setting, x: float, y: float, z: float, turn: float) -> Laid:
    ahead, left = setting.reach
    return Laid(x + ahead + setting.step, y + left, z + working_height(setting), math.radians(turn))
