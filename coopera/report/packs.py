"""Prompts and replies in a page that is one file: packed, a day at a time, and unpacked when looked at."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Sequence
from typing import Any

from coopera.core.hour import Evening, HourRecord, ModelCall
from coopera.core.naming import printable
from coopera.report.environment import MOST_SHOWN


def pack_days(hours: Sequence[HourRecord], evenings: Sequence[Evening]) -> dict[str, str]:
    """The prompts and replies of each day, as base64 of deflated JSON, by "d" and the day's number.

    What is packed is {"d0h9" or "d0evening": [[[role, text, pictures], …], …]}: of each call its messages, then the
    reply. A day's prompts are much alike, so that they pack to a sixth.
    """
    days: dict[int, dict[str, Any]] = {}
    for record in hours:
        days.setdefault(record.day, {})[f"d{record.day}h{record.hour}"] = [_said(call) for call in record.calls]
    for evening in evenings:
        days.setdefault(evening.day, {})[f"d{evening.day}evening"] = [_said(call) for call in evening.calls]
    return {f"d{day}": _packed(found) for day, found in sorted(days.items())}


def _said(call: ModelCall) -> list[list[Any]]:
    messages = [[str(one.get("role", "")), one.get("content", ""), one.get("images", [])] for one in call.messages]
    return [[role, _text(text), images] for role, text, images in [*messages, ["reply", call.reply, []]]]


def _text(text: Any) -> str:
    said = text if isinstance(text, str) else str(text)
    left = len(said) - MOST_SHOWN
    return printable(
        said if left <= 0 else f"{said[:MOST_SHOWN]}… ({left:,} more characters; all is in the trace file)"
    )


def _packed(data: Any) -> str:
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return base64.b64encode(zlib.compress(text.encode(), 9)).decode()
