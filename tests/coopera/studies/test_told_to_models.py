"""A language model as the robot: what the person told stands in the prompts that reach its server."""

from __future__ import annotations

import json
from pathlib import Path

from coopera import Config, run_study
from coopera.config.schema import Models
from coopera.core.hour import HourRecord, ModelCall
from coopera.rundir.directory import RunDir
from tests.serving import serving

DAYS = {"humans": ["amara"], "days": 2, "hours": 1, "pictures": "none"}


def asked(hour: HourRecord, prompt: str) -> str:
    calls: list[ModelCall] = [call for call in hour.calls if call.prompt == prompt]
    return "\n".join(str(message["content"]) for call in calls for message in call.messages)


def test_the_told_tasks_stand_in_the_task_prompt_that_a_server_gets_and_in_the_papers_they_do_not(
    tmp_path: Path, data_dir: Path
) -> None:
    run_study(Config(**DAYS, method="none", data_dir=data_dir, out=tmp_path / "alone"))
    with RunDir.open(tmp_path / "alone") as run:
        lived = run.read_day(0)[0].human
    assert lived is not None
    with serving("--say", json.dumps({"intention": lived.intention.text, "probability": 0.9})) as url:
        for method, told in (("ours", True), ("paper", False)):
            models = Models(robot="openai:tiny")
            out = tmp_path / method
            run_study(Config(**DAYS, method=method, models=models, base_url=url, data_dir=data_dir, out=out))
            hour = RunDir.open(tmp_path / method).read_day(1)[0]
            said = asked(hour, "robot/tasks_type2")
            assert (f'when they wanted "{lived.intention.text}": ' in said) is told
            assert ("when they wanted something like this, the most alike first" in said) is told
            if told and hour.robot:
                percept = hour.robot.observation.percept
                held = percept.in_hand if percept else None
                others = [task.act for task in lived.tasks if getattr(task.act, "in_hand", "") != held]
                assert all(act.describe() in said for act in others)
                assert hour.robot.intentions[0].evidence["prior"] == 0.9
