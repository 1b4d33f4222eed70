"""Where a thing is that somebody holds, wears or has before them: its place and turn in the body frame.

Everything follows from the pose, the thing's size and a `Grip`; nothing is drawn here. A thing's own frame is that of
its recipe: base at z = 0, front towards +y. Lengths are metres.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from coopera.core.affordances import affordances
from coopera.simulation.bodies.humanoid import MOUTH, SIDES, Frames, Side, forward
from coopera.simulation.motions.library import HandPath, Hold, Motion, Triple
from coopera.simulation.motions.poses import Setting, pose_at, working_height
from coopera.simulation.motions.vessels import OVER, grasp, lip, tipped
from coopera.simulation.motions.worn import AHEAD, FLAT, on_body
from coopera.simulation.shapes.kit import Size
from coopera.simulation.shapes.rotations import Array, about_z

_THIN = 0.08
_BIG = 0.17
_LONG = 0.7
_FINE = 0.125
_BULKY = 0.35
_GRASP = 0.16
"""Two hands hold a thing between them that is at most this much narrower than they are apart."""
_END = 0.07
"""A tool is held this far from the end of its handle."""
_STEEP = 0.87
"""Sine of the steepest pitch at which a tool is held down."""
_STILL = 0.5
"""How much a hand that keeps still counts for where a thing lies."""
_LOW = 0.15
"""Hands that come this near to the surface work on it."""
_STRETCH = 0.28
"""Hands go at most this far from their usual way to where a thing lies."""
_OFFSETS = [np.array((x, y)) for x in (0.0, 0.04, 0.08) for y in (0.0, 0.05, -0.05, 0.1, -0.1, 0.14, -0.14)]
"""Where else than under the hands a thing may lie, in the body frame."""
_CLUTTER = 5.0
"""How much worse it is to lie in another thing than to lie farther away."""
_ARM, _BEYOND = 0.15, 100.0
"""Things that lie farther than this from the usual place are out of the hands' reach, which is worst."""
_NEAR = 0.35
"""Hands go to a tool at most this far from where they usually work."""
_MOMENTS, _BITE = 6, 0.08
"""What is eaten out of the hand is so far from its middle (metres)."""
_HANDLE = np.array((-0.6, -0.8))
"""Where the handle of a pan points: back, and to the right hand."""


class Worktop(NamedTuple):
    """The surface before somebody, in their body frame: a rectangle's middle, turn and half extents.

    `marks` are the places on it where things belong, such as a stove's burners; `taken` are what stands on it, as the
    middle and the radius of each thing, and `tools` the middles of those that the motion is done with.
    """

    x: float
    y: float
    yaw: float
    half_x: float
    half_y: float
    marks: tuple[tuple[float, float], ...] = ()
    taken: tuple[tuple[float, float, float], ...] = ()
    tools: tuple[tuple[float, float], ...] = ()

    def stepped(self, step: float) -> Worktop:
        """The same, for a body that has stepped ahead."""
        marks, tools = (tuple((x - step, y) for x, y in places) for places in (self.marks, self.tools))
        taken = tuple((x - step, y, radius) for x, y, radius in self.taken)
        return self._replace(x=self.x - step, marks=marks, taken=taken, tools=tools)


LAP = Worktop(0.27, 0.0, 0.0, 0.19, 0.24)
"""The thighs of somebody who sits, on a seat or cross-legged on the floor."""


class Laid(NamedTuple):
    """A thing that lies before one: the middle of its base in the body frame, and its turn."""

    x: float
    y: float
    z: float
    yaw: float


class Grip(NamedTuple):
    """How a thing is held.

    `laid` is where it lies instead. Nothing that is in one hand goes below the height `surface`, and the tip of a tool
    touches it; raised above it, a tool that is `eaten` with points at the mouth. What is `flat` wipes the surface. What
    `tips` is a vessel that one pours from, tipped by the share `tip` of what empties it. What is
    `bitten` is at the mouth when the hand is near.
    """

    hold: Hold = "right"
    laid: Laid | None = None
    surface: float | None = None
    eaten: bool = False
    flat: bool = False
    tips: bool = False
    tip: float = 0.0
    bitten: bool = False


CARRIED = Grip()
"""How a thing is carried about."""


def lies(motion: Motion, names: Iterable[str], size: Size) -> bool:
    """Whether a thing (by its class, and its text if it has one) lies on the surface while a motion is done."""
    known = affordances()
    if any(known.is_one_of(name, known.of(motion.caption).lies) for name in names):
        return True
    return motion.keys.hold == "surface" and max(size[:2]) > _BIG and not _is_tool(size)


def _is_tool(size: Size) -> bool:
    return size[0] > 1.7 * size[1] and size[2] < _FINE


def grip(
    motion: Motion, setting: Setting, names: Iterable[str], size: Size, top: Worktop | None
) -> tuple[Setting, Grip]:
    """How a thing is held while a motion is done, and the setting in which the hands come to where it lies.

    Args:
        motion: What is done.
        setting: The heights at which it is done.
        names: The thing's class, and its text if it has one.
        size: The thing's size.
        top: The surface before the person, if there is one.
    """
    keys = motion.keys
    height = working_height(setting)
    working = _at_surface(motion)
    if top is not None and working and lies(motion, names, size):
        hands = _hands(motion)
        laid, hand = _laid(size, hands, top)
        return _reaching(setting, hand - hands), Grip(keys.hold, laid=Laid(*laid, height, _yaw(size)))
    setting = to_tools(motion, setting, top)
    hold = _hold(motion, names, size, laid=top is not None)
    if hold == "both" and size[0] <= _LONG and size[2] <= 0.6 and _span(motion, setting) > size[0] + _GRASP:
        hold = "right"
    tips = bool(keys.tip) and hold == "right" and not _is_tool(size)
    if tips:
        setting = setting._replace(right=_pouring(motion, size))
    touches = keys.right is not None and "surface" in keys.right.frames
    eaten = keys.right is not None and "mouth" in keys.right.frames
    return setting, Grip(hold, surface=height if touches else None, eaten=eaten, flat=keys.hold == "flat", tips=tips)


def _hold(motion: Motion, names: Iterable[str], size: Size, *, laid: bool) -> Hold:
    """How a thing that does not lie is held: as the motion says, as far as its size permits.

    What would lie on a surface, and has none, is held level in the left hand.
    """
    hold = motion.keys.hold
    if hold == "surface" and not laid and lies(motion, names, size) and motion.keys.left is not None:
        return "left"
    if hold == "flat":
        return "left" if size[2] > FLAT else "right"
    if (hold == "floor" and size[0] <= _LONG) or (hold == "feet" and max(size[:2]) <= _BIG):
        return "right"
    return hold


def _pouring(motion: Motion, size: Size) -> Triple:
    """How much farther than usual the right hand goes so that the lip of what it tips is over the other vessel."""
    keys = motion.keys
    assert keys.right is not None
    usual = np.array(keys.right.points[keys.tip.index(max(keys.tip))])
    x, y, z = (np.array((*_hands(motion), OVER)) - lip(size) - usual).tolist()
    return x, y, z


def to_tools(motion: Motion, setting: Setting, top: Worktop | None) -> Setting:
    """The setting in which the hands come to the nearest tool that lies before one, if one lies near."""
    if top is None or not top.tools or not _at_surface(motion):
        return setting
    hands = _hands(motion)
    tool = min(top.tools, key=lambda place: round(math.dist(place, hands), 6))
    return setting if math.dist(tool, hands) > _NEAR else _reaching(setting, np.array(tool) - hands)


def _reaching(setting: Setting, farther: Array) -> Setting:
    x, y = np.clip(farther, -_STRETCH, _STRETCH).tolist()
    return setting._replace(reach=(x, y))


def _at_surface(motion: Motion) -> list[HandPath]:
    """The paths of the hands that come to the surface, the right hand's first."""
    paths = (motion.keys.right, motion.keys.left)
    return [path for path in paths if path is not None and "surface" in path.frames]


def _hands(motion: Motion) -> Array:
    """Where hands usually work on the surface: where it is said, or both, if a thing lies there, or the right one."""
    if motion.keys.works_at is not None:
        return np.array(motion.keys.works_at)
    working = _at_surface(motion)
    if motion.keys.hold != "surface" and motion.keys.right in working:
        return _where(working[0], math.inf)
    busy = [1.0 if len(path.points) > 1 else _STILL for path in working]
    middle: Array = np.average([_where(path) for path in working], axis=0, weights=busy)
    return middle


def _yaw(size: Size) -> float:
    if _is_tool(size):
        return math.atan2(float(_HANDLE[1]), float(_HANDLE[0]))
    return math.pi / 2  # the front towards the person


def _where(path: HandPath, highest: float = _LOW) -> Array:
    """The middle of the places where a hand is at the surface: those low above it, if it comes so low at all."""
    points = [point for frame, point in zip(path.frames, path.points, strict=True) if frame == "surface"]
    low = [point for point in points if point[2] <= highest]
    middle: Array = np.mean([point[:2] for point in low or points], axis=0)
    return middle


def _laid(size: Size, hands: Array, top: Worktop) -> tuple[tuple[float, float], Array]:
    """The middle of a thing that lies on a surface, and where the hands go to: over it, or to its handle.

    It lies as near to the hands as it fits there, on a free mark or, without marks, beside what stands there already;
    where there is no room within reach it is as little in the way as can be.
    """
    handle = _HANDLE if _is_tool(size) else np.zeros(2)
    grasp, belly = handle * (size[0] / 2 - _END), handle * (size[1] - size[0]) / 2
    wanted = hands - grasp
    if top.marks:
        radius = size[1] / 2
        bellies = np.array(top.marks)
        places = bellies - belly
    else:
        radius = max(size[:2]) / 2
        places = bellies = np.array([_on(size, wanted + offset, top) for offset in _OFFSETS])
    far = np.hypot(*(places - wanted).T)
    taken = np.array(top.taken).reshape(-1, 3)
    inside = radius + taken[:, 2] - np.hypot(*(bellies[:, None] - taken[:, :2]).transpose(2, 0, 1))
    cost = far + _CLUTTER * np.maximum(inside, 0.0).sum(axis=1) + _BEYOND * np.maximum(far - _ARM, 0.0)
    middle = places[int(np.argmin(cost.round(6)))]
    return (float(middle[0]), float(middle[1])), middle + grasp


def _on(size: Size, middle: Array, top: Worktop) -> Array:
    """The place nearest to a wanted one at which a thing does not stick out of a surface."""
    turn = about_z(top.yaw)[:2, :2]
    centre = np.array((top.x, top.y))
    cos, sin = abs(math.cos(_yaw(size) - top.yaw)), abs(math.sin(_yaw(size) - top.yaw))
    half = np.array((size[0] * cos + size[1] * sin, size[0] * sin + size[1] * cos)) / 2
    room = np.maximum(np.array((top.half_x, top.half_y)) - half, 0.0)
    found: Array = turn @ np.clip(turn.T @ (middle - centre), -room, room) + centre
    return found


def _span(motion: Motion, setting: Setting) -> float:
    """How far the hands are apart while a motion is done, on average."""
    gaps = []
    for k in range(_MOMENTS):
        place = forward(pose_at(motion, motion.keys.period * k / _MOMENTS, setting)).place
        gaps.append(math.dist(place["right_hand"], place["left_hand"]))
    return sum(gaps) / len(gaps)


def held_at(pose: Array, size: Size, grip: Grip = CARRIED) -> tuple[Array, Array]:
    """Place (the middle of its base) and turn (a matrix) of a held thing in the body frame."""
    if grip.laid is not None:
        return np.array(grip.laid[:3]), about_z(grip.laid.yaw)
    frames = forward(pose)
    right, left = (frames.place[f"{side}_hand"] for side in SIDES)
    if grip.hold == "floor" and size[0] > _LONG:
        return _long_tool(right, left, size)
    if grip.hold == "beside" and max(size) > _BULKY:
        return np.array((0.0, -0.75, 0.0)), AHEAD
    if (worn := on_body(frames, grip.hold, size)) is not None:
        return worn
    if grip.hold == "both":
        if size[0] > _LONG:
            return _across(right, left, size)
        return _before_eyes(frames, (right + left) / 2, size) if size[2] < _THIN else _between(right, left, size)
    return _in_one_hand(frames, "left" if grip.hold == "left" else "right", size, grip)


def _in_one_hand(frames: Frames, side: Side, size: Size, grip: Grip) -> tuple[Array, Array]:
    """A thing in one hand, above the surface and on it where it works there; a vessel as far tipped as it is."""
    floor = -math.inf if grip.surface is None else grip.surface
    if _is_tool(size):
        return _handled(frames, side, size, floor, eaten=grip.eaten)
    hand = frames.place[f"{side}_hand"]
    if grip.tips:
        turn = tipped(size, grip.tip)
        base = hand - turn @ grasp(size)
        lowest = float(base[2]) - abs(float(turn[2, 1])) * size[0] / 2
        return base + np.array((0.0, 0.0, max(floor - lowest, 0.0))), turn @ AHEAD
    lower = min(0.6 * size[2], 0.5 * size[2] + 0.03)
    place = hand + np.array((0.02 + 0.3 * min(size[1], 0.1), 0.0, -lower))
    if grip.bitten:
        place = _at_mouth(frames, hand, size)
    place[2] = floor if grip.flat and float(place[2]) < floor + _LOW else max(float(place[2]), floor)
    return place, AHEAD


def _at_mouth(frames: Frames, hand: Array, size: Size) -> Array:
    """A small thing at the side of the hand that is towards the mouth, and at the mouth once the hand is near."""
    way = frames.point("head", *MOUTH) - hand
    return np.asarray(hand + _unit(way) * min(_BITE, 0.6 * float(np.linalg.norm(way))) - (0.0, 0.0, size[2] / 2))


def _unit(line: Array) -> Array:
    found: Array = line / math.sqrt(float(line @ line))
    return found


def _between(right: Array, left: Array, size: Size) -> tuple[Array, Array]:
    """A bulky thing between the two hands; a long one points from the right hand past the left."""
    line = left - right
    if size[2] > 0.6 and float(line @ line) > 0.05:
        up = _unit(line)
        front = np.array((1.0, 0.0, 0.0)) - up * up[0]
        front = _unit(front)
        return right - up * 0.22 * size[2], np.stack((np.cross(front, up), front, up), axis=1)
    return (right + left) / 2 + np.array((0.03, 0.0, -0.5 * size[2])), AHEAD


def _across(right: Array, left: Array, size: Size) -> tuple[Array, Array]:
    """A long thing held like a guitar: its thick end (-x) at the right hand, its top away from the body."""
    across = _unit(left - right)
    top = _unit(np.array((1.0, 0.0, 0.0)) - across * across[0])
    turn = np.stack((across, np.cross(top, across), top), axis=1)
    return right + across * (0.5 * size[0] - 0.5 * size[1]) - top * 0.6 * size[2], turn


def _handled(frames: Frames, side: Side, size: Size, floor: float, *, eaten: bool) -> tuple[Array, Array]:
    """A tool held at its handle (+x): a thin one goes on where the forearm points, or down to the surface.

    A pan stays level.
    """
    hand = frames.place[f"{side}_hand"]
    arm = frames.turn[f"{side}_hand"] @ np.array((0.0, 0.0, -1.0))
    if size[1] > _FINE:
        arm = np.array((1.0, 0.0, 0.0))
        hand = np.array((hand[0], hand[1], max(float(hand[2]), floor + 0.5 * size[2])))
    elif floor > -math.inf:
        aim = _unit(frames.point("head", *MOUTH) - hand) if eaten else arm
        above = (float(hand[2]) - floor - 0.5 * size[2]) / (size[0] - _END)
        down = min(max(above, 0.0), _STEEP)
        level = math.hypot(float(arm[0]), float(arm[1]))
        flat = arm / level if level > 0.1 else np.array((1.0, 0.0, 0.0))
        run = math.sqrt(1 - down * down)
        lowered = np.array((float(flat[0]) * run, float(flat[1]) * run, -down))
        raised = min(max(above - _STEEP, 0.0) / 0.5, 1.0)  # too high to reach the surface: as the forearm points
        arm = _unit(lowered + raised * (aim - lowered))
    up = np.array((0.0, 0.0, 1.0)) if abs(float(arm[2])) < 0.95 else np.array((1.0, 0.0, 0.0))
    up = _unit(up - arm * float(up @ arm))
    turn = np.stack((-arm, np.cross(up, -arm), up), axis=1)
    return hand + arm * (0.5 * size[0] - _END) - up * 0.5 * size[2], turn


def _before_eyes(frames: Frames, middle: Array, size: Size) -> tuple[Array, Array]:
    """A thin thing held up between both hands, its top towards the face."""
    up = _unit(frames.place["head"] - middle)
    across = _unit(np.array((0.0, 1.0, 0.0)) - up * up[1])
    return middle + 0.03 * up, np.stack((across, np.cross(up, across), up), axis=1)


def _long_tool(right: Array, left: Array, size: Size) -> tuple[Array, Array]:
    """A broom through both hands down to the floor; the end at -x sweeps."""
    low, high = (right, left) if right[2] < left[2] else (left, right)
    pole = high - low
    pole[2] = max(float(pole[2]), 0.05)
    pole = _unit(pole)
    across = np.cross(np.array((0.0, 0.0, 1.0)), pole)
    across = _unit(across) if float(across @ across) > 1e-6 else np.array((0.0, 1.0, 0.0))
    side = np.cross(pole, across)
    lift = 0.5 * size[2] * abs(float(side[2]))  # the lower edge of its end is on the floor
    foot = low - pole * (float(low[2]) - lift) / float(pole[2])
    return foot + pole * 0.5 * size[0] - side * 0.5 * size[2], np.stack((pole, across, side), axis=1)
