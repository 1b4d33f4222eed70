"""From a model's free text to a validated reply, or to a sentence that says what is wrong with it.

Three steps: find the JSON (`loose_json`), bring it into the form of the schema where its meaning is plain (`fitting`),
and validate it strictly. What was put right on the way is counted.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, NamedTuple

from pydantic import ValidationError

from coopera.core.household import ObjectMap
from coopera.core.protocols import Reply
from coopera.models.reading.depth import MOST_DEEP, too_deep
from coopera.models.reading.fitting import Fit
from coopera.models.reading.loose_json import LooseJSONError, once, read_loosely
from coopera.models.schemas import enforced_schema, objects_of, schema_of, strays, whole_schema

MAX_STARTS = 50
MAX_TEXT = 200_000  # characters
_START = re.compile(r"[{\[]")
_ERRORS_SHOWN = 5
_STRAYS = 5  # things out of place that a model is told of at once


class BadReplyError(Exception):
    """A reply cannot be used; the text says why, for the model to read. Never leaves the door."""


@dataclass(frozen=True)
class Wanted(Generic[Reply]):
    """What a prompt asks for: a type of reply, and what the prompt's variables say of it.

    Attributes:
        reply: The type.
        variables: What the prompt was filled with.
        held: Whether the reply must name and count what the variables say; the offline model is taken at its word.
        brief: Whether it is to be short.
    """

    reply: type[Reply]
    variables: Mapping[str, Any]
    held: bool = True
    brief: bool = False

    @cached_property
    def objects(self) -> dict[str, dict[str, ObjectMap]]:
        """The objects that it may name, by type of act and field."""
        return objects_of(self.variables)

    @cached_property
    def enforced(self) -> dict[str, Any]:
        """The schema that a backend is given to hold the reply to; empty where it need not be held."""
        return enforced_schema(self.reply, self.variables, brief=self.brief) if self.held else {}

    @property
    def shown(self) -> str:
        """The schema as a model reads it."""
        return schema_of(self.reply, frozenset(self.objects))


class Read(NamedTuple, Generic[Reply]):
    """A valid reply; what was put right in it, by kind; and where it names or counts what was not asked for."""

    reply: Reply
    leniencies: dict[str, int]
    strays: str = ""


class _Piece(NamedTuple):
    """A stretch of text that begins like a JSON object or list; `problem` is set where it is none."""

    length: int
    value: Any
    problem: str = ""
    loose: bool = False


def read_reply(text: str, wanted: Wanted[Reply]) -> Read[Reply]:
    """Find the one answer in a text, bring it into form and validate it strictly.

    Text around the answer, such as a code fence or a greeting, is passed over; so is what a reasoning model thinks
    aloud before "</think>". What would change the meaning is not guessed.

    Raises:
        BadReplyError: If there is no answer, there are several different ones, or it was still thinking when it ended.
    """
    said = text.rpartition("</think>")[2]
    if "<think>" in said:
        raise BadReplyError("its thinking never ended")
    pieces = list(_pieces(said[:MAX_TEXT]))
    problems = [(piece.length, piece.problem) for piece in pieces if piece.problem]
    found: list[Read[Reply]] = []
    for kind in (dict, list):  # a list stands for its object only where no object is an answer
        for piece in [piece for piece in pieces if isinstance(piece.value, kind)]:
            try:
                answer = _fitted(piece, wanted)
            except BadReplyError as err:
                problems.append((piece.length, str(err)))
            else:
                found += [answer] if answer.reply not in [one.reply for one in found] else []
        if found:
            break
    if len(found) == 1:
        return found[0]
    if found:
        raise BadReplyError(f"it holds {len(found)} different answers instead of one")
    if not problems:
        raise BadReplyError("it is empty" if not text.strip() else "there is no JSON object in it")
    raise BadReplyError(max(problems, key=lambda known: known[0])[1])


def _fitted(piece: _Piece, wanted: Wanted[Reply]) -> Read[Reply]:
    if not wanted.held:
        with suppress(ValidationError):
            return Read(wanted.reply.model_validate(piece.value, strict=True), {})
    fit = Fit(whole_schema(wanted.reply), wanted.objects)
    value = fit.whole(piece.value)
    if fit.problems:
        raise BadReplyError("; ".join(fit.problems[:_ERRORS_SHOWN]))
    try:
        reply = wanted.reply.model_validate(value, strict=True)
    except ValidationError as err:
        raise BadReplyError(say(err)) from err
    if piece.loose:
        fit.counted["json"] += 1
    out_of_place = strays(reply.model_dump(), wanted.enforced)[:_STRAYS]
    return Read(reply, dict(sorted(fit.counted.items())), "; ".join(out_of_place))


def say(err: ValidationError) -> str:
    """Put a validation error into words: which fields, and what was expected of them."""
    errors = err.errors(include_url=False, include_input=False, include_context=False)
    said = [f"{'.'.join(str(part) for part in e['loc']) or 'the object'}: {e['msg']}" for e in errors[:_ERRORS_SHOWN]]
    more = [f"and {len(errors) - _ERRORS_SHOWN} more"] if len(errors) > _ERRORS_SHOWN else []
    return "; ".join([*said, *more])


def _pieces(text: str) -> Iterator[_Piece]:
    """Every stretch of text that is an object or a list, or begins like one; what stands inside one is none."""
    decoder = json.JSONDecoder(parse_constant=_refuse, object_pairs_hook=once, strict=False)
    found = _START.search(text)
    for _ in range(MAX_STARTS):
        if found is None:
            return
        at, loose = found.start(), False
        try:
            try:
                value, end = decoder.raw_decode(text, at)
            except (ValueError, RecursionError):
                loose = True
                value, end = read_loosely(text, at)
            if too_deep(text[at:end]):
                raise LooseJSONError(f"it is nested more than {MOST_DEEP} levels deep")
        except LooseJSONError as err:
            end = at + 1
            yield _Piece(err.reached, None, f"it is not valid JSON: {err}")
            if err.begun:
                return
        else:
            yield _Piece(end - at, value, loose=loose)
        found = _START.search(text, end)


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is not a JSON number")
