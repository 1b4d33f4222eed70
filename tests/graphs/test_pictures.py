from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from coopera.core.hour import HourRecord
from tests.fakes import FakeHome, FolderRecorder, ScriptedAsk, type2_answers
from tests.graphs.conftest import MakeServices
from tests.graphs.test_day import run_study


def test_an_hour_that_stands_has_all_its_pictures(make_services: MakeServices, tmp_path: Path) -> None:
    home, missing = FakeHome(), []

    class Counting(FolderRecorder):
        def write_hour(self, record: HourRecord) -> None:
            missing.append(len(home.late))
            super().write_hour(record)

    services = make_services(home=home, frames=2, help_frames=1)
    run_study(replace(services, recorder=Counting(tmp_path)), n=1)
    assert missing == [0, 0, 0]
    assert len(list(tmp_path.glob("frames/*/*/*.webp"))) > 12


@pytest.mark.parametrize("looks", [True, False])
def test_a_robot_that_looks_at_pictures_has_them_before_it_thinks(make_services: MakeServices, looks: bool) -> None:
    home, late = FakeHome(), []
    answers = type2_answers()
    tasks = answers["robot/tasks_type2"]
    answers["robot/tasks_type2"] = lambda v: (late.append(len(home.late)), tasks(v))[1]
    ask = ScriptedAsk(answers)
    ask.seeing = {"robot"} if looks else set()
    run_study(make_services(home=home, ask=ask, frames=2), n=1)
    assert set(late) == {0 if looks else 4}
