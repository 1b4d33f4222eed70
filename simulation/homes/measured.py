"""What the mesh of an imported object says about its use: kept with the object, in its own frame, in metres.

`simulation.homes.measuring` finds it. The frame is that of a scene's objects: the origin is the middle of the base,
Z is up, the front looks towards +y.
"""

from __future__ import annotations

import math
from typing import Annotated, TypeAlias

from pydantic import Field

from coopera.core.people import Frozen

MOST_LEVELS = 24
MOST_SOLIDS = 48
OPEN = 9.0
"""The clear height of what has nothing above it (metres)."""

_Part = Annotated[float, Field(ge=-20, le=20)]
Level: TypeAlias = tuple[_Part, _Part, _Part, _Part, _Part, Annotated[float, Field(ge=0, le=20)]]
"""A rectangle for things: height, x from and to, y from and to, clear height above it."""
Block: TypeAlias = tuple[_Part, _Part, _Part, _Part, _Part, _Part]
"""An upright box: x from, y from, x to, y to, low, high."""


class Resting(Frozen):
    """Where a body rests: the seat point, or the middle of the lying place; `turn` is where it faces, 0 towards +x.

    Who lies faces from head to feet. `wide` is how far the place reaches to the sides of who rests there, from end to
    end.
    """

    x: _Part
    y: _Part
    z: _Part
    turn: Annotated[float, Field(ge=-2 * math.pi, le=2 * math.pi)]
    wide: Annotated[float, Field(ge=0, le=20)]


class Measured(Frozen):
    """Where things go on and within an object, the usual place first, where bodies rest, and where it is solid."""

    surfaces: list[Level] = Field([], max_length=MOST_LEVELS)
    inside: list[Level] = Field([], max_length=MOST_LEVELS)
    seat: Resting | None = None
    lie: Resting | None = None
    solids: list[Block] = Field([], max_length=MOST_SOLIDS)
