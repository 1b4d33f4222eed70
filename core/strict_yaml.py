"""The one reader of YAML: plain data that say one thing, within limits, and one kind of error with its line.

Refused are a key that stands twice, an alias (a few hundred bytes of them stand for gigabytes), a tag (`!!set`), a
scalar that is not what it looks like (a month 13, five thousand digits), and files beyond the limits below.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import yaml

MOST_BYTES = 8 * 2**20
"""Of a file."""
MOST_CHARACTERS = 5_000_000
MOST_VALUES = 500_000
DEEPEST = 64

_Safe: type[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast where PyYAML has its C part
_OPENS = (yaml.SequenceStartEvent, yaml.MappingStartEvent)
_CLOSES = (yaml.SequenceEndEvent, yaml.MappingEndEvent)


def load_yaml(text: str) -> Any:
    """Read one YAML document; None where it is empty.

    Raises:
        yaml.MarkedYAMLError: If it is not valid, or refused; it has the line as `problem_mark`.
    """
    try:
        _check(text)
        return yaml.load(text, _Strict)
    except yaml.MarkedYAMLError:
        raise
    except yaml.YAMLError as err:  # a character that YAML does not know
        mark = yaml.Mark("", 0, text.count("\n", 0, getattr(err, "position", 0)), 0, None, 0)
        raise yaml.MarkedYAMLError(problem=" ".join(str(err).split()), problem_mark=mark) from err


class _Strict(_Safe):  # type: ignore[misc]
    """A safe loader in which a repeated key, and a scalar that cannot be read, is an error with its line."""

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        try:
            return super().construct_object(node, deep=deep)
        except (ValueError, OverflowError, LookupError, TypeError, AttributeError) as err:
            raise _refused(f"{str(node.value)[:40]!r} cannot be read ({str(err)[:80]})", node.start_mark) from err

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        seen: set[Hashable] = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if isinstance(key, Hashable):
                if key in seen:
                    raise _refused(f"{key!r} stands twice", key_node.start_mark)
                seen.add(key)
        found: dict[Hashable, Any] = super().construct_mapping(node, deep)
        return found


def _check(text: str) -> None:
    """Refuse what would take long, or grow, before anything is built of it."""
    if len(text) > MOST_CHARACTERS:
        raise _refused(f"it has {len(text)} characters, and {MOST_CHARACTERS} are the most", None)
    depth = values = documents = 0
    event: Any
    for event in yaml.parse(text, Loader=_Safe):
        if isinstance(event, yaml.AliasEvent):
            raise _refused("an alias (*) is not allowed", event.start_mark)
        if getattr(event, "tag", None) is not None:
            raise _refused(f"a tag ({event.tag[:40]}) is not allowed", event.start_mark)
        documents += isinstance(event, yaml.DocumentStartEvent)
        if documents > 1:
            raise _refused("it holds more than one document", event.start_mark)
        depth += isinstance(event, _OPENS) - isinstance(event, _CLOSES)
        values += isinstance(event, yaml.NodeEvent)
        if depth > DEEPEST:
            raise _refused(f"it is nested more than {DEEPEST} deep", event.start_mark)
        if values > MOST_VALUES:
            raise _refused(f"it holds more than {MOST_VALUES} values", event.start_mark)


def _refused(problem: str, mark: Any) -> yaml.MarkedYAMLError:
    return yaml.constructor.ConstructorError(None, None, problem, mark)
