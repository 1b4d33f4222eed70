"""Diaries with times: how they are read, and which hours they become."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.clock import Clock
from coopera.core.errors import ConfigError
from coopera.core.hour import LoggedHour
from coopera.people.diary import Episode, as_csv, hours_of, overlap, read_episodes
from coopera.people.log_file import open_log, read_log
from coopera.people.real import open_logs
from coopera.people.rows import read_rows
from tests.coopera.people.test_real_people import Config, plans

HEADER = "day,start,end,activity\n"


def diary(tmp_path: Path, text: str, name: str = "mara.csv") -> Path:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def hours(*episodes: str) -> list[str]:
    """The hours of episodes such as "09:30-12:10 Work", as "9 Work" or "10 Work …" where it goes on."""
    made = []
    for text in episodes:
        times, activity = text.split(" ", 1)
        start, end = times.split("-")
        made.append(Episode(day=0, start=start, end=end, activity=activity))
    return [f"{hour.hour} {hour.intention}{' …' if hour.continues else ''}" for hour in hours_of(made)]


def test_a_diary_is_told_by_its_header_and_becomes_hours(tmp_path: Path) -> None:
    path = diary(
        tmp_path,
        "day,start,end,activity,tasks,away\n0,09:00,11:00,Cook,chop onions; stir the pot,\n"
        "0,11:00,12:00,Shop,,yes\n1,09:00,10:00,Rest,,no\n",
    )
    log = open_log(path)
    assert log.diary
    assert log.hours == [
        LoggedHour(day=0, hour=9, intention="Cook", tasks=["chop onions", "stir the pot"]),
        LoggedHour(day=0, hour=10, intention="Cook", tasks=["chop onions", "stir the pot"], continues=True),
        LoggedHour(day=0, hour=11, intention="Shop", away=True),
        LoggedHour(day=1, hour=9, intention="Rest"),
    ]


def test_minutes_of_the_day_and_jsonl_say_the_same(tmp_path: Path) -> None:
    clock = read_log(diary(tmp_path, HEADER + "0,09:30,11:00,Cook\n"))
    assert clock == read_log(diary(tmp_path, HEADER + "0,570,660,Cook\n"))
    row = {"day": 0, "start": 570, "end": "11:00", "activity": "Cook", "away": False}
    assert clock == read_log(diary(tmp_path, json.dumps(row) + "\n", "mara.jsonl"))


def test_an_hour_by_hour_log_may_say_away_and_continues(tmp_path: Path) -> None:
    path = diary(tmp_path, "day,hour,intention,away,continues\n0,9,Shop,Yes,\n0,10,Shop,yes,yes\n")
    assert [(hour.away, hour.continues) for hour in read_log(path)] == [(True, False), (True, True)]
    assert not open_log(path).diary


def test_a_short_event_does_not_vanish_behind_a_long_one() -> None:
    assert hours("08:00-09:00 Wash", "09:00-12:20 Work", "12:20-12:45 Eat lunch", "12:45-15:00 Work") == [
        "8 Wash",
        "9 Work",
        "10 Work …",
        "11 Work …",
        "12 Eat lunch",
        "13 Work",
        "14 Work …",
    ]


def test_what_reaches_another_hour_waits_for_it() -> None:
    assert hours("08:05-08:50 Have breakfast", "08:50-09:15 Wash up", "09:15-11:00 Read") == [
        "8 Have breakfast",
        "9 Wash up",
        "10 Read",
    ]


def test_the_longer_of_two_that_end_within_the_hour_is_its_intention_and_of_equals_the_earlier() -> None:
    assert hours("08:00-08:15 Eat", "08:15-08:45 Knit", "08:45-09:00 Rest") == ["8 Knit"]
    assert hours("08:00-08:30 Eat", "08:30-09:00 Knit") == ["8 Eat"]


def test_less_than_ten_minutes_make_no_hour_except_where_there_is_nothing_else() -> None:
    assert hours("09:00-09:03 Brush my teeth") == ["9 Brush my teeth"]
    assert hours("09:00-09:03 Brush my teeth", "09:30-09:40 Read") == ["9 Read"]
    assert hours("09:58-10:50 Cook", "12:00-13:09 Rest") == ["10 Cook", "12 Rest"]
    assert hours("09:56-10:05 Call") == ["9 Call"]


def test_an_episode_past_midnight_goes_on_in_the_next_day_if_that_has_a_row(tmp_path: Path) -> None:
    night = "0,21:00,06:30,Sleep\n"
    assert {hour.day for hour in read_log(diary(tmp_path, HEADER + night))} == {0}
    found = read_log(diary(tmp_path, HEADER + night + "1,06:30,07:30,Wash\n"))
    assert [(h.day, h.hour, h.intention, h.continues) for h in found][:5] == [
        (0, 21, "Sleep", False),
        (0, 22, "Sleep", True),
        (0, 23, "Sleep", True),
        (1, 0, "Sleep", True),
        (1, 1, "Sleep", True),
    ]
    assert [(h.hour, h.intention) for h in found][-2:] == [(6, "Wash"), (7, "Wash")]
    assert read_log(diary(tmp_path, HEADER + "0,21:00,30:30,Sleep\n")) == read_log(diary(tmp_path, HEADER + night))


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("", "the diary holds no episode"),
        (
            "0,09:00,10:00,Cook\n0,09:30,09:45,Eat\n",
            'line 3: day 0, "Eat" from 09:30 to 09:45 overlaps with day 0, "Cook"',
        ),
        ("0,22:00,06:00,Sleep\n1,05:00,07:00,Run\n", "overlaps with day 0"),
        ("0,09:00,10:00,Cook\n0,09:00,10:00,Cook\n", "in line 2; a person does one thing at a time"),
        ("0,10:00,09:30,Cook\n", 'line 2: "Cook" from 10:00 to 09:30 ends before it starts; past midnight'),
        ("0,600,570,Cook\n", "ends before it starts"),
        ("0,09:00,09:00,Cook\n", "ends before it starts"),
        ("0,25:30,25:00,Cook\n", "ends before it starts"),
        ("0,09:60,10:00,Cook\n", "line 2: start must be a time such as 09:30 or 25:30, or minutes of the day"),
        ("0,09:00,49:00,Cook\n", "end must be a time"),
        ("0,0930,1000,Cook\n", "start must be a time"),
        ("0,9.5,10,Cook\n", "start must be a time"),
        ("-1,09:00,10:00,Cook\n", "day must be a whole number from 0 up, not '-1'"),
        ("0,09:00,10:00,\n", "activity must be a text of 1 to 300 characters"),
        ("0,09:00,10:00\n", "expected 4 cells"),
        ("0,24:30,25:30,Cook\n", "every episode of the diary is after midnight"),
    ],
)
def test_a_wrong_diary_is_refused_in_one_sentence(tmp_path: Path, rows: str, said: str) -> None:
    path = diary(tmp_path, HEADER + rows)
    with pytest.raises(ConfigError) as err:
        read_log(path)
    assert said in str(err.value)
    assert str(err.value).startswith(str(path))
    assert "\n" not in str(err.value)


@pytest.mark.parametrize(
    ("text", "name", "said"),
    [
        ("day,start,activity\n0,09:00,Cook\n", "a.csv", "line 1: the column end is missing; the header has day, start"),
        ("day,start,end,activity,mood\n0,540,600,Cook,good\n", "a.csv", "no field 'mood' (a diary has day, start"),
        ("day,hour,intention,start\n0,9,Cook,540\n", "a.csv", "no field 'start'"),
        ("day,start,end,activity,away\n0,540,600,Cook,perhaps\n", "a.csv", "away must be yes or no, not 'perhaps'"),
        ('{"day": 0, "start": 540, "activity": "Cook"}\n', "a.jsonl", "line 1: the field end is missing"),
        ('{"day": 0, "start": true, "end": 600, "activity": "Cook"}\n', "a.jsonl", "start must be a time"),
    ],
)
def test_a_wrong_header_or_value_is_refused_in_one_sentence(tmp_path: Path, text: str, name: str, said: str) -> None:
    with pytest.raises(ConfigError, match=".") as err:
        read_log(diary(tmp_path, text, name))
    assert said in str(err.value)


def test_a_file_that_is_too_large_is_refused(tmp_path: Path) -> None:
    path = diary(tmp_path, HEADER)
    os.truncate(path, 65 * 2**20)
    with pytest.raises(ConfigError, match="has more than 64 MiB"):
        read_log(path)


def test_an_hour_that_a_diary_leaves_open_is_left_to_the_model(tmp_path: Path) -> None:
    path = diary(tmp_path, HEADER + "3,09:00,10:00,Cook\n")
    days = plans("joan", hours=2)
    logs = open_logs(Config(played_by=f"log:{path}"), days)
    assert logs is not None
    assert logs(days[0], Clock(day=0, hour=10)) is None
    found = logs(days[0], Clock(day=0, hour=9))
    assert found is not None
    assert found.intention == "Cook"


def test_a_day_without_any_of_the_hours_that_are_lived_is_refused(tmp_path: Path) -> None:
    path = diary(tmp_path, HEADER + "0,22:00,06:00,Sleep\n")
    with pytest.raises(
        ConfigError, match="day 0 of the diary says nothing of the hours that the run lives, 9 am to 10 am"
    ):
        open_logs(Config(played_by=f"log:{path}"), plans("joan", hours=2))


EPISODES = st.lists(st.tuples(st.integers(0, 90), st.integers(1, 400), st.booleans()), max_size=30)


@given(EPISODES)
def test_any_diary_reads_back_and_has_one_intention_an_hour(
    tmp_path_factory: pytest.TempPathFactory, pieces: list[tuple[int, int, bool]]
) -> None:
    """Episodes with gaps between them, one after the other from midnight of day 0, each on the day where it begins."""
    made: list[Episode] = []
    at = 0
    for n, (gap, minutes, away) in enumerate(pieces):
        at += gap
        start = at % 1440
        made.append(Episode(day=at // 1440, start=start, end=start + minutes, activity=f"Do {n}", away=away))
        at += minutes
    assert overlap(made) is None
    path = tmp_path_factory.getbasetemp() / "any_diary.csv"
    path.write_text(as_csv(made))
    if made:
        assert read_episodes(path, read_rows(path, "diary")) == made
    found = hours_of(made)
    assert len({(hour.day, hour.hour) for hour in found}) == len(found)
    by_name = {one.activity: one for one in made}
    for before, hour in zip([None, *found], found, strict=False):
        episode = by_name[hour.intention]
        assert episode.minutes_of(hour.day * 24 + hour.hour) > 0
        assert hour.away == episode.away
        assert hour.continues == (before is not None and before.intention == hour.intention)


@given(text=st.text(max_size=200), kind=st.sampled_from(["csv", "jsonl"]))
def test_any_text_under_a_diarys_header_is_a_diary_or_is_refused(
    tmp_path_factory: pytest.TempPathFactory, text: str, kind: str
) -> None:
    path = tmp_path_factory.getbasetemp() / f"any_text.{kind}"
    path.write_bytes((HEADER * (kind == "csv") + text).encode("utf-8", "replace"))
    try:
        assert read_log(path)
    except ConfigError:
        return


@pytest.mark.parametrize("name", ["a.csv", "a.jsonl"])
def test_a_log_of_more_rows_than_a_life_has_is_refused(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("coopera.people.rows.MOST_ROWS", 2)
    rows = '{"day": 0}\n' * 3 if name.endswith("l") else "day,hour\n" + "0,9\n" * 3
    with pytest.raises(ConfigError, match="at most 2 rows of a log are read"):
        read_log(diary(tmp_path, rows, name))
