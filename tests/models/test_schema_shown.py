"""The schema of a reply is sent once: in the prompt only where nothing else holds the reply to it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from coopera.models.cache import ReplyCache
from coopera.models.door import Door
from coopera.models.settings import CallSettings, Structure
from tests.models.test_door import YES, ScriptedModel, ask, door_to


@pytest.fixture
def cache(tmp_path: Path) -> Iterator[ReplyCache]:
    with closing(ReplyCache(tmp_path / "c")) as opened:
        yield opened


def enforcing(*script: str | Exception, **options: Any) -> tuple[Door, ScriptedModel]:
    """A door to a server that has three ways to be held to a schema, and refuses those of these exceptions."""
    return door_to(*script, structures=("json_schema", "tools", "text"), **options)


class RefusalError(OSError):
    """A server's 400."""

    status_code = 400


def test_the_schema_is_shown_only_where_nothing_else_holds_the_reply_to_it() -> None:
    door, model = enforcing(YES)
    ask(door)
    assert model.asked[0][0].text == "Judge!\n\nAnswer with one JSON object and nothing else."
    door, model = enforcing(RefusalError("no"), YES, YES)
    ask(door)
    assert all("JSON schema" not in asked[0].text for asked in model.asked), "a tool shows the model its parameters"
    door, model = enforcing(RefusalError("no"), RefusalError("no"), YES, YES)
    ask(door)
    ask(door)
    assert ["JSON schema" in asked[0].text for asked in model.asked] == [False, False, True, True]
    first, second = door.take_calls()
    assert "JSON schema" in first.messages[0]["content"], "the trace has what was answered"
    assert "JSON schema" in second.messages[0]["content"]


@pytest.mark.parametrize("structure", ["text", "json_object"])
def test_a_way_that_holds_to_no_schema_shows_it(structure: Structure) -> None:
    door, model = door_to(YES, structures=(structure,))
    ask(door)
    assert '"verdicts"' in model.asked[0][0].text


def test_a_server_that_only_seems_to_hold_replies_to_the_schema_is_noticed() -> None:
    door, model = enforcing("Yes.", YES, "I am sorry.", YES, YES)
    for _ in range(3):
        ask(door)
    shown = ["JSON schema" in asked[0].text for asked in model.asked]
    assert shown == [False, True, False, True, True], "two bad replies more than good ones"
    door, model = enforcing(YES, "I am sorry.", YES, "I am sorry.", YES, YES)
    for _ in range(4):
        ask(door)
    assert ["JSON schema" in asked[0].text for asked in model.asked] == [False, False, True, False, True, False]


def test_a_call_shows_the_schema_or_not_whatever_other_calls_find_out_meanwhile(cache: ReplyCache) -> None:
    door, model = enforcing(YES, cache=cache)
    told = model._generate

    def meanwhile(*given: Any, **options: Any) -> Any:
        for _ in range(2):
            door.backends["judge"].notice(kept=False)
        return told(*given, **options)

    object.__setattr__(model, "_generate", meanwhile)
    ask(door)
    (call,) = door.take_calls()
    assert "JSON schema" not in call.messages[0]["content"], "the trace has what was sent"
    again, model = enforcing(cache=cache)
    ask(again)
    assert model.asked == [], "the answer is kept under what was sent"


def test_an_answer_is_found_again_though_the_server_is_trusted_otherwise_by_now(cache: ReplyCache) -> None:
    for trusted in (False, True):
        say = f"Judge {trusted}!"
        first, model = enforcing(YES, cache=cache)
        again, unasked = enforcing(cache=cache)
        for door in (first, again):
            for _ in range(2):
                door.backends["judge"].notice(kept=(door is first) == trusted)
        ask(first, say=say)
        assert ("JSON schema" in model.asked[0][0].text) == (not trusted)
        ask(again, say=say)
        assert unasked.asked == []


@pytest.mark.parametrize(("chosen", "shown"), [("always", True), ("never", False)])
def test_the_schema_is_shown_or_not_as_the_settings_say(chosen: str, shown: bool) -> None:
    for structure in ("json_schema", "text"):
        door, model = door_to(YES, structures=(structure,))
        door.settings = CallSettings(show_schema=chosen)
        ask(door)
        assert ("JSON schema" in model.asked[0][0].text) == shown


def test_an_answer_is_found_again_in_the_cache_however_the_server_was_held_to_the_schema(cache: ReplyCache) -> None:
    door, _ = enforcing(RefusalError("no"), RefusalError("no"), YES, cache=cache)
    ask(door)
    again, model = enforcing(cache=cache)
    assert ask(again).verdicts
    assert model.asked == []
    other, model = door_to(YES, structures=("json_object",), cache=cache)
    ask(other)
    assert len(model.asked) == 1, "another way to hold it may give another answer"
