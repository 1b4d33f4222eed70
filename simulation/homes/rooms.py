"""A room of a home: its floor, a rectangle or a polygon, and what one may ask of it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, TypeAdapter, ValidationError, model_validator

from coopera.core.people import Frozen
from coopera.simulation.homes.floorplan import TOUCH, Bounds, Edge, Point, Wall, edges_of

if TYPE_CHECKING:
    from coopera.simulation.homes.polygon import Polygon

Array = NDArray[np.float64]
Place = Annotated[float, Field(ge=-100, le=100)]
Corner: TypeAlias = tuple[Place, Place]
MOST_CORNERS = 500
_CORNERS = TypeAdapter(Annotated[tuple[Corner, ...], Field(min_length=3, max_length=MOST_CORNERS)])


class Room(Frozen):
    """A room, the rectangle (x0, y0) to (x1, y1) or the `polygon` within it; `kind` is "bedroom" for "bedroom 2".

    A polygon has its corners counter-clockwise, in metres, and does not cross itself; the rectangle around it need not
    be given then.
    """

    name: str = Field(min_length=1, max_length=60)
    kind: str = Field(min_length=1, max_length=60)
    x0: Place
    y0: Place
    x1: Place
    y1: Place
    polygon: tuple[Corner, ...] | None = Field(None, min_length=3, max_length=MOST_CORNERS)

    @model_validator(mode="before")
    @classmethod
    def _around_polygon(cls, given: Any) -> Any:
        """Fill in the rectangle around a polygon, whose corners are put in order."""
        if not isinstance(given, Mapping) or given.get("polygon") is None:
            return given
        try:
            corners = _CORNERS.validate_python(given["polygon"])
        except ValidationError:  # the field itself says what is wrong
            return {"x0": 0, "y0": 0, "x1": 1, "y1": 1, **given}
        from coopera.simulation.homes.polygon import fault, tidy  # noqa: PLC0415 - most homes have no polygon

        corners = tuple(tidy(corners))
        wrong = fault(corners)
        if wrong:
            raise ValueError(f"room {str(given.get('name'))[:60]!r}: its polygon {wrong}")
        xs, ys = zip(*corners, strict=True)
        box = {"x0": min(xs), "y0": min(ys), "x1": max(xs), "y1": max(ys)}
        for side, value in box.items():
            said = given.get(side, value)
            if isinstance(said, int | float) and abs(said - value) > TOUCH:
                raise ValueError(
                    f"room {str(given.get('name'))[:60]!r}: {side} is {said}, but its polygon's is {value}"
                )
        return {**given, **box, "polygon": corners}

    @model_validator(mode="after")
    def _has_area(self) -> Room:
        if self.x1 - self.x0 < 0.8 or self.y1 - self.y0 < 0.8:
            raise ValueError(f"room {self.name!r} must be at least 0.8 m wide and deep (x0 < x1, y0 < y1)")
        return self

    @cached_property
    def _floor(self) -> Polygon | None:
        if self.polygon is None:
            return None
        from coopera.simulation.homes.polygon import Polygon  # noqa: PLC0415 - most homes have no polygon

        return Polygon(self.polygon)

    @property
    def bounds(self) -> Bounds:
        """The rectangle around the room, which it fills where it has no polygon."""
        return Bounds(self.x0, self.y0, self.x1, self.y1)

    @property
    def outline(self) -> tuple[Point, ...]:
        """The corners of the floor, counter-clockwise."""
        return self.polygon or ((self.x0, self.y0), (self.x1, self.y0), (self.x1, self.y1), (self.x0, self.y1))

    @cached_property
    def edges(self) -> tuple[Edge, ...]:
        """The sides of the floor; those of a rectangle: low y, high y, low x, high x."""
        if self.polygon is not None:
            return edges_of(self.polygon)
        return (
            Edge(Wall("x", self.y0, self.x0, self.x1), (0.0, 1.0)),
            Edge(Wall("x", self.y1, self.x0, self.x1), (0.0, -1.0)),
            Edge(Wall("y", self.x0, self.y0, self.y1), (1.0, 0.0)),
            Edge(Wall("y", self.x1, self.y0, self.y1), (-1.0, 0.0)),
        )

    @property
    def centre(self) -> Point:
        """The middle of the floor: of a polygon the point farthest from its walls."""
        return self._floor.centre if self._floor else ((self.x0 + self.x1) / 2, (self.y0 + self.y1) / 2)

    @property
    def area(self) -> float:
        """In square metres."""
        return self._floor.area if self._floor else (self.x1 - self.x0) * (self.y1 - self.y0)

    def contains(self, x: float, y: float) -> bool:
        """Whether a point lies in the room, its edge included."""
        inside = self.x0 <= x <= self.x1 and self.y0 <= y <= self.y1
        return inside and (self._floor is None or bool(self._floor.covers(np.array(x), np.array(y))))

    def covers(self, x: Array, y: Array, inset: float = 0.0) -> NDArray[np.bool_]:
        """Which points lie in the room, at least `inset` metres from its edge; any shape in, same out."""
        if self._floor:
            return self._floor.covers(x, y, inset)
        b = self.bounds.grown(-inset)
        return np.asarray((x >= b.x0) & (x <= b.x1) & (y >= b.y0) & (y <= b.y1))

    def distance(self, x: float, y: float) -> float:
        """Distance from a point to the room; 0 inside."""
        return float(self._floor.away(np.array(x), np.array(y))) if self._floor else self.bounds.distance(x, y)

    def depth(self, x: Array, y: Array) -> Array:
        """Distance of each point in the room to its edge; not above 0 outside; any shape in, same out."""
        if self._floor:
            return self._floor.depth(x, y)
        return np.asarray(np.minimum.reduce([x - self.x0, self.x1 - x, y - self.y0, self.y1 - y]))

    def away(self, x: Array, y: Array) -> Array:
        """Distance of each point to the room; any shape in, same out."""
        if self._floor:
            return self._floor.away(x, y)
        out_x = np.maximum(np.maximum(self.x0 - x, x - self.x1), 0.0)
        return np.hypot(out_x, np.maximum(np.maximum(self.y0 - y, y - self.y1), 0.0))

    def encloses(self, bounds: Bounds, slack: float = 0.0) -> bool:
        """Whether a rectangle lies within the room, or sticks out by no more than `slack` metres."""
        return self.bounds.encloses(bounds, slack) and (self._floor is None or self._floor.encloses(bounds, slack))

    def overlaps(self, other: Room, margin: float) -> bool:
        """Whether two rooms share more than a strip of `margin` metres."""
        if not self.bounds.overlaps(other.bounds, -margin):
            return False
        if self._floor is None and other._floor is None:
            return True
        from coopera.simulation.homes.polygon import Polygon  # noqa: PLC0415 - most homes have no polygon

        return (self._floor or Polygon(self.outline)).overlaps(other._floor or Polygon(other.outline), margin)

    def corners(self, inset: float) -> list[Point]:
        """The corners of what lies at least `inset` metres from the edge."""
        if self._floor:
            return self._floor.corners(inset)
        b = self.bounds.grown(-inset)
        return list(product((b.x0, b.x1), (b.y0, b.y1)))

    def rectangles(self) -> list[Bounds]:
        """Upright rectangles that cover the floor: exactly, but at slanted edges."""
        return self._floor.rectangles() if self._floor else [self.bounds]

    def outside(self, around: Bounds, by: float) -> list[Bounds]:
        """Upright rectangles that cover what of `around` lies outside; of a rectangle, all that is `by` metres near."""
        if self._floor:
            return self._floor.outside(around)
        r, out = self.bounds, self.bounds.grown(by)
        return [out._replace(x1=r.x0), out._replace(x0=r.x1), out._replace(y1=r.y0), out._replace(y0=r.y1)]

    def triangles(self, cell: float) -> Array | None:
        """Triangles that cover a polygon, shape (n, 3, 2), counter-clockwise, none wider than a cell; else None."""
        return self._floor.triangles(cell) if self._floor else None
