"""Short replies for models that are slow or wander: a reply's schema without reasons, and with short texts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

SENTENCE, PARAGRAPH, ITEMS = 120, 400, 4
"""Most characters of a sentence and of a longer text, and most items of a list that may be left out."""
_SENTENCE = 400  # a text that a reply type bounds by so much or less is a sentence


def shortened(schema: Mapping[str, Any]) -> dict[str, Any]:
    """Cut a reply type's schema down: no reasons where they may be left out, shorter texts, shorter optional lists.

    Whatever fits what is left fits the reply type.
    """
    made = dict(schema)
    for parts in ("properties", "$defs"):
        if parts in made:
            made[parts] = {name: shortened(part) for name, part in made[parts].items()}
    if "items" in made:
        made["items"] = shortened(made["items"])
    if "anyOf" in made:
        made["anyOf"] = [shortened(option) for option in made["anyOf"]]
    if "properties" in made:
        needed = set(made.get("required", ()))
        fields = made["properties"].items()
        made["properties"] = {
            name: part if name in needed else _fewer(part)
            for name, part in fields
            if name in needed or not name.startswith("reason")
        }
    if "maxLength" in made:
        made["maxLength"] = min(made["maxLength"], SENTENCE if made["maxLength"] <= _SENTENCE else PARAGRAPH)
    return made


def _fewer(part: dict[str, Any]) -> dict[str, Any]:
    return part | {"maxItems": min(part["maxItems"], ITEMS)} if "maxItems" in part else part
