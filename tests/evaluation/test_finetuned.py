from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.tiny_mistral import make_recipe
from coopera.config.schema import Config, Models
from coopera.core.clock import Clock
from coopera.core.errors import ConfigError
from coopera.core.hour import RobotHour
from coopera.core.household import FreeMotion, HandOver
from coopera.core.people import PersonId
from coopera.evaluation.baselines import Occasion
from coopera.evaluation.finetuned import BringReply, lesson
from coopera.models.parsing import Wanted, read_reply
from coopera.rundir.directory import RunDir
from coopera.studies.catalogues import resolve, tuned_model
from coopera.studies.study import run_study
from tests.tiny import random_llama


def test_the_right_reply_of_a_lesson_is_one_that_can_be_read() -> None:
    motion = FreeMotion(target_id=1, target="kitchen_table_0", in_hand="tea mug", motion="drink")
    question, reply = lesson(
        Occasion(PersonId("ann"), Clock(day=0, hour=9), "In the kitchen.", "Rest a while", [motion])
    )
    assert "In the kitchen." in question
    assert "Rest" not in question
    read = read_reply(reply, Wanted(BringReply, {}))
    assert read.reply == BringReply(intention="Rest a while", tasks=[HandOver(object="tea mug")])
    assert read.leniencies == {}


def test_a_model_on_a_server_cannot_be_finetuned(tmp_path: Path) -> None:
    models = Models(robot="openai:some-model")
    with pytest.raises(ConfigError, match="direct_finetuning finetunes the robot's model in this process"):
        resolve(Config(method="direct_finetuning", models=models, out=tmp_path / "run"))


def test_the_model_in_the_box_can_be_finetuned(tmp_path: Path) -> None:
    config = Config(method="direct_finetuning", models=Models(robot="smol"), out=tmp_path / "run")
    assert tuned_model(resolve(config)) == "smol"


def answered(robot: RobotHour) -> bool:
    """Whether the finetuned model said something, be it of use or not: a tiny one of random weights says anything."""
    return len(robot.intentions) == 1 or any("the finetuned model's reply" in one for one in robot.fallbacks)


@pytest.mark.slow
def test_the_robots_own_model_is_asked_after_its_first_evening(tmp_path: Path) -> None:
    base = random_llama(tmp_path / "llama")
    recipe = make_recipe(tmp_path / "recipe.yaml", base, learning_rate=0.02, epochs=5)
    config = Config(
        method="direct_finetuning",
        models=Models(robot=f"huggingface:{base}"),
        classifier_config=recipe,
        days=2,
        hours=2,
        pictures="none",
        out=tmp_path / "run",
        data_dir=tmp_path / "data",
    )
    run_study(config)
    run = RunDir.open(tmp_path / "run")
    first, later = ([hour.robot for hour in run.read_day(day) if hour.robot] for day in (0, 1))
    assert [robot.intentions for robot in first] == [[], []]
    assert not any(answered(robot) for robot in first)
    assert all(answered(robot) for robot in later)
    evening = run.read_evening(0)
    assert evening is not None
    assert evening.learned["lessons"] == 2
    assert (tmp_path / "run/adapters/day-00/robot/adapter_model.safetensors").is_file()
