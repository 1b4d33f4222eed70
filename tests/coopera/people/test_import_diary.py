"""Published diaries: HOMER schedules and days of the American Time Use Survey."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from coopera.core.errors import ConfigError
from coopera.people.diary import Episode
from coopera.people.homer import plain
from coopera.people.import_diary import read_published, recognise, store, summary
from coopera.people.log_file import open_log
from coopera.people.published import words
from tests.coopera.people.survey import ACT_HEADER, ANN, BEN, DAYS, activities, write_survey

HOMER = Path(__file__).parent / "homer_plus_sample.json"


def said(episodes: list[Episode]) -> list[tuple[int, int, int, str, bool]]:
    return [(one.day, one.start, one.end, one.activity, one.away) for one in episodes]


def homer(tmp_path: Path, data: Any) -> Path:
    path = tmp_path / "days.json"
    path.write_text(json.dumps(data))
    return path


def survey(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "atusact_2099.dat"
    path.write_text(text)
    return path


def test_a_sample_of_homer_plus_is_a_diary_for_each_person() -> None:
    people, notes = read_published(HOMER)
    assert [(one.who, one.name) for one in people] == [("A/train", "a-train"), ("B/train", "b-train")]
    first = said(people[0].episodes)
    assert first[0] == (0, 360, 370, "Wake up", False)
    assert first[7] == (0, 528, 550, "Wash the dishes after breakfast", False)
    assert first[20] == (0, 1264, 1504, "Sleep", False)
    assert {day for day, *_ in first} == {0, 1}
    assert notes == []


def test_from_leaving_home_to_coming_back_a_person_is_away() -> None:
    (person,) = read_published(HOMER, who="B/train").people
    out = [one for one in said(person.episodes) if one[4]]
    assert out == [(0, 559, 1039, "Be out of the home", True)]


def test_who_leaves_home_and_does_not_come_back_is_away_until_midnight(tmp_path: Path) -> None:
    path = homer(tmp_path, {"A/train/004": {"schedule": [["leave_home", 1200, 1205]]}})
    assert said(read_published(path).people[0].episodes)[1] == (4, 1205, 1440, "Be out of the home", True)


def test_an_activity_without_words_is_read_as_it_stands_and_named(tmp_path: Path) -> None:
    assert plain("water_the_plants") == "Water the plants"
    path = homer(tmp_path, {"A/train/000": {"schedule": [["water_the_plants", 600, 620], ["reading", 620, 640]]}})
    people, notes = read_published(path)
    assert [one.activity for one in people[0].episodes] == ["Water the plants", "Read"]
    assert notes == ["Without words of their own, read as they stand: Water the plants (1)."]


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        ({}, "there is no day in this file"),
        ([], "expected an object of days"),
        ({"A/train/000": []}, "A/train/000: expected an object of days"),
        ({"A/train/000": {"schedule": []}}, "with at least one activity"),
        ({"A/train/000": {"schedule": [["lunch", 700]]}}, "row 1: expected an activity, its start and its end"),
        ({"A/train/000": {"schedule": [["lunch", 700, 690]]}}, "row 1: lunch ends at 690, and starts at 700"),
        (
            {"A/train/000": {"schedule": [["lunch", 700, 9999]]}},
            "must be minutes of the day, from 0 to 2880, not '9999'",
        ),
        ({"A/train/000": {"schedule": [["lunch", "noon", 780]]}}, "must be minutes of the day"),
        (
            {"A/train/000": {"schedule": [["lunch", 700, 730], ["nap", 720, 800]]}},
            "row 2: nap begins at 720, before lunch",
        ),
        ({"A/train/000": {"schedule": [["", 700, 730]]}}, "an activity must be a text"),
        ({"train": {"schedule": [["lunch", 700, 730]]}}, "'train' must be a person and the number of a day"),
        ({"A/0": {"schedule": [["nap", 1, 2]]}, "A/00": {"schedule": [["nap", 1, 2]]}}, "day 0 of A is there twice"),
    ],
)
def test_schedules_of_another_shape_are_refused_in_one_sentence(tmp_path: Path, data: Any, sentence: str) -> None:
    path = homer(tmp_path, data)
    with pytest.raises(ConfigError) as err:
        read_published(path, "homer")
    assert sentence in str(err.value)
    assert str(err.value).startswith(str(path))
    assert "\n" not in str(err.value)


def test_a_respondents_day_is_a_diary_with_its_weekday_age_and_places(tmp_path: Path) -> None:
    people, notes = read_published(write_survey(tmp_path))
    ann, ben = people
    assert (ann.who, ann.about, ben.about) == (ANN, "Sunday, aged 41", "Wednesday, aged 67")
    assert said(ann.episodes) == [
        (6, 240, 390, "Sleep", False),
        (6, 390, 420, "Wash, dress and groom", False),
        (6, 420, 450, "Eat and drink", False),
        (6, 450, 480, "Travel for work", True),
        (6, 480, 720, "Work at my job", True),
        (6, 720, 750, "Eat and drink", True),
        (6, 750, 1020, "Work at my job", True),
        (6, 1020, 1050, "Travel for work", True),
        (6, 1050, 1095, "Prepare food and drinks", False),
        (6, 1095, 1125, "Eat and drink", False),
        (6, 1140, 1320, "Watch television or a film", False),
        (6, 1320, 1470, "Do sports and exercise", False),
        (6, 1470, 1680, "Sleep", False),
    ]
    assert said(ben.episodes) == [(2, 240, 540, "Sleep", False), (2, 540, 1680, "Work at my job", False)]
    assert notes == [
        "Codes without words of their own, said by their major category: 130136 (1).",
        "Codes of activities that are not known, left open: 500106 (1).",
    ]


def test_one_respondent_or_the_first_so_many_can_be_taken(tmp_path: Path) -> None:
    path = write_survey(tmp_path)
    assert [one.who for one in read_published(path, who=BEN).people] == [BEN]
    assert [one.who for one in read_published(path, limit=1).people] == [ANN]
    with pytest.raises(ConfigError, match=f"has no '7' .it begins with {ANN}"):
        read_published(path, who="7")


def test_a_survey_without_its_respondent_file_says_that_the_weekday_is_not_known(tmp_path: Path) -> None:
    people, notes = read_published(survey(tmp_path, activities()))
    assert {episode.day for one in people for episode in one.episodes} == {0}
    assert {one.about for one in people} == {""}
    assert notes[-1] == "The weekday of 2 is in no atusresp file beside this one, so their day is 0."


@pytest.mark.parametrize("codes", ["TRCODE", "TUTIER1CODE,TUTIER2CODE,TUTIER3CODE"])
def test_codes_are_read_from_other_columns_too_and_without_their_first_zero(tmp_path: Path, codes: str) -> None:
    code = "10101" if codes == "TRCODE" else "1,1,1"
    text = f"TUCASEID,{codes},TEWHERE,TUSTARTTIM,TUSTOPTIME\n7,{code},-1,04:00:00,04:00:00\n"
    (person,) = read_published(survey(tmp_path, text)).people
    assert said(person.episodes) == [(0, 240, 1680, "Sleep", False)]


@pytest.mark.parametrize(
    ("code", "place", "away"),
    [("050101", 1, False), ("050101", -1, True), ("120303", 3, True), ("010101", -1, False), ("180501", -1, True)],
)
def test_the_place_travel_and_work_say_who_is_away(tmp_path: Path, code: str, place: int, away: bool) -> None:
    path = survey(tmp_path, activities(("7", [("04:00:00", "04:00:00", code, place)])))
    assert [one.away for one in read_published(path).people[0].episodes] == [away]


def test_a_day_of_which_nothing_is_known_is_not_written(tmp_path: Path) -> None:
    path = survey(tmp_path, activities(("7", [("04:00:00", "04:00:00", "500106", -1)])))
    people, notes = read_published(path)
    assert people == []
    assert "Nothing is known of the day of 7, so nothing is written." in notes


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("TUCASEID,TUSTARTTIM\n", "line 1: the column TUSTOPTIME is missing; the header begins with TUCASEID"),
        ("TUCASEID,TUSTARTTIM,TUSTOPTIME,TEWHERE\n", "the column TRCODEP is missing"),
        (ACT_HEADER + "\n", "the file has a header and no activity"),
        (ACT_HEADER + "\n7,1\n", "line 2: expected 13 cells, found 2"),
        (activities(("7", [("4 am", "05:00:00", "010101", 1)])), "line 2: TUSTARTTIM must be a time such as 04:00:00"),
        (activities(("7", [("04:00:00", "05:00:00", "sleep", 1)])), "TRCODEP must be an activity code such as 110101"),
        (
            activities(("7", [("04:00:00", "05:00:00", "010101", 1), ("04:30:00", "05:00:00", "010101", 1)])),
            "line 3: TUSTARTTIM is 04:30, before the activity before has ended",
        ),
        (
            activities(("7", [("05:00:00", "04:30:00", "010101", 1), ("06:00:00", "07:00:00", "010101", 1)])),
            "line 2: TUSTOPTIME is 04:30, and only the last activity may end after 4 am",
        ),
        (activities(*DAYS.items(), (ANN, DAYS[ANN])), f"the respondent {ANN} has stood before"),
        (activities(("../x", DAYS[BEN])), "line 2: TUCASEID must be a number"),
    ],
)
def test_a_survey_file_that_cannot_be_used_is_refused_in_one_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    path = survey(tmp_path, text)
    with pytest.raises(ConfigError) as err:
        read_published(path, "atus")
    assert sentence in str(err.value)
    assert str(err.value).startswith(str(path))
    assert "\n" not in str(err.value)


def test_a_weekday_that_is_none_is_refused(tmp_path: Path) -> None:
    path = write_survey(tmp_path)
    (tmp_path / "atusresp_2099.dat").write_text(f"TUCASEID,TUDIARYDAY\n{ANN},8\n")
    with pytest.raises(ConfigError, match=r"atusresp_2099.dat, line 2: TUDIARYDAY must be from 1 \(Sunday\)"):
        read_published(path)


def test_a_file_is_told_by_its_content(tmp_path: Path) -> None:
    assert recognise(HOMER) == "homer"
    assert recognise(write_survey(tmp_path)) == "atus"
    for text, sentence in (
        ("", "the file is empty"),
        ("a,b\n1,2\n", "this is neither HOMER schedules"),
        ("day,start,end,activity\n", "this is a diary or log already; live it with coopera run --played-by log:"),
    ):
        (tmp_path / "x.csv").write_text(text)
        with pytest.raises(ConfigError, match=sentence):
            recognise(tmp_path / "x.csv")
    with pytest.raises(ConfigError, match="no such file"):
        recognise(tmp_path / "missing.dat")


def test_what_is_written_is_the_diary_that_was_read(tmp_path: Path) -> None:
    people = read_published(HOMER).people
    stored = store(people, tmp_path / "diaries")
    assert [path.name for path in stored.written] == ["a-train.csv", "b-train.csv"]
    assert summary(people[1], tmp_path)["away"] == sum(
        hour.away for hour in open_log(stored.written[1]).hours if 9 <= hour.hour <= 21
    )
    stored.written[0].write_text("mine")
    again = store(people, tmp_path / "diaries")
    assert (again.written, len(again.kept)) == ([], 2)
    assert stored.written[0].read_text() == "mine"
    store(people, tmp_path / "diaries", force=True)
    assert open_log(stored.written[0]).diary


def test_two_people_of_one_file_name_are_refused_before_anything_is_written(tmp_path: Path) -> None:
    day = {"schedule": [["lunch", 700, 730]]}
    people = read_published(homer(tmp_path, {"A/x/0": day, "a-x/0": day})).people
    with pytest.raises(ConfigError, match=r"A/x and a-x would both be a-x\.csv"):
        store(people, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_every_code_of_the_survey_has_words_or_a_major_category() -> None:
    table = words("atus")
    assert len(table["activities"]) >= 60
    assert {code[:2] for code in table["activities"]} <= set(table["major"])
    assert all(1 <= len(text) <= 80 for text in (*table["activities"].values(), *table["major"].values()))
