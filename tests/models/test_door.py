"""The door: strict replies, bounded repair, a record of every call, and the same answer for the same address."""

from __future__ import annotations

import base64
import json
import threading
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from langchain_core.callbacks import CallbackManagerForLLMRun
from langchain_core.exceptions import ModelTimeoutError
from langchain_core.language_models import BaseChatModel
from langchain_core.messages import AIMessage, BaseMessage
from langchain_core.outputs import ChatGeneration, ChatResult
from pydantic import PrivateAttr

from coopera.core.errors import ModelCallError, ModelOutputError, RunError
from coopera.core.protocols import Rendered, Role
from coopera.core.randomness import Address, seed_at
from coopera.core.replies import FreeMotionReply, VerdictsReply
from coopera.models.backends import Backend, Request
from coopera.models.cache import ReplyCache
from coopera.models.door import SEEDS, Door
from coopera.models.settings import CallSettings, Structure
from coopera.models.transport import Gate, Line

AT = Address("nora", 1, 9, "score")
YES = '{"verdicts": [{"yes": true, "reason": "it helps"}]}'
NO = '{"verdicts": [{"yes": false}]}'
USAGE: Any = {"input_tokens": 1, "output_tokens": 1, "total_tokens": 2}


class ScriptedModel(BaseChatModel):
    """Answers from a script, remembers what it was asked, and fails on an unscripted call."""

    _script: list[str | Exception | AIMessage] = PrivateAttr()
    _asked: list[list[BaseMessage]] = PrivateAttr(default_factory=list)
    _options: list[dict[str, Any]] = PrivateAttr(default_factory=list)

    def __init__(self, *script: str | Exception | AIMessage) -> None:
        super().__init__()
        self._script = list(script)

    @property
    def _llm_type(self) -> str:
        return "scripted"

    @property
    def asked(self) -> list[list[BaseMessage]]:
        return self._asked

    @property
    def options(self) -> list[dict[str, Any]]:
        return self._options

    def _generate(
        self,
        messages: list[BaseMessage],
        stop: list[str] | None = None,
        run_manager: CallbackManagerForLLMRun | None = None,
        **kwargs: Any,
    ) -> ChatResult:
        assert self._script, "an unscripted call"
        self._asked.append(messages)
        self._options.append(kwargs)
        answer = self._script.pop(0)
        if isinstance(answer, Exception):
            raise answer
        message = answer if isinstance(answer, AIMessage) else AIMessage(content=answer, usage_metadata=USAGE)
        return ChatResult(generations=[ChatGeneration(message=message)])


class OnePrompt:
    """A prompt folder with any prompt in it: its text is the variable `say`."""

    def render(self, name: str, variables: Mapping[str, Any]) -> Rendered:
        role: Role = "robot" if name.startswith("robot") else "judge"
        return Rendered(name=name, role=role, text=variables["say"], sha="f00", reply="any", temperature=0.25)


def door_to(*script: str | Exception | AIMessage, **options: Any) -> tuple[Door, ScriptedModel]:
    model = ScriptedModel(*script)
    door_options = {key: options.pop(key) for key in ("cache", "root", "seed") if key in options}
    settings = CallSettings(attempts=options.pop("attempts", 3), retries=options.pop("retries", 2))
    line = Line(settings, Gate(4, None), (OSError, ModelTimeoutError), (ValueError, LookupError), sleep=lambda _: None)
    backend = Backend("scripted:one", model, **{"options": drawing, "line": line, **options})
    backends: dict[Role, Backend] = {"robot": backend, "judge": backend}
    return Door(prompts=OnePrompt(), backends=backends, settings=settings, **{"seed": 7, **door_options}), model


def drawing(request: Request, structure: Structure) -> dict[str, Any]:
    return {"temperature": request.temperature, "seed": request.seed}


def ask(door: Door, at: Address = AT, say: str = "Judge!", images: Sequence[Path] = ()) -> VerdictsReply:
    return door("judge/tasks", VerdictsReply, at=at, variables={"say": say}, images=images)


@pytest.mark.parametrize(
    "text",
    [
        YES,
        f"```json\n{YES}\n```",
        f"Of course! Here is my judgement:\n\n{YES}\n\nI hope {{this}} helps.",
        f"<think>Maybe {NO}? No.</think>\n{YES}",
        f"{YES}\n{YES}",
        YES.replace("helps", "}{ helps \\u00e9"),
    ],
)
def test_a_valid_object_is_found_in_whatever_stands_around_it(text: str) -> None:
    door, _ = door_to(text)
    assert [v.yes for v in ask(door).verdicts] == [True]
    (call,) = door.take_calls()
    assert (call.attempts, call.faults, call.reply) == (1, [], text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "it is empty"),
        ("  \n", "it is empty"),
        ("Yes, all of them.", "there is no JSON object in it"),
        ('["perhaps"]', "verdicts.0: Input should be"),
        (YES[:-4], "it is not valid JSON"),
        ('{"verdicts": [{"yes": "perhaps"}]}', "verdicts.0.yes: Input should be a valid boolean"),
        ('{"verdicts": [{"yes": 2}]}', "verdicts.0.yes: Input should be a valid boolean"),
        ('{"verdicts": [{"yes": NaN}]}', "NaN is not a JSON number"),
        ('{"verdicts": [{}]}', "verdicts.0.yes: Field required"),
        ('{"verdicts": [{"yes": true, "no": true}]}', "it says yes and no at once"),
        ('{"verdicts": [{"yes": true, "reason": "\\ud800"}]}', "verdicts.0.reason"),
        (f"{YES} or rather {NO}", "it holds 2 different answers instead of one"),
        ("{'verdicts': [{'yes': Perhaps}]}", "it is not valid JSON"),
        ('{"a":' * 20_000, "it is not valid JSON"),
        ("{" * 50_000, "it is not valid JSON"),
    ],
)
def test_a_bad_reply_is_never_guessed_at(text: str, said: str) -> None:
    door, _ = door_to(text, attempts=1)
    with pytest.raises(ModelOutputError, match="judge/tasks") as err:
        ask(door)
    assert said in str(err.value)
    assert (err.value.prompt, err.value.reply) == ("judge/tasks", text)
    (call,) = door.take_calls()
    assert len(call.faults) == 1
    assert said in call.faults[0]


def test_a_reply_of_plain_meaning_is_taken_as_it_is_meant_and_the_trace_says_what_was_put_right() -> None:
    door, _ = door_to("{'verdicts': [{'yes': 'Yes', 'reason': None, 'certainty': 3},]}", YES)
    assert [ask(door).verdicts[0].yes for _ in range(2)] == [True, True]
    call, clean = door.take_calls()
    assert (call.attempts, call.faults) == (1, [])
    assert call.leniencies == {"extra field": 1, "json": 1, "null": 1, "yes/no": 1}
    assert "leniencies" not in clean.model_dump()


def test_a_bad_reply_is_shown_to_the_model_with_what_is_wrong_with_it() -> None:
    door, model = door_to('{"verdicts": [{"yes": "maybe"}]}', "I give up.", YES)
    assert ask(door).verdicts[0].yes
    first, second, third = model.asked
    assert [m.type for m in third] == ["human", "ai", "human", "ai", "human"]
    assert third[: len(second)] == second
    assert second[: len(first)] == first
    assert second[1].text == '{"verdicts": [{"yes": "maybe"}]}'
    assert "verdicts.0.yes: Input should be a valid boolean" in second[2].text
    assert "there is no JSON object in it" in third[4].text
    (call,) = door.take_calls()
    assert call.attempts == 3
    assert [fault.split(":")[0] for fault in call.faults] == ["attempt 1", "attempt 2"]
    assert [m["role"] for m in call.messages] == ["user", "assistant", "user", "assistant", "user"]


def test_repair_is_bounded_and_the_failure_is_on_record() -> None:
    door, model = door_to("no", "no", "no")
    with pytest.raises(ModelOutputError) as err:
        ask(door)
    assert err.value.reply == "no"
    assert len(model.asked) == 3
    (call,) = door.take_calls()
    assert (call.attempts, len(call.faults), call.reply) == (3, 3, "no")
    assert call.messages[-1]["role"] == "user", "what was really sent, not what would have come next"


def test_an_empty_reply_is_not_sent_back_as_an_empty_message() -> None:
    door, model = door_to("", YES)
    ask(door)
    assert all(m.text for m in model.asked[1])


def test_a_cut_reply_is_called_cut() -> None:
    cut = AIMessage(content=YES[:20], response_metadata={"finish_reason": "length"})
    door, model = door_to(cut, YES)
    ask(door)
    assert "cut off at the length limit" in model.asked[1][-1].text


def test_a_reply_that_ends_early_at_the_limit_counts_and_is_said_to() -> None:
    door, _ = door_to(AIMessage(content=YES, response_metadata={"finish_reason": "length"}))
    assert ask(door).verdicts
    assert "ends early" in door.take_calls()[0].faults[0]


def test_the_schema_is_appended_by_the_door_and_names_no_insides() -> None:
    door, model = door_to('{"tasks": []}', attempts=1)
    with pytest.raises(ModelOutputError):
        door("robot/tasks_type2", FreeMotionReply, at=AT, variables={"say": "Go!"})
    text = model.asked[0][0].text
    assert text.startswith("Go!\n\nAnswer with one JSON object")
    schema = json.loads(text.splitlines()[-1])
    assert schema["required"] == ["tasks"]
    assert "description" not in text
    assert chr(34) + "title" not in text


def test_seed_and_temperature_follow_prompt_and_address() -> None:
    door, model = door_to(YES, YES, YES, "no", YES)
    for at in (AT, AT, AT._replace(draw=1), AT._replace(hour=10)):
        ask(door, at)
    seeds = [o["seed"] for o in model.options]
    assert seeds[0] == seeds[1] == seed_at(7, *AT, "judge/tasks") % SEEDS
    assert len(set(seeds)) == 4
    assert {o["temperature"] for o in model.options} == {0.25}
    assert all(0 <= seed < 2**31 for seed in seeds)


def test_the_offline_kind_gets_the_variables_and_no_schema() -> None:
    door, model = door_to("no", YES, reads_variables=True, options=lambda request, structure: {})
    ask(door)
    first, again = model.asked[0][0], model.asked[1][-1]
    assert first.text == "Judge!"
    told = first.additional_kwargs["coopera"]
    assert told == {
        "prompt": "judge/tasks",
        "variables": {"say": "Judge!"},
        "seed": seed_at(7, *AT, "judge/tasks"),
        "temperature": 0.25,
    }
    assert again.additional_kwargs["coopera"]["seed"] != told["seed"]
    assert model.options == [{}, {}]


def test_a_model_that_cannot_be_reached_is_tried_again_and_every_try_is_recorded() -> None:
    for error in (ConnectionResetError("reset"), ModelTimeoutError("too slow")):
        door, model = door_to(error, error, error)
        with pytest.raises(ModelCallError, match=f"judge/tasks: scripted:one cannot be asked: {error}"):
            ask(door)
        (call,) = door.take_calls()
        assert (len(model.asked), call.attempts, len(call.faults)) == (3, 1, 3)
        door, _ = door_to(error, YES)
        assert ask(door).verdicts
        assert door.take_calls()[0].faults == [f"attempt 1: {error}; sent again after 1 s"]


def test_a_garbled_answer_of_the_server_is_asked_for_again() -> None:
    door, model = door_to(json.JSONDecodeError("Expecting value", "<html>", 0), IndexError("no choices"), YES)
    assert ask(door).verdicts
    assert [len(asked) for asked in model.asked] == [1, 1, 1]
    (call,) = door.take_calls()
    assert (call.attempts, len(call.faults)) == (1, 2)
    assert all("what the server sent is no reply" in fault for fault in call.faults)


def test_a_server_that_only_talks_garbage_is_a_call_error() -> None:
    door, _ = door_to(*[ValueError("choices is null")] * 3)
    with pytest.raises(ModelCallError, match="cannot be asked: .*choices is null"):
        ask(door)
    (call,) = door.take_calls()
    assert len(call.faults) == 3


def test_an_error_names_the_server_and_gives_no_key_away(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ACME_API_KEY", "sk-secret")
    door, _ = door_to(ConnectionError("the key sk-secret\nis wrong"), address="http://box:8000/v1", retries=0)
    with pytest.raises(ModelCallError, match="one at http://box:8000/v1 cannot be asked: the key <ACME_API_KEY> is"):
        ask(door)
    assert "sk-secret" not in door.take_calls()[0].model_dump_json()


def test_garbage_after_a_bad_reply_does_not_lose_the_repair() -> None:
    door, model = door_to("no", ValueError("garbage"), YES)
    ask(door)
    assert [m.type for m in model.asked[2]] == ["human", "ai", "human"]
    assert [fault[:9] for fault in door.take_calls()[0].faults] == ["attempt 1", "attempt 2"]


def test_a_bug_in_a_model_of_ours_is_not_taken_for_a_bad_answer() -> None:
    door, _ = door_to(KeyError("bug"), line=None)
    with pytest.raises(KeyError):
        ask(door)
    assert len(door.take_calls()) == 1


def test_tokens_of_all_attempts_are_counted() -> None:
    usage = {"input_tokens": 100, "output_tokens": 7, "total_tokens": 107}
    door, _ = door_to(*[AIMessage(content=text, usage_metadata=usage) for text in ("no", YES)])
    ask(door)
    (call,) = door.take_calls()
    assert (call.tokens_in, call.tokens_out) == (200, 14)
    assert call.seconds >= 0


def test_pictures_go_to_a_model_that_sees_and_their_names_into_the_record(tmp_path: Path) -> None:
    picture = tmp_path / "frames" / "day-00" / "robot-0.webp"
    picture.parent.mkdir(parents=True)
    picture.write_bytes(b"light")
    door, model = door_to(YES, sees=True, root=tmp_path)
    ask(door, images=[picture])
    image, text = model.asked[0][0].content_blocks
    assert (image["type"], image["mime_type"]) == ("image", "image/webp")
    assert base64.b64decode(image["base64"]) == b"light"
    assert text["type"] == "text"
    (call,) = door.take_calls()
    assert call.messages[0]["images"] == ["frames/day-00/robot-0.webp"]
    assert "bGlnaHQ" not in call.model_dump_json()


def test_pictures_that_cannot_be_shown_are_refused(tmp_path: Path) -> None:
    door, _ = door_to(sees=True)
    with pytest.raises(RunError, match=r"0\.webp: the picture cannot be read"):
        ask(door, images=[tmp_path / "0.webp"])
    with pytest.raises(RunError, match="must end in"):
        ask(door, images=[tmp_path / "0.bmp"])
    door, _ = door_to(sees=False)
    with pytest.raises(ModelCallError, match="cannot look at pictures"):
        ask(door, images=[tmp_path / "0.webp"])


def test_calls_of_parallel_draws_come_out_in_the_order_of_the_draws() -> None:
    door, model = door_to(YES, YES)
    ask(door, AT._replace(node="propose"))
    ask(door, AT._replace(node="decompose"))
    barrier = threading.Barrier(8)

    def imagine(draw: int) -> None:
        barrier.wait()
        ask(door, AT._replace(node="imagine_tasks", draw=draw), say=f"draw {draw}")

    model._script = [YES] * 8
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(imagine, [5, 3, 7, 1, 0, 2, 6, 4]))
    calls = door.take_calls()
    assert [c.node for c in calls] == ["propose", "decompose"] + ["imagine_tasks"] * 8
    assert [c.messages[0]["content"].split("\n")[0] for c in calls[2:]] == [f"draw {n}" for n in range(8)]
    assert door.take_calls() == []


@pytest.fixture
def cache(tmp_path: Path) -> Iterator[ReplyCache]:
    with closing(ReplyCache(tmp_path / "c")) as opened:
        yield opened


def test_the_cache_answers_what_was_asked_before(tmp_path: Path, cache: ReplyCache) -> None:
    usage = {"input_tokens": 10, "output_tokens": 2, "total_tokens": 12}
    door, _ = door_to("no", AIMessage(content=YES, usage_metadata=usage), cache=cache)
    again, model = door_to(cache=ReplyCache(tmp_path / "c"))
    with closing(again):
        assert ask(door) == ask(again)
    assert model.asked == []
    (before,), (after,) = door.take_calls(), again.take_calls()
    assert (before.cached, after.cached) == (False, True)
    assert before.model_copy(update={"cached": True, "seconds": 0.0}) == after.model_copy(update={"seconds": 0.0})


def test_the_cache_tells_apart_what_decides_a_reply(tmp_path: Path, cache: ReplyCache) -> None:
    picture = tmp_path / "a.png"
    picture.write_bytes(b"one")
    door, model = door_to(*[YES] * 7, cache=cache, sees=True)
    ask(door)
    ask(door, say="Judge again!")
    ask(door, AT._replace(day=2))
    ask(door, images=[picture])
    picture.write_bytes(b"two")
    ask(door, images=[picture])
    door.seed = 8
    ask(door)
    assert len(model.asked) == 6
    ask(door)
    assert len(model.asked) == 6


def test_a_call_that_failed_is_not_cached(cache: ReplyCache) -> None:
    door, _ = door_to("no", cache=cache, attempts=1)
    with pytest.raises(ModelOutputError):
        ask(door)
    door, model = door_to(YES, cache=cache)
    assert ask(door).verdicts
    assert len(model.asked) == 1


def test_the_offline_kind_is_never_cached(cache: ReplyCache) -> None:
    door, model = door_to(YES, YES, reads_variables=True, cache=cache)
    assert ask(door) == ask(door)
    assert len(model.asked) == 2
