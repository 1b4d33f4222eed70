"""The day over HTTP, with a real client and a server in its own process that goes wrong in every way servers do."""

from __future__ import annotations

import gc
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from coopera import Config, run_study
from coopera.config.schema import Models
from coopera.core.errors import ModelCallError
from coopera.core.hour import ModelCall
from coopera.core.randomness import Address
from coopera.core.replies import VerdictsReply
from coopera.models.backends import open_backend
from coopera.models.door import Door
from coopera.models.servers.client import BoundedClient
from coopera.models.settings import CallSettings
from coopera.models.transport import NobodyThereError
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
from coopera.rundir.directory import RunDir
from tests.fakes import LetterEmbeddings
from tests.server import FAULTS
from tests.serving import done, serving
from tests.tiny import SEEING, random_llava, word_tokenizer

QUICK = {"timeout": 1.0, "backoff": 0.01, "max_tokens": 64}
AT = Address("nora", 0, 9, "score")
SAID = {
    "500": "a fault of kind 500",
    "429": "a fault of kind 429",
    "hang": "timed out",
    "html": "is no reply",
    "cut": "it was cut off at the length limit",
    "empty": "it is empty",
    "prose": "there is no JSON object",
    "types": "Input should be",
    "ids": "there is no |there must be",
}
"""What the trace says of each kind of fault."""


@pytest.fixture(scope="module")
def data_dir(letters: Path) -> Path:
    """What a server does wrong does not depend on how texts are compared."""
    return letters


def door_to(base_url: str, **settings: Any) -> Door:
    calls = CallSettings(**{**QUICK, **settings})
    backend = open_backend("openai:tiny", "judge", LetterEmbeddings(), base_url, calls)
    return Door(prompts=PromptLibrary(), backends={"judge": backend}, seed=1, settings=calls)


def judge(door: Door, draw: int = 0) -> VerdictsReply:
    return door("judge/tasks", VerdictsReply, at=AT._replace(draw=draw), variables=examples("judge/tasks")[0])


def all_calls(run: RunDir) -> list[ModelCall]:
    calls = [call for hour in run.hours() for call in hour.calls]
    return calls + [call for evening in run.evenings() for call in evening.calls]


def live(out: Path, data_dir: Path, base_url: str, hours: int, **more: Any) -> RunDir:
    config = Config(
        models=Models(human="openai:tiny", robot="openai:tiny+images", judge="openai:tiny"),
        base_url=base_url,
        **{
            "calls": CallSettings(**QUICK),
            "hours": hours,
            "days": 1,
            "frames": 1,
            "frame_size": (64, 48),
            "out": out,
            **more,
        },
        data_dir=data_dir,
    )
    run_study(config)
    return RunDir.open(out)


def assert_every_fault_is_on_record(run: RunDir, kinds: list[str]) -> None:
    faults = [fault for call in all_calls(run) for fault in call.faults]
    happened = Counter(kind for kind in kinds if kind in FAULTS)
    assert set(happened) == set(FAULTS)
    for kind, count in happened.items():
        heard = sum(any(part in fault for part in SAID[kind].split("|")) for fault in faults)
        assert heard >= count, f"{kind}: {heard} in the trace of {count}"


def assert_nothing_unreadable_became_a_no(run: RunDir) -> None:
    for hour in run.hours():
        if hour.status == "failed":
            assert hour.success is None
            assert "cannot be used" in hour.reason
            continue
        assert hour.success is not None
        (judged,) = [call for call in hour.calls if call.node == "score"] or [None]
        if judged is not None and any(_unread(fault) for fault in judged.faults):
            assert hour.success.judge.unscored == len(hour.robot.tasks if hour.robot else [])


def _unread(fault: str) -> bool:
    """Whether the last answer that was asked for could not be read; one that was late was only sent again."""
    mended = ("sent again after", "asked again without", "can be used")
    return fault.startswith("attempt 3: ") and not any(words in fault for words in mended)


def test_an_hour_goes_well_though_almost_half_of_all_calls_go_wrong(tmp_path: Path, data_dir: Path) -> None:
    with serving("--faults", "0.45", "--hang", "1.5") as url:
        run = live(tmp_path / "run", data_dir, url, 2)
        kinds = done(url)
    assert [hour.hour for hour in run.hours()] == [9, 10]
    assert_every_fault_is_on_record(run, kinds)
    assert_nothing_unreadable_became_a_no(run)


@pytest.mark.slow
def test_a_whole_day_goes_well_with_a_tiny_model_though_a_third_of_all_calls_go_wrong(
    tmp_path: Path, data_dir: Path
) -> None:
    model = random_llava(tmp_path / "model", word_tokenizer(SEEING, "<image>"))
    with serving("--faults", "0.3", "--hang", "30", "--model", str(model)) as url:
        patient = CallSettings(**{**QUICK, "timeout": 25.0})
        run = live(tmp_path / "run", data_dir, url, 13, calls=patient, collab=1)
        kinds = done(url)
    assert len(run.hours()) == 13
    assert_every_fault_is_on_record(run, kinds)
    assert_nothing_unreadable_became_a_no(run)


@pytest.mark.parametrize("refused", [[], ["response_format"], ["response_format", "tools"]])
def test_a_server_is_asked_for_the_form_in_the_best_way_that_it_has(refused: list[str]) -> None:
    with serving(*(["--refuse", *refused] if refused else [])) as url:
        door = door_to(url, attempts=1)
        backend = door.backends["judge"]
        if len(refused) == 2:  # the server then says "No.", whatever it is asked
            with pytest.raises(Exception, match="no JSON object"):
                judge(door)
        else:
            for draw in range(2):
                assert len(judge(door, draw).verdicts) == len(examples("judge/tasks")[0]["offers"])
        first = door.take_calls()[0]
    assert backend.structure == ("json_schema", "tools", "text")[len(refused)]
    assert [("asked again without" in fault) for fault in first.faults[: len(refused)]] == [True] * len(refused)


def test_a_server_that_is_gone_is_given_up_after_all_the_retries() -> None:
    with serving() as url:
        door = door_to(url, retries=2)
        judge(door)
    door.take_calls()
    with pytest.raises(ModelCallError, match=f"openai:tiny at {url} cannot be asked: Connection error"):
        judge(door, 1)
    assert len(door.take_calls()[0].faults) == 3


def test_a_server_that_never_was_is_not_waited_for() -> None:
    with serving() as base_url:
        pass
    url = base_url.replace("127.0.0.1", "localhost")  # of another test's server the system may have reused the port
    door = door_to(url, retries=2)
    with pytest.raises(NobodyThereError, match=f"openai:tiny at {url} cannot be asked: no server listens there"):
        judge(door)
    assert len(door.take_calls()[0].faults) == 1


def test_a_client_that_nobody_uses_has_closed_its_connections_in_whichever_order_they_go() -> None:
    with serving() as base_url:
        client: Any = BoundedClient(1_000_000)
        client.itself = client
        gc.freeze()
        client.get(f"{base_url}/models")
        gc.collect()
        gc.unfreeze()  # of what refers to itself, the younger connection now goes first
        del client
        gc.collect()  # Python would warn of a connection that is still open, and a warning is an error here
