"""What changed between two texts, marked word by word, and the changes of a reflection as before and after."""

from __future__ import annotations

import re
from difflib import SequenceMatcher
from typing import NamedTuple

from markupsafe import Markup, escape

from coopera.core.hour import HumanHour

_CHANGE = re.compile(r"(?P<task>\d{1,2}\.\d{1,3}): (?P<before>.*?) -> (?P<after>.*)", re.DOTALL)
_WORD = re.compile(r"\s+|\w+|[^\w\s]")
_MOST_WORDS = 3000
"""Longer texts are shown whole, one struck out and the other put in: comparing takes time by the square of them."""


class Change(NamedTuple):
    """A change that a reflection asked for, or code made.

    Attributes:
        node: Which reflection, or "code".
        task: The task's id; empty where one was added.
        kind: changed, dropped, added, or mended.
        marked: Before and after in one, marked.
        made: Whether it was made; it may have been overruled.
    """

    node: str
    task: str
    kind: str
    marked: Markup
    made: bool


def marked(before: str, after: str) -> Markup:
    """Both texts in one: what went is in <del>, what came in <ins>, the rest as it is."""
    one, other = _WORD.findall(before), _WORD.findall(after)
    if max(len(one), len(other)) > _MOST_WORDS:
        return Markup("<del>{}</del><ins>{}</ins>").format(before, after)
    parts: list[Markup] = []
    for what, a, b, c, d in SequenceMatcher(None, one, other, autojunk=False).get_opcodes():
        gone, come = "".join(one[a:b]), "".join(other[c:d])
        if what == "equal":
            parts.append(escape(gone))
            continue
        parts += [Markup("<del>{}</del>").format(gone)] if gone else []
        parts += [Markup("<ins>{}</ins>").format(come)] if come else []
    return Markup("").join(parts)


def changes_of(human: HumanHour) -> list[Change]:
    """All changes that the reflections of an hour asked for, those that were overruled after those that were made."""
    found = []
    for reflection in human.reflections:
        found += [_change(reflection.node, text, made=True) for text in reflection.changes]
        found += [_change(reflection.node, text, made=False) for text in reflection.overruled]
    return [*found, *(Change("code", "", "mended", escape(text), True) for text in human.repairs)]


def _change(node: str, text: str, *, made: bool) -> Change:
    if read := _CHANGE.fullmatch(text):
        if read["after"] == "dropped":
            return Change(node, read["task"], "dropped", Markup("<del>{}</del>").format(read["before"]), made)
        return Change(node, read["task"], "changed", marked(read["before"], read["after"]), made)
    if text.startswith("added: "):
        return Change(node, "", "added", Markup("<ins>{}</ins>").format(text.removeprefix("added: ")), made)
    before, arrow, after = text.partition(" -> ")
    return Change(node, "", "changed", marked(before, after) if arrow else escape(text), made)
