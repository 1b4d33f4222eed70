from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import pytest
from rich.console import Console

from coopera.config.schema import Config
from coopera.core.errors import WaitingError
from coopera.core.interview import Question
from coopera.core.people import PersonId
from coopera.people.answers import Answers, Sitting
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


def typing(*lines: str) -> Callable[[], str]:
    left = iter(lines)

    def read() -> str:
        try:
            return next(left)
        except StopIteration:
            raise EOFError from None

    return read


TASKS = QUESTION.model_copy(
    update={
        "kind": "tasks",
        "places": {"sofa_1": "living room", "bed_1": "bedroom"},
        "motions": ["sit and read"],
        "n_tasks": 2,
    }
)
EVENING = QUESTION.model_copy(update={"kind": "feedback", "items": ["tea", "a book", "a nap"]})


def test_one_wrong_number_costs_one_line_and_no_more() -> None:
    shown = io.StringIO()
    ask = Terminal(Console(file=shown, width=200), typing("1 | 1 | mug", "9 | 1 | mug", "2 | sit and read | novel", ""))
    assert ask(TASKS) == ["sofa_1 | sit and read | mug", "bed_1 | sit and read | novel"]
    assert "There is no fixed object number 9; the list has 2." in shown.getvalue()


def test_undo_takes_the_last_line_back() -> None:
    ask = Terminal(Console(file=io.StringIO()), typing("sing", "undo", "undo", "hum a tune", "", "never"))
    assert ask(TASKS) == ["hum a tune"]


def test_an_hour_needs_one_step() -> None:
    shown = io.StringIO()
    assert Terminal(Console(file=shown, width=200), typing("", "sing", ""))(TASKS) == ["sing"]
    assert "at least one step" in shown.getvalue()


def test_the_evening_is_checked_line_by_line_and_can_be_undone() -> None:
    shown = io.StringIO()
    lines = typing("yes", "perhaps", "no, too late", "undo", "skip", "n")
    assert Terminal(Console(file=shown, width=200), lines)(EVENING) == ["yes", "skip", "n"]
    assert "Item 2 needs yes or no" in shown.getvalue()


def test_what_was_said_before_later_is_there_when_the_run_goes_on(tmp_path: Path) -> None:
    def at(*lines: str) -> Terminal:
        terminal = Terminal(Console(file=io.StringIO()), typing(*lines))
        terminal.attend(Sitting(tmp_path, Config(played_by="me"), lambda question, step: step, lambda: None))
        return terminal

    with pytest.raises(WaitingError):
        at("yes", "no")(EVENING)
    assert at("skip")(EVENING) == ["yes", "no", "skip"]
    assert at()(EVENING) == ["yes", "no", "skip"]  # the answer was given; it is not asked for again
    with pytest.raises(WaitingError):  # unless it could not be read
        at()(EVENING.model_copy(update={"problem": "What?"}))


def test_a_participant_agrees_before_the_first_question(tmp_path: Path) -> None:
    (tmp_path / "consent.txt").write_text("You may stop.")
    config = Config.model_validate({"played_by": "me", "real_person": {"consent": tmp_path / "consent.txt"}})
    shown = io.StringIO()
    terminal = Terminal(Console(file=shown, width=200), typing("p07", "hm", "yes", "make tea"))
    terminal.attend(Sitting(tmp_path / "run", config, lambda question, step: step, lambda: None))
    assert terminal(QUESTION) == "make tea"
    assert "You may stop." in shown.getvalue()
    assert Answers(tmp_path / "run").participant().id == "p07"
