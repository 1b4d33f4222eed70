"""What fuzzing has found, kept: each file that once broke its reader is now read, or refused in one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.fuzz import outcome
from benchmarks.fuzzing import READERS

CORPUS = Path(__file__).parents[1] / "corpus"
FOLDERS = sorted(path.name for path in CORPUS.iterdir())


@pytest.mark.parametrize("name", FOLDERS)
def test_what_once_broke_a_reader_is_read_or_refused_in_a_sentence(name: str, tmp_path: Path) -> None:
    reader = READERS[name]
    target = reader.ready(tmp_path)
    for path in sorted((CORPUS / name).iterdir()):
        target.path.write_bytes(path.read_bytes())
        assert outcome(target.read, reader.ours) in ("read", "refused"), path.name


@pytest.mark.parametrize("name", FOLDERS)
def test_a_good_file_is_read_by_the_reader_that_is_fuzzed(name: str, tmp_path: Path) -> None:
    target = READERS[name].ready(tmp_path)
    for seed in target.seeds:
        target.path.write_bytes(seed)
        target.read()
