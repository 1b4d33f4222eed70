from __future__ import annotations

from pathlib import Path

import pytest

from coopera.config.schema import Config
from coopera.core.clock import Clock
from coopera.core.errors import ConfigError
from coopera.core.hour import DayPlan
from coopera.core.household import SceneId
from coopera.core.people import PersonId
from coopera.people.real import open_logs

SHIPPED = Path(__file__).parents[3] / "examples" / "my_week.csv"


def plans(*people: str, hours: int = 2) -> list[DayPlan]:
    """One day each, in turn, in one episode."""
    nine = [9 + n for n in range(hours)]
    return [
        DayPlan(day=d, episode_day=d, person=PersonId(who), scene=SceneId("maple"), hours=nine)
        for d, who in enumerate(people)
    ]


def write(path: Path, *rows: str) -> Path:
    path.write_text("\n".join(["day,hour,intention", *rows]))
    return path


def test_the_shipped_example_fills_two_days_of_five_hours() -> None:
    days = plans("joan", "joan", hours=5)
    logs = open_logs(Config(played_by=f"log:{SHIPPED}"), days)
    assert logs is not None
    lived = [logs(plan, Clock(day=plan.episode_day, hour=hour)) for plan in days for hour in plan.hours]
    assert [hour.intention for hour in lived if hour][0] == "Have a slow breakfast with the radio on"
    assert sum(bool(hour and hour.tasks) for hour in lived) == 5


def test_recorded_days_are_lived_in_their_order_by_each_person(tmp_path: Path) -> None:
    write(tmp_path / "amara.csv", "3,9,Bake", "7,9,Rest")
    write(tmp_path / "joan.csv", "0,9,Knit")
    days = plans("amara", "joan", "amara", hours=1)
    logs = open_logs(Config(played_by=f"log:{tmp_path}"), days)
    assert logs is not None
    said = [logs(plan, Clock(day=plan.episode_day, hour=9)) for plan in days]
    assert [hour.intention for hour in said if hour] == ["Bake", "Knit", "Rest"]


def test_a_simulated_person_has_no_log() -> None:
    assert open_logs(Config(), plans("joan")) is None


@pytest.mark.parametrize(
    ("rows", "people", "sentence"),
    [
        (["0,9,Rest"], ["joan"], "day 0 has no hour 10 (10 am); the run lives 9 am to 10 am"),
        (["0,9,Rest", "0,10,Read"], ["joan", "joan"], "the log has 1 days, and joan is to live more; use --days 1"),
        (["0,9,Rest", "0,9,Read"], ["joan"], "day 0, hour 9 stands already in line 2"),
        (["0,9,Rest"], ["joan", "gus"], "is the log of one person, and 2 take part (joan, gus)"),
    ],
)
def test_a_log_that_does_not_fit_the_run_is_one_sentence(
    tmp_path: Path, rows: list[str], people: list[str], sentence: str
) -> None:
    path = write(tmp_path / "log.csv", *rows)
    with pytest.raises(ConfigError) as err:
        open_logs(Config(played_by=f"log:{path}"), plans(*people))
    assert sentence in str(err.value)
    assert "\n" not in str(err.value)


def test_a_folder_without_somebodys_log_is_said(tmp_path: Path) -> None:
    write(tmp_path / "amara.csv", "0,9,Bake")
    with pytest.raises(ConfigError, match=r"gus\.csv or \.jsonl is missing"):
        open_logs(Config(played_by=f"log:{tmp_path}"), plans("amara", "gus", hours=1))
