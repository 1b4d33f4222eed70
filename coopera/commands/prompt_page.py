"""The page of all prompts, filled as a model gets them, so that a reader can judge them.

>>> coopera prompts page > docs/prompts.md
"""

from __future__ import annotations

import math
from typing import NamedTuple

from coopera.core.asks import ASKS, PROMPTS
from coopera.core.replies import REPLIES
from coopera.models.schemas import objects_of, schema_of
from coopera.models.specs import LETTERS
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples

_HEAD = """\
# Prompts

Every prompt as a model gets it, filled with an example: a small home and a short day, so that each is read in a
minute. A whole home is longer: the shipped ones have 90 to 217 objects, some 300 to 750 tokens to list (`python -m
benchmarks.search`). {letters} characters count as a token, whatever tokenizer is installed; a model's own differs.
*Schema* is the reply's JSON schema, which follows the prompt where the model's server cannot be held to it.

`coopera prompts page > docs/prompts.md` makes this page, and `--prompts DIR` makes it of your own folder.
"""
_FENCE = "````"


class Entry(NamedTuple):
    """A prompt on the page; lengths in tokens."""

    name: str
    asked: str
    reply: str
    paper: str
    tokens: int
    schema: int
    text: str


def page(library: PromptLibrary) -> str:
    """The page as Markdown: a table of all prompts, then the text of each."""
    entries = [_entry(library, name) for name in library.names]
    lines = ["| prompt | asks | reply | paper | tokens | schema |", "|---|---|---|---|---|---|"]
    lines += [
        f"| [{one.name}](#{one.name.replace('/', '')}) | {one.asked} | {one.reply} | {one.paper} | {one.tokens} "
        f"| {one.schema or ''} |"
        for one in entries
    ]
    texts = [
        f"## {one.name}\n\n{one.tokens} tokens{f', schema {one.schema}' if one.schema else ''}.\n\n"
        f"{_FENCE}text\n{one.text.strip()}\n{_FENCE}\n"
        for one in entries
    ]
    return "\n".join([_HEAD.format(letters=LETTERS), *lines, "", *texts])


def _entry(library: PromptLibrary, name: str) -> Entry:
    head, text = library.head(name), library.fill(name, examples(name)[0])
    schema = schema_of(REPLIES[head.reply], frozenset(objects_of(examples(name)[0]))) if name in ASKS else ""
    return Entry(name, PROMPTS[name].role, head.reply, head.paper, _tokens(text), _tokens(schema), text)


def _tokens(text: str) -> int:
    return math.ceil(len(text) / LETTERS)
