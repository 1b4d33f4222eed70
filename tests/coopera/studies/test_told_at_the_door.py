"""What the person told in the evening stands in the prompts that a language model's robot gets on the next day."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera import Config, run_study
from coopera.config.schema import Models
from coopera.core.hour import HourRecord
from coopera.models.settings import CallSettings
from coopera.rundir.directory import RunDir
from tests.roles import roles


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory, data_dir: Path) -> list[HourRecord]:
    """Two days of three hours; the robot is answered by a server that speaks as language models' servers do."""
    out = tmp_path_factory.mktemp("told") / "run"
    with roles() as url:
        run_study(
            Config(
                models=Models(human="offline", robot="openai:good", judge="offline"),
                base_url=url,
                calls=CallSettings(timeout=5.0, backoff=0.01, max_tokens=2000),
                **{"hours": 3, "days": 2, "pictures": "none", "out": out, "data_dir": data_dir},
            )
        )
    return list(RunDir.open(out).hours())


def prompts(hours: list[HourRecord], day: int, name: str) -> list[str]:
    return [
        "\n".join(str(message["content"]) for message in call.messages)
        for hour in hours
        for call in hour.calls
        if hour.day == day and call.prompt == name
    ]


def told(hours: list[HourRecord]) -> set[str]:
    return {task.act.describe() for hour in hours if hour.day == 0 and hour.human for task in hour.human.tasks}


def test_the_told_tasks_stand_in_the_task_prompt_of_the_next_day(lived: list[HourRecord]) -> None:
    asked = prompts(lived, 1, "robot/tasks_type2")
    assert asked
    assert any(task in text for text in asked for task in told(lived))


def test_the_told_intentions_stand_in_the_intention_prompt_of_the_next_day(lived: list[HourRecord]) -> None:
    said = {hour.human.intention.text for hour in lived if hour.day == 0 and hour.human}
    asked = prompts(lived, 1, "robot/intentions")
    assert len(asked) == 3
    assert all(any(text in prompt for text in said) for prompt in asked)


def test_on_the_day_itself_nothing_that_is_told_in_the_evening_is_known(lived: list[HourRecord]) -> None:
    asked = [*prompts(lived, 0, "robot/tasks_type2"), *prompts(lived, 0, "robot/intentions")]
    assert asked
    assert not any(task in text for text in asked for task in told(lived))
