from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from coopera.core.people import PersonId
from coopera.models.recorded import Past
from coopera.rundir.lives import read_recorded


def test_a_recorded_person_may_have_kept_a_diary(tmp_path: Path) -> None:
    path = tmp_path / "amara.csv"
    path.write_text("day,start,end,activity\n0,09:00,11:00,Bake\n")
    recorded = read_recorded([path], [PersonId("amara")])
    assert [(hour.hour, hour.intention) for hour in recorded[PersonId("amara")]] == [(9, "Bake"), (10, "Bake")]


def trace(run: Path, name: str, *calls: tuple[str, bool]) -> None:
    """A file of a trace: the prompts that were asked, and whether late."""
    told: dict[str, Any] = {"prompt_sha": "0", "model": "m", "messages": [{"content": ""}], "reply": ""}
    asked = [{"node": "n", "prompt": prompt, "late": late, **told} for prompt, late in calls]
    path = run / "trace" / "day-00" / f"{name}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"person": "amara", "episode_day": 0, "calls": asked}))


def test_a_judge_that_a_broken_off_run_had_not_asked_yet_is_not_asked_in_the_hour(tmp_path: Path) -> None:
    trace(tmp_path, "hour-09", ("human/intention", False))
    past = Past(tmp_path)
    assert past.was_instant("human")
    assert not past.was_instant("judge")
    trace(tmp_path, "evening", ("judge/tasks", False))
    assert not Past(tmp_path).was_instant("judge"), "what stands in an evening was asked in the evening"
    trace(tmp_path, "hour-10", ("judge/tasks", True))
    assert not Past(tmp_path).was_instant("judge")
    trace(tmp_path, "hour-11", ("judge/tasks", False))
    assert Past(tmp_path).was_instant("judge")
