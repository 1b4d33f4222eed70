"""An hour on the floor plan of its home: where its acts were done, and the ways between them, as inline SVG.

The trace says where everybody stood when an hour ended and how far each act led, not each step. A way is therefore
worked out again on the home's floor, between the places of the acts; it shows where an act led, not every detour.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from markupsafe import Markup

from coopera.core.errors import CooperaError
from coopera.core.hour import HourRecord
from coopera.core.household import HandOver, Outcome, PickPlace, SceneId, plain
from coopera.rundir.trace_files import human_outcomes
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Scene, SceneObject, load_scene
from coopera.simulation.ways.navigation import Navigator

_SCALE = 100  # SVG units per metre
_MARGIN = 0.12
_FARTHEST = 1000  # metres from the middle of a home
_ROOM_LABEL = 1.1  # metres that a room must be wide for its name


class Plan(NamedTuple):
    """An hour's ways; `home` is the id of the drawing of its home, which a page holds once."""

    home: str
    drawing: Markup


class Homes:
    """The homes of a run as drawings, each read once, and its hours' ways.

    Args:
        folders: Where homes lie besides the shipped ones.
    """

    def __init__(self, folders: Sequence[Path]) -> None:
        self._folders = tuple(folders)
        self._known = lru_cache(maxsize=8)(self._look_up)

    def drawing(self, scene: str) -> Markup | None:
        """The home as an SVG symbol, to be put once into a page; None where it cannot be found any more."""
        found = self._known(scene)
        return None if found is None else _symbol(found[0])

    def plan(self, record: HourRecord, before: Mapping[str, Any] | None) -> Plan | None:
        """What happened in an hour, on the plan; None where the home or the places are not known.

        Args:
            record: The hour.
            before: `world.poses` of the hour before it, if there was one.
        """
        found = self._known(record.scene)
        now = _spots(record.world.get("poses"))
        if found is None or not now:
            return None
        scene, floor = found
        try:
            return Plan(_id(scene), _drawn(scene, floor, record, _spots(before), now))
        except (ValueError, KeyError, IndexError, TypeError, ArithmeticError):  # poses that no home of ours has
            return None

    def _look_up(self, scene: str) -> tuple[Scene, Navigator] | None:
        try:
            found = load_scene(SceneId(scene), self._folders)
            return found, Navigator(found)
        except CooperaError:
            return None


class _Stop(NamedTuple):
    """A place where an act was done, and what stands beside it."""

    at: Point
    title: str
    ok: bool


def _spots(poses: Any) -> dict[str, Point]:
    """Where each agent stands, by id."""
    agents = poses.get("agents") if isinstance(poses, dict) else None
    found = {}
    for name, agent in agents.items() if isinstance(agents, dict) else ():
        spot = agent.get("spot") if isinstance(agent, dict) else None
        numbers = [float(one) for one in spot if isinstance(one, int | float)] if isinstance(spot, list) else []
        if len(numbers) == 2 and all(math.isfinite(one) and abs(one) < _FARTHEST for one in numbers):
            found[str(name)] = (numbers[0], numbers[1])
    return found


def _drawn(
    scene: Scene, floor: Navigator, record: HourRecord, before: Mapping[str, Point], now: Mapping[str, Point]
) -> Markup:
    acts = human_outcomes(record)
    outcomes = record.robot.outcomes if record.robot else []
    marks = [_label(thing) for thing in _used(scene, [*acts, *outcomes])]
    start, end = before.get("human", now.get("human")), now.get("human")
    if start and end:
        way, stops = _walked(scene, floor, acts, start, end, person=None)
        marks += [_path("human", way), *_numbers("human", stops)]
    start, last = before.get("robot", now.get("robot")), now.get("robot")
    if start and last:
        way, stops = _walked(scene, floor, outcomes, start, last, person=end)
        marks += [_path("robot", way), *_numbers("robot", stops), _square(last)]
    return Markup(
        '<svg class="plan" viewBox="{}" role="img" aria-label="Where it happened, on the plan of the home">'
        '<use href="#{}" x="{}" y="{}" width="{}" height="{}"/>{}</svg>'
    ).format(_box(scene), _id(scene), *_box(scene).split(), Markup("").join(marks))


def _walked(
    scene: Scene, floor: Navigator, acts: Sequence[Outcome], start: Point, end: Point, *, person: Point | None
) -> tuple[list[Point], list[_Stop]]:
    """The way past the places of some acts, and those places in order; an act of no way is done where one is."""
    here, way, stops = start, [start], list[_Stop]()
    for number, outcome in enumerate(acts):
        final = number == len(acts) - 1
        there = end if final and outcome.metres > 0 else _place(scene, floor, outcome, here, person)
        if outcome.metres > 0 and there is not None:
            way += (floor.route(here, there).points or [here, there])[1:]
            here = there
        what = "" if outcome.ok else f" (not done: {outcome.reason})"
        stops.append(_Stop(here, f"{outcome.act.describe()}{what}, {outcome.metres:.1f} m", outcome.ok))
    return way, stops


def _place(scene: Scene, floor: Navigator, outcome: Outcome, here: Point, person: Point | None) -> Point | None:
    """Where one stands for an act; beside the person to hand a thing over."""
    act = outcome.act
    if isinstance(act, HandOver):
        return person
    target: SceneObject | None = scene.object(act.receptacle if isinstance(act, PickPlace) else act.target)
    if target is None:
        return None
    stand = next(iter(floor.approach(target, here, most=1)), None)
    return (stand.x, stand.y) if stand else target.xy


def _used(scene: Scene, acts: Sequence[Outcome]) -> list[SceneObject]:
    """The furniture that some acts were done at."""
    names = (getattr(one.act, "receptacle", None) or getattr(one.act, "target", None) for one in acts)
    return [thing for name in dict.fromkeys(names) if name and (thing := scene.object(name)) is not None]


def _label(thing: SceneObject) -> Markup:
    x, y = _xy(thing.xy)
    return Markup('<text class="used" x="{:.0f}" y="{:.0f}">{}</text>').format(x, y + 7, plain(thing.name))


def _path(who: str, way: Sequence[Point]) -> Markup:
    if len(way) < 2:
        return Markup("")
    x, y = _xy(way[0])
    line = " L".join(f"{a:.0f} {b:.0f}" for a, b in map(_xy, way))
    return Markup('<path class="way {0}" d="M{1}"/><circle class="from {0}" cx="{2:.0f}" cy="{3:.0f}" r="9"/>').format(
        who, line, x, y
    )


def _numbers(who: str, stops: Sequence[_Stop]) -> list[Markup]:
    """A numbered mark at each place; acts at one place stand beside each other."""
    taken: dict[tuple[int, int], int] = {}
    marks = []
    for number, stop in enumerate(stops, 1):
        key = (round(stop.at[0] * 2), round(stop.at[1] * 2))
        beside = taken.get(key, 0)
        taken[key] = beside + 1
        x, y = _xy(stop.at)
        x, y = x + 34 * (beside % 5), y + (26 if who == "robot" else -26) + 36 * (beside // 5)
        marks.append(
            Markup(
                '<g class="stop {}{}"><title>{}</title><circle cx="{:.0f}" cy="{:.0f}" r="17"/>'
                '<text x="{:.0f}" y="{:.0f}">{}</text></g>'
            ).format(who, "" if stop.ok else " failed", stop.title, x, y, x, y + 8, number)
        )
    return marks


def _square(at: Point) -> Markup:
    x, y = _xy(at)
    return Markup('<rect class="stands" x="{:.0f}" y="{:.0f}" width="22" height="22" rx="5"/>').format(x - 11, y - 11)


def _symbol(scene: Scene) -> Markup:
    """Rooms, walls and furniture; what lies about is left out."""
    marks = []
    for room in scene.rooms:
        line = " ".join(f"{x:.0f},{y:.0f}" for x, y in map(_xy, room.outline))
        marks.append(Markup('<polygon class="room" points="{}"/>').format(line))
    for thing in scene.fixed:
        corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
        half_x, half_y = thing.size[0] / 2, thing.size[1] / 2
        points = (thing.to_world(a * half_x, b * half_y)[:2] for a, b in corners)
        line = " ".join(f"{x:.0f},{y:.0f}" for x, y in map(_xy, points))
        marks.append(
            Markup('<polygon class="thing" points="{}"><title>{}</title></polygon>').format(line, plain(thing.name))
        )
    for wall in scene.walls():
        (x0, y0), (x1, y1) = map(_xy, wall.ends)
        marks.append(Markup('<path class="wall" d="M{:.0f} {:.0f}L{:.0f} {:.0f}"/>').format(x0, y0, x1, y1))
    for room in scene.rooms:
        if room.x1 - room.x0 >= _ROOM_LABEL:
            x, y = _xy(min(room.outline, key=lambda corner: (-corner[1], corner[0])))
            marks.append(
                Markup('<text class="roomname" x="{:.0f}" y="{:.0f}">{}</text>').format(x + 14, y + 32, room.name)
            )
    return Markup('<svg class="homes" aria-hidden="true"><symbol id="{}" viewBox="{}">{}</symbol></svg>').format(
        _id(scene), _box(scene), Markup("").join(marks)
    )


def _id(scene: Scene) -> str:
    return f"home-{scene.id}"


def _box(scene: Scene) -> str:
    edge = scene.bounds.grown(_MARGIN)
    x, y = _xy((edge.x0, edge.y1))
    return f"{x:.0f} {y:.0f} {(edge.x1 - edge.x0) * _SCALE:.0f} {(edge.y1 - edge.y0) * _SCALE:.0f}"


def _xy(point: Point) -> Point:
    """A point of the floor in SVG units; up is north."""
    return point[0] * _SCALE, -point[1] * _SCALE
