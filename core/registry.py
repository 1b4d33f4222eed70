"""Values that are found by name: those that ship, those that a script registers, those of other packages."""

from __future__ import annotations

import difflib
import pkgutil
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache, cached_property
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Generic, Protocol, TypeVar, cast

from coopera.core.errors import ConfigError


class Named(Protocol):
    """A frozen dataclass with a name."""

    @property
    def name(self) -> str:
        """What it is found by."""
        ...


Value = TypeVar("Value", bound=Named)


class Registry(Generic[Value]):
    """All values of one type, by name.

    A value ships as a file of its own in the registry's package. The file bears the value's name, so that a name is
    known before anything is imported. Another package offers a value by an entry point in the group `coopera.<what>s`.
    """

    def __init__(
        self,
        what: str,
        kind: type[Value],
        *,
        package: str | None = None,
        dash: str = "_",
        registered: dict[str, Value] | None = None,
    ) -> None:
        """Describe a registry; nothing is imported yet.

        Args:
            what: What a value is, as sentences call it, such as "classifier". A file names its value so in capitals.
            kind: The values' type.
            package: The package whose files ship one value each.
            dash: What stands in a value's name where "_" stands in its file's name.
            registered: Values that are there from the start, by name; `register` adds to them.
        """
        self._what, self._kind, self._package, self._dash = what, kind, package, dash
        self._registered = {} if registered is None else registered

    @property
    def group(self) -> str:
        """The group of entry points."""
        return f"coopera.{self._what}s"

    def known(self) -> list[str]:
        """All names: those that ship, sorted, then those registered here, then those of other packages."""
        return list(dict.fromkeys([*sorted(self._shipped), *self._registered, *sorted(self._installed)]))

    def find(self, name: str) -> Value:
        """Return a value by its name.

        Raises:
            ConfigError: If there is none, or the file or package that has it cannot be used.
        """
        if name in self._registered:
            return self._registered[name]
        shipped, offered = self._shipped.get(name), self._installed.get(name)
        where = shipped or ""
        if offered and not shipped:
            where = f"{name} of {offered.dist.name if offered.dist else 'another package'} ({offered.value})"
        try:
            if shipped:
                return self._checked(getattr(import_module(shipped), self._what.upper()), name, where)
            if offered:
                return self._checked(offered.load(), name, where)
        except (ImportError, AttributeError) as err:
            raise ConfigError(f"{self._what}: {where} cannot be loaded: {err}.") from err
        raise unknown(self._what, name, self.known())

    def register(self, value: Value) -> Value:
        """Make a value a choice in this process, as scripts and notebooks need it; packages use an entry point.

        Raises:
            ConfigError: If another value has its name already.
        """
        taken = value.name in self._shipped or value.name in self._installed
        if taken or self._registered.setdefault(value.name, value) != value:
            raise ConfigError(f"{self._what}: the name {value.name!r} is taken by another {self._what}.")
        return value

    @property
    def _shipped(self) -> Mapping[str, str]:
        """The module of each value that ships, by name."""
        if self._package is None:
            return {}
        names = _modules_in(tuple(import_module(self._package).__path__))
        return {name.replace("_", self._dash): f"{self._package}.{name}" for name in names}

    @cached_property
    def _installed(self) -> Mapping[str, EntryPoint]:
        return {entry.name: entry for entry in entry_points(group=self.group)}

    def _checked(self, found: object, name: str, where: str) -> Value:
        if not isinstance(found, self._kind):
            got = type(found).__name__
            raise ConfigError(f"{self._what}: {where} must give a {self._kind.__name__}, and gives {got}.")
        return found if found.name == name else cast(Value, replace(cast(Any, found), name=name))


@cache
def _modules_in(folders: tuple[str, ...]) -> list[str]:
    """Names of the modules in a package's folders, looked for once: every hour asks."""
    return [one.name for one in pkgutil.iter_modules(folders) if not one.name.startswith("_")]


def unknown(what: str, name: str, known: Sequence[str]) -> ConfigError:
    """The error of a name that nothing has, with the nearest one and all there are."""
    hint = nearest(name, known)
    return ConfigError(f"{what}: there is no {what} {name!r} ({hint}known are {', '.join(known) or 'none'}).")


def nearest(name: str, known: Sequence[str]) -> str:
    """The question whether the nearest one was meant, with a blank at its end; empty where none is near."""
    near = difflib.get_close_matches(name, known, n=1)
    return f"did you mean {near[0]}? " if near else ""
