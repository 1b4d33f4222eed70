"""A goal as a small immutable tree: atoms, and how they are put together. `str` writes it as `read_goal` reads it."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from coopera.core.errors import ConfigError

Role: TypeAlias = Literal[
    "thing", "furniture", "object", "container", "room", "agent", "person", "motion", "content", "form"
]
"""What a word of an atom stands for; an object is a thing or furniture, and a container is one that holds things."""
OBJECTS: frozenset[Role] = frozenset({"thing", "furniture", "object", "container"})
State: TypeAlias = Literal["open", "powered", "clean", "filled", "form"]
"""Predicates that ask a state of an object (`coopera.core.affordances`)."""
STATES: tuple[State, ...] = get_args(State)

PREDICATES: dict[str, tuple[tuple[Role, ...], ...]] = {
    "on": (("thing", "furniture"),),
    "inside": (("thing", "container"),),
    "in_room": (("object", "room"),),
    "on_floor": (("thing",),),
    "next_to": (("object", "object"),),
    "holding": (("agent", "thing"),),
    "wearing": (("person", "thing"),),
    "near": (("agent", "object"),),
    "at": (("agent", "room"),),
    "open": (("object",),),
    "powered": (("object",),),
    "clean": (("object",),),
    "filled": (("object",), ("object", "content")),
    "form": (("object", "form"),),
    "performed": (("motion",), ("person", "motion")),
}
"""Every predicate, with what its words stand for; a few can be said in two ways."""


@dataclass(frozen=True, slots=True)
class Atom:
    """One predicate with its words, such as on(mug, dining table).

    It is true if it holds for some object that its first word means; with `every` it must hold for all of them, of
    which there must be one.
    """

    name: str
    words: tuple[str, ...]
    every: bool = False

    def __post_init__(self) -> None:
        """Refuse what is no predicate.

        Raises:
            ConfigError: If there is no such predicate, or it takes other words.
        """
        if self.name not in PREDICATES:
            known = ", ".join(signature(name) for name in PREDICATES)
            raise ConfigError(f"There is no predicate {self.name!r}{near(self.name, PREDICATES)}; known are {known}.")
        if len(self.words) not in {len(roles) for roles in PREDICATES[self.name]}:
            raise ConfigError(f"{self} has {len(self.words)} words in brackets; it is written {signature(self.name)}.")
        if self.every and self.roles[0] not in OBJECTS:
            raise ConfigError(f'{self}: "every" can be said of objects only, and {self.name} starts with an agent.')

    @property
    def roles(self) -> tuple[Role, ...]:
        """What each word stands for."""
        return next(roles for roles in PREDICATES[self.name] if len(roles) == len(self.words))

    def __str__(self) -> str:
        first = "every " if self.every else ""
        return f"{self.name}({first}{', '.join(map(_quoted, self.words))})"


@dataclass(frozen=True, slots=True)
class Not:
    """True where its goal is not."""

    goal: Goal

    def __str__(self) -> str:
        return f"not {_in_brackets(self.goal, And, Or)}"


@dataclass(frozen=True, slots=True)
class And:
    """True where all of its goals are."""

    goals: tuple[Goal, ...]

    def __post_init__(self) -> None:
        _several("and", self.goals)

    def __str__(self) -> str:
        return " and ".join(_in_brackets(goal, And, Or) for goal in self.goals)


@dataclass(frozen=True, slots=True)
class Or:
    """True where one or more of its goals are."""

    goals: tuple[Goal, ...]

    def __post_init__(self) -> None:
        _several("or", self.goals)

    def __str__(self) -> str:
        return " or ".join(_in_brackets(goal, Or) for goal in self.goals)


@dataclass(frozen=True, slots=True)
class Then:
    """Over a day: the first goal holds at some moment, the next one at that or a later moment, and so on."""

    goals: tuple[Goal, ...]

    def __post_init__(self) -> None:
        _several("then", self.goals)
        for goal in self.goals:
            _of_one_moment("then", goal)

    def __str__(self) -> str:
        return f"then({', '.join(map(str, self.goals))})"


@dataclass(frozen=True, slots=True)
class Eventually:
    """Over a day: the goal holds at some moment, be it not at the end."""

    goal: Goal

    def __post_init__(self) -> None:
        _of_one_moment("eventually", self.goal)

    def __str__(self) -> str:
        return f"eventually({self.goal})"


Goal: TypeAlias = Atom | Not | And | Or | Then | Eventually


def over_a_day(goal: Goal) -> Then | Eventually | None:
    """The first part of a goal that needs more than one moment, if there is one."""
    return next((part for part in parts(goal) if isinstance(part, Then | Eventually)), None)


def atoms(goal: Goal) -> Iterator[Atom]:
    """All atoms of a goal, in order."""
    return (part for part in parts(goal) if isinstance(part, Atom))


def parts(goal: Goal) -> Iterator[Goal]:
    """A goal and all that it is made of, in order."""
    yield goal
    if isinstance(goal, Not | Eventually):
        yield from parts(goal.goal)
    elif not isinstance(goal, Atom):
        for part in goal.goals:
            yield from parts(part)


def signature(name: str) -> str:
    """How a predicate is written, such as "on(thing, furniture)"."""
    return " or ".join(f"{name}({', '.join(roles)})" for roles in PREDICATES[name])


def near(word: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """The question whether the nearest of some known words was meant, in brackets; empty where none is near."""
    found = difflib.get_close_matches(word, list(known), n=1, cutoff=cutoff)
    return f" (did you mean {found[0]}?)" if found else ""


def _several(word: str, goals: tuple[Goal, ...]) -> None:
    if len(goals) < 2:
        raise ConfigError(f"{word!r} joins two goals or more, not {len(goals)}.")


def _of_one_moment(word: str, goal: Goal) -> None:
    within = over_a_day(goal)
    if within is not None:
        raise ConfigError(f"{word!r} is said of what holds at a moment, so {within} cannot stand in it.")


def _in_brackets(goal: Goal, *kinds: type[Goal]) -> str:
    return f"({goal})" if isinstance(goal, kinds) else str(goal)


def _quoted(word: str) -> str:
    plainly = word and word == word.strip() and not set(word) & set(',()"') and not word.startswith("every ")
    return word if plainly else '"' + word.replace('"', '""') + '"'
