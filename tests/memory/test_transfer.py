from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from coopera.core.errors import ConfigError
from coopera.memory import CachedEmbeddings, MemoryStream, export_jsonl, import_jsonl
from coopera.memory.minilm import Vector

HEADER = '{"kind": "coopera memory stream", "version": 1, "stream": "x", "model": "lengths"}\n'


def encode(text: str) -> Vector:
    return np.array([1, len(text)], np.float32)


@pytest.fixture
def stream(tmp_path: Path) -> Iterator[MemoryStream]:
    with MemoryStream.open(tmp_path / "store", "x", CachedEmbeddings(encode, "lengths")) as opened:
        yield opened


def test_a_stream_comes_back_from_its_file_as_it_was(stream: MemoryStream, tmp_path: Path) -> None:
    stream.add(["tea — 茶", 'with "quotes"\nand lines'], -3, [{"act": {"id": 1}}, {}])
    for hour in range(4):
        stream.add([f"text {n}" for n in range(400)], hour)
    assert export_jsonl(stream, tmp_path / "x.jsonl") == 1602
    other = CachedEmbeddings(lambda text: -encode(text), "another model")
    with MemoryStream.open(tmp_path / "other", "y", other) as copy:
        assert import_jsonl(copy, tmp_path / "x.jsonl") == 1602
        assert list(copy.records()) == list(stream.records())
    lines = (tmp_path / "x.jsonl").read_text().splitlines()
    assert json.loads(lines[0]) == json.loads(HEADER)
    assert json.loads(lines[1]) == {"text": "tea — 茶", "hour": -3, "metadata": {"act": {"id": 1}}}
    assert [path.name for path in tmp_path.glob("*.part")] == []


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "is empty"),
        ("\n", "line 1: is not the first line of"),
        ('{"text": "a", "hour": 1}\n', "line 1: is not the first line of"),
        (HEADER.replace("1", "2"), "of version 2"),
        (HEADER + '{"text": "a", "hour": 1}\n{"text": "b", "hour": 0}\n', "line 3: hour 0 comes after hour 1"),
        (HEADER + '{"text": "", "hour": 1}\n', "line 2: text: String should have at least 1 character"),
        (HEADER + '{"text": "a", "hour": 1.5}\n', "line 2: hour: "),
        (HEADER + '{"text": "a", "hour": 1, "who": 2}\n', "line 2: who: Extra inputs"),
        (HEADER + '{"text": "a", "hour": 1}\nnonsense\n', "line 3: the line: Invalid JSON"),
        (HEADER + '{"text": "a", "hour": 1}\n{"text": " ", "hour": 1}\n', "not empty"),
    ],
)
def test_a_bad_file_is_told_by_line_and_adds_nothing(
    stream: MemoryStream, tmp_path: Path, content: str, says: str
) -> None:
    (tmp_path / "bad.jsonl").write_text(content)
    with pytest.raises(ConfigError, match=says):
        import_jsonl(stream, tmp_path / "bad.jsonl")
    assert len(stream) == 0


def test_a_file_that_cannot_be_read_or_written_is_told(stream: MemoryStream, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"missing\.jsonl: cannot be read"):
        import_jsonl(stream, tmp_path / "missing.jsonl")
    (tmp_path / "binary.jsonl").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match=r"binary\.jsonl: cannot be read"):
        import_jsonl(stream, tmp_path / "binary.jsonl")
    with pytest.raises(ConfigError, match="cannot be written"):
        export_jsonl(stream, tmp_path / "no" / "such" / "folder.jsonl")


def test_a_file_is_added_after_what_is_there_or_not_at_all(stream: MemoryStream, tmp_path: Path) -> None:
    (tmp_path / "x.jsonl").write_text(HEADER + '{"text": "a", "hour": 5}\n')
    stream.add(["first"], 5)
    import_jsonl(stream, tmp_path / "x.jsonl")
    assert [record.text for record in stream.records()] == ["first", "a"]
    stream.add(["later"], 6)
    with pytest.raises(ConfigError, match="hour 5 is before hour 6"):
        import_jsonl(stream, tmp_path / "x.jsonl")
