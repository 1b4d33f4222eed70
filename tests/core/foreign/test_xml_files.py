"""Foreign XML is read within bounds, and nothing in it stands for something else."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera.core.errors import ConfigError
from coopera.core.foreign import xml_files
from coopera.core.foreign.xml_files import read_xml

BOMB = '<!DOCTYPE a [<!ENTITY b "' + "x" * 1000 + '">]><a>' + "&b;" * 1000 + "</a>"
ELSEWHERE = '<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/hostname">]><a>&b;</a>'


def read(tmp_path: Path, data: str | bytes) -> str:
    path = tmp_path / "it.xml"
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return read_xml(path, "thing", 100_000, 10).tag


def test_good_xml_is_read(tmp_path: Path) -> None:
    assert read(tmp_path, '\ufeff<?xml version="1.0"?><a b="1"><c/></a>') == "a"


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (BOMB, "it.xml: the thing has a document type"),
        (ELSEWHERE, "it.xml: the thing has a document type"),
        ("<a>" * 12 + "</a>" * 12, "it.xml: its elements lie more than 10 deep within each other."),
        ("<a>\n<b></a>", "it.xml, line 2: this is not valid XML."),
        (b"<a>\n\xff</a>", "it.xml, line 2: the thing must be UTF-8 text"),
        ("<a>" + " " * 100_000 + "</a>", "it.xml: the thing has more than 100000 bytes"),
    ],
)
def test_what_cannot_be_read_is_one_sentence(tmp_path: Path, data: str | bytes, said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        read(tmp_path, data)
    assert said in str(caught.value)


def test_tags_and_attributes_are_counted_before_any_is_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml_files, "MOST_PARTS", 10)
    for data in ("<a>" + "<b/>" * 9 + "</a>", "<a " + " ".join(f'b{n}=""' for n in range(9)) + "></a>"):
        with pytest.raises(ConfigError, match="more than 10 tags and attributes"):
            read(tmp_path, data)
