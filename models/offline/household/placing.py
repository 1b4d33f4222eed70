"""Finding what a home offers for an activity: executable pick-and-places, and spots to move at. Shared common sense."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from coopera.core.affordances import Relation, affordances
from coopera.core.household import FreeMotion, PickPlace
from coopera.models.offline.household.knowledge import Activity
from coopera.models.offline.household.reading import Piece, Surroundings, room_kind
from coopera.models.offline.household.sense import CommonSense

Pick = Callable[[Sequence[Piece], str], Piece]
"""Chooses one of several equal objects; the text says for what."""


class Placement(NamedTuple):
    """One executable pick-and-place; `order` is its place in the sequence in which an activity is done."""

    thing: Piece
    spot: Piece
    order: int

    @property
    def relation(self) -> Relation:
        """Where the thing usually goes: inside the furniture, such as a plate in the dishwasher, or on it."""
        return affordances().relation(self.thing.cls, self.spot.cls)

    def act(self) -> PickPlace:
        """Return it as an act."""
        return PickPlace(
            object_id=self.thing.id,
            object=self.thing.name,
            receptacle_id=self.spot.id,
            receptacle=self.spot.name,
            relation=self.relation,
        )

    def words(self) -> str:
        """Say it in words, such as "the plate in the dishwasher"."""
        return self.act().describe().removeprefix("put ")


def by_name(pieces: Sequence[Piece], _what: str) -> Piece:
    """Choose the first by name: what one does who knows no preference."""
    return min(pieces, key=lambda piece: piece.name)


def in_rooms(pieces: Sequence[Piece], activity: Activity) -> list[Piece]:
    """Return those in a room where the activity is done; all, where none is."""
    inside = [piece for piece in pieces if room_kind(piece.room) in activity.rooms]
    return inside or list(pieces)


def feasible_places(activity: Activity, fixed: Surroundings, movable: Surroundings) -> list[int]:
    """Return which of the activity's places the home has both objects for."""
    return [i for i, (thing, spot) in enumerate(activity.places) if movable.of(thing) and fixed.of(spot)]


def placement(
    activity: Activity, index: int, fixed: Surroundings, movable: Surroundings, taken: Sequence[str], pick: Pick
) -> Placement:
    """Make one of the activity's feasible places executable, with a thing not yet taken where there is one."""
    thing_class, spot_class = activity.places[index]
    free = [piece for piece in movable.of(thing_class) if piece.name not in taken] or movable.of(thing_class)
    spots = in_rooms(fixed.of(spot_class), activity)
    return Placement(pick(free, thing_class), pick(spots, f"{activity.id} {spot_class}"), index)


def makeshift_places(
    sense: CommonSense, activity: Activity, fixed: Surroundings, movable: Surroundings
) -> list[Placement]:
    """Return placements for a home that lacks the usual objects, the most fitting first.

    The activity's own things come first, then the things most like them. For each thing, the usual spots of any
    activity come before unusual ones. Among these, the spots most like the activity's own come first.
    """
    known = {thing for thing, _ in activity.places}
    things = _by_fit(sense, movable.pieces, [thing for thing, _ in activity.places])[:12]
    spots = _by_fit(sense, fixed.pieces, [spot for _, spot in activity.places])
    spots.sort(key=lambda piece: room_kind(piece.room) not in activity.rooms)
    ranked: list[tuple[tuple[int, ...], Placement]] = []
    for i, thing in enumerate(things):
        for j, spot in enumerate(spots[:12]):
            strange = (thing.cls, spot.cls) not in sense.household.usual_places
            rank = (0, strange, max(i, j), i, j) if thing.cls in known else (1, i, strange, j)
            ranked.append((rank, Placement(thing, spot, 0)))
    ranked.sort(key=lambda pair: pair[0])
    return [place._replace(order=len(activity.places) + n) for n, (_, place) in enumerate(ranked)]


def fill_up(chosen: Sequence[Placement], spare: Sequence[Placement], count: int) -> list[Placement]:
    """Add spare placements up to a count: new things first, then new pairs; none that reads like another."""
    result = list(chosen)
    texts = {place.act().describe() for place in result}
    things = {place.thing.name for place in result}
    for fresh_thing in (True, False):
        for place in spare:
            if len(result) >= count:
                return result
            text = place.act().describe()
            if text not in texts and not (fresh_thing and place.thing.name in things):
                result.append(place)
                texts.add(text)
                things.add(place.thing.name)
    return result


def spots(sense: CommonSense, activity: Activity, fixed: Surroundings) -> dict[str, list[Piece]]:
    """Return where the activity can be done, by class in its own order; never empty if there is furniture."""
    found = {cls: in_rooms(fixed.of(cls), activity) for cls in activity.fixed if fixed.of(cls)}
    if found or not fixed.pieces:
        return found
    nearest = _by_fit(sense, fixed.pieces, activity.fixed)[0]
    return {nearest.cls: [nearest]}


def usable(activity: Activity, thing: str, furniture: Iterable[str]) -> bool:
    """Whether the common motion with a thing of the activity can be made at one of some classes of furniture."""
    return any(affordances().suits(activity.things[thing], cls) for cls in furniture)


def free_motion(spot: Piece, thing: str, motion: str) -> FreeMotion:
    """Return a free-form task as an act."""
    return FreeMotion(target_id=spot.id, target=spot.name, in_hand=thing, motion=motion)


def _by_fit(sense: CommonSense, pieces: Sequence[Piece], known: Sequence[str]) -> list[Piece]:
    """Sort objects by how like their class is to the likest of the known classes; the known ones come first."""
    classes = list(dict.fromkeys(known))
    likeness = {piece.cls: round(sense.nearest(piece.cls, classes)[1], 6) for piece in pieces}
    return sorted(pieces, key=lambda piece: (-likeness[piece.cls], piece.name))
