"""Servers that misbehave: each way ends in a sentence and a true state, and a good server takes over from there."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from coopera import Config, RunDir, resume_study, run_study
from coopera.config.schema import Models
from coopera.core.errors import ConfigError, ModelCallError, ModelOutputError, StoppedError
from coopera.core.hour import ModelCall
from coopera.core.randomness import Address
from coopera.core.replies import VerdictsReply
from coopera.models.backends import open_backend
from coopera.models.budget import Meter
from coopera.models.door import Door
from coopera.models.servers.saying import LOGIN
from coopera.models.settings import Budget, CallSettings
from coopera.models.transport import NobodyThereError
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
from tests.fakes import LetterEmbeddings
from tests.models.misbehaving import LIMIT, WAYS, Server, misbehaving

AT = Address("nora", 0, 9, "score")
ONCE = {"retries": 1, "backoff": 0.001, "attempts": 1}
OF_THE_WAY = [name for name, way in WAYS.items() if not way.replies]
HANGING = [name for name, way in WAYS.items() if way.hangs]
LIES = [name for name in WAYS if name.startswith("counts")]
PAGE = Path(__file__).parents[2] / "docs" / "reliability.md"


@pytest.fixture(scope="module")
def data_dir(letters: Path) -> Path:
    """What a server does wrong does not depend on how texts are compared."""
    return letters


def door_to(url: str, *, meter: Meter | None = None, check: Callable[[], None] = lambda: None, **settings: Any) -> Door:
    calls = CallSettings(**{**ONCE, **settings})
    backend = open_backend("openai:tiny", "judge", LetterEmbeddings(), url, calls, check)
    return Door(prompts=PromptLibrary(), backends={"judge": backend}, seed=1, settings=calls, meter=meter)


def judge(door: Door) -> VerdictsReply:
    return door("judge/tasks", VerdictsReply, at=AT, variables=examples("judge/tasks")[0])


def record_of(door: Door) -> ModelCall:
    (call,) = door.take_calls()
    return call


@pytest.mark.parametrize("name", [name for name, way in WAYS.items() if way.said])
def test_a_server_that_misbehaves_is_told_of_in_a_sentence_and_leaves_a_short_record(name: str) -> None:
    way = WAYS[name]
    with misbehaving(name) as server:
        door = door_to(server.url, timeout=0.3 if way.hangs else 60.0)
        with pytest.raises(ModelOutputError if way.replies else ModelCallError, match=way.said):
            judge(door)
        assert 1 <= server.requests <= 2
    call = record_of(door)
    assert re.search(way.said, call.faults[-1])
    assert sum(map(len, call.faults)) < 2000
    assert len(call.reply) < LIMIT


@pytest.mark.parametrize("name", LIES)
def test_a_count_of_tokens_that_cannot_be_is_estimated_and_the_trace_says_so(name: str) -> None:
    meter = Meter(Budget(tokens=100))
    with misbehaving(name) as server:
        door = door_to(server.url, meter=meter)
        judge(door)
        with pytest.raises(Exception, match="the budget of 100 tokens is spent"):
            judge(door)
    first, refused = door.take_calls()
    assert first.leniencies["tokens"] == 2
    assert first.tokens_in == -(-len(first.messages[0]["content"]) // 4)
    assert first.tokens_out == -(-len(first.reply) // 4)
    assert meter.spent.tokens == first.tokens_in + first.tokens_out
    assert refused.tokens_in == 0


def test_counts_that_can_be_are_believed() -> None:
    with misbehaving("good") as server:
        door = door_to(server.url)
        judge(door)
    call = record_of(door)
    assert (call.tokens_in, call.tokens_out, call.leniencies) == (100, 20, {})


def test_a_server_that_refuses_connections_is_told_of_in_a_sentence() -> None:
    with Server() as server:
        pass
    with pytest.raises(NobodyThereError, match="no server listens there"):
        judge(door_to(server.url))


def test_a_server_that_is_killed_and_comes_back_is_asked_again() -> None:
    with Server() as first:
        door = door_to(first.url, retries=20, backoff=0.001, max_pause=0.2)
        judge(door)
    door.take_calls()
    first.socket.close()
    asked: list[VerdictsReply] = []
    asking = threading.Thread(target=lambda: asked.append(judge(door)))
    asking.start()
    with Server(port=first.server_address[1]):
        asking.join(60)
    assert len(asked) == 1


def test_a_call_is_given_up_at_once_where_the_run_is_asked_to_stop() -> None:
    stop = threading.Event()

    def check() -> None:
        if stop.is_set():
            raise StoppedError("The run was interrupted.")

    for name in HANGING:
        with misbehaving(name) as server:
            door = door_to(server.url, check=check, timeout=600.0)
            stop.clear()
            asking = threading.Thread(target=lambda server=server: server.begun.wait(60) and stop.set())
            asking.start()
            with pytest.raises(StoppedError):
                judge(door)
            assert not server.ended.is_set()
            asking.join()


def run_against(server: Server, out: Path, data_dir: Path, **calls: Any) -> Config:
    return Config(
        models=Models(human="openai:tiny"),
        base_url=server.url,
        calls=CallSettings(**{"retries": 0, "max_tokens": 64, **calls}),
        hours=1,
        days=1,
        humans=["amara"],
        method="none",
        pictures="none",
        out=out,
        data_dir=data_dir,
        cache=out.parent / "cache.sqlite",
    )


def state_of(out: Path) -> tuple[str, str]:
    info = json.loads((out / "run.json").read_text())
    return info["state"], info["reason"]


def test_a_run_outlives_every_way_and_ends_as_if_its_server_had_been_good(tmp_path: Path, data_dir: Path) -> None:
    out = tmp_path / "run"
    with misbehaving("good") as server:
        run_study(run_against(server, tmp_path / "good" / "run", data_dir))
        server.way = "fails (500)"
        with pytest.raises(ModelCallError):
            run_study(run_against(server, out, data_dir))
        for name in (name for name in OF_THE_WAY if name not in HANGING):
            server.way = name
            with pytest.raises(ModelCallError) as err:
                resume_study(out)
            assert state_of(out) == ("failed", str(err.value))
            assert RunDir.open(out).hours_done() == []
        server.way = "good"
        assert resume_study(out)["failed_hours"] == 0
    assert state_of(out) == ("finished", "")
    ours, theirs = ([hour.human for hour in RunDir.open(run).hours()] for run in (out, tmp_path / "good" / "run"))
    assert ours == theirs


def test_an_hour_whose_replies_cannot_be_read_is_recorded_as_failed(tmp_path: Path, data_dir: Path) -> None:
    with misbehaving("answers in colour") as server:
        summary = run_study(run_against(server, tmp_path / "run", data_dir, attempts=1))
    (hour,) = RunDir.open(tmp_path / "run").hours()
    assert (summary["failed_hours"], hour.status, hour.human) == (1, "failed", None)
    assert "it is not valid JSON" in hour.reason
    assert state_of(tmp_path / "run") == ("finished", "")


def test_ctrl_c_stops_a_run_whose_server_drips_and_it_can_be_resumed(tmp_path: Path, data_dir: Path) -> None:
    out = tmp_path / "run"
    with misbehaving("drips text") as server:

        def interrupt() -> None:
            server.begun.wait(60)
            os.kill(os.getpid(), signal.SIGINT)

        killer = threading.Thread(target=interrupt)
        killer.start()
        with pytest.raises((KeyboardInterrupt, StoppedError)):
            run_study(run_against(server, out, data_dir, timeout=600.0))
        assert not server.ended.is_set()
        killer.join()
        assert state_of(out)[0] == "stopped"
        server.way = "good"
        assert resume_study(out)["hours"] == 1


def test_user_and_password_come_from_the_environment_and_stand_in_no_record(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, data_dir: Path
) -> None:
    monkeypatch.setenv(LOGIN, "ada:pass:word")
    with misbehaving("tells what it was sent") as server:
        door = door_to(server.url)
        with pytest.raises(ModelCallError, match=f"Basic <{LOGIN}>") as err:
            judge(door)
        assert "pass:word" not in f"{err.value} {record_of(door).model_dump_json()}"
    with pytest.raises(ConfigError, match=LOGIN) as refused:
        open_backend("openai:tiny", "judge", LetterEmbeddings(), "http://ada:pass@localhost/v1")
    assert "pass@" not in str(refused.value)
    monkeypatch.setenv(LOGIN, "ada")
    with pytest.raises(ConfigError, match="must be USER:PASSWORD"):
        door_to("http://localhost:1/v1")


def test_the_page_says_of_each_way_what_happens() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for name in WAYS.keys() - {"good"}:
        assert f"| {name} |" in page


def test_a_port_that_takes_connections_and_never_answers_is_left_in_time() -> None:
    with socket.create_server(("127.0.0.1", 0)) as mute, pytest.raises(ModelCallError, match="timed out"):
        judge(door_to(f"http://127.0.0.1:{mute.getsockname()[1]}/v1", timeout=0.3, retries=0))
