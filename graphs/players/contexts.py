"""What a node works with, as LangGraph's tools ask for it: a context of live services has no form to be filled in."""

from __future__ import annotations

from typing import Any

from pydantic import GetCoreSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import core_schema


class GivenByCode:
    """A context that only code can give; its JSON schema is that of an empty object.

    A server asks each graph for its schemas, and would fail over homes, models and memories.
    """

    __slots__ = ()

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """An instance, taken as it is."""
        return core_schema.is_instance_schema(
            cls, metadata={"pydantic_js_functions": [lambda _schema, _handler: cls._as_json()]}
        )

    @classmethod
    def _as_json(cls) -> JsonSchemaValue:
        return {"title": cls.__name__, "type": "object", "properties": {}, "description": "Given by code alone."}
