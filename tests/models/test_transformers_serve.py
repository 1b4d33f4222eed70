"""The door before the server that comes with transformers, which takes `response_format` and ignores it."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from coopera import Config, run_study
from coopera.config.schema import Models
from coopera.core.errors import ModelOutputError
from coopera.core.randomness import Address
from coopera.core.replies import VerdictsReply
from coopera.models.backends import open_backend
from coopera.models.door import Door
from coopera.models.settings import CallSettings
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
from coopera.rundir.directory import RunDir
from tests.fakes import LetterEmbeddings
from tests.tiny import random_llama, word_tokenizer

pytestmark = pytest.mark.slow
CALLS = CallSettings(timeout=60.0, retries=1, max_tokens=64)


@contextmanager
def transformers_serve(model: Path) -> Iterator[str]:
    """Serve a model while the context lasts; gives the base URL."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "transformers.cli.transformers", "serve", str(model), "--device", "cpu"]
    environment = {**os.environ, "HF_HUB_CACHE": str(model), "HF_HUB_OFFLINE": "1", "OMP_NUM_THREADS": "1"}
    with subprocess.Popen([*command, "--host", "127.0.0.1", "--port", str(port)], env=environment) as server:
        try:
            while not answers(f"http://127.0.0.1:{port}/health"):
                with pytest.raises(subprocess.TimeoutExpired):  # it has not ended
                    server.wait(0.5)
            yield f"http://127.0.0.1:{port}/v1"
        finally:
            server.kill()


def answers(url: str) -> bool:
    try:
        with urllib.request.urlopen(url, timeout=5):
            return True
    except (urllib.error.URLError, TimeoutError):
        return False


def test_what_a_server_that_ignores_the_form_says_is_counted_and_never_a_no(tmp_path: Path, data_dir: Path) -> None:
    pytest.importorskip("fastapi", reason="transformers serve needs fastapi")
    model = random_llama(tmp_path / "model", word_tokenizer())
    spec = f"openai:{model}"
    with transformers_serve(model) as url:
        backend = open_backend(spec, "judge", LetterEmbeddings(), url, CALLS)
        door = Door(prompts=PromptLibrary(), backends={"judge": backend}, seed=1, settings=CALLS)
        with pytest.raises(ModelOutputError):
            door(
                "judge/tasks",
                VerdictsReply,
                at=Address("nora", 0, 9, "score"),
                variables=examples("judge/tasks")[0],
            )
        (call,) = door.take_calls()
        assert call.attempts == len(call.faults) == CALLS.attempts
        assert call.tokens_in > 100
        assert 0 < call.tokens_out <= 3 * CALLS.max_tokens
        assert len(call.messages) == 5, "it was shown its reply and what was wrong with it, twice"
        config = Config(
            models=Models(human="offline", robot="offline", judge=spec),
            base_url=url,
            calls=CALLS,
            days=1,
            hours=1,
            pictures="none",
            out=tmp_path / "run",
            data_dir=data_dir,
        )
        summary = run_study(config)
    (hour,) = RunDir.open(tmp_path / "run").hours()
    assert hour.status == "ok"
    assert hour.success is not None
    assert hour.success.judge.unscored == summary["judge_unscored"] == len(hour.robot.tasks if hour.robot else []) > 0
    assert hour.success.predicate.unscored == 0
