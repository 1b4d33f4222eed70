"""The shared common sense as data: reads and checks household.yaml. Nothing here is about a particular person."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import chain, pairwise
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
import yaml
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, ValidationError, ValidationInfo, field_validator

from coopera.core.errors import ConfigError
from coopera.core.lazy import made_once
from coopera.core.people import TRAITS, BigFive, Frozen

SHIPPED = Path(__file__).parents[1] / "household.yaml"
FIRST, LAST = 9, 21
"""The hours of day that the activities' curves cover, both inclusive."""

_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast where PyYAML has its C part
_MOVED = (
    "where a motion can be done now stands in core/affordances.yaml, under motions, for everybody; take the field out "
    "(a motion that is not in there can be done anywhere)"
)

Floats = NDArray[np.float64]
Text = Annotated[str, Field(min_length=2, max_length=200)]
Weight = Annotated[float, Field(ge=0, le=50)]


def _known_traits(loadings: dict[str, float]) -> dict[str, float]:
    if unknown := sorted(set(loadings) - set(TRAITS)):
        raise ValueError(f"{unknown[0]!r} is not one of {', '.join(TRAITS)}")
    return loadings


Loadings = Annotated[dict[str, Annotated[float, Field(ge=-1, le=1)]], AfterValidator(_known_traits)]
"""What a trait above its middle adds to something, by trait."""


class Activity(Frozen):
    """One thing that people do at home; the fields are explained at the head of household.yaml."""

    id: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
    wordings: Annotated[tuple[Text, ...], Field(min_length=2)]
    also: tuple[Text, ...] = ()
    statement: Text
    hours: Annotated[tuple[Weight, ...], Field(min_length=LAST - FIRST + 1, max_length=LAST - FIRST + 1)]
    rooms: Annotated[tuple[Text, ...], Field(min_length=1)]
    fixed: Annotated[tuple[Text, ...], Field(min_length=1)]
    things: Annotated[dict[Text, Text], Field(min_length=5)]
    motions: tuple[Text, ...] = ()
    places: Annotated[tuple[tuple[Text, Text], ...], Field(min_length=3)]
    follows: tuple[str, ...] = ()
    big_five: Loadings = {}
    source: Text
    assumed: tuple[str, ...] = ()
    dirty: tuple[Text, ...] = ()
    repeatable: bool = False
    need: bool = False
    closes: bool = False

    @field_validator("hours")
    @classmethod
    def _some_hour(cls, hours: tuple[float, ...]) -> tuple[float, ...]:
        if not any(hours):
            raise ValueError("at least one of the weights must be above 0")
        return hours

    @field_validator("assumed")
    @classmethod
    def _assumed_are_loadings(cls, assumed: tuple[str, ...], info: ValidationInfo) -> tuple[str, ...]:
        if strange := sorted(set(assumed) - set(info.data.get("big_five", assumed))):
            raise ValueError(f"{strange[0]!r} has no loading in big_five")
        return assumed

    @cached_property
    def all_motions(self) -> tuple[str, ...]:
        """Every motion that belongs to the activity, without repeats, in the file's order."""
        return tuple(dict.fromkeys([*self.things.values(), *self.motions]))

    @cached_property
    def thing_names(self) -> tuple[str, ...]:
        """The things in hand, in the order in which they come into play."""
        return tuple(self.things)


class Household(Frozen):
    """All activities, in the file's order: the index of an activity is its place in every array."""

    looks_like: Annotated[dict[Text, Text], Field(min_length=1)]
    activities: Annotated[tuple[Activity, ...], Field(min_length=2)]

    @cached_property
    def uses(self) -> dict[str, frozenset[str]]:
        """The motions that anybody makes with each thing, in whatever activity."""
        made: dict[str, set[str]] = {}
        for activity in self.activities:
            for thing, motion in activity.things.items():
                made.setdefault(thing, set()).add(motion)
        return {thing: frozenset(motions) for thing, motions in made.items()}

    @cached_property
    def usual_places(self) -> frozenset[tuple[str, str]]:
        """What is put where, in whatever activity: (movable class, fixed class)."""
        return frozenset(place for activity in self.activities for place in activity.places)

    @cached_property
    def index(self) -> dict[str, int]:
        """Place of each activity by id."""
        return {activity.id: i for i, activity in enumerate(self.activities)}

    @cached_property
    def log_hours(self) -> Floats:
        """Log of how usual each activity is at each hour of the day; shape (activities, 24).

        Hours outside the curves are as their nearest covered hour.
        """
        weights = np.array([activity.hours for activity in self.activities]) + 0.005
        columns = np.clip(np.arange(24), FIRST, LAST) - FIRST
        return np.asarray(np.log(weights)[:, columns], dtype=np.float64)

    @cached_property
    def follow_matrix(self) -> Floats:
        """1 where the column's activity tends to come right after the row's; shape (activities, activities)."""
        matrix = np.zeros((len(self.activities), len(self.activities)))
        for i, activity in enumerate(self.activities):
            matrix[i, [self.index[other] for other in activity.follows]] = 1.0
        return matrix

    @cached_property
    def loadings(self) -> Floats:
        """Big-Five loadings in the order of `TRAITS`; shape (activities, 5)."""
        rows = [[activity.big_five.get(trait, 0.0) for trait in TRAITS] for activity in self.activities]
        return np.array(rows, dtype=np.float64)

    def trait_pull(self, big_five: BigFive) -> Floats:
        """How much a personality speaks for each activity, in logits; shape (activities,)."""
        deviation = np.array([getattr(big_five, trait) - 3.0 for trait in TRAITS])
        return np.asarray(self.loadings @ deviation, dtype=np.float64)


class Extension(Frozen):
    """What a user's file changes of the shipped one: an activity of a known id replaces it, the others come last."""

    extends: Literal["shipped"]
    looks_like: dict[Text, Text] = {}
    activities: tuple[Activity, ...] = ()

    def applied(self) -> Household:
        """The shipped household with these changes."""
        known = shipped()
        own = {activity.id: activity for activity in self.activities}
        kept = tuple(own.get(activity.id, activity) for activity in known.activities)
        added = tuple(activity for activity in self.activities if activity.id not in known.index)
        return Household(
            looks_like={**known.looks_like, **self.looks_like},
            activities=kept + added,
        )


Read = TypeVar("Read", bound=Frozen)


def load(path: Path = SHIPPED) -> Household:
    """Read a household file, or one that `extends: shipped`, and check that it hangs together.

    Raises:
        ConfigError: Naming the file, the activity and the field, and what was expected.
    """
    try:
        data = yaml.load(path.read_text(encoding="utf-8"), Loader=_Loader)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as err:
        raise ConfigError(f"{path}: cannot be read as YAML: {' '.join(str(err).split())}") from err
    if isinstance(data, dict) and "done_at" in data:
        raise ConfigError(f"{path}: field 'done_at': {_MOVED}")
    if isinstance(data, dict) and "extends" in data:
        extension = _parsed(Extension, data, path)
        _refuse(_double_ids(extension.activities), path)
        household = extension.applied()
    else:
        household = _parsed(Household, data, path)
    _refuse(chain(_double_ids(household.activities), _double_wordings(household), _unknowns(household)), path)
    return household


def _parsed(kind: type[Read], data: Any, path: Path) -> Read:
    try:
        return kind.model_validate(data)
    except ValidationError as err:
        raise ConfigError(f"{path}: {_first_problem(err, data)}") from err


@made_once()
def shipped() -> Household:
    """Return the household file that comes with the package."""
    return load()


def _first_problem(err: ValidationError, data: Any) -> str:
    """Say the first problem as "activity 'bake', field 'hours': ..."."""
    first = err.errors(include_url=False)[0]
    where = [str(part) for part in first["loc"]]
    said = first["msg"].removeprefix("Value error, ")
    if len(where) >= 2 and where[0] == "activities":
        rows = data["activities"]
        row = rows[int(where[1])] if isinstance(rows, list) else {}
        name = row.get("id", f"number {int(where[1]) + 1}") if isinstance(row, dict) else f"number {int(where[1]) + 1}"
        return f"activity {name!r}, field {'.'.join(where[2:]) or 'all'!r}: {said}"
    return f"field {'.'.join(where) or 'all'!r}: {said}"


def _refuse(problems: Iterator[str], path: Path) -> None:
    for problem in problems:
        raise ConfigError(f"{path}: {problem}")


def _double_ids(activities: Sequence[Activity]) -> Iterator[str]:
    for before, after in pairwise(sorted(activity.id for activity in activities)):
        if before == after:
            yield f"activity {after!r}, field 'id': each id may be used once only"


def _double_wordings(household: Household) -> Iterator[str]:
    seen: dict[str, str] = {}
    for activity in household.activities:
        for wording in activity.wordings:
            other = seen.setdefault(key(wording), activity.id)
            if other != activity.id or len({key(text) for text in activity.wordings}) < len(activity.wordings):
                yield f"activity {activity.id!r}, field 'wordings': {wording!r} stands also in activity {other!r}"


def _unknowns(household: Household) -> Iterator[str]:
    for activity in household.activities:
        for other in activity.follows:
            if other not in household.index:
                yield f"activity {activity.id!r}, field 'follows': there is no activity {other!r}"
        fields = {f"things.{thing}": motion for thing, motion in activity.things.items()}
        for field, motion in [*fields.items(), *(("motions", motion) for motion in activity.motions)]:
            if motion not in household.looks_like:
                yield f"activity {activity.id!r}, field {field!r}: {motion!r} is not listed under looks_like"


def key(text: str) -> str:
    """Return a text in the form in which texts are compared word by word: lower case, plain, no full stop."""
    return re.sub(r"[^a-z0-9]+", " ", text.lower()).strip()
