"""What comes of an import: the home, and what was understood of the files, what was guessed, what was left out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

from coopera.simulation.homes.scene import Scene

HIGHEST = 2.0
"""What hangs higher above the floor (metres) is left out: nobody gets there."""
PLAIN = ("#8a6d4f", "#6f7f8a", "#9a8f7a", "#7a6a84", "#6d8570", "#a07a62")
"""Colours of what has no class of ours."""


@dataclass(frozen=True, slots=True)
class Report:
    """The lines of one import, each what it is about, as the files call it, and what is said of it."""

    understood: list[str] = field(default_factory=list)
    guessed: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)


class Imported(NamedTuple):
    """A home, the report of its import, what `prove` says of it, and the files of its meshes by their names."""

    scene: Scene
    report: Report
    problems: list[str]
    meshes: Mapping[str, str] = MappingProxyType({})
