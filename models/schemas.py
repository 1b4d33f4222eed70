"""The JSON schema of a reply: as a model reads it in words, and as a decoder or a server enforces it.

The enforced schema is narrower than the reply type. It requires every field, takes the names of objects from the
prompt, and fixes the length of lists. It leaves out what code knows: the kind of an act, and the ids of objects where
the prompt's variables have them by name. Some models cannot be held to a schema. Such a model is shown its errors;
after the last attempt its reply counts if the reply type accepts it.
"""

from __future__ import annotations

import functools
import json
from collections.abc import Container, Iterator, Mapping
from typing import Any

from coopera.core.household import ObjectMap
from coopera.core.people import Frozen
from coopera.models.reading.names import nearest
from coopera.models.small.short import shortened

_OBJECTS = {
    "PickPlace": {"object": "movable", "receptacle": "fixed"},
    "FreeMotion": {"target": "fixed"},
}
"""By type and field: the variable of the prompt (an `ObjectMap`) that says which objects there are."""
_COUNTS = {
    "verdicts": ("offers", "guesses", "tasks"),
    "reviews": ("tasks",),
    "grades": ("offers", "guesses"),
    "tasks": ("n_tasks",),
    "intentions": ("n_intentions",),
}
"""By list: the variables of which the first that is there says how long the list is."""
_NOTES = {"title", "description"}
_SHOWN = 5
_SAID = 130  # characters of a wrong name that are repeated


@functools.lru_cache(maxsize=64)
def _schema_of(reply: type[Frozen]) -> dict[str, Any]:
    """A reply type's schema, worked out once: pydantic takes milliseconds for it. Only ever copied by `_bare`."""
    return reply.model_json_schema()


@functools.lru_cache(maxsize=128)
def schema_of(reply: type[Frozen], named: frozenset[str] = frozenset()) -> str:
    """A reply type's JSON schema on one line, without titles, notes and what code knows.

    Args:
        reply: The reply type.
        named: Types of acts whose objects are named by name alone.
    """
    schema = _bare(_schema_of(reply), _NOTES)
    _leave_to_code(schema, named)
    return json.dumps(schema, ensure_ascii=False)


@functools.lru_cache(maxsize=64)
def whole_schema(reply: type[Frozen]) -> dict[str, Any]:
    """All that a reply may hold, with defaults, for those who read one; not to be changed."""
    whole: dict[str, Any] = _bare(_schema_of(reply), {"description"})
    return whole


def objects_of(variables: Mapping[str, Any]) -> dict[str, dict[str, ObjectMap]]:
    """The objects that a reply may name, by type of act and field, as far as the prompt's variables say them."""
    known = {
        kind: {field: variables[source] for field, source in fields.items() if variables.get(source)}
        for kind, fields in _OBJECTS.items()
    }
    return {kind: fields for kind, fields in known.items() if fields}


def enforced_schema(reply: type[Frozen], variables: Mapping[str, Any], *, brief: bool = False) -> dict[str, Any]:
    """What constrained decoding, or a server's `response_format`, holds a reply to.

    Args:
        reply: The reply type.
        variables: What the prompt was filled with.
        brief: Whether the reply is to be short (`coopera.models.small.short`).

    Returns:
        A schema in which every object lists all its fields as required and allows no other.
    """
    schema: dict[str, Any] = _bare(_schema_of(reply), {*_NOTES, "default"})
    objects = objects_of(variables)
    _leave_to_code(schema, objects)
    schema = shortened(schema) if brief else schema
    definitions = schema.get("$defs", {})
    for part in (schema, *definitions.values()):
        if "properties" in part:
            part["required"] = list(part["properties"])
            part["additionalProperties"] = False
    for kind, fields in objects.items():
        for field, known in fields.items():
            if kind in definitions:
                definitions[kind]["properties"][field] = {"type": "string", "enum": sorted(known)}
    for field, sources in _COUNTS.items():
        counted = next((variables[source] for source in sources if source in variables), None)
        if counted is not None and field in schema["properties"]:
            _as_long_as(schema["properties"][field], counted if isinstance(counted, int) else len(counted))
    return schema


def strays(value: Any, schema: Mapping[str, Any], place: str = "") -> list[str]:
    """Say where a valid reply leaves the enforced schema: things that are not there, too many or too few of a list."""
    return list(_strays(value, schema, schema.get("$defs", {}), place))


def _strays(value: Any, schema: Mapping[str, Any], definitions: Mapping[str, Any], place: str) -> Iterator[str]:
    schema = _meant(schema, definitions, value is None)
    if "enum" in schema and value not in schema["enum"]:
        near = nearest(value, schema["enum"])
        known = json.dumps(near or schema["enum"][:_SHOWN], ensure_ascii=False)
        most_alike = "; the nearest are" if near else ", but for example"
        yield f"{place}: there is no {json.dumps(value, ensure_ascii=False)[:_SAID]}{most_alike} {known}"
    if isinstance(value, list):
        count = schema.get("minItems", 0)
        if count == schema.get("maxItems") != len(value):
            yield f"{place}: there must be {count} of them, not {len(value)}"
        for n, item in enumerate(value):
            yield from _strays(item, schema.get("items", {}), definitions, f"{place}.{n}")
    elif isinstance(value, dict):
        for name, part in schema.get("properties", {}).items():
            if name in value:
                yield from _strays(value[name], part, definitions, f"{place}.{name}" if place else name)


def _meant(schema: Mapping[str, Any], definitions: Mapping[str, Any], is_null: bool) -> Mapping[str, Any]:
    """The schema that a valid value is held to: of something or null the one that it is, and what a reference names."""
    for option in schema.get("anyOf", ()):
        if (option.get("type") == "null") == is_null:
            return _meant(option, definitions, is_null)
    return definitions[schema["$ref"].rpartition("/")[2]] if "$ref" in schema else schema


def _leave_to_code(schema: dict[str, Any], named: Container[str]) -> None:
    """Take out the fields that have one value only, and the ids of objects that are named by name."""
    for kind, part in schema.get("$defs", {}).items():
        ids = {f"{field}_id" for field in _OBJECTS.get(kind, ())} if kind in named else set()
        known = [name for name, field in part.get("properties", {}).items() if "const" in field or name in ids]
        for name in known:
            del part["properties"][name]
        if known and "required" in part:
            part["required"] = [name for name in part["required"] if name not in known]


def _as_long_as(items: dict[str, Any], count: int) -> None:
    if items.get("minItems", 0) <= count <= items.get("maxItems", count):
        items |= {"minItems": count, "maxItems": count}


def _bare(schema: Any, notes: set[str], *, names: bool = False) -> Any:
    """Drop keywords; `names` says that the keys are names of fields, which may be called like a keyword."""
    if isinstance(schema, list):
        return [_bare(part, notes) for part in schema]
    if not isinstance(schema, dict):
        return schema
    return {
        key: _bare(value, notes, names=not names and key in {"properties", "$defs"})
        for key, value in schema.items()
        if names or key not in notes
    }
