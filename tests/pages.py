"""The code blocks of README and docs/, and a folder that holds everything they name."""

from __future__ import annotations

import csv
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coopera.simulation.motions.smplx import COLUMNS
from tests.simulation.synthetic_hssd import write_hssd

ROOT = Path(__file__).parents[1]
SERVER = "http://localhost:8000/v1"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
_BLOCK = re.compile(
    r"(?:<!-- (?P<note>[^>]*?) -->\n)?^```(?P<language>\w*)\n(?P<text>.*?)^```", re.DOTALL | re.MULTILINE
)
_TALK = "User 1: Hi!\nUser 2: Hello, how are you?\nUser 1: Fine, I have just baked bread."


class Block(NamedTuple):
    """One fenced block; `note` is the HTML comment right above it: why it is not run, or that it is long."""

    page: Path
    line: int
    language: str
    note: str
    text: str

    @property
    def place(self) -> str:
        """Where it stands, as a test's id."""
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def blocks(*languages: str) -> Iterator[Block]:
    """All blocks in some languages, page by page."""
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for found in _BLOCK.finditer(text):
            if found["language"] in languages:
                line = text.count("\n", 0, found.start("language")) + 1
                yield Block(page, line, found["language"], found["note"] or "", found["text"])


def furnish(folder: Path, base_url: str) -> None:
    """Put what the pages name into a folder: conversations, clips, prompts, a grid, goals, a home, our folders."""
    for name in ("conversations.csv", "synthetic_persona_chat_valid.csv", "check.csv"):
        with (folder / name).open("w", newline="", encoding="utf-8") as file:
            rows = csv.writer(file)
            rows.writerow(["user 1 personas", "user 2 personas", "Best Generated Conversation"])
            rows.writerows([f"I bake bread.\nI have {n} cats.", f"I run {n} miles.", _TALK] for n in range(2, 14))
    clips = folder / "my-clips"
    clips.mkdir()
    clip = np.zeros((30, COLUMNS), dtype=np.float32)
    clip[:, 3 + 3 * 15 + 2], clip[:, 3 + 3 * 16 + 2], clip[:, 310] = -1.2, np.linspace(1.2, -1.2, 30), 0.9
    np.save(clips / "raise_the_right_hand.npy", clip)
    (folder / "my-prompts" / "human").mkdir(parents=True)
    shutil.copy(ROOT / "prompts" / "human" / "intention.md", folder / "my-prompts" / "human")
    grid = next(block for block in blocks("yaml") if block.page.name == "benchmark.md")
    (folder / "my-grid.yaml").write_text(grid.text.replace(SERVER, base_url), encoding="utf-8")
    goals = next(block for block in blocks("yaml") if block.page.name == "goals.md")
    (folder / "goals.yaml").write_text(goals.text, encoding="utf-8")
    own = (ROOT / "coopera" / "personas" / "amara.yaml").read_text(encoding="utf-8")
    (folder / "me.yaml").write_text(own.replace("id: amara", "id: me"), encoding="utf-8")
    home = (ROOT / "simulation" / "scenes" / "maple.json").read_text(encoding="utf-8")
    (folder / "flat.json").write_text(home.replace('"maple"', '"flat"'), encoding="utf-8")
    write_hssd(folder / "path" / "to" / "hssd-hab")
    for name in ("examples", "models", "docs", "benchmarks", "constraints.txt"):
        (folder / name).symlink_to(ROOT / name)
