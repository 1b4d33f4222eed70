"""Make a home from a seed: rooms, doors, furniture, and things on it. The same seed gives the same file."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import zip_longest
from typing import NamedTuple

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.household import SceneId
from coopera.core.randomness import rng_at
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.floorplan import Edge
from coopera.simulation.homes.scene import ID, Room, Scene, SceneObject
from coopera.simulation.homes.spots import Spot, Taken, furniture_on, is_free, spots, stands_through, taken_at, taken_by
from coopera.simulation.making.furnish import FACING, Piece, RoomPlan
from coopera.simulation.making.layout import USUAL_ROOMS, Form, Layout, lay_out
from coopera.simulation.making.proof import prove
from coopera.simulation.making.styles import styled
from coopera.simulation.shapes.kit import Size
from coopera.simulation.ways.navigation import RADIUS, REACH, Navigator

MOST_ROOMS = 24
MOST_THINGS = 300
THINGS_PER_ROOM = 8.5  # PAPER App. B: from 33 movable things in 4 rooms to 94 in 11
_ATTEMPTS = 8
_WAYS = 3
_NEEDED = 20
"""A room without the first piece of its kind's furniture (a bedroom without a bed) counts as so many missing."""
_COMFORTABLE = 0.68
"""Things are put this near to where one can stand if they can be, in metres."""


class _Draft(NamedTuple):
    layout: Layout
    pieces: list[list[Piece]]
    missing: int


def generate(
    seed: int,
    rooms: int | Sequence[str] = 7,
    id: str = "home",
    *,
    things: int | Sequence[str] | None = None,
    form: Form | None = None,
) -> Scene:
    """Generate a home in which everything can be walked up to and taken: several are tried, the fullest first.

    Should every one of them have a problem that `prove` finds, the one with the fewest is returned.
    `generate_proved` says whether it has.

    Args:
        seed: Any integer; the same gives the same home on every machine.
        rooms: How many rooms (1 to 24), or their kinds in words.
        id: The home's id.
        things: How many movable things to put in it, or their classes, repeats allowed; without it `THINGS_PER_ROOM`.
            Things that find no fitting support are left out.
        form: How large and long it is, which rooms are no rectangles, and its style; without it, the usual.

    Raises:
        ConfigError: If the number of rooms, a kind of room, or a class of thing is not known.
        SimulationError: If no layout of so many rooms was found.
    """
    return generate_proved(seed, rooms, id, things=things, form=form)[0]


def generate_proved(
    seed: int,
    rooms: int | Sequence[str] = 7,
    id: str = "home",
    *,
    things: int | Sequence[str] | None = None,
    form: Form | None = None,
    attempts: int = _ATTEMPTS,
) -> tuple[Scene, list[str]]:
    """Generate a home as `generate` does, of so many `attempts` to furnish it; returns its problems, too."""
    kinds = _room_kinds(rooms)
    if not re.fullmatch(ID, id):
        raise ConfigError(f"A home's id is lower-case letters, digits, - and _, at most 64, not {id[:80]!r}.")
    if things is None:
        things = round(THINGS_PER_ROOM * len(kinds))
    if isinstance(things, int) and not 0 <= things <= MOST_THINGS:
        raise ConfigError(f"A home has 0 to {MOST_THINGS} movable things, not {things}.")
    unknown = [] if isinstance(things, int) else sorted(set(things) - set(catalogue().movable))
    if unknown:
        raise ConfigError(f"There is no movable class {unknown[0]!r} in the catalogue.")
    form = form or Form()
    homes = (
        home for draft in _drafts(seed, kinds, form, attempts) for home in _inhabit(draft, seed, id, things, form.style)
    )
    best: tuple[Scene, list[str]] | None = None
    for home in homes:
        problems = prove(home)
        if best is None or len(problems) < len(best[1]):
            best = home, problems
        if not problems:
            break
    assert best is not None  # at least one is drafted
    return best


def _inhabit(draft: _Draft, seed: int, id: str, things: int | Sequence[str], style: str = "") -> Iterator[Scene]:
    """Yield a furnished home with its things, put in several ways."""
    furniture = [styled(one, style) for one in _name_furniture(draft, rng_at(seed, "colours"))]
    home = Scene(id=SceneId(id), seed=seed, rooms=draft.layout.rooms, doors=draft.layout.doors, objects=furniture)
    wanted = _choose(home, things, rng_at(seed, "which things")) if isinstance(things, int) else things
    rng = rng_at(seed, "things")
    for _ in range(_WAYS):
        placed = _place_things(home, wanted, rng)
        yield Scene(id=home.id, seed=seed, rooms=home.rooms, doors=home.doors, objects=[*furniture, *placed])


def _choose(home: Scene, count: int, rng: np.random.Generator) -> list[str]:
    """Classes of things that belong in a home: of each super-category in turn, none twice before all are there."""
    there = {"floor", *(thing.cls for thing in home.fixed)}
    by_category: dict[str, list[str]] = {}
    for cls, kind in sorted(catalogue().movable.items()):
        if not there.isdisjoint(kind.put):
            by_category.setdefault(kind.category, []).append(cls)
    shuffled = [[classes[int(i)] for i in rng.permutation(len(classes))] for classes in by_category.values()]
    once = [cls for row in zip_longest(*shuffled) for cls in row if cls is not None]
    return [once[i % len(once)] for i in range(count)] if once else []


def _room_kinds(rooms: int | Sequence[str]) -> list[str]:
    known = catalogue().rooms
    if isinstance(rooms, int):
        if not 1 <= rooms <= MOST_ROOMS:
            raise ConfigError(f"A home has 1 to {MOST_ROOMS} rooms, not {rooms}.")
        return [USUAL_ROOMS[i % len(USUAL_ROOMS)] for i in range(rooms)]
    for kind in rooms:
        if kind not in known:
            raise ConfigError(f"There is no kind of room {kind!r}; known are {', '.join(sorted(known))}.")
    if not 1 <= len(rooms) <= MOST_ROOMS:
        raise ConfigError(f"A home has 1 to {MOST_ROOMS} rooms, not {len(rooms)}.")
    return list(rooms)


def _drafts(seed: int, kinds: Sequence[str], form: Form, attempts: int) -> list[_Draft]:
    """Furnish several layouts, up to the first that holds everything; those that hold most come first."""
    drafts: list[_Draft] = []
    for attempt in range(attempts):
        drafts.append(_furnish(lay_out(kinds, rng_at(seed, "layout", attempt), form), seed, attempt))
        if drafts[-1].missing == 0:
            break
    return sorted(drafts, key=lambda draft: draft.missing)


def _furnish(layout: Layout, seed: int, attempt: int) -> _Draft:
    pieces, missing = [], 0
    for room in layout.rooms:
        doors = [door for door in layout.doors if room.name in door.between]
        others = [other for other in layout.rooms if other is not room]
        plan = RoomPlan(room, doors, others, rng_at(seed, "furniture", attempt, room.name))
        for index, cls in enumerate(catalogue().rooms[room.kind].furniture):
            if not plan.add(cls):
                missing += 1 if index else _NEEDED
        pieces.append(plan.pieces)
    return _Draft(layout, pieces, missing)


def _name_furniture(draft: _Draft, rng: np.random.Generator) -> list[SceneObject]:
    count: Counter[str] = Counter()
    objects: list[SceneObject] = []
    start = {cls: int(rng.integers(len(kind.colours))) for cls, kind in catalogue().fixed.items()}
    for room, pieces in zip(draft.layout.rooms, draft.pieces, strict=True):
        for piece in pieces:
            kind = catalogue().fixed[piece.cls]
            colour = kind.colours[(start[piece.cls] + count[piece.cls]) % len(kind.colours)]
            count[piece.cls] += 1
            objects.append(
                SceneObject(
                    id=len(objects),
                    name=f"{piece.cls}_{count[piece.cls]}",
                    cls=piece.cls,
                    category=kind.category,
                    fixed=True,
                    room=room.name,
                    position=(piece.x, piece.y, piece.z),
                    yaw=piece.yaw,
                    size=piece.size,
                    colour=colour,
                )
            )
    return objects


def _place_things(scene: Scene, wanted: Sequence[str], rng: np.random.Generator) -> list[SceneObject]:
    """Put things on fitting furniture, near a place to stand; large ones first, so that they find room."""
    navigator = Navigator(scene)
    known = catalogue().movable
    order = sorted(wanted, key=lambda cls: (-known[cls].size[0] * known[cls].size[1], cls))
    taken: dict[str, list[Taken]] = {thing.name: furniture_on(scene, thing) for thing in scene.fixed}
    placed: list[SceneObject] = []
    count: Counter[str] = Counter()
    for cls in order:
        kind = known[cls]
        where = _somewhere(scene, navigator, cls, taken, placed, rng)
        if where is None:
            continue
        carrier, room, spot = where
        count[cls] += 1
        if carrier is not None:
            taken[carrier.name].append(taken_at(spot, kind.size))
        placed.append(
            SceneObject(
                id=0,
                name=f"{cls}_{count[cls]}",
                cls=cls,
                category=kind.category,
                fixed=False,
                room=room,
                position=(spot.x, spot.y, spot.z),
                yaw=spot.yaw,
                size=kind.size,
                colour=kind.colours[int(rng.integers(len(kind.colours)))],
                on=carrier.name if carrier is not None else None,
            )
        )
    placed = [_freed(scene, navigator, thing, placed) for thing in placed]
    placed.sort(key=lambda thing: thing.name)
    first = len(scene.objects)
    return [thing.model_copy(update={"id": first + i}) for i, thing in enumerate(placed)]


def _somewhere(
    scene: Scene,
    navigator: Navigator,
    cls: str,
    taken: dict[str, list[Taken]],
    placed: Sequence[SceneObject],
    rng: np.random.Generator,
) -> tuple[SceneObject | None, str, Spot] | None:
    """A carrier, its room and a spot for a thing: among the fitting carriers the emptier ones come first."""
    kind = catalogue().movable[cls]
    load = Counter(thing.on for thing in placed)
    carriers = [thing for thing in scene.fixed if thing.cls in kind.put]
    rank = {
        thing.name: load[thing.name] / max(0.3, thing.size[0])
        + kind.put.index(thing.cls) / 2
        + float(rng.uniform(0, 2.5))
        for thing in carriers
    }
    carriers.sort(key=lambda thing: (rank[thing.name], thing.name))
    if "floor" in kind.put and (kind.put[0] == "floor" or not carriers):
        found = _on_floor(scene, navigator, kind.size, placed, rng)
        if found is not None:
            return None, found[0], found[1]
    for carrier in carriers:
        spot = _reachable_spot(navigator, carrier, kind.size, taken[carrier.name], rng)
        if spot is not None:
            return carrier, carrier.room, spot
    found = _on_floor(scene, navigator, kind.size, placed, rng) if "floor" in kind.put else None
    return (None, *found) if found is not None else None


def _reachable_spot(
    navigator: Navigator, carrier: SceneObject, size: Size, taken: Sequence[Taken], rng: np.random.Generator
) -> Spot | None:
    stands = navigator.approach(carrier, most=40)
    ranked = []
    for spot in spots(carrier, size, taken, through=True):
        near = min((math.dist((spot.x, spot.y), (stand.x, stand.y)) for stand in stands), default=math.inf)
        if near <= REACH - 0.04:
            ranked.append((max(0.0, near - _COMFORTABLE) * 20 + float(rng.uniform()), spot))
    return min(ranked, default=(0.0, None))[1]


def _freed(scene: Scene, navigator: Navigator, thing: SceneObject, placed: Sequence[SceneObject]) -> SceneObject:
    """A thing moved on its carrier so that it sticks in none of the carrier's parts.

    That is done when all have their places: so a seed gives the home that it always gave, but for such things.
    """
    carrier = scene.object(thing.on) if thing.on else None
    if carrier is None or not stands_through(carrier, Spot(*thing.position, thing.yaw), thing.size):
        return thing
    beside = [taken_by(other) for other in placed if other.on == thing.on and other.name != thing.name]
    free = spots(carrier, thing.size, furniture_on(scene, carrier) + beside)
    stands = navigator.approach(carrier, most=40)
    near = [spot for spot in free if any(math.dist((spot.x, spot.y), stand[:2]) <= REACH - 0.04 for stand in stands)]
    spot = min(near, key=lambda spot: round(math.dist(spot[:3], thing.position), 3), default=None)
    return thing if spot is None else thing.model_copy(update={"position": spot[:3], "yaw": spot.yaw})


def _on_floor(
    scene: Scene, navigator: Navigator, size: Size, placed: Sequence[SceneObject], rng: np.random.Generator
) -> tuple[str, Spot] | None:
    """A spot on the floor that is in nobody's way: nearer to a wall than a body can walk."""
    filled = [taken_by(thing) for thing in [*scene.objects, *placed] if thing.position[2] < 0.5]
    order = [scene.rooms[int(i)] for i in rng.permutation(len(scene.rooms))]
    for room in order:
        options = [spot for spot in _along_skirting(room, size) if is_free(taken_at(spot, size), filled)]
        for index in rng.permutation(len(options)):
            spot = options[int(index)]
            if _is_aside(scene, room, spot) and navigator.approach((spot.x, spot.y), reach=0.6, most=1):
                return room.name, spot
    return None


def _along_skirting(room: Room, size: Size) -> list[Spot]:
    off = 0.07 + size[1] / 2
    half = size[0] / 2 + 0.08
    found: list[Spot] = []
    for axis in ("x", "y"):
        rows = [_along(edge, half, off) for edge in room.edges if edge.wall.axis == axis and not edge.wall.rise]
        found += [spot for spots in zip_longest(*rows) for spot in spots if spot is not None]
    return found


def _along(edge: Edge, half: float, off: float) -> list[Spot]:
    """Spots along one side of a room, a thing's back to it."""
    across = round(edge.wall.at + sum(edge.inward) * off, 3)
    yaw = round(FACING[edge.inward], 4)
    places = [round(float(along), 3) for along in np.arange(edge.wall.start + half, edge.wall.end - half, 0.1)]
    return [Spot(*((one, across) if edge.wall.axis == "x" else (across, one)), 0.0, yaw) for one in places]


def _is_aside(scene: Scene, room: Room, spot: Spot) -> bool:
    return all(
        math.dist((door.x, door.y), (spot.x, spot.y)) > door.width / 2 + 2 * RADIUS
        for door in scene.doors
        if room.name in door.between
    )
