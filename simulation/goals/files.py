"""Read goals from YAML: a file holds `goals: {name: goal}`, and a goal is text, or a mapping or list of goals.

`all: [...]` (or a list alone), `any: [...]`, `not: ...`, `then: [...]` and `eventually: ...` stand for the operators.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import yaml

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.strict_yaml import MOST_BYTES, load_yaml
from coopera.simulation.goals.reading import DEEPEST, read_goal
from coopera.simulation.goals.tree import And, Eventually, Goal, Not, Or, Then, near

LARGEST = 200_000
"""Characters of a file."""
_JOINS: dict[str, Callable[[tuple[Goal, ...]], Goal]] = {"all": And, "any": Or, "then": Then}
_SAYS: dict[str, Callable[[Goal], Goal]] = {"not": Not, "eventually": Eventually}


def read_goals(path: Path) -> dict[str, Goal]:
    """Read a file of goals, by name.

    Raises:
        ConfigError: If it cannot be used; names the file, the goal and what was expected.
    """
    return parse_goals(read_text(path, "file of goals", MOST_BYTES), str(path))


def parse_goals(text: str, source: str) -> dict[str, Goal]:
    """Read goals from YAML; `source` names it in errors, which are those of `read_goals`."""
    if len(text) > LARGEST:
        raise ConfigError(f"{source}: the file has {len(text)} characters; {LARGEST} is the most.")
    try:
        data = load_yaml(text)
    except yaml.YAMLError as err:
        raise ConfigError(f"{source} is not valid YAML: {' '.join(str(err).split())}.") from err
    goals = data.get("goals") if isinstance(data, Mapping) else None
    if not isinstance(goals, Mapping) or not goals or len(data) != 1:
        raise ConfigError(f"{source} must hold `goals:` with one or more goals by name, and nothing else.")
    strange = next((name for name in goals if not isinstance(name, str) or not name.strip()), None)
    if strange is not None:
        raise ConfigError(f"{source}: a goal's name must be text, not {strange!r}.")
    return {name: goal_from(goal, f"{source}, goals.{name}") for name, goal in goals.items()}


def goal_from(data: Any, where: str) -> Goal:
    """Make a goal of data as YAML or JSON hold it.

    Args:
        data: Text, a list of goals, or a mapping with one operator.
        where: Names it in errors.

    Raises:
        ConfigError: If it is none of these.
    """
    return _goal(data, where, DEEPEST)


def _goal(data: Any, where: str, deep: int) -> Goal:
    if not deep:
        raise ConfigError(f"{where}: a goal is nested at most {DEEPEST} deep.")
    if isinstance(data, str):
        cut = " (in a YAML list in [brackets] a goal with a comma stands in quotes)" if _was_cut(data) else ""
        return _said(f"{where}{cut}", lambda: read_goal(data))
    if isinstance(data, list):
        return _joined(data, "all", where, deep)
    if not isinstance(data, Mapping) or len(data) != 1:
        raise ConfigError(f"{where} must be text, a list, or just one of {_known()}, not {_shown(data)}.")
    operator, rest = next(iter(data.items()))
    there = f"{where}.{operator}"
    if operator in _JOINS:
        if not isinstance(rest, list):
            raise ConfigError(f"{there} must be a list of goals, not {_shown(rest)}.")
        return _joined(rest, operator, there, deep)
    if operator in _SAYS:
        inner = _goal(rest, there, deep - 1)
        return _said(there, lambda: _SAYS[operator](inner))
    raise ConfigError(
        f"{where}: there is no {operator!r}{near(str(operator), (*_JOINS, *_SAYS))}; known are {_known()}."
    )


def _joined(data: list[Any], operator: str, where: str, deep: int) -> Goal:
    if not data:
        raise ConfigError(f"{where} is empty, where goals were expected.")
    goals = tuple(_goal(one, f"{where}.{place}", deep - 1) for place, one in enumerate(data))
    return goals[0] if len(goals) == 1 else _said(where, lambda: _JOINS[operator](goals))


def _said(where: str, make: Callable[[], Goal]) -> Goal:
    """Make a goal, and say where it stands if it cannot be."""
    try:
        return make()
    except ConfigError as err:
        raise ConfigError(f"{where}: {err}") from err


def _was_cut(text: str) -> bool:
    return text.count("(") != text.count(")")


def _known() -> str:
    return ", ".join(f"`{word}:`" for word in (*_JOINS, *_SAYS))


def _shown(data: Any) -> str:
    text = repr(data)
    return text if len(text) <= 60 else f"{text[:60]}…"
