"""What follows from a stated fact, as data: reads and checks facts.yaml, whose head explains the fields."""

from __future__ import annotations

import re
from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal, Self, TypeAlias

import yaml
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, PrivateAttr, ValidationError, model_validator

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.lazy import made_once
from coopera.core.strict_yaml import MOST_BYTES, load_yaml
from coopera.models.offline.human.stated import Standing

SHIPPED = Path(__file__).parent / "facts.yaml"

Kind: TypeAlias = Literal[
    "age", "body", "job", "family", "home", "pets", "diet", "belief", "rhythm", "hobby", "aversion"
]
LifeStage: TypeAlias = Literal["young", "adult", "older"]
Employment: TypeAlias = Literal["employed", "student", "retired", "not_working"]
Workplace: TypeAlias = Literal["home", "outside"]
WorkTime: TypeAlias = Literal["mornings", "evenings", "nights", "weekdays", "weekends"]

_NAMED = re.compile(r"<([a-z_]+)>")
_GROUP = "(?P<what>"
_A_WORD = r"(?:(?!(?:not|never|no|hardly|rarely)\b)\w+ )"  # what "(?:\w+ )" in a pattern stands for: no denial
_WORD_AFTER = r"(?:(?! (?:not|never|no|hardly|rarely)\b) \w+)"


def _is_pattern(text: str) -> str:
    try:
        re.compile(_NAMED.sub("x", text.replace(_GROUP, "(")))
    except re.error as err:
        raise ValueError(f"{text!r} is no regular expression ({err})") from err
    return text


Text = Annotated[str, Field(min_length=2, max_length=200)]
Pattern = Annotated[str, Field(min_length=2, max_length=2000), AfterValidator(_is_pattern)]
Patterns = Annotated[tuple[Pattern, ...], Field(min_length=1)]
Id = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
Logits = dict[Id, Annotated[float, Field(gt=0, le=3)]]


class _Part(BaseModel):
    """A part of facts.yaml: of the types stated, unknown fields refused, and not changed once read."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class Effects(_Part):
    """What follows from a fact; of several `employment`s and the like the highest rank is believed."""

    never: tuple[Id, ...] = ()
    never_things: tuple[Text, ...] = ()
    never_motions: tuple[Text, ...] = ()
    more: Logits = {}
    less: Logits = {}
    speaks_for: tuple[Id, ...] = ()
    employment: Employment | None = None
    workplace: Workplace | None = None
    work_time: WorkTime | None = None
    life_stage: LifeStage | None = None
    hours_shift: Annotated[float | None, Field(ge=-6, le=6)] = None
    rank: Annotated[int, Field(ge=0, le=9)] = 0
    gives_way: bool = False
    keeps: Annotated[str, Field(max_length=200)] = ""


class Rule(Effects):
    """A fact, the words that state it, and what follows."""

    kind: Kind
    says: Text
    any: Patterns
    unless: tuple[Pattern, ...] = ()
    reads: Literal["own", "sentence"] = "own"
    even: tuple[Standing, ...] = ()
    gives: tuple[Id, ...] = ()


class Age(Effects):
    """What follows from an age within bounds, in years, both included."""

    first: Annotated[int, Field(alias="from", ge=0, le=129)]
    last: Annotated[int, Field(alias="to", ge=0, le=129)]
    says: Text


class Spoken(_Part):
    """The words that are about an activity (`speaks`) or near it (`hints`)."""

    called: Text
    speaks: Patterns
    hints: tuple[Pattern, ...] = ()
    without: Annotated[tuple[Pattern, ...], Field(alias="not")] = ()
    gives: Id | None = None
    strict: bool = False


class Requires(_Part):
    """What only a stated fact allows: activities and things, each with the fact's name."""

    activities: dict[Id, Id] = {}
    things: dict[Text, Id] = {}
    says: dict[Id, Text]

    @model_validator(mode="after")
    def _said(self) -> Self:
        for name in (*self.activities.values(), *self.things.values()):
            if name not in self.says:
                raise ValueError(f"{name!r} does not stand under says")
        return self


class Search:
    """Patterns as one search over whole words."""

    def __init__(self, patterns: tuple[str, ...]) -> None:
        numbered = (text.replace(_GROUP, f"(?P<what{i}>") for i, text in enumerate(patterns))
        self._found = re.compile(rf"(?<!\w)(?:{'|'.join(numbered)})(?!\w)") if patterns else None

    def all(self, text: str) -> list[re.Match[str]]:
        """Return every match, from left to right."""
        return list(self._found.finditer(text)) if self._found else []

    def __contains__(self, text: str) -> bool:
        return self._found is not None and self._found.search(text) is not None

    def masked(self, text: str) -> str:
        """Return the text, of the same length, with every match made unreadable."""
        return self._found.sub(lambda found: "_" * len(found.group()), text) if self._found else text


def what(found: re.Match[str]) -> str:
    """Return what a match's group "what" caught, or nothing."""
    return next((text for text in found.groupdict().values() if text), "")


class FactsFile(_Part):
    """All that is known of stated facts."""

    lists: dict[Id, Patterns]
    rules: Annotated[tuple[Rule, ...], Field(min_length=1)]
    ages: tuple[Age, ...]
    requires: Requires
    foods: dict[Pattern, Annotated[tuple[Text, ...], Field(min_length=1)]]
    activities: dict[Id, Spoken]
    _searches: dict[tuple[str, ...], Search] = PrivateAttr(default_factory=dict)

    @model_validator(mode="after")
    def _lists_known(self) -> Self:
        texts = [*(text for rule in self.rules for text in (*rule.any, *rule.unless))]
        texts += [text for one in self.activities.values() for text in (*one.speaks, *one.hints, *one.without)]
        for text in [*texts, *(text for one in self.lists.values() for text in one)]:
            for name in _NAMED.findall(text.replace(_GROUP, "(")):
                if name not in self.lists:
                    raise ValueError(f"{text!r} names the list {name!r}, which does not stand under lists")
        return self

    def search(self, patterns: tuple[str, ...]) -> Search:
        """Return a search for patterns, with the lists that they name written out; each is made once."""
        known = self._searches.get(patterns)
        if known is None:
            known = self._searches[patterns] = Search(tuple(self._written_out(text) for text in patterns))
        return known

    @cached_property
    def food_words(self) -> dict[str, re.Pattern[str]]:
        """For each kind of food or scent: what finds a word of it."""
        return {words: re.compile(rf"\b(?:{words})(?!\w)") for words in self.foods}

    def _written_out(self, text: str) -> str:
        def listed(found: re.Match[str]) -> str:
            return f"(?:{'|'.join(self._written_out(one) for one in self.lists[found.group(1)])})"

        text = text.replace("(?:\\w+ )", _A_WORD).replace("(?: \\w+)", _WORD_AFTER)
        return _GROUP.join(_NAMED.sub(listed, part) for part in text.split(_GROUP))


def load(path: Path = SHIPPED) -> FactsFile:
    """Read a file of facts and check it.

    Raises:
        ConfigError: Naming the file and the field, and what was expected.
    """
    try:
        data = load_yaml(read_text(path, "file of facts", MOST_BYTES))
        return FactsFile.model_validate(_with_tuples(data))
    except yaml.YAMLError as err:
        raise ConfigError(f"{path}: cannot be read as YAML: {' '.join(str(err).split())}") from err
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "all"
        raise ConfigError(f"{path}: field {where!r}: {first['msg'].removeprefix('Value error, ')}") from err


def _with_tuples(data: object) -> object:
    """Lists of YAML as tuples, which strict reading asks for."""
    if isinstance(data, dict):
        return {key: _with_tuples(value) for key, value in data.items()}
    return tuple(_with_tuples(value) for value in data) if isinstance(data, list) else data


@made_once()
def shipped() -> FactsFile:
    """Return the file of facts that comes with the package."""
    return load()
