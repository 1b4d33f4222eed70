"""What is wrong with a configuration, in one sentence that names file or flag, field and what was expected."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ValidationError

from coopera.config.declared import Declared, declared
from coopera.models.servers.saying import bare_addresses


def complaint(err: ValidationError, model: type[BaseModel], file: str, flags: Mapping[str, Any]) -> str:
    """Turn the first of pydantic's complaints into one sentence.

    Args:
        err: What pydantic says.
        model: The configuration that it says it of.
        file: Where the values stood that no flag gave.
        flags: What flags gave, by field.
    """
    settings = declared(model)
    first = err.errors(include_url=False)[0]
    names = [part for part in first["loc"] if isinstance(part, str)]
    if first["type"] == "extra_forbidden":
        *section, name = names
        fields = ((settings[section[0]].section if section else None) or model).model_fields
        near = difflib.get_close_matches(name, fields, n=1)
        hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(fields)}"
        return f"{file}: there is no field {name!r} ({hint})."
    field = next(name for size in range(len(names), 0, -1) if (name := ".".join(names[:size])) in settings)
    where = _flag(settings, field, flags) or f"{file}: {field}"
    return f"{where} must be {settings[field].expected}, not {bare_addresses(repr(first['input']))}."


def _flag(settings: Mapping[str, Declared], field: str, flags: Mapping[str, Any]) -> str | None:
    """The flag that a wrong value came from, or None where it came from the file."""
    name, _, inner = field.partition(".")
    if name not in flags:
        return None
    given, whole, part = flags[name], settings[name], settings[field].words.flag
    if whole.section is None or not inner:
        return part
    if inner not in given:
        return None
    for_all = len(given) == len(whole.section.model_fields) and len(set(given.values())) == 1
    return whole.words.flag if for_all and whole.words.flag else part
