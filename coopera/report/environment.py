"""What every template of a run's pages can use: figures and texts as they are shown, none of them markup."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from coopera.core.clock import hour_label
from coopera.core.naming import printable
from coopera.report.hours import FLAGS
from coopera.report.look import TEMPLATES
from coopera.report.progress import figure
from coopera.report.tree import reasons

MOST_SHOWN = 40_000
"""Characters of one prompt or reply on a page; the whole of it is in the trace."""
MOST_LINE = 4_000
"""Characters of any other text."""


@functools.cache
def environment() -> Environment:
    """The templates of a page that is one file, compiled once: it takes longer than filling them."""
    made = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    equip(made)
    return made


def equip(made: Environment) -> None:
    """Give an environment our filters, and have it write out control characters of all that it shows."""
    made.filters |= {
        "figure": figure,
        "hour": hour_label,
        "reasons": reasons,
        "flat": _flat,
        "words": _words,
        "bounded": _bounded,
    }
    made.globals["flags"] = FLAGS
    made.finalize = _shown


def _shown(value: Any) -> Any:
    """A text without control characters and of bearable length; markup of ours stays as it is."""
    if isinstance(value, Markup) or not isinstance(value, str):
        return value
    return printable(value if len(value) <= MOST_LINE else _cut(value, MOST_LINE))


def _bounded(text: Any) -> Markup:
    """A prompt or a reply, in full where it is not endless."""
    said = text if isinstance(text, str) else str(text)
    return Markup("{}").format(printable(_cut(said, MOST_SHOWN)))


def _cut(text: str, most: int) -> str:
    left = len(text) - most
    return text if left <= 0 else f"{text[:most]}… ({left:,} more characters; all of it is in the trace file)"


def _flat(value: object) -> str:
    """A measurement as short words."""
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_flat(one)}" for name, one in value.items())
    if isinstance(value, list | tuple):
        return ", ".join(_flat(one) for one in value)
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def _words(items: Sequence[str]) -> str:
    """Join words as people do: "a, b and c"."""
    return " and ".join(filter(None, [", ".join(items[:-1]), *items[-1:]]))
