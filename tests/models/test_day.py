"""A real, if ignorant, language model lives the day: random weights play the person, the robot and the judge."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera import Config, run_study
from coopera.config.schema import Models
from coopera.models.settings import CallSettings
from coopera.rundir.directory import RunDir
from tests.tiny import SEEING, random_llama, random_llava, word_tokenizer


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Models:
    """A text model for the person and the judge, and one with eyes for the robot."""
    folder = tmp_path_factory.mktemp("models")
    text = f"huggingface:{random_llama(folder / 'llama', word_tokenizer())}"
    eyes = f"huggingface:{random_llava(folder / 'llava', word_tokenizer(SEEING, '<image>'))}"
    return Models(human=text, robot=eyes, judge=text)


def live(out: Path, data_dir: Path, models: Models, hours: int, collab: int) -> RunDir:
    config = Config(
        models=models,
        hours=hours,
        collab=collab,
        days=1,
        frames=1,
        frame_size=(64, 48),
        calls=CallSettings(max_tokens=64),
        out=out,
        data_dir=data_dir,
    )
    run_study(config)
    return RunDir.open(out)


def assert_all_valid(run: RunDir, hours: int) -> None:
    summary = run.summary()
    assert (summary["hours"], summary["failed_hours"], summary["judge_unscored"]) == (hours, 0, 0)
    (evening,) = run.evenings()
    assert all(item.helpful is not None for item in evening.feedback)
    calls = [call for hour in run.hours() for call in hour.calls] + evening.calls
    assert {call.attempts for call in calls} == {1}, "no reply had to be asked for twice"
    looked = [call for call in calls if call.prompt == "robot/intentions"]
    assert len(looked) == hours
    assert all(len(call.messages[0]["images"]) == 2 for call in looked), "a frame from each of two viewpoints"


def test_a_tiny_random_model_lives_an_hour_and_every_reply_is_valid(
    tmp_path: Path, data_dir: Path, models: Models
) -> None:
    assert_all_valid(live(tmp_path / "run", data_dir, models, 1, 2), 1)


@pytest.mark.slow
@pytest.mark.parametrize("collab", [1, 2])
def test_a_tiny_random_model_lives_a_whole_day(tmp_path: Path, data_dir: Path, models: Models, collab: int) -> None:
    assert_all_valid(live(tmp_path / "run", data_dir, models, 13, collab), 13)
