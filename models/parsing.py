"""From a model's free text to a validated reply, or to a sentence that says what is wrong with it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, NamedTuple

from pydantic import ValidationError

from coopera.core.protocols import Reply

MAX_STARTS = 200
MAX_TEXT = 200_000  # characters
_ERRORS_SHOWN = 5


class BadReplyError(Exception):
    """A reply cannot be used; the text says why, for the model to read. Never leaves the door."""


class _Piece(NamedTuple):
    """A stretch of text that begins like a JSON object; `problem` is set where it is none."""

    length: int
    value: dict[str, Any] | None
    problem: str = ""


def read_reply(text: str, reply: type[Reply]) -> Reply:
    """Find the one JSON object in a reply and validate it strictly.

    Text around the object, such as a code fence or a greeting, is passed over; so is what a reasoning model
    thinks aloud before "</think>". Nothing is guessed: types must be right as they stand.

    Raises:
        BadReplyError: If there is no such object, or there are several different ones.
    """
    pieces = list(_pieces(text.rpartition("</think>")[2][:MAX_TEXT]))
    found: list[Reply] = []
    problems: list[tuple[int, str]] = []
    for length, value, problem in pieces:
        try:
            if value is None:
                problems.append((length, problem))
            elif (answer := reply.model_validate(value, strict=True)) not in found:
                found.append(answer)
        except ValidationError as err:
            problems.append((length, say(err)))
    if len(found) == 1:
        return found[0]
    if found:
        raise BadReplyError(f"it holds {len(found)} different answers instead of one")
    if not problems:
        raise BadReplyError("it is empty" if not text.strip() else "there is no JSON object in it")
    raise BadReplyError(max(problems, key=lambda known: known[0])[1])


def say(err: ValidationError) -> str:
    """Put a validation error into words: which fields, and what was expected of them."""
    errors = err.errors(include_url=False, include_input=False, include_context=False)
    said = [f"{'.'.join(str(part) for part in e['loc']) or 'the object'}: {e['msg']}" for e in errors[:_ERRORS_SHOWN]]
    more = [f"and {len(errors) - _ERRORS_SHOWN} more"] if len(errors) > _ERRORS_SHOWN else []
    return "; ".join([*said, *more])


def _pieces(text: str) -> Iterator[_Piece]:
    decoder = json.JSONDecoder(parse_constant=_refuse)
    at = text.find("{")
    for _ in range(MAX_STARTS):
        if at < 0:
            return
        end = at + 1
        try:
            value, end = decoder.raw_decode(text, at)
            yield _Piece(end - at, value)
        except json.JSONDecodeError as err:
            yield _Piece(err.pos - at, None, f"it is not valid JSON: {err.msg} at character {err.pos - at}")
        except (ValueError, RecursionError) as err:
            yield _Piece(0, None, f"it is not valid JSON: {err}")
        at = text.find("{", end)


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is not a JSON number")
