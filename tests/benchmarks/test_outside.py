"""The benchmarks on other people's data, on their samples, and on what is not such data."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks import homer, outside, pahf, tidybot
from coopera.models.learners.habits import Habits

SAMPLES = Path(homer.__file__).with_name("samples")
DAYS, REQUESTS, SCENARIOS = (
    SAMPLES / "homer_plus" / "days.json",
    SAMPLES / "pahf",
    SAMPLES / "tidybot" / "scenarios.yml",
)
Change = Callable[[Any], Any]


def last_line(capsys: pytest.CaptureFixture[str]) -> Any:
    return json.loads(capsys.readouterr().out.strip().splitlines()[-1])


def test_homer_ends_with_one_line_of_json_for_each_number_of_days(capsys: pytest.CaptureFixture[str]) -> None:
    assert homer.main([str(DAYS), "--json", "--days", "1", "3"]) == 0
    found = last_line(capsys)["homer"]["A"]
    assert list(found) == ["1", "3"]
    assert all(0.2 < found[n][who] < 0.8 for n in found for who in ("counts", "ours"))


def test_by_default_homer_learns_from_those_numbers_of_days_that_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    assert homer.main([str(DAYS), "--json"]) == 0
    assert list(last_line(capsys)["homer"]["A"]) == ["1", "5"]


def test_homer_knows_nothing_of_the_hour_that_it_foretells() -> None:
    days = homer.read_days(DAYS)["A"]["test"]
    codes = homer.Codes(days)
    day = days[0]
    until_eleven = homer.Day(
        [one for one in day.schedule if one[1] <= 11 * 60], [one for one in day.moves if one[0] < 11 * 60]
    )
    whole, cut = codes.observations([day]), codes.observations([until_eleven])
    rows = whole.numbers[:, 0] == 11
    assert whole.label[rows].any()
    assert not cut.label[rows].any()
    # when an activity that is going on will end shows only once it has ended
    assert (whole.contexts[rows] == cut.contexts[rows]).all()
    assert (whole.numbers[rows] == cut.numbers[rows]).all()


def test_counts_are_the_mean_of_the_frequencies_by_hour_and_by_activity_before() -> None:
    day = homer.Day([("tea", 530, 700)], [(545, "cup", "table"), (610, "cup", "sink")])
    other = homer.Day([("tea", 530, 700)], [(545, "pot", "stove")])
    codes = homer.Codes([day, other])
    seen = codes.observations([day, other])
    yes = homer.counts(seen, codes.observations([other]))
    # cup at 9: 1 of 2 by hour, 2 of 6 while having tea (9, 10, 11 of two days): 0.42. At 10 the same. pot at 9: 0.33.
    assert [(9 + int(at // 2), codes.things[int(at % 2)]) for at in np.flatnonzero(yes)] == [(9, "cup"), (10, "cup")]


def test_what_lies_where_it_is_soon_fetched_from_is_expected() -> None:
    """A cup is washed in the hour after it came into the sink, at whatever hour that is."""

    def day(at: int) -> homer.Day:
        return homer.Day([("tea", 530, 1400)], [(60 * at, "cup", "sink"), (60 * at + 90, "cup", "shelf")])

    codes = homer.Codes([day(9)])
    habits = Habits()
    habits.train(codes.observations([day(at) for at in (9, 11, 13, 15, 17)]))
    asked = codes.observations([day(12)])
    assert [9 + int(at) for at in np.flatnonzero(habits.says_yes(asked)) if at > 3] == [13]


def test_the_gain_of_a_day_like_any_other_is_certain_and_that_of_unlike_days_is_not() -> None:
    day = homer.Day([], [(545, "cup", "table")])
    two = [day, homer.Day([], [(605, "cup", "table")])]
    for days, spread in ([day, day], False), (two, True):
        asked = homer.Codes(days).observations(days)
        nothing, nine = np.zeros(len(asked), bool), asked.contexts[:, 0] == 0
        low, high = homer.gain(days, asked, nothing, nine)
        assert (low, high) == ((0.0, 1.0) if spread else (1.0, 1.0))


def test_a_thing_never_seen_counts_as_missed() -> None:
    first = homer.Day([("tea", 530, 700)], [(545, "cup", "table")])
    second = homer.Day([("tea", 530, 700)], [(545, "cup", "table"), (550, "spoon", "cup")])
    assert homer.household([first], [second])["counts"] == pytest.approx(2 / 3, abs=1e-3)


def test_pahf_ends_with_one_line_of_json_and_relearns_what_it_was_not_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert pahf.main([str(REQUESTS), "--json", "--people", "1"]) == 0
    found = last_line(capsys)["pahf"]
    assert found["same"] > 0.8
    assert found["shifted"] < 0.3
    assert found["relearned"] > 0.7 > found["relearned_never"]
    assert found["unchanged"] > 0.8


def test_tidybot_ends_with_one_line_of_json_and_never_reads_the_notes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert tidybot.main([str(SCENARIOS), "--json"]) == 0
    found = last_line(capsys)["tidybot"]
    assert found["ours"] >= found["nearest"] > 0.5
    (tmp_path / "silent.yml").write_text(
        SCENARIOS.read_text().replace("annotator_notes: Put", "annotator_notes: Nothing")
    )
    assert tidybot.main([str(tmp_path / "silent.yml"), "--json"]) == 0
    assert last_line(capsys)["tidybot"] == found


def test_what_tidybot_is_chosen_by_is_made_of_seen_placements_only() -> None:
    scenarios = tidybot.read_scenarios(SCENARIOS)
    for one in tidybot.within_seen(scenarios):
        assert any(one.seen | one.unseen == whole.seen for whole in scenarios)
        assert set(one.unseen.values()) <= set(one.seen.values())


def without(key: str) -> Change:
    return lambda days: {name: day for name, day in days.items() if name != key}


def with_day(**fields: Any) -> Change:
    return lambda days: days | {"A/train/001": days["A/train/001"] | fields}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (without("A/train/002"), "the day A/train/002 is missing"),
        (without("A/train/000"), "the day A/train/000 is missing"),
        (lambda days: {k: v for k, v in days.items() if "train" in k}, "household A has no day of test"),
        (lambda days: days | {"monday": {}}, "'monday' names no day, expected a name such as"),
        (lambda days: list(days), "expected a JSON object of days"),
        (lambda days: {}, "expected a JSON object of days"),
        (lambda days: days | {"A/train/001": []}, "A/train/001: expected an object with schedule and moves"),
        (with_day(moves={}), "A/train/001: moves: expected a list"),
        (with_day(moves=[[60.0, "cup", "table"], [59.0, "cup", "table"]]), "moves[1]: times are out of order"),
        (with_day(moves=[["noon", "cup", "table"]]), "moves[0]: expected [minute, thing, destination]"),
        (with_day(moves=[[1500, "cup", "table"]]), "moves[0]: expected [minute, thing, destination], the minute below"),
        (with_day(moves=[[True, "cup", "table"]]), "moves[0]: expected [minute, thing, destination]"),
        (with_day(schedule=[["tea", 60, 50]]), "schedule[0]: times are out of order"),
        (with_day(schedule=[["tea", 60, 70], ["nap", 65, 80]]), "schedule[1]: times are out of order"),
        (with_day(schedule=[["tea", 60]]), "schedule[0]: expected [activity, start, end]"),
        (with_day(schedule=[["", 60, 70]]), "schedule[0]: expected [activity, start, end]"),
    ],
)
def test_days_that_are_none_are_refused_in_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: Change, sentence: str
) -> None:
    path = tmp_path / "days.json"
    path.write_text(json.dumps(change(json.loads(DAYS.read_text()))))
    assert homer.main([str(path), "--json"]) == 2
    said = capsys.readouterr().err
    assert sentence in said
    assert "days.json" in said
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (b"{", "line 1: is not JSON"),
        (b'{"A/train/000": NaN}', "NaN is no number of JSON"),
        (b'{"a": 1, "a": 2}', "'a' stands twice"),
        (b"\xff\xfe", "is not UTF-8 text"),
        (b"[" * 100_000, "is not JSON that can be read"),
    ],
)
def test_what_is_no_json_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: bytes, sentence: str
) -> None:
    (tmp_path / "days.json").write_bytes(text)
    assert homer.main([str(tmp_path / "days.json")]) == 2
    assert sentence in capsys.readouterr().err


def test_more_days_than_there_are_cannot_be_learned_from(capsys: pytest.CaptureFixture[str]) -> None:
    assert homer.main([str(DAYS), "--days", "6"]) == 2
    assert "household A has 5 days of train, and --days asks for 6" in capsys.readouterr().err


def test_a_file_too_large_or_not_there_is_not_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert homer.main([str(tmp_path / "nowhere.json")]) == 2
    assert "nowhere.json: cannot be read" in capsys.readouterr().err
    monkeypatch.setattr(outside, "LARGEST", 100)
    assert homer.main([str(DAYS)]) == 2
    assert "expected at most 100" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda lines: {}, "expected a JSON list of 1 to"),
        (lambda lines: [{}], "request 0: expected an object with"),
        (lambda lines: [lines[0] | {"scene_objects": "tea"}], "request 0: scene_objects: expected"),
        (lambda lines: [lines[0] | {"scene_objects": ["tea", "tea"]}], "scene_objects: a name stands twice"),
        (lambda lines: [lines[0] | {"task": 3}], "request 0: task: expected a text"),
        (lambda lines: lines[:30], "is not in both original_A and original_B"),
    ],
)
def test_requests_that_are_none_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: Change, sentence: str
) -> None:
    for path in REQUESTS.glob("*.json"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    spoilt = tmp_path / "original_scenarios_A.json"
    spoilt.write_text(json.dumps(change(json.loads(spoilt.read_text()))))
    assert pahf.main([str(tmp_path)]) == 2
    assert sentence in capsys.readouterr().err
    spoilt.unlink()
    assert pahf.main([str(tmp_path)]) == 2
    assert "original_scenarios_A.json: cannot be read" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[", "is not YAML"),
        ("a: 1", "expected a list of 1 to"),
        ("- 3", "scenario 0: expected a mapping"),
        ("- {seen_placements: [[a, b]], unseen_placements: [[c]]}", "expected pairs of thing and receptacle"),
        ("- {seen_placements: [[a, b]], unseen_placements: []}", "unseen_placements: expected a list of 1"),
        ("- {seen_placements: [[a, b], [a, c]], unseen_placements: [[d, b]]}", "a thing stands twice"),
        ("- {seen_placements: [[a, b]], unseen_placements: [[d, e]]}", "nothing was seen in 'e'"),
        ("- !!python/object/apply:os.system [ls]", "is not YAML"),
    ],
)
def test_scenarios_that_are_none_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, sentence: str
) -> None:
    (tmp_path / "s.yml").write_text(text)
    assert tidybot.main([str(tmp_path / "s.yml")]) == 2
    assert sentence in capsys.readouterr().err
