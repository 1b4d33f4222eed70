"""Goals asked of the days of a run. Its hours are made by hand, in the flat of the tests, with nothing else faked."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from coopera.config.schema import Config
from coopera.core.errors import RunError
from coopera.core.hour import HourRecord, Observation, RobotHour
from coopera.core.household import Outcome
from coopera.people.shipped import find
from coopera.rundir.directory import RunDir
from coopera.simulation import World
from coopera.simulation.goals.files import parse_goals
from coopera.simulation.homes.scene import dump_scene
from coopera.simulation.state.snapshots import digest
from coopera.studies.goals import After, GoalOfDay, judge_days
from tests.coopera.conftest import Said
from tests.simulation.flat import bring, flat, move, put

# without pictures the robot's acts of an hour come first
DAYS = {
    (0, 9): [("robot", bring("book")), ("human", put("mug_1", "dining_table_1"))],
    (0, 10): [("robot", put("mug_1", "coffee_table_1"))],
    (1, 9): [("robot", put("apple_1", "kitchen_counter_1")), ("human", move("sofa_1", "book", "sit and read"))],
}
GOALS = """
goals:
  served: on(mug, dining table)
  tidied: then(on(mug, dining table), on(mug, coffee table))
  read:
    eventually: performed(human, sit and read)
  cleared: not on(apple, dining table)
  "[/b] in brackets": eventually(on(mug, sofa))
"""


@pytest.fixture
def run(tmp_path: Path) -> RunDir:
    """Two days of a person and a robot, of three hours."""
    data = tmp_path / "data"
    (data / "scenes").mkdir(parents=True)
    (data / "scenes" / "flat.json").write_text(dump_scene(flat()))
    config = Config(humans=["amara"], scenes=["flat"], days=2, out=tmp_path / "run", data_dir=data)
    made = RunDir.create(config, people=[find("amara", data)], prompts={}, models={})
    with made, World(flat()) as world:
        for (day, hour), acts in DAYS.items():
            done = [world.perform(agent, act) for agent, act in acts]
            made.write_hour(record(day, hour, done, world))
    return RunDir.open(tmp_path / "run")


def record(day: int, hour: int, done: list[Outcome], world: World) -> HourRecord:
    left = world.snapshot()
    own = [one.model_dump() for one in done if one.agent == "human"]
    helped = [one for one in done if one.agent == "robot"]
    return HourRecord(
        day=day, episode=0, episode_day=day, hour=hour, person="amara", scene="flat", human=None, success=None,
        robot=RobotHour(observation=Observation(), intentions=[], tasks=[], outcomes=helped), status="ok",
        world={"outcomes": own, "poses": left, "sha256": digest(left), "watched": False},
    )  # fmt: skip


def test_each_day_says_which_goals_it_met_and_after_which_act(run: RunDir) -> None:
    first, second = judge_days(run, parse_goals(GOALS, "goals.yaml"), "goals.yaml")
    assert (first.day, first.person, first.scene, first.differences) == (0, "amara", "flat", [])
    assert {goal.goal: (goal.met, goal.first) for goal in first.goals} == {
        "served": (False, After(9, 2, "human", "put the mug on the dining table")),
        "tidied": (True, After(10, 1, "robot", "put the mug on the coffee table")),
        "read": (False, None),
        "cleared": (False, None),
        "[/b] in brackets": (False, None),
    }
    assert {goal.goal: (goal.met, goal.first and goal.first.act) for goal in second.goals} == {
        "served": (False, None),
        "tidied": (False, None),  # the day before does not count
        "read": (True, 2),
        "cleared": (True, 1),
        "[/b] in brackets": (False, None),
    }


def test_an_hour_that_comes_out_otherwise_is_judged_by_its_end_in_the_trace(run: RunDir) -> None:
    path = next(run.root.glob("trace/day-00/hour-09.json"))
    hour = json.loads(path.read_text())
    hour["world"]["outcomes"][0]["metres"] += 1
    path.write_text(json.dumps(hour))
    first, second = judge_days(RunDir.open(run.root), parse_goals(GOALS, "goals.yaml"), "goals.yaml")
    (difference,) = first.differences
    assert difference.startswith("Day 0, 9:00: act 2 (human: put the mug on the dining table) came out as")
    assert first.goals[0] == GoalOfDay("served", False, After(9))
    assert first.goals[1].met
    assert second.differences == []


def test_the_command_prints_a_table_or_json(run: RunDir, coopera: Callable[..., Said]) -> None:
    Path("goals.yaml").write_text(GOALS)
    said = coopera("analyse", "goals", run.root, "goals.yaml")
    assert said.code == 0, said.err
    assert "10:00, after act 1 (robot: put the mug on the coffee table)" in said.out
    assert "tidied: met on 1 of 2 days" in said.out
    assert said.out.count("[/b] in brackets") == 3
    said = coopera("analyse", "goals", run.root, "goals.yaml", "--json")
    assert said.json["goals"]["read"] == "eventually(performed(human, sit and read))"
    day = said.json["days"][1]
    assert (day["day"], day["goals"]["served"]) == (1, {"met": False, "first": None})
    assert day["goals"]["read"]["first"]["did"].startswith("sit and read at the sofa")


@pytest.mark.parametrize(
    ("goal", "sentence"),
    [
        ("on(mug, dinning table)", "goals.yaml, goals.a: In on(mug, dinning table), there is no furniture"),
        ("performed(sit and raed)", "nobody can perform 'sit and raed' (did you mean sit and read?)"),
        ("holding(ana, mug)", "'ana' is nobody here, the agent being human or robot"),
        ("on(mug)", "goals.yaml, goals.a: on(mug) has 1 words in brackets"),
    ],
)
def test_a_goal_that_means_nothing_in_the_runs_homes_is_refused_before_anything_is_done_again(
    run: RunDir, coopera: Callable[..., Said], goal: str, sentence: str
) -> None:
    Path("goals.yaml").write_text(f'goals: {{a: "{goal}"}}')
    said = coopera("analyse", "goals", run.root, "goals.yaml")
    assert said.code == 2
    assert sentence in said.err


def test_a_run_without_hours_has_no_days_to_judge(tmp_path: Path) -> None:
    config = Config(humans=["amara"], scenes=["maple"], out=tmp_path / "empty")
    with (
        RunDir.create(config, people=[find("amara", config.data_dir)], prompts={}, models={}) as empty,
        pytest.raises(RunError, match="there are no hours yet"),
    ):
        list(judge_days(empty, parse_goals(GOALS, "goals.yaml"), "goals.yaml"))
