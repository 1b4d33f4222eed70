from __future__ import annotations

import pytest

from coopera.core.hour import LoggedHour
from coopera.core.people import PersonId
from coopera.evaluation.people.alignment import alignment, week
from tests.evaluation.people.lived import day, lives
from tests.fakes import LetterEmbeddings

LETTERS = LetterEmbeddings()
ANN, BOB, NOBODY = PersonId("ann"), PersonId("bob"), PersonId("nobody")
PEOPLE = lives([day("ann", does=["aaa", "aab"]), day("bob", does=["zzz"]), day("nobody", does=["mmm"])])


def test_a_recorded_person_is_compared_with_their_own_simulation_another_and_nobody() -> None:
    logs = {ANN: [LoggedHour(day=0, hour=9, intention="aaa"), LoggedHour(day=0, hour=10, intention="aab")]}
    figures = {f.measure: f for f in alignment(PEOPLE, logs, LETTERS, generic=NOBODY)}
    assert figures["aligned"].value == pytest.approx(1, abs=1e-6)
    assert figures["mismatched"].value == pytest.approx(0, abs=0.01)  # only bob: nobody is not one of the others
    assert figures["generic"].value == pytest.approx(0, abs=0.01)
    assert figures["aligned"].low is None  # one recorded person has no interval


def test_a_week_is_the_mean_of_its_days() -> None:
    """Two days, all of a and all of b: the vector half way between, so its cosine to a is 1 / sqrt 2."""
    both, one = week([["aaa"], ["bbb"]], LETTERS), week([["aaa"]], LETTERS)
    assert float(both @ one) == pytest.approx(0.5**0.5, abs=0.01)


def test_three_recorded_people_have_an_interval_and_two_have_none() -> None:
    said = {ANN: "aaa", BOB: "zaz", NOBODY: "mam"}
    logs = {who: [LoggedHour(day=0, hour=9, intention=text)] for who, text in said.items()}
    figure = alignment(PEOPLE, logs, LETTERS)[0]
    assert figure.n == 3
    assert figure.low is not None
    two = alignment(PEOPLE, {who: logs[who] for who in (ANN, BOB)}, LETTERS)[0]
    assert (two.n, two.low) == (2, None)


def test_what_was_not_given_is_unmeasured_with_the_reason() -> None:
    assert {f.note for f in alignment(PEOPLE, {}, LETTERS)} == {"no log of a real person was given"}
    logs = {ANN: [LoggedHour(day=0, hour=9, intention="aaa")]}
    figures = {f.measure: f for f in alignment(lives([day("ann", does=["aaa"])]), logs, LETTERS)}
    assert figures["generic"].note == "nobody without a profile was named"
    assert figures["mismatched"].note == "it takes a second simulated person"


def test_only_hours_at_home_that_were_simulated_count_of_a_recorded_day() -> None:
    at_night = LoggedHour(day=0, hour=3, intention="zzz")
    away = LoggedHour(day=0, hour=10, intention="zzz", away=True)
    logs = {ANN: [LoggedHour(day=0, hour=9, intention="aaa"), away, at_night]}
    alone = {ANN: [LoggedHour(day=0, hour=9, intention="aaa")]}
    assert [f.value for f in alignment(PEOPLE, logs, LETTERS)] == [f.value for f in alignment(PEOPLE, alone, LETTERS)]
    figures = alignment(PEOPLE, {ANN: [away, at_night]}, LETTERS)
    assert {f.note for f in figures} == {"the logs have no hour at home of those that were simulated"}
