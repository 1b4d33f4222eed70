"""Acts and observations as numbers, so that any learner can read and write them.

The names behind the numbers are public: `things`, `places`, `motions`, `classes`, `rooms`. They follow from the home,
sorted, so a number means the same in each episode.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from coopera.core.affordances import Relation
from coopera.core.errors import ConfigError
from coopera.core.household import HUMAN, ROBOT, Act, FreeMotion, HandOver, Percept, PickPlace, plain
from coopera.simulation.env.life import Hour
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.magic_box import shape_of
from coopera.simulation.world import World

Numbers: TypeAlias = NDArray[np.int64]
WAIT, PUT_ON, PUT_INSIDE, BRING = range(4)
"""Kinds of the robot's acts: wait and watch; put a thing on furniture, or inside it; bring a thing to the person."""
DO = BRING
"""The last kind of the person's acts is another one: a motion at furniture, with a thing in hand."""
_RELATIONS: dict[int, Relation] = {PUT_ON: "on", PUT_INSIDE: "inside"}
_ELSEWHERE = ("unseen", "floor", "robot", "person")
"""What a thing's place is besides furniture: never seen, on the floor, or with one of the two."""


class Coding:
    """The numbers of one home."""

    def __init__(self, world: World, brings: Sequence[str] = ()) -> None:
        """Read the names of a home.

        Args:
            world: The home.
            brings: Things that are not in the home and can be brought, by their names; by default every class of
                thing that the catalogue has a shape for.

        Raises:
            ConfigError: If one of these names is empty or stands there twice.
        """
        fixed, movable = world.objects("fixed"), world.objects("movable")
        self.home_things: tuple[str, ...] = tuple(sorted(movable))
        more = [plain(name) for name in (brings or sorted(catalogue().movable))]
        if len({*more}) < len(more) or not all(more):
            raise ConfigError(f"brings: expected names, each once, not {more}")
        self.things: tuple[str, ...] = (*self.home_things, *(one for one in more if one not in movable))
        self.places: tuple[str, ...] = tuple(sorted(fixed))
        self.rooms: tuple[str, ...] = tuple(world.rooms)
        self.motions: tuple[str, ...] = tuple(world.motions)
        self.labels: tuple[str, ...] = tuple(world.motion_classes)
        self.classes: tuple[str, ...] = tuple(sorted({plain(world.class_of(one)) for one in self.things}))
        self._ids = {name: number for name, (number, _) in (fixed | movable).items()}
        self._caption_of = world.caption_of
        self._class = {one: world.class_of(one) for one in self.things}

    # Acts

    @property
    def robot_acts(self) -> list[int]:
        """How many kinds, things and places an act of the robot chooses from."""
        return [4, len(self.things), len(self.places)]

    @property
    def human_acts(self) -> list[int]:
        """The same for the person, and motions."""
        return [*self.robot_acts, len(self.motions)]

    def act(self, numbers: Sequence[int] | Numbers) -> Act | None:
        """The act that numbers stand for: three of the robot, four of the person; None to wait.

        Numbers that the kind has no use for are not read. Whether it can be done is found out by doing it.
        """
        kind, thing, place, *motion = (int(number) for number in numbers)
        if kind == WAIT:
            return None
        name, where = self.things[thing], self.places[place]
        if kind in _RELATIONS:
            number, furniture = self._ids.get(name, -1), self._ids[where]
            relation = _RELATIONS[kind]
            return PickPlace(
                object_id=number, object=name, receptacle_id=furniture, receptacle=where, relation=relation
            )
        if not motion:
            return HandOver(object=name)
        return FreeMotion(target_id=self._ids[where], target=where, in_hand=name, motion=self.motions[motion[0]])

    def numbers(self, act: Act | None, *, person: bool = False) -> Numbers:
        """The numbers of an act.

        A thing that has none goes by another one of its class, or by what it looks like; a motion in words of its own
        by the one that is meant.

        Raises:
            KeyError: If it names what this home does not have.
        """
        found = [WAIT, 0, 0, 0]
        if isinstance(act, PickPlace):
            kind = PUT_ON if act.relation == "on" else PUT_INSIDE
            found = [kind, self.thing(act.object), self._index(self.places, act.receptacle), 0]
        elif isinstance(act, HandOver):
            found = [BRING, self.thing(act.object), 0, 0]
        elif isinstance(act, FreeMotion):
            place, motion = self._index(self.places, act.target), self.motions.index(self._caption_of(act.motion))
            found = [DO, self.thing(act.in_hand), place, motion]
        return np.array(found if person else found[:3], dtype=np.int64)

    def thing(self, name: str) -> int:
        """The number of a thing by its name, or of the first one of that class or that looks like it.

        Raises:
            KeyError: If there is neither.
        """
        if name in self.things:
            return self.things.index(name)
        for words in (plain(name), plain(shape_of(name).cls)):
            for at, one in enumerate(self.things):
                if words in (plain(one), plain(self._class[one])):
                    return at
        raise KeyError(name)

    @staticmethod
    def _index(names: Sequence[str], name: str) -> int:
        if name not in names:
            raise KeyError(name)
        return names.index(name)

    # Observations

    def clock(self, hour: Hour) -> Numbers:
        """Weekday (Monday is 0) and hour of the day."""
        return np.array([hour.day % 7, hour.hour % 24], dtype=np.int64)

    def whereabouts(self, places: Mapping[str, str]) -> Numbers:
        """For each thing of the home what is known of its place: 0 unseen, 1 floor, 2 and 3 in hand, then furniture."""
        found = np.zeros(len(self.home_things), dtype=np.int64)
        for at, thing in enumerate(self.home_things):
            found[at] = self._place(places.get(thing, _ELSEWHERE[0]))
        return found

    @property
    def whereabouts_sizes(self) -> list[int]:
        """How many values each of them can have."""
        return [len(_ELSEWHERE) + len(self.places)] * len(self.home_things)

    def _place(self, where: str) -> int:
        where = {str(HUMAN): "person", str(ROBOT): "robot"}.get(where, where.removeprefix("inside "))
        if where in _ELSEWHERE:
            return _ELSEWHERE.index(where)
        return len(_ELSEWHERE) + self.places.index(where) if where in self.places else 0

    def percept(self, seen: Percept | None) -> Numbers:
        """Room, motion label, furniture and class in hand of what was seen last; each 0 where it is not known."""
        if seen is None:
            return np.zeros(4, dtype=np.int64)
        near = seen.near[0] if seen.near else ""
        values = (
            _of(self.rooms, seen.room),
            _of(self.labels, seen.motion),
            _of(self.places, near),
            _of(self.classes, plain(seen.in_hand or "")),
        )
        return np.array(values, dtype=np.int64)

    @property
    def percept_sizes(self) -> list[int]:
        """How many values each of them can have."""
        return [len(names) + 1 for names in (self.rooms, self.labels, self.places, self.classes)]


def _of(names: Sequence[str], name: str) -> int:
    return names.index(name) + 1 if name in names else 0
