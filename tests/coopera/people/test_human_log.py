from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.errors import ConfigError
from coopera.core.hour import LoggedHour
from coopera.people.log_file import read_log

HEADER = "day,hour,intention,tasks\n"


def log(tmp_path: Path, text: str, name: str = "mara.csv") -> Path:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def test_a_csv_log_is_read_in_order_of_time(tmp_path: Path) -> None:
    path = log(tmp_path, HEADER + '0,10,"Cook, slowly",chop onions; stir the pot\n\n0,9,Rest,\n')
    assert read_log(path) == [
        LoggedHour(day=0, hour=9, intention="Rest"),
        LoggedHour(day=0, hour=10, intention="Cook, slowly", tasks=["chop onions", "stir the pot"]),
    ]


def test_a_csv_log_needs_no_tasks(tmp_path: Path) -> None:
    assert read_log(log(tmp_path, "hour,Day,intention\n9,2,Rest\n")) == [LoggedHour(day=2, hour=9, intention="Rest")]


def test_a_jsonl_log_is_the_same_log(tmp_path: Path) -> None:
    row = {"day": 0, "hour": 9, "intention": "Rest", "tasks": ["lie down"]}
    path = log(tmp_path, json.dumps(row) + "\n\n", "mara.jsonl")
    assert read_log(path) == [LoggedHour(day=0, hour=9, intention="Rest", tasks=["lie down"])]


@pytest.mark.parametrize(
    ("text", "name", "said"),
    [
        ("", "a.csv", "column day is missing"),
        ("day,hour\n0,9\n", "a.csv", "column intention is missing"),
        (HEADER, "a.csv", "holds no hour"),
        (HEADER + "0,9,Rest\n", "a.csv", "line 2: expected 4 cells"),
        (HEADER + "0,nine,Rest,\n", "a.csv", "line 2: hour must be a whole number from 0 to 23, not 'nine'"),
        (HEADER + "0,24,Rest,\n", "a.csv", "hour must be a whole number from 0 to 23"),
        (HEADER + "-1,9,Rest,\n", "a.csv", "day must be a whole number from 0 up"),
        (HEADER + "0,9,,\n", "a.csv", "intention must be a text"),
        (HEADER + "0,9,Rest,\n0,9,Cook,\n", "a.csv", "line 3: day 0, hour 9 stands already in line 2"),
        ("day,hour,intention,mood\n0,9,Rest,good\n", "a.csv", "no field 'mood'"),
        (HEADER + '0,9,"Rest,\n', "a.csv", "not valid CSV"),
        ("{\n", "a.jsonl", "line 1: this is not valid JSON"),
        ("[1]\n", "a.jsonl", "expected an object"),
        ('{"day": 0, "hour": 9}\n', "a.jsonl", "field intention is missing"),
        ('{"day": 0, "hour": 9, "intention": "Rest", "tasks": [""]}\n', "a.jsonl", "tasks must be at most 8 texts"),
    ],
)
def test_a_wrong_log_is_refused_in_one_sentence(tmp_path: Path, text: str, name: str, said: str) -> None:
    path = log(tmp_path, text, name)
    with pytest.raises(ConfigError) as err:
        read_log(path)
    assert said in str(err.value)
    assert str(err.value).startswith(str(path))
    assert "\n" not in str(err.value)


def test_a_log_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no such log"):
        read_log(tmp_path / "nobody.csv")


@given(text=st.text(max_size=200), kind=st.sampled_from(["csv", "jsonl"]))
def test_any_text_is_a_log_or_is_refused(tmp_path_factory: pytest.TempPathFactory, text: str, kind: str) -> None:
    path = tmp_path_factory.getbasetemp() / f"any.{kind}"
    path.write_bytes(text.encode("utf-8", "replace"))
    try:
        hours = read_log(path)
    except ConfigError:
        return
    assert hours == sorted(hours, key=lambda hour: (hour.day, hour.hour))
