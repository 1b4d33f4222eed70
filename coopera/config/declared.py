"""The settings as declared, each with what its type, range and default say, in words: for errors, flags and pages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Le
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from coopera.core.errors import ConfigError, deprecated
from coopera.core.setting import Setting


@dataclass(frozen=True, slots=True)
class Declared:
    """One setting of a configuration.

    Attributes:
        name: The field, with its section where it has one, such as `calls.timeout`.
        words: What people are told of it.
        type: The type of a value, without its constraints and without None.
        constraints: What a value must fulfil besides, such as `Ge(1)`.
        default: What holds where nothing is given.
    """

    name: str
    words: Setting
    type: Any
    constraints: tuple[Any, ...]
    default: Any

    @property
    def values(self) -> tuple[Any, ...]:
        """The values that are allowed, where they can be counted."""
        return get_args(self.type) if get_origin(self.type) is Literal else self.words.values

    @property
    def section(self) -> type[BaseModel] | None:
        """The model whose fields these are, where the setting is a section."""
        return self.type if isinstance(self.type, type) and issubclass(self.type, BaseModel) else None

    @property
    def range(self) -> str:
        """The range of a number, such as "1 to 366" or "0 up"; empty where there is none."""
        low = next((one.ge for one in self.constraints if isinstance(one, Ge)), None)
        high = next((one.le for one in self.constraints if isinstance(one, Le)), None)
        if low is None:
            return ""
        return f"{low} up" if high is None else f"{low} to {high}"

    @property
    def expected(self) -> str:
        """What a value may be, as the end of "must be …"."""
        if self.words.expected:
            return self.words.expected
        if self.values:
            return listed(self.values, "or")
        if self.section:
            return f"a mapping with any of {listed(list(self.section.model_fields), 'and')}"
        if self.type is Path:
            return "the path of a folder" if self.words.metavar == "DIR" else "the path of a file"
        if self.type is int:
            return f"a whole number from {self.range}"
        return "a text"

    @property
    def unset(self) -> str:
        """What holds where nothing is given, in words; empty where that is nothing."""
        if self.words.unset or self.default is None or self.section:
            return self.words.unset
        if isinstance(self.default, tuple):
            return " x ".join(str(part) for part in self.default)
        return str(self.default)

    @property
    def metavar(self) -> str | None:
        """What stands for a value in help; None leaves it to the type."""
        return self.words.metavar or "|".join(map(str, self.values)) or ("N" if self.range else None)

    @property
    def help(self) -> str:
        """What the setting decides, with its range, where its values are listed, and what holds without it."""
        facts = [
            f"from {self.range}" if self.range else "",
            f"see: coopera list {self.words.listed}" if self.words.listed else "",
            f"default: {self.unset}" if self.unset else "",
        ]
        said = "; ".join(fact for fact in facts if fact)
        return f"{self.words.help} [{said}]" if said else self.words.help


OLD_WORDS_GO = "0.3"
"""The version that no longer knows what settings were called before."""


@lru_cache
def declared(model: type[BaseModel], prefix: str = "") -> Mapping[str, Declared]:
    """All settings of a configuration by name, each section before its fields.

    Raises:
        TypeError: If a field is declared without a `Setting`.
    """
    found: dict[str, Declared] = {}
    for name, field in model.model_fields.items():
        one = _declared(prefix + name, field)
        found[one.name] = one
        if one.section:
            found |= declared(one.section, f"{one.name}.")
    return found


def in_words_of_today(model: type[BaseModel], data: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Return a configuration's fields by the names that they have now, with a warning for each old name.

    Args:
        model: The configuration.
        data: Its fields as given.
        where: Who gave them, such as a file, for the error.

    Raises:
        ConfigError: If a setting is given by both its names.
    """
    now = {one.words.formerly: name for name, one in declared(model).items() if one.words.formerly}
    for old in (name for name in data if name in now):
        if now[old] in data:
            raise ConfigError(f"{where}: {old} and {now[old]} are one setting, and only {now[old]} may be given.")
        deprecated(f"the setting {old}", now[old], OLD_WORDS_GO)
    return {now.get(name, name): value for name, value in data.items()}


def listed(names: Sequence[Any], last: str) -> str:
    """Names as words: "a, b or c"."""
    *most, end = map(str, names)
    return f"{', '.join(most)} {last} {end}" if most else end


def _declared(name: str, field: FieldInfo) -> Declared:
    type_, constraints = _bare(field.annotation)
    given = [*field.metadata, *constraints]
    words = next((one for one in given if isinstance(one, Setting)), None)
    if words is None:
        raise TypeError(f"the field {name} is declared without a Setting")
    default = None if field.is_required() or field.default_factory else field.default
    return Declared(name, words, type_, tuple(given), default)


def _bare(annotation: Any) -> tuple[Any, list[Any]]:
    """A type without `Annotated` and `| None`, and the constraints that stood in these."""
    if get_origin(annotation) is Annotated:
        inner, *more = get_args(annotation)
        bare, constraints = _bare(inner)
        return bare, [*constraints, *_flat(more)]
    if get_origin(annotation) in (Union, UnionType):
        parts = [part for part in get_args(annotation) if part is not type(None)]
        if len(parts) == 1:
            return _bare(parts[0])
    return annotation, []


def _flat(metadata: Sequence[Any]) -> Iterator[Any]:
    for one in metadata:
        if isinstance(one, FieldInfo):
            yield from one.metadata
        else:
            yield one
