"""What there is to choose from: lists, the version, and what a shell completes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import get_args

import pytest

from coopera.commands.rows import Kind
from coopera.core.version import __version__
from coopera.evaluation import METHODS, known_methods
from coopera.graphs import Method
from coopera.graphs.players.person_models import PERSON_MODELS
from tests.coopera.conftest import Said

Cli = Callable[..., Said]


@pytest.mark.parametrize("kind", get_args(Kind))
def test_each_kind_is_a_list_of_ids_with_a_line_about_each(coopera: Cli, kind: str) -> None:
    rows = coopera("list", kind, "--json").json
    assert rows
    for row in rows:
        assert row["id"]
        assert row["about"].strip()
        assert "\n" not in row["about"]
    shown = coopera("list", kind).out
    assert all(row["id"] in shown and row["about"] in shown for row in rows)


def test_what_is_listed_is_what_can_be_chosen(coopera: Cli, tmp_path: Path) -> None:
    assert [row["id"] for row in coopera("list", "methods", "--json").json] == known_methods()
    for kind, flag in (("methods", "--method"), ("robots", "--robot"), ("homes", "--scenes"), ("people", "--humans")):
        for row in coopera("list", kind, "--json").json:
            said = coopera("run", flag, row["id"], "--prompts", "missing")
            assert "prompts: missing must be a folder" in said.err


def test_a_method_of_ones_own_is_listed(coopera: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(METHODS, "mine", Method(name="mine", traits=False))
    assert {"id": "mine", "about": "paper with traits=False"} in coopera("list", "methods", "--json").json


def test_the_lists_of_the_groups_say_the_same(coopera: Cli) -> None:
    for group, kind in (("humans", "people"), ("scenes", "homes"), ("prompts", "prompts")):
        assert coopera(group, "list", "--json").json == coopera("list", kind, "--json").json


def test_what_is_no_kind_is_refused_with_the_kinds_there_are(coopera: Cli) -> None:
    said = coopera("list", "things")
    assert said.code == 2
    assert all(kind in said.err for kind in get_args(Kind))


def test_the_version_is_said(coopera: Cli) -> None:
    said = coopera("--version")
    assert (said.code, said.out) == (0, f"coopera {__version__}\n")


@pytest.mark.parametrize(
    ("words", "completed"),
    [
        (["run", "--method", "or"], ["oracle"]),
        (["run", "--person-model", ""], list(PERSON_MODELS)),
        (["run", "--humans", "joan,am"], ["joan,amara"]),
        (["list", "rob"], ["robots"]),
    ],
)
def test_a_shell_completes_values(tmp_path: Path, words: list[str], completed: list[str]) -> None:
    given = {
        "_COOPERA_COMPLETE": "complete_bash",
        "COMP_WORDS": " ".join(["coopera", *words]),
        "COMP_CWORD": str(len(words)),
    }
    root = str(Path(__file__).parents[3])
    environment = {**os.environ, **given, "PYTHONPATH": root, "COOPERA_DATA_DIR": str(tmp_path)}
    command = [sys.executable, "-c", "from coopera.cli import main; main([])"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.stdout.split() == completed, done.stderr
