"""What can be done where and with what, and what it changes: affordances.yaml, the one file that everybody reads.

The home plans and refuses by it, both agents' tasks are checked by it, the offline model and the prompts know it.
Nothing in here is about a particular home or person.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias, get_args

import yaml
from pydantic import BeforeValidator, Field, ValidationError, model_validator

from coopera.core.errors import ConfigError
from coopera.core.lazy import made_once
from coopera.core.naming import ends_with, plain
from coopera.core.people import Frozen

FILE = Path(__file__).with_name("affordances.yaml")
_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast where PyYAML has its C part
HAND = "<hand>"
"""As the value of `filled`: whatever is in the hand."""

StateName: TypeAlias = Literal["open", "powered", "clean", "filled", "form"]
StateValue: TypeAlias = bool | str
Condition: TypeAlias = dict[StateName, StateValue]
"""The states of one object, as far as they are not as at first."""
Relation: TypeAlias = Literal["on", "inside"]
Part: TypeAlias = Literal["hand", "used", "there", "furniture", "person"]
FORMS = ("whole", "cut", "cooked")


def _as_tuple(data: Any) -> Any:
    return (data,) if isinstance(data, str) else data


Classes = Annotated[tuple[str, ...], BeforeValidator(_as_tuple)]
"""Classes of things, words for them, or names of groups."""


class Declared(Frozen):
    """A state: the classes that have it, and its value at first."""

    of: Classes
    first: StateValue


class Effect(Frozen):
    """What a motion changes of some objects: one or more states; an effect on the person means that it is worn."""

    to: tuple[Part, ...] = Field(min_length=1)
    of: Classes = ()
    at: Classes = ()
    one: bool = False
    open: bool | None = None
    powered: bool | None = None
    clean: bool | None = None
    filled: str | None = None
    form: Literal["whole", "cut", "cooked"] | None = None

    @cached_property
    def changes(self) -> Condition:
        """The states that it sets."""
        said = {name: getattr(self, name) for name in get_args(StateName)}
        return {name: value for name, value in said.items() if value is not None}


class Gather(Frozen):
    """What is fetched to the furniture before a motion: things in a state."""

    of: Classes
    clean: bool
    most: int = Field(3, ge=1, le=10)
    inside: bool = False


class Affordance(Frozen):
    """Where a motion can be done, with what, and what it changes: see the head of affordances.yaml."""

    at: Classes | None = None
    needs: Classes = ()
    uses: Classes = ()
    gathers: Gather | None = None
    switches: Classes = ()
    undresses: bool = False
    seated: bool = True
    roomy: bool = False
    lies: Classes = ()
    does: tuple[Effect, ...] = ()

    @property
    def tools(self) -> Classes:
        """What is wanted at the place, needed or not."""
        return self.needs or self.uses


_ANYWHERE = Affordance()


class Affordances(Frozen):
    """The whole file."""

    groups: dict[str, Classes] = {}
    states: dict[StateName, Declared] = {}
    inside: dict[str, Classes] = {}
    holds: dict[str, Classes] = {}
    looked_at: Classes = ()
    stood_on: Classes = ()
    motions: dict[str, Affordance] = {}

    @model_validator(mode="after")
    def _values_fit(self) -> Affordances:
        for name, declared in self.states.items():
            wrong = problem_of(name, declared.first)
            if wrong:
                raise ValueError(f"states.{name}.first: {wrong}")
        return self

    def of(self, motion: str) -> Affordance:
        """What is said of a motion's caption; nothing, where it is not in the file."""
        return self.motions.get(motion, _ANYWHERE)

    def is_one_of(self, cls: str, classes: Iterable[str]) -> bool:
        """Whether a class is one of some classes or groups."""
        return plain(cls).lower() in self._words(tuple(classes))

    def means_one_of(self, words: str, classes: Iterable[str]) -> bool:
        """Whether words for a thing mean one of some classes or groups: the whole of them does, or their end."""
        said = plain(words).lower()
        return any(ends_with(said, known) for known in self._words(tuple(classes)))

    def _words(self, classes: tuple[str, ...]) -> frozenset[str]:
        known = self._spelled.get(classes)
        if known is None:
            names = [word for cls in classes for word in self.groups.get(cls, (cls,))]
            known = self._spelled[classes] = frozenset(plain(word).lower() for word in names)
        return known

    @cached_property
    def _spelled(self) -> dict[tuple[str, ...], frozenset[str]]:
        return {}

    def names(self, classes: Sequence[str]) -> list[str]:
        """The classes or words that some classes and groups stand for, in the file's order."""
        return list(dict.fromkeys(word for cls in classes for word in self.groups.get(cls, (cls,))))

    @cached_property
    def furniture(self) -> frozenset[str]:
        """Every class of furniture that some motion is said to be done at."""
        return frozenset(cls for motion in self.motions.values() for cls in motion.at or ())

    def suits(self, motion: str, furniture: str) -> bool:
        """Whether a motion can be done at a class of furniture; an unknown class has the benefit of the doubt."""
        places = self.of(motion).at
        return places is None or furniture in places or furniture not in self.furniture

    def motions_at(self, furniture: str) -> list[str]:
        """The captions that name this class of furniture as a place, in the file's order."""
        return [caption for caption, motion in self.motions.items() if motion.at and furniture in motion.at]

    def contains(self, cls: str) -> bool:
        """Whether furniture or a thing of this class holds things within it."""
        return cls in self.inside or cls in self.holds

    def relation(self, thing: str, receptacle: str) -> Relation:
        """Where a thing of a class is usually put: inside a receptacle of a class, or on it."""
        usual = self.inside.get(receptacle) or self.holds.get(receptacle) or ()
        return "inside" if self.is_one_of(thing, usual) else "on"

    def first(self, cls: str) -> Condition:
        """The states that a class has, with their values at first; empty for one that has none."""
        return {name: said.first for name, said in self.states.items() if self.is_one_of(cls, said.of)}


def problem_of(name: StateName, value: StateValue) -> str:
    """What is wrong with a value for a state; empty where it can be."""
    if name == "form":
        return "" if value in FORMS else f"must be one of {', '.join(FORMS)}"
    if name == "filled":
        return "" if isinstance(value, str) and len(value) <= 120 else "must be a short text, empty for nothing"
    return "" if isinstance(value, bool) else "must be yes or no"


def in_words(condition: Condition) -> str:
    """States as words, such as "open, dirty, with tea in it"; empty where all is as at first."""
    said = []
    for name in get_args(StateName):
        if name not in condition:
            continue
        value = condition[name]
        if name == "filled":
            said.append(f"with {value} in it" if value else "empty")
        elif name == "form":
            said.append(str(value))
        else:
            yes, no = {"open": ("open", "closed"), "powered": ("on", "off"), "clean": ("clean", "dirty")}[name]
            said.append(yes if value else no)
    return ", ".join(said)


@made_once()
def affordances() -> Affordances:
    """The shipped file.

    Raises:
        ConfigError: If affordances.yaml was edited into something unusable; names the field.
    """
    return read_affordances(FILE)


def read_affordances(path: Path) -> Affordances:
    """Read a file of affordances.

    Raises:
        ConfigError: If it cannot be used; names file, field and what was expected.
    """
    try:
        return Affordances.model_validate(yaml.load(path.read_text(encoding="utf-8"), _Loader))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as err:
        raise ConfigError(f"The affordances {path} cannot be read: {' '.join(str(err).split())}.") from err
    except ValidationError as err:
        first = err.errors()[0]
        field = ".".join(str(part) for part in first["loc"]) or "the whole file"
        raise ConfigError(f"The affordances {path}, field {field}: {first['msg']}.") from err
