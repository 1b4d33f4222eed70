"""Homes in number, each different: how many rooms, which, how large, of which shapes and style the seed decides."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from coopera.core.errors import ConfigError, SimulationError
from coopera.core.household import plain
from coopera.core.randomness import rng_at
from coopera.simulation.homes.scene import Scene
from coopera.simulation.making.generate import MOST_ROOMS as MOST_OF_ONE
from coopera.simulation.making.generate import generate_proved
from coopera.simulation.making.layout import Form
from coopera.simulation.making.styles import STYLES

MOST_HOMES = 1000
FEWEST_ROOMS, MOST_ROOMS = 3, 11  # PAPER App. B: 4 to 11 rooms
_TRIES, _DRAFTS = 8, 2
_ALWAYS = ("living room", "kitchen", "bedroom", "bathroom")
_OFTEN = {
    **{"hallway": 4.0, "bedroom": 3.0, "study": 2.0, "bathroom": 1.5, "dining room": 1.5, "hobby room": 1.2},
    **{"laundry room": 1.0, "sunroom": 0.8, "garage": 0.6},
}
"""How often further rooms are drawn, one beside the other."""
_THINGS = (6.0, 9.5)
"""Between these is how many movable things there are for each room. PAPER App. B: about 8."""


_ESSENTIAL = {
    **{"living room": "sofa", "kitchen": "kitchen_sink", "bedroom": "bed", "bathroom": "toilet", "study": "desk"},
    **{"dining room": "dining_table", "hobby room": "workbench", "laundry room": "washing_machine"},
}
"""What a room must have to be one of its kind."""


class Draw(NamedTuple):
    """What is drawn for a home before anything stands in it."""

    kinds: list[str]
    form: Form
    things: int


def draw(seed: int, rooms: int | None = None, attempt: int = 0) -> Draw:
    """Draw what a home is like; `rooms` fixes how many rooms it has.

    Raises:
        ConfigError: If a home cannot have so many.
    """
    if rooms is not None and not 1 <= rooms <= MOST_OF_ONE:
        raise ConfigError(f"A home has 1 to {MOST_OF_ONE} rooms, not {rooms}.")
    rng = rng_at(seed, "varied", attempt)
    count = rooms or int(rng.integers(FEWEST_ROOMS, MOST_ROOMS + 1))
    kinds = [*_ALWAYS] if count >= len(_ALWAYS) else ["living room", "bedroom", "bathroom"][:count]
    names, weights = list(_OFTEN), np.array(list(_OFTEN.values()))
    while len(kinds) < count:
        kind = names[int(rng.choice(len(names), p=weights / weights.sum()))]
        most = 4 if kind == "bedroom" else 2 if kind == "bathroom" else 1
        if kinds.count(kind) < most * (1 + count // (MOST_ROOMS + 1)):
            kinds.append(kind)
    polygons = rng.random() < 0.75
    form = Form(
        size=round(float(rng.uniform(0.9, 1.3)), 2),
        long=round(float(rng.uniform(1.0, 2.0)), 2),
        bites=int(rng.integers(0, 1 + max(1, count // 3))) if polygons else 0,
        notch=bool(polygons and rng.random() < 0.4),
        slants=int(rng.integers(0, 3)) if polygons else 0,
        style=list(STYLES)[int(rng.integers(len(STYLES)))],
    )
    return Draw(kinds, form, round(count * float(rng.uniform(*_THINGS))))


def varied(seed: int, id: str, *, rooms: int | None = None, things: int | None = None) -> Scene:
    """Make a home in which `prove` finds no problem; where one is found, another is drawn from the same seed.

    Raises:
        SimulationError: If several have a problem.
        ConfigError: If the id, or the number of rooms or things, cannot be.
    """
    problem = ""
    for attempt in range(_TRIES):
        drawn = draw(seed, rooms, attempt)
        try:
            wanted = drawn.things if things is None else things
            own = seed + 1_000_003 * attempt
            home, found = generate_proved(own, drawn.kinds, id, things=wanted, form=drawn.form, attempts=_DRAFTS)
        except SimulationError as err:
            problem = str(err)
            continue
        found = [*_missing(home), *found]
        if not found:
            return home.model_copy(update={"seed": seed})
        problem = found[0]
    raise SimulationError(
        f"Seed {seed} gave no home without a problem in {_TRIES} tries ({problem}); use another seed."
    )


def _missing(home: Scene) -> Iterator[str]:
    for room in home.rooms:
        wanted = _ESSENTIAL.get(room.kind, "")
        if wanted and not any(thing.cls == wanted and thing.room == room.name for thing in home.fixed):
            yield f"There is no {plain(wanted)} in the {room.name}."
