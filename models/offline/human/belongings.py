"""Where a person wants things to be: in their own order of places, drawn once for each thing. Person's side only.

How much people differ stands in belongings.csv: thing, place, and the weight that Housekeep's ten people give it, made
of their ranks by `python -m benchmarks.belongings` (Kant et al. 2022, github.com/yashkant/housekeep; MIT License,
Copyright (c) 2022 Yash Kant and others). DEVIATES: in the paper a language model says where a person puts things.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Collection, Mapping
from pathlib import Path

import numpy as np

from coopera.core.affordances import affordances
from coopera.core.lazy import made_once
from coopera.models.offline.household.knowledge import Activity, Household
from coopera.models.offline.household.reading import Surroundings, room_kind

_FILE = Path(__file__).with_suffix(".csv")
CUSTOM = 0.35
"""What custom adds to the place where the household file puts a thing for an activity, as a share of all weights. So
two people agree as often as Housekeep's: `python -m benchmarks.belongings RANKS.csv --agreement`."""


class Belongings:
    """One person's order of places for each thing: of those at hand, the first is where they want it.

    The order is a draw without replacement in proportion to the weights (Plackett and Luce). The draw is the same at
    every hour and in every home; what a home has and in which rooms the person is busy leaves more or less of it.
    """

    def __init__(self, rng: Callable[..., np.random.Generator], household: Household) -> None:
        self._rng, self._household = rng, household
        self._luck: dict[tuple[str, str], float] = {}

    def at_home(self, activity: Activity, fixed: Surroundings) -> Activity:
        """An activity with each thing put where this person wants it, of the furniture in the activity's rooms.

        What is put to use, at a tap or an appliance, stays where it is of use. No thing has the same place twice.
        """
        here = {piece.cls for piece in fixed.pieces if room_kind(piece.room) in activity.rooms}
        taken = {place for place in activity.places if of_use(place[1])}
        places: list[tuple[str, str]] = []
        for thing, usual in activity.places:
            spot = usual
            if not of_use(usual):
                near = {*here, usual} if fixed.of(usual) else here
                free = (cls for cls in self._order(thing, usual, near) if (thing, cls) not in taken)
                spot = next(free, usual)
                taken.add((thing, spot))
            places.append((thing, spot))
        return activity.model_copy(update={"places": tuple(dict.fromkeys(places))})

    def _order(self, thing: str, usual: str, here: Collection[str]) -> list[str]:
        """The places of `here` for a thing, the dearest first: those that people call right, and the usual one."""
        weights = {cls: weight for cls, weight in self._right(thing).items() if cls in here}
        if usual in here:
            weights[usual] = weights.get(usual, 0.0) + CUSTOM * (sum(weights.values()) or 1.0)
        return sorted(weights, key=lambda cls: (-np.log(weights[cls]) - self._lucky(thing, cls), cls))

    def _right(self, thing: str) -> Mapping[str, float]:
        """How often people call each place right for a thing; of a thing unknown to them, the household file's."""
        return people_say().get(thing) or {cls: CUSTOM for known, cls in self._household.usual_places if known == thing}

    def _lucky(self, thing: str, place: str) -> float:
        if (thing, place) not in self._luck:
            self._luck[thing, place] = float(self._rng("belongs", thing, place).gumbel())
        return self._luck[thing, place]


def of_use(furniture: str) -> bool:
    """Whether things are put to a class of furniture to be used there, as into a washing machine or under a tap."""
    return affordances().is_one_of(furniture, affordances().states["powered"].of)


@made_once()
def people_say() -> dict[str, dict[str, float]]:
    """The table beside this file: the weight of each place, by thing."""
    said: dict[str, dict[str, float]] = {}
    with _FILE.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            said.setdefault(row["thing"], {})[row["place"]] = float(row["weight"])
    return said
