"""The sentences of a self-description, sorted: for a habit, against a habit, about other people."""

from __future__ import annotations

import re
from typing import NamedTuple

_END = re.compile(r"(?<=[.!?;])\s+|\n+|\s+but\s+")
_AGAINST = re.compile(
    r"\b(?:not|never|hate|hates|dislike|detest|avoid|afraid|scared|terrified|allergic|cannot|cant|dont|no longer|"
    r"used to|quit|without|unable|gave up|given up)\b|n['’]t\b",
    re.IGNORECASE,
)
_NEVER_SKIP = re.compile(r"\b(?:never|not|n['’]t)\s+(?:skip|miss|forget|go\s+(?:a\s+day\s+)?without)\b", re.IGNORECASE)
_OTHERS = re.compile(
    r"^(?:my|our|his|her|their)\s+(?:\w+\s+)?(?:father|mother|dad|mom|mum|parents?|brothers?|sisters?|uncle|aunt|"
    r"grand\w+|husband|wife|spouse|partner|boyfriend|girlfriend|sons?|daughters?|kids?|child(?:ren)?|cousins?|"
    r"friends?|boss|neighbou?rs?|family|ex)\b|^(?:he|she|they)\b",
    re.IGNORECASE,
)
_FIRST_PERSON = re.compile(r"\b(?:i|i['’]m|we|me|us|mine)\b", re.IGNORECASE)


class Statements(NamedTuple):
    """A self-description, sentence by sentence."""

    habits: list[str]
    """What the person does or likes."""
    aversions: list[str]
    """What the person does not do, dislikes or has given up."""
    others: list[str]
    """What other people do: no habit of this person."""


def statements(text: str) -> Statements:
    """Sort the sentences of a self-description.

    A few words decide, not understanding. "not", "hate" and the like make the whole sentence an aversion. A sentence
    with a relative and without "I" is about the relative.
    """
    result = Statements([], [], [])
    for sentence in sentences(text):
        if _OTHERS.search(sentence) and not _FIRST_PERSON.search(sentence):
            result.others.append(sentence)
        elif _AGAINST.search(sentence) and not _NEVER_SKIP.search(sentence):
            result.aversions.append(sentence)
        else:
            result.habits.append(sentence)
    return result


def sentences(text: str) -> list[str]:
    """Split a text into sentences of at least two words, without repeats (whatever their case)."""
    parts = (" ".join(part.split()).strip(" -*") for part in _END.split(text))
    kept: dict[str, str] = {}
    for part in parts:
        if len(part.split()) >= 2:
            kept.setdefault(part.lower().rstrip(".!"), part)
    return list(kept.values())
