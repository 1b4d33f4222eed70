"""Diaries that others have published, as diaries of ours: what every importer gives and uses."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeAlias

from coopera.config.files import read_yaml
from coopera.core.errors import ConfigError
from coopera.people.diary import Episode

Format: TypeAlias = Literal["homer", "atus"]
"""What can be imported."""

WORDS = Path(__file__).parent / "words"
_NAMED = 8  # codes that a note names


class PersonDiary(NamedTuple):
    """One person's diary: who they are in the file, what is known of them, and what they did."""

    who: str
    about: str
    episodes: list[Episode]

    @property
    def name(self) -> str:
        """The name of their file, such as a-train for A/train."""
        return re.sub(r"[^a-z0-9]+", "-", self.who.lower()).strip("-") or "person"


class Published(NamedTuple):
    """What an importer read: the people, and notes on what was left out or guessed, each a sentence."""

    people: list[PersonDiary]
    notes: list[str]


@cache
def words(name: Format) -> Mapping[str, Any]:
    """The table of plain words for a format's activities.

    Raises:
        ConfigError: If the installed table is damaged.
    """
    return read_yaml(WORDS / f"{name}.yaml", "table of words")


def counted(counts: Mapping[str, int]) -> str:
    """Names with how often each occurs, the commonest first, as in "130136 (4), 170101 (1) and 3 more"."""
    ranked = sorted(counts.items(), key=lambda one: (-one[1], one[0]))
    more = f" and {len(ranked) - _NAMED} more" if len(ranked) > _NAMED else ""
    return ", ".join(f"{name} ({count})" for name, count in ranked[:_NAMED]) + more


def nobody(path: Path, who: str, known: Sequence[str]) -> ConfigError:
    """That the one asked for is not there."""
    return ConfigError(f"--who: {path} has no {who!r} (it begins with {', '.join(known[:_NAMED])}).")
