"""What nodes say of where a life is, to whoever listens by LangChain's callbacks (`on_custom_event`)."""

from __future__ import annotations

from typing import Any

from langchain_core.callbacks import dispatch_custom_event
from typing_extensions import TypedDict

SAID = "coopera"
"""The name of these events."""


class Said(TypedDict):
    """`hour` is None in the evening; `success` is the hour's (`coopera.core.success.Success`), once it is known.

    Which node says it is in the event's metadata, as `langgraph_node`.
    """

    day: int
    hour: int | None
    success: dict[str, Any] | None


def say(day: int, hour: int | None = None, success: dict[str, Any] | None = None) -> None:
    """Say, within a node, that it is reached."""
    dispatch_custom_event(SAID, Said(day=day, hour=hour, success=success))
