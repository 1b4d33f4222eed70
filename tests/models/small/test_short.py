"""Short replies: no reasons, short texts, and still every reply type's own."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import pytest

from coopera.core.asks import ASKS
from coopera.core.people import Frozen
from coopera.core.replies import REPLIES
from coopera.models.parsing import Wanted, read_reply
from coopera.models.schemas import enforced_schema
from coopera.models.small.short import PARAGRAPH, SENTENCE
from coopera.prompts.examples import examples


def _longest(schema: Mapping[str, Any], known: Mapping[str, Any]) -> Any:
    """A reply as long as its schema lets it be."""
    if "$ref" in schema:
        return _longest(known[schema["$ref"].rpartition("/")[2]], known)
    if "enum" in schema or "const" in schema:
        return schema.get("enum", [schema.get("const")])[0]
    if "anyOf" in schema:
        return _longest(schema["anyOf"][0], known)
    kind = schema["type"]
    if kind == "object":
        return {name: _longest(part, known) for name, part in schema.get("properties", {}).items()}
    if kind == "array":
        return [_longest(schema["items"], known)] * schema.get("maxItems", 1)
    if kind == "string":
        return "a" * schema.get("maxLength", 9)
    return {"integer": schema.get("minimum", 1), "number": schema.get("minimum", 0.5), "boolean": True}[kind]


@pytest.mark.parametrize("name", sorted(ASKS))
def test_the_longest_short_reply_fits_its_type_and_gives_no_reasons(name: str) -> None:
    reply: type[Frozen] = REPLIES[ASKS[name].reply]
    for variables in examples(name):
        schema = enforced_schema(reply, variables, brief=True)
        whole = _longest(schema, schema.get("$defs", {}))
        assert not read_reply(json.dumps(whole), Wanted(reply, variables, brief=True)).leniencies
        texts = list(_texts(whole))
        assert not [field for field, _ in texts if field.startswith("reason")]
        assert all(len(text) <= (PARAGRAPH if "profile" in field else SENTENCE) for field, text in texts)


def test_without_the_setting_nothing_is_cut() -> None:
    reply = REPLIES["PickPlaceReply"]
    variables = examples("robot/tasks_type1")[0]
    assert "reason_human" in str(enforced_schema(reply, variables))
    assert "reason" not in str(enforced_schema(reply, variables, brief=True))


def _texts(value: Any, field: str = "") -> Any:
    if isinstance(value, str):
        yield field, value
    elif isinstance(value, dict):
        for name, part in value.items():
            yield from _texts(part, name)
    elif isinstance(value, list):
        for part in value:
            yield from _texts(part, field)
