"""One conformance test over all methods: whatever a method leaves out, its days keep to the same rules."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera.core.hour import DayPlan, HourRecord
from coopera.core.household import SceneId
from coopera.evaluation import METHODS
from coopera.graphs import build_study_graph
from tests.fakes import MARA, ScriptedAsk, type2_answers
from tests.graphs.conftest import MakeServices

HELPING = [name for name, method in METHODS.items() if method.robot and not method.knows]
SCHEDULE = [
    DayPlan(day=day, episode_day=day, person=MARA.id, scene=SceneId("toy"), hours=[9, 10], collab=2) for day in (0, 1)
]


def live(make_services: MakeServices, method: str, folder: Path) -> tuple[list[HourRecord], ScriptedAsk]:
    ask = ScriptedAsk(type2_answers())
    services = make_services(ask=ask, method=method, folder=folder)
    build_study_graph().invoke({"schedule": SCHEDULE}, context=services)
    return [hour for day in (0, 1) for hour in services.recorder.read_day(day)], ask


@pytest.mark.parametrize("method", HELPING)
def test_a_method_keeps_to_the_rules(make_services: MakeServices, tmp_path: Path, method: str) -> None:
    hours, _ = live(make_services, method, tmp_path / "one")
    assert len(hours) == 4
    for hour in hours:
        assert hour.status == "ok"
        assert hour.robot is not None
        assert hour.success is not None
        assert hour.success.help is not None
        accepted = [task for task in hour.robot.tasks if task.accepted]
        assert all(task.accepted is not None and task.correct is not None for task in hour.robot.tasks)
        assert all(task.probability is not None and 0 <= task.probability <= 1 for task in hour.robot.tasks)
        assert {task.intention for task in hour.robot.tasks} <= {c.text for c in hour.robot.intentions if c.accepted}
        assert len({task.act.describe() for task in hour.robot.tasks}) == len(hour.robot.tasks)
        assert [o.act.describe() for o in hour.robot.outcomes] == [t.act.describe() for t in accepted]
    again, _ = live(make_services, method, tmp_path / "two")
    assert again == hours


def test_an_oracle_imagines_tasks_for_the_truth_and_for_nothing_else(
    make_services: MakeServices, tmp_path: Path
) -> None:
    hours, ask = live(make_services, "oracle", tmp_path)
    assert {v["intention"] for v in ask.variables_of("robot/tasks_type2")} == {"Cook a meal"}
    assert all(hour.robot and [c.text for c in hour.robot.intentions] == ["Cook a meal"] for hour in hours)


def test_a_robot_without_intentions_is_told_to_go_on_from_what_it_saw(
    make_services: MakeServices, tmp_path: Path
) -> None:
    for method in ("intention_agnostic", "ours"):
        _, ask = live(make_services, method, tmp_path / method)
        asked = ask.variables_of("robot/tasks_type2")
        assert {v["direct"] for v in asked} == {method == "intention_agnostic"}
        assert all((v["seen"] == v["intention"]) is v["direct"] for v in asked)


def test_direct_prompting_proposes_one_intention(make_services: MakeServices, tmp_path: Path) -> None:
    hours, _ = live(make_services, "direct_prompting", tmp_path)
    assert {len(hour.robot.intentions) for hour in hours if hour.robot} == {1}


def test_what_is_told_in_the_evening_is_tomorrows_habit(make_services: MakeServices, tmp_path: Path) -> None:
    for method in ("frequency_prior", "direct_finetuning"):
        hours, _ = live(make_services, method, tmp_path / method)
        first, later = [h.robot.tasks for h in hours[:2] if h.robot], [h.robot.tasks for h in hours[2:] if h.robot]
        assert first == [[], []]
        assert [[task.act.describe() for task in tasks] for tasks in later] == [
            ["bring the ladle", "bring the whisk", "bring the fork", "bring the spatula"]
        ] * 2


def test_rejecting_everything_does_nothing_in_the_home(make_services: MakeServices, tmp_path: Path) -> None:
    hours, _ = live(make_services, "always_no", tmp_path)
    assert all(hour.robot and hour.robot.tasks and not hour.robot.outcomes for hour in hours)
