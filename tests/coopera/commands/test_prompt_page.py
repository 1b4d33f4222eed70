"""The page of all prompts: what it says of each, and that the stored page is the one that the code gives."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera.cli import main
from coopera.commands.prompt_page import page
from coopera.core.asks import INSTRUCTION, PROMPTS
from coopera.prompts import PromptLibrary

PAGE = Path(__file__).parents[3] / "docs" / "prompts.md"
OWN = """---
id: judge/tasks
version: 1
model_role: judge
reply: VerdictsReply
temperature: 0
inputs: [offers]
paper: ours
---
Weigh {{ offers | length }} offers.
"""


def test_the_page_of_prompts_is_the_one_that_the_code_gives() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(PromptLibrary()), "coopera prompts page > docs/prompts.md"


def test_every_prompt_stands_on_the_page_in_full() -> None:
    library = PromptLibrary()
    said = page(library)
    assert all(library.show(name, filled=True).strip() in said for name in PROMPTS)


def test_prompts_of_ones_own_are_counted_at_four_characters_a_token(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "judge").mkdir()
    (tmp_path / "judge" / "tasks.md").write_text(OWN, encoding="utf-8")
    assert main(["prompts", "page", "--prompts", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "| [judge/tasks](#judgetasks) | judge | VerdictsReply | ours | 4 |" in said
    assert "````text\nWeigh 2 offers.\n````" in said  # 15 characters


def test_the_text_that_a_classifier_is_tuned_on_has_no_schema() -> None:
    row = next(line for line in page(PromptLibrary()).splitlines() if line.startswith(f"| [{INSTRUCTION}]"))
    assert row.endswith("|  |")
