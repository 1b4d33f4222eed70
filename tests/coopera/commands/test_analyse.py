from __future__ import annotations

import csv
import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from coopera.evaluation.people.studies import make_study
from coopera.report.study_forms import render
from coopera.rundir.directory import RunDir
from coopera.rundir.lives import read_lives
from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run
from tests.evaluation.people.lived import day, lives
from tests.tiny import random_bert

Coopera = Callable[..., Said]


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Two runs of other seeds; three people with two days each, in one home."""
    folder = tmp_path_factory.mktemp("lives")
    for seed in (0, 1):
        fake_run(folder / str(seed), people=("amara", "bruno", "chen"), days=2, hours=9, seed=seed, frames=1)
    return [folder / "0", folder / "1"]


def test_runs_become_figures_files_a_picture_and_a_study_that_is_scored(
    coopera: Coopera, runs: list[Path], tmp_path: Path
) -> None:
    said = coopera("analyse", "humans", *runs, "--out", "found", "--json")
    assert said.code == 0, said.err
    figures = {(one["check"], one["measure"]): one for one in said.json["figures"]}
    assert figures["diverse", "SD"]["n"] == 3
    assert figures["coherent", "aligned"]["value"] > figures["coherent", "mismatched"]["value"]
    assert figures["distinct", "intentions"]["n"] == 12
    assert figures["temporal", "accuracy"]["paper"] == 0.789
    assert figures["like people", "aligned"]["value"] is None
    stored = json.loads(Path("found/people.json").read_text())
    assert stored["figures"] == said.json["figures"]
    assert stored["command"] == f"coopera analyse humans {runs[0]} {runs[1]} --out found"
    assert [run["seed"] for run in stored["runs"]] == [0, 1]
    rows = list(csv.DictReader(Path("found/people.csv").read_text().splitlines()))
    assert len(rows) == len(figures)
    assert Path("found/people.md").read_text().count("\n") == len(figures) + 2
    assert Path("found/people.png").read_bytes().startswith(b"\x89PNG")
    page = Path("found/study.html").read_text()
    assert "amara" not in page  # nobody's id, and nothing that is loaded from elsewhere
    assert not re.search(r"(src|href)=", page)
    key = json.loads(Path("found/study-key.json").read_text())
    right = {"study": key["study"], "participant": "p", "answers": key["choices"] | key["matches"]}
    Path("p.json").write_text(json.dumps(right))
    Path("q.csv").write_text("participant,question,answer\nq,C1," + key["choices"]["C1"].lower() + "\n")
    scored = coopera("analyse", "score", "found/study-key.json", "p.json", "q.csv", "--json")
    assert [one["value"] for one in scored.json["figures"]] == [1, 1]


def test_days_that_stand_in_two_runs_count_once(runs: list[Path], tmp_path: Path) -> None:
    shutil.copytree(runs[0], tmp_path / "copy")
    once, twice = read_lives(runs[:1]), read_lives([runs[0], tmp_path / "copy"])
    assert once.variants["full"].days == twice.variants["full"].days


def test_what_participants_read_is_escaped(tmp_path: Path) -> None:
    made = make_study(lives([day(name, does=["<script>alert(1)</script>"]) for name in ("ann", "bob", "cyd")]))
    assert made is not None
    page = render(made.study)
    assert "<script>alert" not in page
    assert "&lt;script&gt;alert" in page


def test_no_run_and_a_folder_that_is_no_run_are_refused(coopera: Coopera, tmp_path: Path) -> None:
    said = coopera("analyse", "humans")
    assert (said.code, said.err) == (2, "coopera: RUN: name at least one run directory.\n")
    (tmp_path / "empty").mkdir()
    said = coopera("analyse", "humans", "empty")
    assert said.code == 2
    assert "holds no run" in said.err


def test_a_run_without_hours_is_refused(coopera: Coopera, tmp_path: Path) -> None:
    fake_run(tmp_path / "run", lived=False, finished=False)
    said = coopera("analyse", "humans", "run")
    assert (said.code, said.err) == (2, "coopera: run: this run holds no hour that a person has lived.\n")


def test_one_person_only_is_refused(coopera: Coopera, tmp_path: Path) -> None:
    fake_run(tmp_path / "run", days=1, hours=2, frames=1)
    said = coopera("analyse", "humans", "run")
    assert said.code == 2
    assert "one person only (amara)" in said.err


def test_runs_that_do_not_go_together_are_refused(coopera: Coopera, runs: list[Path], tmp_path: Path) -> None:
    fake_run(tmp_path / "type1", people=("amara", "bruno"), days=1, hours=2, collab=1, frames=1)
    said = coopera("analyse", "humans", runs[0], "type1")
    assert said.code == 2
    assert "type1: collaboration type is 1 here, but 2 in" in said.err
    other = shutil.copytree(runs[0], tmp_path / "other")
    change(other / "run.json", '"human": "offline routine model"', '"human": "llama"')
    said = coopera("analyse", "humans", runs[0], "other")
    assert said.code == 2
    assert "other: human model is llama here, but offline routine model in" in said.err
    away = shutil.copytree(runs[0], tmp_path / "away")
    change(away / "config.yaml", "absence: none", "absence: named")
    said = coopera("analyse", "humans", runs[0], "away")
    assert said.code == 2
    assert "away: absence is named here, but none in" in said.err
    twin = shutil.copytree(runs[0], tmp_path / "twin")
    change(twin / "people" / "amara.yaml", "I am a 34-year-old", "I am a 43-year-old")
    said = coopera("analyse", "humans", runs[0], "twin")
    assert said.code == 2
    assert "twin: amara is somebody else here" in said.err


def test_a_run_of_a_newer_schema_is_refused(coopera: Coopera, runs: list[Path], tmp_path: Path) -> None:
    newer = shutil.copytree(runs[0], tmp_path / "newer")
    info = json.loads((newer / "run.json").read_text())
    (newer / "run.json").write_text(json.dumps(info | {"schema": 99}))
    said = coopera("analyse", "humans", runs[0], "newer")
    assert said.code == 1
    assert "schema 99 was written by a newer coopera" in said.err
    assert said.err.count("\n") == 1


def test_a_log_of_nobody_and_a_generic_nobody_are_refused(coopera: Coopera, runs: list[Path], tmp_path: Path) -> None:
    (tmp_path / "zoe.csv").write_text("day,hour,intention\n0,9,Rest\n")
    said = coopera("analyse", "humans", *runs, "--recorded", "zoe.csv")
    assert said.code == 2
    assert "zoe.csv must be named after a person in these runs (amara, bruno, chen), such as amara.csv" in said.err
    said = coopera("analyse", "humans", *runs, "--generic", "zoe")
    assert said.code == 2
    assert "'zoe' lives in none of these runs" in said.err


def test_an_encoder_that_is_none_is_refused(coopera: Coopera, runs: list[Path], tmp_path: Path) -> None:
    for more in ([], ["--finetune"]):
        said = coopera("analyse", "humans", *runs, "--encoder", tmp_path / "nothing", *more)
        assert said.code == 2
        assert said.err.startswith("coopera: --encoder: ")


@pytest.fixture(scope="module")
def bert(runs: list[Path]) -> Path:
    """A tiny BERT, as Hugging Face stores it, that knows the words of the runs' intentions."""
    texts = [text for day in read_lives(runs).variants["full"].days for text in day.intentions]
    folder = runs[0].parent / "bert"
    folder.mkdir()
    return random_bert(folder, sorted({word.lower() for text in texts for word in text.split()}))


def test_any_hugging_face_encoder_can_be_looked_through(coopera: Coopera, runs: list[Path], bert: Path) -> None:
    said = coopera("analyse", "humans", *runs, "--encoder", bert, "--out", "found", "--json")
    assert said.code == 0, said.err
    assert said.json["encoder"] == str(bert)
    assert f"--encoder {bert}" in said.json["command"]
    figures = {(one["check"], one["measure"]): one for one in said.json["figures"]}
    assert figures["distinct", "intentions"]["n"] == 12
    assert figures["temporal", "accuracy"]["value"] is not None


@pytest.mark.slow
def test_any_hugging_face_encoder_can_be_finetuned(coopera: Coopera, runs: list[Path], bert: Path) -> None:
    said = coopera("analyse", "humans", *runs, "--encoder", bert, "--finetune", "--out", "found", "--json")
    assert said.code == 0, said.err
    assert said.json["encoder"] == f"{bert}, finetuned"
    assert said.json["command"].endswith("--finetune --out found")
    figures = {(one["check"], one["measure"]): one for one in said.json["figures"]}
    assert 0 <= figures["distinct", "tasks"]["low"] <= figures["distinct", "tasks"]["high"] <= 1


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("p.json", "{", "not valid JSON"),
        ("p.json", '{"study": "s"}', "no answers to a user study"),
        ("p.csv", "who,what\n", "the columns must be participant, question, answer"),
        ("p.csv", "participant,question,answer\np,C1\n", "line 2: expected 3 cells"),
        ("p.csv", "participant,question,answer\np,C1,A\np,C1,B\n", "answered C1 before"),
        ("p.csv", "participant,question,answer\np,C9,A\n", "no question 'C9'"),
    ],
)
def test_wrong_answers_files_are_refused(coopera: Coopera, tmp_path: Path, name: str, text: str, said: str) -> None:
    key = {"study": "s", "choices": {"C1": "A"}, "matches": {}, "people": {}}
    (tmp_path / "key.json").write_text(json.dumps(key))
    (tmp_path / name).write_text(text)
    found = coopera("analyse", "score", "key.json", name)
    assert found.code == 2
    assert said in found.err
    assert found.err.count("\n") == 1


def test_what_is_no_key_is_refused(coopera: Coopera, tmp_path: Path) -> None:
    (tmp_path / "key.json").write_text("[]")
    assert "no key of a user study" in coopera("analyse", "score", "key.json", "p.json").err
    assert "there is no such JSON file" in coopera("analyse", "score", "nothing.json", "p.json").err


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_a_run_keeps_how_the_person_was_simulated(runs: list[Path], tmp_path: Path) -> None:
    shot = shutil.copytree(runs[1], tmp_path / "shot")
    change(shot / "config.yaml", "person_model: full", "person_model: single_shot")
    found = read_lives([runs[0], shot])
    assert list(found.variants) == ["full", "single_shot"]
    assert RunDir.open(shot).config.person_model == "single_shot"
