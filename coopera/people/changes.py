"""What becomes different in people's lives, from a file or drawn by seed."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field, ValidationError

from coopera.config.files import read_yaml
from coopera.core.errors import ConfigError
from coopera.core.lazy import made_once
from coopera.core.people import Frozen, PersonId
from coopera.core.randomness import rng_at
from coopera.graphs.players.changes import Change, Changes, Logits, Work, no_changes

NONE, SEEDED = "none", "seeded"
SEASON = 91  # days
MOODY = 0.35  # share of days with a mood of their own
FIRST_DRIFT, LAST_DRIFT, DRIFT_TAKES = 10, 45, 30  # days
FIRST_TURN, LAST_TURN = 15, 85  # days on which something changes at once

_MOST_BYTES = 4 * 2**20  # of a file of changes
_SAID = {
    "missing": "this is missing",
    "tuple_type": "must be a list",
    "dict_type": "must be a mapping of fields to values",
    "model_type": "must be a mapping of fields to values",
    "too_long": "may have 10000 entries at most",
    "string_too_short": "must be a text of 1 to 200 characters",
    "string_too_long": "must be a text of 1 to 200 characters",
}

_Effects = dict[str, Logits]


class _Event(Frozen):
    text: Annotated[str, Field(min_length=1, max_length=200)]
    more: _Effects = {}
    never: tuple[str, ...] = ()
    work: Work | None = None
    days: Annotated[int, Field(ge=1)] | None = None


class _Catalogue(Frozen):
    moods: tuple[_Event, ...]
    hobbies: tuple[_Event, ...]
    drifts: tuple[_Event, ...]
    illnesses: tuple[_Event, ...]
    jobs: tuple[_Event, ...]
    seasons: tuple[_Event, ...]


class _File(Frozen):
    changes: Annotated[tuple[Change, ...], Field(max_length=10_000)] = ()
    moods: bool = False


def open_changes(named: str, seed: int, activities: Collection[str] | None = None) -> Changes:
    """Return what is different on each day: nothing, what a seed draws, or what a file says.

    Args:
        named: "none", "seeded" or the path of a YAML file with `changes` and perhaps `moods: true`.
        seed: The run's.
        activities: Ids that a file may name; None does not look.

    Raises:
        ConfigError: If the file is wrong; names the file, the change and what was expected.
    """
    if named == NONE:
        return no_changes
    if (path := changes_file(named)) is None:
        return lambda person, day: [*drawn(seed, person, day), *mood(seed, person, day)]
    file = read_changes(path, activities)

    def changes(person: PersonId, day: int) -> Sequence[Change]:
        listed = [one for one in file.changes if one.person in (None, person) and one.strength(day) > 0]
        return [*listed, *(mood(seed, person, day) if file.moods else ())]

    return changes


def changes_file(named: str) -> Path | None:
    """The file that the setting `changes` names; None for `none` and `seeded`."""
    return None if named in (NONE, SEEDED) else Path(named).expanduser()


def read_changes(path: Path, activities: Collection[str] | None = None) -> _File:
    """Read a file of changes.

    Raises:
        ConfigError: If it cannot be read or is wrong.
    """
    data = read_yaml(path, "file of changes", _MOST_BYTES)
    try:
        file = _File.model_validate(data)
    except ValidationError as err:
        raise ConfigError(f"{path}: {_complaint(err)}") from None
    for place, change in enumerate(file.changes, 1):
        if change.until is not None and change.until <= change.day:
            raise ConfigError(
                f"{path}: change {place}, field until: must come after day {change.day}, not on day {change.until}."
            )
        for field, names in (("more", change.more), ("never", change.never)):
            if activities is not None and (unknown := [name for name in names if name not in activities]):
                near = get_close_matches(unknown[0], activities, 1)
                meant = f"; did you mean {near[0]}?" if near else "."
                raise ConfigError(f"{path}: change {place}, field {field}: there is no activity {unknown[0]!r}{meant}")
    return file


def mood(seed: int, person: PersonId, day: int) -> list[Change]:
    """Draw the mood of a day; on most days there is none of note."""
    rng = rng_at(seed, "mood", person, day)
    if rng.random() >= MOODY:
        return []
    return [_change("mood", _pick(_catalogue().moods, rng), day, until=day + 1)]


def drawn(seed: int, person: PersonId, day: int) -> list[Change]:
    """Draw the changes of a life, and return those of a day.

    A life has a season that passes, one slow drift, a new hobby, a job that ends or not, and an illness now and then.
    """
    rng = rng_at(seed, "changes", person)
    start = int(rng.integers(4))
    life = [_change("drift", _pick(_catalogue().drifts, rng), _day(rng, FIRST_DRIFT, LAST_DRIFT), ramp=DRIFT_TAKES)]
    life.append(_change("hobby", _pick(_catalogue().hobbies, rng), _day(rng, FIRST_TURN, LAST_TURN)))
    if rng.random() < 0.3:
        life.append(_change("job", _pick(_catalogue().jobs, rng), _day(rng, FIRST_TURN, LAST_TURN)))
    ill = _day(rng, 3, 40)
    while ill <= day:
        illness = _pick(_catalogue().illnesses, rng)
        life.append(_change("illness", illness, ill, until=ill + (illness.days or 1)))
        ill += _day(rng, 30, 120)
    season = (start + day // SEASON) % 4
    since = day - day % SEASON
    life.append(_change("season", _catalogue().seasons[season], since, until=since + SEASON))
    return [one for one in life if one.strength(day) > 0]


def _change(kind: Any, event: _Event, day: int, *, until: int | None = None, ramp: int = 0) -> Change:
    return Change(
        kind=kind, text=event.text, day=day, until=until, ramp=ramp, more=event.more, never=event.never, work=event.work
    )


def _pick(events: Sequence[_Event], rng: np.random.Generator) -> _Event:
    return events[int(rng.integers(len(events)))]


def _day(rng: np.random.Generator, first: int, last: int) -> int:
    return int(rng.integers(first, last + 1))


@made_once()
def _catalogue() -> _Catalogue:
    return _Catalogue.model_validate(read_yaml(Path(__file__).with_name("changes.yaml"), "list of changes"))


def _complaint(err: ValidationError) -> str:
    first = err.errors(include_url=False)[0]
    place, *field = first["loc"][1:] if first["loc"][:1] == ("changes",) and len(first["loc"]) > 1 else (None,)
    known = _File if place is None else Change
    names = [str(part) for part in (first["loc"] if place is None else field)]
    where = [f"change {int(place) + 1}"] if place is not None else []
    where += [f"field {'.'.join(names)}"] if names else []
    if names[-1:] in (["day"], ["until"]) and first["type"] == "greater_than_equal":
        said = f"day {first['input']} is before the life, whose days count from 0"
    elif first["type"] == "extra_forbidden":
        said = f"there is no such field; known are {', '.join(known.model_fields)}"
    else:
        said = _SAID.get(first["type"]) or first["msg"].replace("Input should be", "must be")
    return f"{', '.join(where)}: {said}."
