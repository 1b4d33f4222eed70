"""Commands and code blocks of README and docs, and examples, are run as they stand, in short (`COOPERA_AT_MOST`)."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest
import yaml

from tests.conftest import with_vectors
from tests.pages import ROOT, SERVER, Block, blocks, furnish
from tests.serving import serving

NOT_RUN, LONG = "not run: ", "long"
# what a page's command does that would set up an environment within the test's, or run the tests within a test
STANDS_FOR = {
    "make run": "coopera run",
    "make test": "true",
    "pip install": "true",
    "source .venv/bin/activate": "true",
    "coopera view runs  ": "true  ",  # it serves until Ctrl-C
}
NEEDS = {"trace_with_mlflow.py": "mlflow"}
"""Examples with a package that is no extra of ours."""
SHORT, EXAMPLE = "days=1,hours=1,episodes=1,settings=1,methods=2,seeds=1", "days=2,hours=2"


def pages(*, long: bool) -> list[object]:
    """The shell blocks to run, page by page; the long ones apart."""
    of: dict[Path, list[Block]] = defaultdict(list)
    for block in blocks("sh", "python"):
        if not block.note.startswith(NOT_RUN) and (block.note == LONG) == long:
            of[block.page].append(block)
    return [pytest.param(found, id=str(page.relative_to(ROOT))) for page, found in of.items()]


def run_page(found: list[Block], folder: Path, data_dir: Path) -> None:
    """Run a page's blocks one after the other in one folder, in an environment that was activated once."""
    scripts = {
        "sh": lambda text: ["bash", "-euo", "pipefail", "-c", text],
        "python": lambda text: [sys.executable, "-c", text],
    }
    python = "".join(block.text for block in found if block.language == "python")
    texts = [("sh", block.text, block.place) for block in found if block.language == "sh"]
    with serving() as base_url:
        furnish(folder, base_url)
        environment = os.environ | {
            "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(ROOT),
            "COOPERA_AT_MOST": SHORT,
            "COOPERA_DATA_DIR": str(data_dir),
            "OPENAI_API_KEY": "none",
        }
        for language, text, place in [*texts, *([("python", python, found[0].place)] if python else [])]:
            said = text.replace(SERVER, base_url)
            for command, instead in STANDS_FOR.items():
                said = said.replace(command, instead)
            done = subprocess.run(
                scripts[language](said), cwd=folder, env=environment, capture_output=True, text=True,
                stdin=subprocess.DEVNULL, check=False,
            )  # fmt: skip
            assert done.returncode == 0, f"{place}\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}"


@pytest.mark.parametrize("found", pages(long=False))
def test_what_a_page_says_can_be_done(found: list[Block], tmp_path: Path, vectors: Path) -> None:
    run_page(found, tmp_path, with_vectors(tmp_path / "data", vectors))


@pytest.mark.slow
@pytest.mark.parametrize("found", pages(long=True))
def test_what_a_page_says_can_be_done_in_a_long_while(found: list[Block], tmp_path: Path, vectors: Path) -> None:
    run_page(found, tmp_path, with_vectors(tmp_path / "data", vectors))


@pytest.mark.parametrize("block", list(blocks("yaml", "json")), ids=lambda block: block.place)
def test_a_pages_data_can_be_read(block: Block) -> None:
    assert (yaml.safe_load if block.language == "yaml" else json.loads)(block.text)


def test_a_block_that_is_not_run_says_why() -> None:
    left_out = {block.place: block.note for block in blocks("sh", "python") if block.note.startswith(NOT_RUN)}
    assert all(len(note) > len(NOT_RUN) + 10 for note in left_out.values())
    assert len(left_out) <= 7, left_out
    odd = [block.place for block in blocks("sh", "python") if block.note and not block.note.startswith((NOT_RUN, LONG))]
    assert odd == []


@pytest.mark.parametrize("example", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.name)
def test_an_example_runs(example: Path, tmp_path: Path, data_dir: Path) -> None:
    if example.name in NEEDS:
        pytest.importorskip(NEEDS[example.name])
    environment = os.environ | {
        "PYTHONPATH": str(ROOT),
        "COOPERA_AT_MOST": EXAMPLE,
        "COOPERA_DATA_DIR": str(data_dir),
    }
    done = subprocess.run(
        [sys.executable, example], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False,
        stdin=subprocess.DEVNULL,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
