"""The one reader of foreign XML: no more of it than is bearable, nothing that stands for something else."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text

MOST_PARTS = 1_000_000
"""No file has more tags and attributes."""


def read_xml(path: Path, what: str, most_bytes: int, deepest: int) -> ElementTree.Element:
    """Read the elements of an XML file; `what` names the kind of file in errors.

    A document type is refused, for it may define names that stand for gigabytes, or for other files.

    Raises:
        ConfigError: If it cannot be read, is no valid XML, or is larger or deeper than is read; names the file.
    """
    text = read_text(path, what, most_bytes)
    if "<!DOCTYPE" in text:
        raise ConfigError(f"{path}: the {what} has a document type (<!DOCTYPE>), which is not read.")
    if text.count("<") + text.count("=") > MOST_PARTS:
        raise ConfigError(f"{path}: the {what} has more than {MOST_PARTS} tags and attributes.")
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as err:
        raise ConfigError(f"{path}, line {err.position[0]}: this is not valid XML.") from err
    level = [root]
    for _ in range(deepest):
        level = [inner for one in level for inner in one]
    if level:
        raise ConfigError(f"{path}: its elements lie more than {deepest} deep within each other.")
    return root
