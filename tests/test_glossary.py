"""The glossary: each word once, and each Python name on the page leads somewhere."""

from __future__ import annotations

import re
from collections import Counter

import pytest

from tests.names import ROOT, leads_somewhere, names_in

TEXT = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in line.strip("|").split("|")] for line in TEXT.splitlines() if line.startswith("| **")]
WORDS = [word for row in ROWS for word in re.findall(r"\*\*([^*]+)\*\*", row[0])]


def test_each_word_has_one_entry_with_a_meaning() -> None:
    assert [word for word, count in Counter(WORDS).items() if count > 1] == []
    assert [row[0] for row in ROWS if len(row) != 4 or not row[1]] == []


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0].strip("*"))
def test_each_python_name_of_an_entry_leads_somewhere(row: list[str]) -> None:
    assert [name for name in sorted(names_in(" ".join(row))) if not leads_somewhere(name)] == []


def test_most_entries_say_where_they_stand_in_the_code() -> None:
    assert sum(bool(names_in(" ".join(row))) for row in ROWS) > len(ROWS) / 2


@pytest.mark.parametrize("word", ["candidate", "belief", "account", "rehearsal", "replay", "recorded", "earlier life"])
def test_a_word_that_once_had_several_meanings_has_an_entry_and_rivals(word: str) -> None:
    (rivals,) = [row[3] for row in ROWS if row[0] == f"**{word}**"]
    assert rivals
    assert word not in rivals.split(", ")
