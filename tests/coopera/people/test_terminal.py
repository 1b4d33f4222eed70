from __future__ import annotations

import io
from collections.abc import Callable

import pytest
from rich.console import Console

from coopera.core.errors import WaitingError
from coopera.core.interview import Question
from coopera.core.people import PersonId
from coopera.people.terminal import Terminal
from coopera.studies.study import nobody

QUESTION = Question(
    kind="intention",
    person=PersonId("joan"),
    name="Joan",
    day=2,
    hour=9,
    time="9 am",
    weekday="Wednesday",
    collab=2,
    rooms=["kitchen"],
)


def test_a_person_is_told_the_weekday_and_no_number_of_a_day() -> None:
    shown = io.StringIO()
    assert Terminal(Console(file=shown, width=200), lambda: "make tea")(QUESTION) == "make tea"
    assert "Wednesday, 9 am. You are Joan." in shown.getvalue()
    assert "ay 2" not in shown.getvalue()
    assert "ay 3" not in shown.getvalue()


@pytest.mark.parametrize("ask", [nobody, Terminal(Console(file=io.StringIO()), lambda: "later")])
def test_a_run_that_waits_names_the_day_as_its_folder_does(ask: Callable[[Question], object]) -> None:
    with pytest.raises(WaitingError, match="The run waits for Joan: day 2, 9 am."):
        ask(QUESTION)
