"""What becomes different in people's lives: a list of one's own, or drawn by the seed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from coopera.config.schema import Config, Models
from coopera.core.errors import ConfigError
from coopera.core.people import PersonId
from coopera.people.changes import NONE, SEEDED, drawn, mood, open_changes, read_changes
from coopera.studies.assemble import open_living
from tests.coopera.conftest import Said

Cli = Callable[..., Said]
ANN, BEN = PersonId("ann"), PersonId("ben")
KNOWN = ["nap", "cardio", "read"]
YEAR = range(365)


def written(folder: Path, text: str) -> Path:
    path = folder / "changes.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def texts(seed: int, person: PersonId) -> list[list[str]]:
    return [[one.text for one in (*drawn(seed, person, day), *mood(seed, person, day))] for day in YEAR]


def test_without_changes_every_day_is_like_the_others() -> None:
    assert [list(open_changes(NONE, 0)(ANN, day)) for day in YEAR] == [[]] * 365


def test_a_list_of_changes_holds_on_its_days_and_for_its_person(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        "changes:\n"
        "  - {kind: illness, text: I have the flu, day: 2, until: 4, more: {nap: 3.0}, never: [cardio]}\n"
        "  - {kind: drift, text: I read more, day: 3, ramp: 4, more: {read: 2.0}, person: ann}\n",
    )
    changes = open_changes(str(path), 0, KNOWN)
    assert [[one.text for one in changes(ANN, day)] for day in range(5)] == [
        [],
        [],
        ["I have the flu"],
        ["I have the flu", "I read more"],
        ["I read more"],
    ]
    assert [[one.text for one in changes(BEN, day)] for day in (2, 3, 4)] == [["I have the flu"]] * 2 + [[]]
    [_, reading] = changes(ANN, 3)
    assert [reading.strength(day) for day in (3, 6, 100)] == [0.25, 1.0, 1.0]


def test_moods_come_with_a_list_only_where_it_asks_for_them(tmp_path: Path) -> None:
    plain = open_changes(str(written(tmp_path, "changes: []")), 0)
    assert not any(plain(ANN, day) for day in YEAR)
    moody = open_changes(str(written(tmp_path, "moods: true")), 0)
    assert [list(moody(ANN, day)) for day in YEAR] == [mood(0, ANN, day) for day in YEAR]


def test_a_life_drawn_by_the_seed_is_the_same_again_and_differs_by_seed_and_person() -> None:
    assert texts(0, ANN) == texts(0, ANN)
    assert texts(0, ANN) != texts(0, BEN)
    assert texts(0, ANN) != texts(1, ANN)
    seeded = open_changes(SEEDED, 0)
    assert [[one.text for one in seeded(ANN, day)] for day in YEAR] == texts(0, ANN)


def test_about_a_third_of_days_have_a_mood_that_is_over_the_next_day() -> None:
    moods = [one for person in (ANN, BEN) for day in YEAR for one in mood(0, person, day)]
    assert 0.28 < len(moods) / (2 * len(YEAR)) < 0.42
    assert {one.kind for one in moods} == {"mood"}
    assert all((one.strength(one.day), one.strength(one.day + 1)) == (1.0, 0.0) for one in moods)


def test_a_life_drawn_by_the_seed_has_a_season_each_day_a_drift_a_hobby_and_illness_that_passes() -> None:
    days = [drawn(0, ANN, day) for day in YEAR]
    kinds = [{one.kind for one in day} for day in days]
    assert all("season" in kind for kind in kinds)
    assert len({one.text for day in days for one in day if one.kind == "season"}) == 4
    assert "drift" in kinds[-1]
    assert "hobby" in kinds[-1]
    assert 0 < sum("illness" in kind for kind in kinds) < 120
    assert kinds[0] == {"season"}


def test_what_is_not_over_by_the_next_day_is_there_the_next_day_too() -> None:
    for seed in range(5):
        for day in YEAR:
            goes_on = [one for one in drawn(seed, ANN, day) if one.strength(day + 1) > 0]
            assert all(one in drawn(seed, ANN, day + 1) for one in goes_on)


WRONG = [
    ("changes: [{text: a, day: 1, more: {napp: 1}}]", "change 1, field more: there is no activity 'napp'; did you"),
    ("changes: [{text: a, day: 1}, {text: a, day: 1, never: [z]}]", "change 2, field never: there is no activity 'z'."),
    ("changes: [{text: a, day: -1}]", "change 1, field day: day -1 is before the life, whose days count from 0."),
    ("changes: [{text: a, day: 1, until: -3}]", "change 1, field until: day -3 is before the life"),
    ("changes: [{text: a, day: 5, until: 5}]", "change 1, field until: must come after day 5, not on day 5."),
    ("changes: [{text: a, day: 1, foo: 1}]", "change 1, field foo: there is no such field; known are kind, text, day"),
    ("mood: true", "field mood: there is no such field; known are changes, moods."),
    ("changes: [{text: a}]", "change 1, field day: this is missing."),
    ("changes: [{text: '', day: 1}]", "change 1, field text: must be a text of 1 to 200 characters."),
    ("changes: [{text: a, day: true}]", "change 1, field day: must be a valid integer."),
    ("changes: [{text: a, day: 1, kind: fun}]", "change 1, field kind: must be 'mood', 'drift'"),
    ("changes: [{text: a, day: 1, more: {nap: 11}}]", "change 1, field more.nap: must be less than or equal to 10."),
    ("changes: [{text: a, day: 1, more: {nap: .nan}}]", "change 1, field more.nap: must be"),
    ("changes: [{text: a, day: 1, never: nap}]", "change 1, field never: must be a list."),
    ("changes: [5]", "change 1: must be a mapping of fields to values."),
    ("changes: 5", "field changes: must be a list."),
    ("- a", "the file of changes must be a mapping of fields to values, not a list."),
    ("changes: " + "[" * 5000, "it is nested more than 64 deep"),
    ("changes: [" + "{text: a, day: 1}," * 10_001 + "]", "field changes: may have 10000 entries at most."),
    ("#" * (4 * 2**20 + 1), "the file of changes has more than 4 MiB, and at most that many are read."),
]  # fmt: skip


@pytest.mark.parametrize(("text", "sentence"), WRONG, ids=[sentence[:40] for _, sentence in WRONG])
def test_a_wrong_list_of_changes_is_refused_in_one_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(ConfigError) as refused:
        read_changes(path, KNOWN)
    assert str(refused.value).startswith(f"{path}")
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_language_model_reads_words_so_that_any_activity_may_be_named(tmp_path: Path) -> None:
    path = written(tmp_path, "changes: [{text: I have taken up falconry, day: 0, more: {falconry: 2.0}}]")
    with pytest.raises(ConfigError, match="there is no activity 'falconry'"):
        open_living(Config(changes=str(path)))
    living = open_living(Config(changes=str(path), models=Models(human="openai:x")))
    assert [one.text for one in living.changes(ANN, 0)] == ["I have taken up falconry"]


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        (["--changes", "missing.yaml"], "missing.yaml: there is no such file of changes."),
        (["--changes", "."], ".: the file of changes cannot be read (is a directory)."),
        (["--changes", ""], "--changes must be none, seeded or the path of a YAML file, not ''."),
        (["--feedback-noise", "0.7"], "--feedback-noise must be a number from 0 to 0.5, not 0.7."),
        (["--feedback-rate", "-1"], "--feedback-rate must be a number from 0 to 1, not -1.0."),
        (["--feedback-rate", "nan"], "--feedback-rate must be a number from 0 to 1, not nan."),
        (["--intentions", "daily"], "--intentions must be lasting or hourly, not 'daily'."),
        (["--absence", "yes"], "--absence must be none or named, not 'yes'."),
    ],
)
def test_what_a_life_cannot_be_is_refused_in_one_sentence_and_nothing_is_written(
    coopera: Cli, tmp_path: Path, flags: list[str], sentence: str
) -> None:
    said = coopera("run", *flags, "--out", tmp_path / "run")
    assert (said.code, said.err.strip()) == (2, f"coopera: {sentence}")
    assert not (tmp_path / "run").exists()
