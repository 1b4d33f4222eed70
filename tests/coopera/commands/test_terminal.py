"""Nothing that a model, a person or a file says takes over the terminal on which it is shown."""

from __future__ import annotations

import io
import json
import logging
from collections.abc import Callable
from pathlib import Path

import pytest

from coopera.cli import main
from coopera.core.interview import Card, Entry, Question
from coopera.core.people import BigFive, Persona, PersonId
from coopera.people.shipped import write_persona
from coopera.people.terminal import Terminal
from coopera.report.console import PlainConsole
from coopera.report.progress import Progress, days_table
from coopera.report.tables import print_table
from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run
from tests.models.misbehaving import ESCAPES

Cli = Callable[..., Said]
RAW = set(ESCAPES) & {chr(code) for code in (7, 0x1B, 0x9B, 0x202E)}


def assert_written_out(shown: str) -> None:
    assert not RAW & set(shown)
    assert "\\u001b[31mred" in shown


def test_a_trace_shows_what_models_said_letter_by_letter(coopera: Cli, tmp_path: Path) -> None:
    fake_run(tmp_path / "run", days=1, hours=1, frames=1)
    (path,) = (tmp_path / "run" / "trace" / "day-00").glob("hour-*.json")
    data = json.loads(path.read_text())
    data["human"]["intention"]["text"] = ESCAPES
    data["calls"][0]["faults"] = [ESCAPES]
    data["calls"][0]["prompt"] = ESCAPES
    path.write_text(json.dumps(data))
    assert_written_out(coopera("trace", "run").out)
    assert json.loads(coopera("trace", "run", "--json").out)[0]["human"]["intention"]["text"] == ESCAPES


@pytest.mark.parametrize(
    "told", [["run", "--method", ESCAPES], ["trace", ESCAPES], ["humans", "show", ESCAPES], ["resume", ESCAPES]]
)
def test_errors_show_what_was_given_letter_by_letter(coopera: Cli, told: list[str]) -> None:
    done = coopera(*told)
    assert done.code == 2
    assert not RAW & set(done.err + done.out)


def test_people_and_prompts_of_ones_own_are_shown_letter_by_letter(coopera: Cli) -> None:
    eve = Persona(id=PersonId("eve"), name="Eve", profile=ESCAPES, big_five=BigFive(openness=4), source="test")
    write_persona(eve, Path())
    assert_written_out(coopera("humans", "show", "eve.yaml").out)


def test_tables_progress_and_warnings_are_written_out(
    capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    print_table([ESCAPES], [[ESCAPES]])
    assert_written_out(capsys.readouterr().out)
    shown = PlainConsole(file=io.StringIO(), highlight=False, width=200)
    with Progress(1, shown) as progress:
        progress.tell({"day": 0, "hour": 9, "node": ESCAPES, "success": None})
    summary = {"method": ESCAPES, "setting": 1, "days": [{"day": 0, "person": ESCAPES, "scene": "maple"}]}
    days_table(summary, Path(ESCAPES), shown)
    assert_written_out(shown.file.getvalue())
    assert main(["--version"]) == 0
    last = logging.lastResort
    assert last is not None
    assert_written_out(last.format(logging.LogRecord("x", logging.WARNING, "", 1, "%s", (ESCAPES,), None)))


def test_a_real_person_is_asked_letter_by_letter() -> None:
    shown = io.StringIO()
    asked = Question(
        kind="feedback",
        person=PersonId("joan"),
        name=ESCAPES,
        day=0,
        hour=9,
        time="9 am",
        weekday="Monday",
        collab=2,
        items=[ESCAPES],
        cards=[Card(hour=9, time="9 am", intention=ESCAPES, tasks=[ESCAPES], entries=[Entry(item=0, kind="task")])],
        problem=ESCAPES,
    )
    Terminal(PlainConsole(file=shown, width=200), lambda: "yes")(asked)
    assert_written_out(shown.getvalue())
