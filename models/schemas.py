"""The JSON schema of a reply: as a model reads it in words, and as a decoder or a server enforces it.

The enforced schema is narrower than the reply type. It requires every field, takes the names and ids of objects from
the prompt, and fixes the length of lists. Some models cannot be held to a schema. Such a model is shown its errors;
after the last attempt its reply counts if the reply type accepts it.
"""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator, Mapping
from typing import Any

from coopera.core.people import Frozen
from coopera.models.small.short import shortened

_OBJECTS = {
    "PickPlace": {"object": "movable", "receptacle": "fixed"},
    "FreeMotion": {"target": "fixed"},
}
"""By type and field: the variable of the prompt (an `ObjectMap`) that says which objects there are."""
_COUNTS = {
    "verdicts": ("offers", "guesses", "tasks"),
    "tasks": ("n_tasks",),
    "intentions": ("n_intentions",),
}
"""By list: the variables of which the first that is there says how long the list is."""
_NOTES = {"title", "description"}
_SHOWN = 5


@functools.lru_cache(maxsize=64)
def _schema_of(reply: type[Frozen]) -> dict[str, Any]:
    """A reply type's schema, worked out once: pydantic takes milliseconds for it. Only ever copied by `_bare`."""
    return reply.model_json_schema()


@functools.lru_cache(maxsize=64)
def schema_of(reply: type[Frozen]) -> str:
    """A reply type's JSON schema on one line, without titles and notes that say nothing to a model."""
    return json.dumps(_bare(_schema_of(reply), _NOTES), ensure_ascii=False)


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
    schema = shortened(schema) if brief else schema
    definitions = schema.get("$defs", {})
    for part in (schema, *definitions.values()):
        if "properties" in part:
            part["required"] = list(part["properties"])
            part["additionalProperties"] = False
    for name, fields in _OBJECTS.items():
        for field, variable in fields.items():
            if name in definitions and variables.get(variable):
                _only(definitions[name]["properties"], field, variables[variable])
    for field, sources in _COUNTS.items():
        counted = next((variables[source] for source in sources if source in variables), None)
        if counted is not None and field in schema["properties"]:
            _as_long_as(schema["properties"][field], counted if isinstance(counted, int) else len(counted))
    return schema


def strays(value: Any, schema: Mapping[str, Any], place: str = "") -> list[str]:
    """Say where a valid reply leaves the enforced schema: things that are not there, too many or too few of a list."""
    return list(_strays(value, schema, schema.get("$defs", {}), place))


def _strays(value: Any, schema: Mapping[str, Any], definitions: Mapping[str, Any], place: str) -> Iterator[str]:
    if "$ref" in schema:
        schema = definitions[schema["$ref"].rpartition("/")[2]]
    if "enum" in schema and value not in schema["enum"]:
        known = json.dumps(schema["enum"][:_SHOWN], ensure_ascii=False)
        yield f"{place}: there is no {json.dumps(value, ensure_ascii=False)}, but for example {known}"
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


def _only(properties: dict[str, Any], field: str, objects: Mapping[str, Any]) -> None:
    properties[field] = {"type": "string", "enum": sorted(objects)}
    properties[f"{field}_id"] = {"type": "integer", "enum": sorted({int(place[0]) for place in objects.values()})}


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
