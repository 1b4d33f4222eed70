from __future__ import annotations

import csv
import json
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

from coopera.report.budget import budget_of, read_budget
from coopera.rundir.directory import RunDir
from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run

Coopera = Callable[..., Said]


def test_each_missed_task_of_a_run_is_lost_in_one_place(coopera: Coopera, small_run: RunDir) -> None:
    said = coopera("analyse", "robot", small_run.root, "--json", "--out", "found")
    assert said.code == 0, said.err
    total = said.json["total"]["ours"]
    hours = [hour for hour in small_run.hours() if hour.human and hour.robot]
    assert total["hours"] == len(hours)
    assert total["remaining"] == sum(len(hour.human.tasks) - 1 for hour in hours if hour.human)
    assert sum(total["lost"].values()) == total["missed"] == total["remaining"] - total["helped"] > 0
    assert sum(total["false"].values()) == total["useless"]
    assert abs(sum(total["shares"].values()) - 1) < 1e-9
    assert said.json["out"] == "found"


def test_the_files_have_a_row_for_each_day_and_add_up_to_what_is_said(coopera: Coopera, small_run: RunDir) -> None:
    said = coopera("analyse", "robot", small_run.root, "--json", "--out", "found")
    rows = list(csv.DictReader(Path("found/error-budget.csv").read_text().splitlines()))
    assert [(row["person"], row["day"]) for row in rows] == [(who, day) for who in ("amara", "bruno") for day in "01"]
    total = said.json["total"]["ours"]
    for name in ("missed", "useless", "accepted"):
        assert sum(int(row[name]) for row in rows) == total[name]
    for cause, count in total["lost"].items():
        assert sum(int(row[f"lost_{cause}"]) for row in rows) == count
    stored = json.loads(Path("found/error-budget.json").read_text())
    assert stored["total"] == said.json["total"]
    assert stored["by_day"]["ours"].keys() == {"0", "1"}


def test_the_table_says_in_words_where_help_was_lost_and_by_day(coopera: Coopera, small_run: RunDir) -> None:
    said = coopera("analyse", "robot", small_run.root)
    assert said.code == 0, said.err
    for words in ("intention not imagined", "intention imagined, but rejected", "task proposed, but rejected",
                  "the thing was in the person's hand already", "right intention, wrong thing", "By day"):  # fmt: skip
        assert words in said.out
    assert all(len(line.rstrip()) <= 90 for line in said.out.splitlines())


def test_it_says_where_the_measures_differ(coopera: Coopera, small_run: RunDir) -> None:
    said = coopera("analyse", "robot", small_run.root).out
    assert "Where the measures differ" in said
    assert "predicate, people" in said
    found = coopera("analyse", "robot", small_run.root, "--json").json["differences"]["ours"]
    names = ["predicate", "judge", "people"]
    assert [(one["one"], one["other"]) for one in found["pairs"]] == list(combinations(names, 2))
    for one in found["pairs"]:
        assert one["both"] + one["only_one"] + one["only_other"] + one["neither"] <= found["offers"]
    assert sum(one["offers"] for one in found["patterns"]) <= found["offers"]


def test_runs_of_one_method_are_added_up(coopera: Coopera, small_run: RunDir) -> None:
    one = coopera("analyse", "robot", small_run.root, "--json").json["total"]["ours"]
    both = coopera("analyse", "robot", small_run.root, small_run.root, "--json").json["total"]["ours"]
    assert both["missed"] == 2 * one["missed"]
    assert both["shares"] == one["shares"]


def test_a_thing_from_the_magic_box_is_what_it_was_called_by(tmp_path: Path) -> None:
    """In type 1 things are compared by class: "pan_7" came out of the box as a frying pan, "pan_8" as a saucepan."""
    run = fake_run(tmp_path / "run", days=1, hours=1, collab=1, frames=1)
    [hour] = run.hours()
    assert hour.human is not None
    assert hour.robot is not None
    first, second, *_ = hour.human.tasks
    wanted = second.model_copy(update={"act": second.act.model_copy(update={"object": "pan_7"})})
    offered = [
        task.model_copy(update={"accepted": False, "act": wanted.act.model_copy(update={"object": "pan_8"})})
        for task in hour.robot.tasks[:1]
    ]
    human = hour.human.model_copy(update={"tasks": [first, wanted]})
    robot = hour.robot.model_copy(update={"tasks": offered, "outcomes": []})

    def lost(words: str) -> int:
        box = {"pan_7": {"id": 900, "text": "frying pan"}, "pan_8": {"id": 901, "text": words}}
        update = {"human": human, "robot": robot, "world": {"poses": {"box": box}}}
        found = budget_of(run, [hour.model_copy(update=update)], [])
        return found.total.lost["task_rejected"]

    assert (lost("frying pan"), lost("saucepan")) == (1, 0)


def test_a_run_in_which_no_robot_helped_has_nothing_to_analyse(coopera: Coopera, tmp_path: Path) -> None:
    fake_run(tmp_path / "run", lived=False, finished=False)
    said = coopera("analyse", "robot", tmp_path / "run")
    assert said.code == 2
    assert "no robot has helped in any hour of these runs" in said.err
    assert read_budget(RunDir.open(tmp_path / "run")).days == []
    assert coopera("analyse", "robot", tmp_path / "nowhere").code == 2
