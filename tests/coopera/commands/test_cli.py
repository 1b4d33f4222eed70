from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

import coopera.studies.study
from coopera.core.errors import ModelCallError
from coopera.core.people import BigFive, Persona, PersonId
from coopera.people.shipped import shipped_ids, write_persona
from coopera.rundir.directory import RunDir
from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run

Cli = Callable[..., Said]


def files_in(folder: Path) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*"))


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (["run", "--setting", "7"], "--setting must be 1, 2, 3 or 4, not 7."),
        (["run", "--collab", "3"], "--collab must be 1 or 2, not 3."),
        (["run", "--days", "-1"], "--days must be a whole number from 1 to 366, not -1."),
        (["run", "--days", "0"], "--days must be a whole number from 1 to 366, not 0."),
        (["run", "--hours", "0"], "--hours must be a whole number from 1 to 15, not 0."),
        (["run", "--hours", "many"], "Invalid value for '--hours'"),
        (["run", "--seed", "-3"], "--seed must be a whole number from 0 up, not -3."),
        (["run", "--humans", "nobody"], "humans: there is no person 'nobody'"),
        (["run", "--humans", ","], "--humans must be a list of one or more persona ids, not []."),
        (["run", "--scenes", "castle"], "scenes: there is no home 'castle'"),
        (["run", "--method", "magic"], "method: there is no method 'magic'"),
        (["run", "--setting", "3", "--humans", "amara,bruno"], "humans: setting 3 takes 3 or a multiple of it, not 2"),
        (
            ["run", "--classifier", "oracle"],
            "classifier: there is no classifier 'oracle' (did you mean lora? known are",
        ),
        (["run", "--pictures", "film"], "--pictures must be sampled, none or video, not 'film'."),
        (["run", "--prompts", "missing"], "prompts: missing must be a folder of prompt files"),
        (["run", "--model", "recorded:missing"], "missing: this folder holds no run"),
        (
            ["run", "--household", "ours"],
            "household: ours is neither own nor shared, and there is no household file of",
        ),
        (["run", "--household", "misspelt.yaml"], "misspelt.yaml: field 'looks_like': Field required"),
        (["run", "missing.yaml"], "missing.yaml: there is no such study file."),
        (["run", "misspelt.yaml"], "misspelt.yaml: there is no field 'dayz' (did you mean days?)."),
        (["run", "--out", "taken"], "out: taken already holds another run"),
        (["run", "--out", "full"], "out: full is not empty"),
        (["run", "--out", "misspelt.yaml"], "out: misspelt.yaml must be a folder, and it is a file."),
        (["run", "--dayz", "3"], "No such option: --dayz"),
        (["rum"], "No such command 'rum'"),
        (["resume", "missing"], "missing: this folder holds no run"),
        (["trace", "missing"], "missing: this folder holds no run"),
        (["report", "full"], "full: this folder holds no run"),
        (["humans", "show", "nobody"], "humans: there is no person 'nobody'"),
        (["humans", "import", "missing.csv"], "missing.csv: there is no such CSV file."),
        (["humans", "import", "column.csv"], "column.csv, line 1: the column 'user 2 personas' is missing"),
        (["humans", "import", "bytes.csv"], "bytes.csv, line 2: the CSV file must be UTF-8 text"),
        (["humans", "import", "rows.csv"], "rows.csv: the file has a header but no row with a persona."),
        (["humans", "check", "column.csv"], "column.csv, line 1: the column 'user 2 personas' is missing"),
        (["scenes", "show", "castle"], "here is no scene 'castle'"),
        (["prompts", "show", "human/wish"], 'there is no prompt "human/wish"'),
        (["prompts", "check", "missing"], "missing: there is no such folder"),
    ],
)
def test_wrong_input_is_one_sentence_exit_code_2_and_nothing_written(
    coopera: Cli, tmp_path: Path, args: list[str], sentence: str
) -> None:
    (tmp_path / "taken").mkdir()
    (tmp_path / "taken" / "run.json").write_text("{}")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes.txt").write_text("mine")
    (tmp_path / "misspelt.yaml").write_text("dayz: 3\n")
    (tmp_path / "column.csv").write_text("user 1 personas,Best Generated Conversation\na,b\n")
    head = b"user 1 personas,user 2 personas,Best Generated Conversation\n"
    (tmp_path / "bytes.csv").write_bytes(head + b"na\xefve,b,c\n")
    (tmp_path / "rows.csv").write_bytes(head + b"\n")
    before = files_in(tmp_path)
    said = coopera(*args)
    assert said.code == 2
    assert sentence in said.err
    assert said.err.startswith("coopera: ")
    assert said.err.count("\n") == 1
    assert said.out == ""
    assert files_in(tmp_path) == before


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (["--model", "gpt"], 'the model "gpt" is unknown'),
        (["--earlier-life", "missing"], "missing: this folder holds no run"),
    ],
)
def test_what_is_found_wrong_only_when_the_run_opens_leaves_no_run_behind(
    coopera: Cli, tmp_path: Path, wrong: list[str], sentence: str
) -> None:
    (tmp_path / "mine").mkdir()
    for out in ("mine", "new/run"):
        said = coopera("run", *wrong, "--out", out)
        assert (said.code, sentence in said.err) == (2, True)
    assert not files_in(tmp_path / "mine")
    assert not (tmp_path / "new").exists()


def test_a_model_without_a_server_ends_the_run_at_once_and_leaves_nothing(coopera: Cli, tmp_path: Path) -> None:
    said = coopera("run", "--model", "openai:x", "--base-url", "http://127.0.0.1:9/v1", "--out", "new/run")
    assert said.code == 1
    assert "no server listens there" in said.err
    assert "coopera models check" in said.err
    assert not (tmp_path / "new").exists()


def test_help_imports_nothing_heavy() -> None:
    heavy = ("torch", "pybullet", "langgraph", "langchain_core", "chromadb", "transformers", "numpy")
    code = (
        "import sys\nfrom coopera.cli import main\nmain(['run', '--help'])\n"
        f"assert not set({heavy!r}) & set(sys.modules), set({heavy!r}) & set(sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "--setting" in done.stdout


@pytest.fixture
def study(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Stand in for the study: tells three events and writes a small run, or raises what `error` says."""
    asked: dict[str, Any] = {"error": None}

    def run_study(
        config: Any, *, on_event: Callable[[Mapping[str, Any]], None], ask_person: Any = None
    ) -> dict[str, Any]:
        asked["config"] = config
        on_event({"day": 0, "hour": 9, "node": "propose", "success": None})
        on_event({"day": 0, "hour": 9, "node": "record", "success": 0.25})
        if asked["error"]:
            with fake_run(config.out, days=1, hours=1, frames=1, finished=False):
                raise asked["error"]
        on_event({"day": 0, "hour": None, "node": "end_day", "success": 0.25})
        run = fake_run(config.out, days=2, hours=2, frames=1)
        (run.root / "report.html").write_text("")
        return run.summary()

    monkeypatch.setattr(coopera.studies.study, "run_study", run_study)
    return asked


def test_run_shows_progress_then_the_days_and_where_the_report_is(
    coopera: Cli, study: dict[str, Any], tmp_path: Path
) -> None:
    said = coopera("run", "--scenes", "maple", "--days", 2, "--hours", 2, "--seed", 4, "--model", "offline")
    assert said.code == 0, said.err
    assert study["config"].out == Path("runs/run-001")
    assert (study["config"].days, study["config"].seed, study["config"].humans) == (2, 4, shipped_ids()[:1])
    assert "day 0, 9 am done (1 of 4 hours); predicate F1 so far 0.250" in said.err
    summary = RunDir.open(tmp_path / "runs" / "run-001").summary()
    for day in summary["days"]:
        assert f"{day['predicate']['f1']:.3f}" in said.out
    assert "Report: runs/run-001/report.html" in said.out


def test_run_ends_with_one_line_of_json(coopera: Cli, study: dict[str, Any], tmp_path: Path) -> None:
    said = coopera("run", "--scenes", "maple", "--out", "here", "--json")
    assert said.code == 0, said.err
    assert said.json == {**json.loads((tmp_path / "here" / "summary.json").read_text()), "run": "here"}


def test_ctrl_c_says_how_to_go_on_and_ends_with_130(coopera: Cli, study: dict[str, Any]) -> None:
    study["error"] = KeyboardInterrupt()
    said = coopera("run", "--scenes", "maple", "--out", "here")
    assert said.code == 130
    assert "Stopped. Continue with: coopera resume here" in said.err


def test_work_that_fails_is_one_sentence_and_exit_code_1(coopera: Cli, study: dict[str, Any]) -> None:
    study["error"] = ModelCallError("the server at x cannot be reached")
    said = coopera("run", "--scenes", "maple", "--out", "here")
    assert said.code == 1
    assert said.err.splitlines()[-1] == "coopera: the server at x cannot be reached"


def test_lists_are_lists_of_objects_with_ids(coopera: Cli) -> None:
    people = coopera("humans", "list", "--json").json
    assert [person["id"] for person in people] == shipped_ids()
    homes = coopera("scenes", "list", "--json").json
    assert all({"id", "rooms", "fixed", "movable"} <= set(home) for home in homes)
    found = coopera("prompts", "list", "--json").json
    assert "human/intention" in [prompt["id"] for prompt in found]


def test_people_homes_and_prompts_can_be_shown_and_checked(coopera: Cli, tmp_path: Path) -> None:
    shown = coopera("humans", "show", "joan")
    assert "Biscuit" in shown.out
    assert "job: is retired -> never: desk_work" in shown.out
    assert "states to play no piano -> never: piano" in shown.out
    joan = coopera("humans", "show", "joan", "--json").json
    assert joan["name"] == "Joan Whitaker"
    assert (joan["facts"]["age"], joan["facts"]["employment"]) == (73, "retired")
    assert all(fact["sentence"].rstrip(";,") in joan["profile"] for fact in joan["facts"]["listed"])
    write_persona(Persona(id=PersonId("nobody"), name="Nobody", profile="I say nothing.", big_five=BigFive()), tmp_path)
    assert "nothing stated" in coopera("humans", "show", "./nobody.yaml").out
    (tmp_path / "x.csv").write_text("user 1 personas,user 2 personas,Best Generated Conversation\na,b,c\n")
    assert coopera("humans", "check", "x.csv", "--json").json == {"file": "x.csv", "rows": 1}
    assert "version: " in coopera("prompts", "show", "human/intention").out
    assert "{{" not in coopera("prompts", "show", "human/intention", "--filled").out
    assert "can be used" in coopera("prompts", "check").out


def test_published_diaries_become_files_and_their_hours_can_be_seen(coopera: Cli, tmp_path: Path) -> None:
    day = {
        "schedule": [["breakfast", 530, 560], ["leave_home", 580, 600], ["come_home", 730, 740], ["sleep", 1300, 1800]]
    }
    (tmp_path / "days.json").write_text(json.dumps({"A/train/000": day}))
    said = coopera("humans", "diary", "days.json")
    assert said.out.splitlines() == [
        "diaries/a-train.csv: A/train, days: 1, episodes: 5; 9 am to 9 pm: 5 hours (1 continued, 2 away), 8 open.",
        "To live one: coopera run --played-by log:diaries/a-train.csv --humans ID --days 1",
    ]
    assert "which was there and is kept" in coopera("humans", "diary", "days.json").out
    (person,) = coopera("humans", "diary", "days.json", "--force", "--json").json["people"]
    assert (person["file"], person["hours"], person["kept"]) == ("diaries/a-train.csv", 5, False)
    hours = coopera("humans", "check", "diaries/a-train.csv").out.splitlines()
    assert hours[:4] == [
        "day 0, 8 am: Have breakfast",
        "day 0, 9 am: Get ready and leave the home",
        "day 0, 10 am: Be out of the home (away)",
        "day 0, 11 am: Be out of the home (goes on) (away)",
    ]
    assert hours[-1] == "diaries/a-train.csv: a diary with 8 hours (days: 1)."
    for args, sentence in (
        (["--format", "csv"], "--format must be homer or atus, not 'csv'."),
        (["--who", "B/train"], "--who: days.json has no 'B/train' (it begins with A/train)."),
        (["--limit", "0"], "Invalid value for '--limit'"),
    ):
        said = coopera("humans", "diary", "days.json", *args)
        assert said.code == 2
        assert sentence in said.err


def test_trace_and_report_read_a_run(coopera: Cli, tmp_path: Path) -> None:
    fake_run(tmp_path / "run", days=1, hours=2, frames=1)
    assert "day 0, 10 am" in coopera("trace", "run").out
    assert coopera("trace", "run", "--day", 0, "--hour", 10, "--json").json["hour"] == 10
    done = coopera("report", "run", "--json").json
    assert (tmp_path / "run" / "report.html").stat().st_size == done["bytes"]


def test_a_data_folder_that_cannot_be_written_is_told_as_one_and_leaves_no_run(
    coopera: Cli, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("COOPERA_DATA_DIR", str(tmp_path / "file"))
    said = coopera("run", "--days", 1, "--hours", 1, "--pictures", "none", "--out", "run")
    assert said.code == 2
    assert "file: the data folder cannot be written" in said.err
    assert "COOPERA_DATA_DIR" in said.err
    assert not (tmp_path / "run").exists()
