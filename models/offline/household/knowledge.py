"""Common sense as data: reads and checks household files. Nothing here is about a particular person."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import chain, pairwise
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
import yaml
from numpy.typing import NDArray
from pydantic import AfterValidator, BeforeValidator, Field, ValidationError, ValidationInfo, field_validator

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.lazy import made_once
from coopera.core.people import TRAITS, BigFive, Frozen
from coopera.core.strict_yaml import MOST_BYTES, load_yaml
from coopera.core.time_use import CATEGORIES, Category
from coopera.models.offline.household.grammar import Template, cores, parse

SHIPPED = Path(__file__).parents[1] / "household.yaml"
"""The person's common sense."""
ROBOTS = SHIPPED.with_name("robot_household.yaml")
"""The robot's, written apart from the person's."""
FIRST, LAST = 9, 21
"""The hours of day that the activities' curves cover, both inclusive."""
HOUR = 60  # minutes

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


def _grammatical(wording: str) -> str:
    parse(wording)
    return wording


Wording = Annotated[str, AfterValidator(_grammatical)]
"""A wording with or without alternatives, as `household.grammar` reads it."""
Loadings = Annotated[dict[str, Annotated[float, Field(ge=-1, le=1)]], AfterValidator(_known_traits)]
"""What a trait above its middle adds to something, by trait."""


def _known_categories(minutes: Any) -> Any:
    if isinstance(minutes, dict) and (unknown := [name for name in minutes if name not in CATEGORIES]):
        raise ValueError(f"{unknown[0]!r} is not one of {', '.join(CATEGORIES)}")
    return minutes


def _within_an_hour(minutes: dict[Category, int]) -> dict[Category, int]:
    if sum(minutes.values()) > HOUR:
        raise ValueError(f"the minutes are {sum(minutes.values())} in all, at most {HOUR}")
    return minutes


Minutes = Annotated[
    dict[Category, Annotated[int, Field(strict=True, ge=1, le=HOUR)]],
    BeforeValidator(_known_categories),
    AfterValidator(_within_an_hour),
]
"""Minutes of an hour by category of time use, 60 in all at most."""


class Activity(Frozen):
    """One thing that people do at home; the fields are explained at the head of household.yaml."""

    id: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
    wordings: tuple[Wording, ...]
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
    uses: Minutes = {}
    lasts: Annotated[float, Field(ge=1, le=12)] = 1.0
    daily: Annotated[float, Field(ge=0, le=1)] = 0.0
    instead: tuple[str, ...] = ()
    after: dict[str, Annotated[float, Field(ge=0, le=1)]] = {}
    away: bool = False
    timing: Text | None = None
    assumed: tuple[str, ...] = ()
    dirty: tuple[Text, ...] = ()
    repeatable: bool = False
    need: bool = False
    closes: bool = False

    @field_validator("wordings")
    @classmethod
    def _some_wordings(cls, wordings: tuple[str, ...]) -> tuple[str, ...]:
        if sum(parse(wording).count for wording in wordings) < 2:
            raise ValueError("at least two wordings are needed, or one with alternatives in braces")
        return wordings

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
    def category(self) -> Category:
        """The category that takes most of its hour."""
        return max(self.minutes, key=lambda name: (self.minutes[name], name))

    @cached_property
    def whole(self) -> bool:
        """Whether it fills its hour, so that it may flow around what is shorter."""
        return sum(self.minutes.values()) == HOUR

    @cached_property
    def minutes(self) -> dict[Category, int]:
        """What an hour of it counts as, by category of time use; where the file says nothing, 60 minutes of "other"."""
        return self.uses or {"other": HOUR}

    @cached_property
    def templates(self) -> tuple[Template, ...]:
        """The wordings with their alternatives, in the file's order."""
        return tuple(map(parse, self.wordings))

    @cached_property
    def canonical(self) -> tuple[str, ...]:
        """One plain text for each wording, with the first of all alternatives."""
        return tuple(template.canonical for template in self.templates)

    def expansions(self) -> Iterator[str]:
        """Yield every text in which the intention may be put, touches aside."""
        return chain.from_iterable(template.expansions() for template in self.templates)

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

    def __hash__(self) -> int:
        """By its ids: equal households have the same ones, and what is made of one can be kept for it."""
        return hash(tuple(self.index))

    @cached_property
    def sha256(self) -> str:
        """SHA-256 of all that it says, whatever file it was read from."""
        return hashlib.sha256(self.model_dump_json().encode()).hexdigest()

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
    def by_wording(self) -> dict[str, Activity]:
        """The activity of every text in which one may be put, by the text's `key`."""
        return {said: activity for activity in self.activities for said in _keys(activity.expansions())}

    def named(self, text: str) -> Activity | None:
        """Return the activity that a text names by one of its wordings, with or without a person's touch around it."""
        found = (self.by_wording.get(key(core)) for core in cores(text))
        return next(filter(None, found), None) or self._also.get(key(text))

    @cached_property
    def _also(self) -> dict[str, Activity]:
        return {key(said): activity for activity in self.activities for said in activity.also}

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
    def away(self) -> NDArray[np.bool_]:
        """Which activities are done outside the home; shape (activities,)."""
        return np.array([activity.away for activity in self.activities])

    @cached_property
    def chores(self) -> dict[str, dict[int, float]]:
        """What may come right after an activity, by its id: the chance, by place."""
        left: dict[str, dict[int, float]] = {activity.id: {} for activity in self.activities}
        for place, activity in enumerate(self.activities):
            for cause, chance in activity.after.items():
                left[cause][place] = chance
        return left

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
        data = load_yaml(read_text(path, "household file", MOST_BYTES))
    except yaml.YAMLError as err:
        raise ConfigError(f"{path}: cannot be read as YAML: {' '.join(str(err).split())}") from err
    if not isinstance(data, dict):
        found = "nothing" if data is None else f"a {type(data).__name__}"
        raise ConfigError(f"{path}: a household file must be a mapping of fields to values, not {found}.")
    if "done_at" in data:
        raise ConfigError(f"{path}: field 'done_at': {_MOVED}")
    if "extends" in data:
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
    """Return the person's household file, as it comes with the package."""
    return load()


@made_once()
def robots() -> Household:
    """Return the robot's household file, as it comes with the package."""
    return load(ROBOTS)


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
    counted = sum(template.count for activity in household.activities for template in activity.templates)
    if len(household.by_wording) == counted:
        return
    seen: dict[str, str] = {}
    for activity in household.activities:
        for text in activity.expansions():
            if other := seen.get(key(text)):
                yield f"activity {activity.id!r}, field 'wordings': {text!r} stands also in activity {other!r}"
            seen[key(text)] = activity.id


def _unknowns(household: Household) -> Iterator[str]:
    for activity in household.activities:
        for field, others in (
            ("follows", activity.follows),
            ("instead", activity.instead),
            ("after", tuple(activity.after)),
        ):
            for other in others:
                if other not in household.index:
                    yield f"activity {activity.id!r}, field {field!r}: there is no activity {other!r}"
        fields = {f"things.{thing}": motion for thing, motion in activity.things.items()}
        for field, motion in [*fields.items(), *(("motions", motion) for motion in activity.motions)]:
            if motion not in household.looks_like:
                yield f"activity {activity.id!r}, field {field!r}: {motion!r} is not listed under looks_like"


def key(text: str) -> str:
    """Return a text in the form in which texts are compared word by word: lower case, plain, no full stop."""
    return re.sub(r"[^a-z0-9]+", " ", text.lower()).strip()


def _keys(texts: Iterable[str]) -> list[str]:
    """Return the `key` of each text, made for all at once: thousands in a few milliseconds."""
    said = re.sub(r"[^a-z0-9\0]+", " ", "\0".join(texts).lower())
    return [one.strip() for one in said.split("\0")]
