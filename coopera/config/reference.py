"""The page of all settings, made from their declarations.

>>> python -m coopera.config.reference > docs/reference/settings.md
"""

from __future__ import annotations

import sys
from collections.abc import Iterable

from coopera.config.declared import Declared
from coopera.config.schema import SETTINGS

_HEAD = """\
# Settings

What a run can be told. A setting stands in a study file by its name (`coopera run STUDY.yaml`), or is given by its
flag, which wins. All that a run was told stands in its `config.yaml`, which is a study file too.

This page is made from `coopera/config/schema.py`: `python -m coopera.config.reference > docs/reference/settings.md`.
"""


def page() -> str:
    """The page as Markdown: the settings, then the fields of each section."""
    parts = [_HEAD, _table(one for one in SETTINGS.values() if "." not in one.name)]
    for section in (one for one in SETTINGS.values() if one.section):
        inner = (one for one in SETTINGS.values() if one.name.startswith(f"{section.name}."))
        parts += [f"## {section.name}\n\n{section.words.help}\n", _table(inner)]
    return "\n".join(parts)


def _table(settings: Iterable[Declared]) -> str:
    lines = ["| setting | flag | must be | default | what it decides |", "|---|---|---|---|---|"]
    for one in settings:
        flag = f"`{one.words.flag}`" if one.words.flag else ""
        where = f" (`coopera list {one.words.listed}`)" if one.words.listed and not one.section else ""
        cells = [f"`{one.name}`", flag, f"{one.expected}{where}", one.unset, one.words.help]
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(page())
