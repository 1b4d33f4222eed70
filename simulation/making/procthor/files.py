"""The files of ProcTHOR as they are published: a house, and the database that says how large each asset is.

Lengths are metres, in Unity's frame: left-handed, y up, so that (x, z) is the floor plan. A hole in a wall is measured
along it, from the first of the wall's lower corners. https://procthor.allenai.org
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_json as read_any_json
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.rooms import MOST_CORNERS
from coopera.simulation.homes.scene import MOST_ROOMS, MOST_THINGS
from coopera.simulation.homes.untrusted import Loose, read_json

Length = Annotated[float, Field(ge=-1e4, le=1e4)]
Near = Annotated[float, Field(ge=-90, le=90)]
"""A home of ours reaches 100 m from its origin; parts of things may stand beside their places."""
Text = Annotated[str, Field(max_length=200)]
MOST_ASSETS = 100_000


class Vector(Loose):
    """A place, or turns about the three axes in degrees."""

    x: Length = 0.0
    y: Length = 0.0
    z: Length = 0.0

    @property
    def plan(self) -> Point:
        """The place on our floor plan: seen from above both frames look alike."""
        return round(self.x, 4), round(self.z, 4)


class Place(Vector):
    """A place in a home."""

    x: Near = 0.0
    z: Near = 0.0


class Item(Loose):
    """An object, and what lies in or on it; `position` is the middle of its box, and not relative to its parent."""

    id: Text = ""
    asset: Text = Field(alias="assetId")
    position: Place
    rotation: Vector = Vector()
    children: list[Item] = Field([], max_length=MOST_THINGS)


class RoomRow(Loose):
    """A room."""

    id: Text
    kind: Text = Field(alias="roomType", min_length=1)
    corners: list[Place] = Field(alias="floorPolygon", min_length=3, max_length=MOST_CORNERS)


class WallRow(Loose):
    """One side of a wall; `empty` where nothing stands."""

    id: Text
    room: Text = Field("", alias="roomId")
    corners: list[Place] = Field(alias="polygon", min_length=2, max_length=16)
    empty: bool = False

    @property
    def foot(self) -> tuple[Point, Point]:
        """Where it begins and ends on the floor."""
        first, second = sorted(self.corners, key=lambda corner: corner.y)[:2]
        return first.plan, second.plan


class _Span(Loose):
    min: Vector
    max: Vector


class Hole(Loose):
    """A door or a window: a hole in a wall, measured along it."""

    id: Text = ""
    room0: Text | None = None
    room1: Text | None = None
    wall0: Text | None = None
    hole: list[Vector] = Field([], alias="holePolygon", max_length=16)
    box: _Span | None = Field(None, alias="boundingBox")

    @property
    def along(self) -> tuple[float, float] | None:
        """Where it begins and ends, in metres along the wall; None where that is not said."""
        ends = [corner.x for corner in self.hole] or ([self.box.min.x, self.box.max.x] if self.box else [])
        return (min(ends), max(ends)) if ends else None


class House(Loose):
    """A house."""

    rooms: list[RoomRow] = Field(min_length=1, max_length=MOST_ROOMS)
    walls: list[WallRow] = Field([], max_length=MOST_THINGS)
    doors: list[Hole] = Field([], max_length=MOST_THINGS)
    windows: list[Hole] = Field([], max_length=MOST_THINGS)
    objects: list[Item] = Field([], max_length=MOST_THINGS)

    def items(self) -> Iterator[Item]:
        """All objects, parents before their children."""
        left = list(reversed(self.objects))
        while left:
            item = left.pop()
            yield item
            left.extend(reversed(item.children))


class _Box(Loose):
    x: float = Field(gt=0, le=50)
    y: float = Field(gt=0, le=50)
    z: float = Field(gt=0, le=50)


class Asset(Loose):
    """What the database says of an asset: its type, and its box in its own frame."""

    type: Text = Field("", alias="objectType")
    box: _Box | None = Field(None, alias="boundingBox")


def is_house(data: Any) -> bool:
    """Whether JSON is meant as a house of ProcTHOR."""
    rooms = data.get("rooms") if isinstance(data, dict) else None
    first = rooms[0] if isinstance(rooms, list) and rooms else None
    return isinstance(data, dict) and (
        "proceduralParameters" in data or (isinstance(first, dict) and ("floorPolygon" in first or "roomType" in first))
    )


def read_house(path: Path) -> House:
    """Read a house.

    Raises:
        ConfigError: If it cannot be read or is none; names file and field.
    """
    house = read_json(path, House)
    count = sum(1 for _ in house.items())
    if count > MOST_THINGS:
        raise ConfigError(f"{path}, field objects: a home holds at most {MOST_THINGS} objects, not {count}.")
    return house


def read_assets(path: Path) -> dict[str, Asset]:
    """Read an asset database: lists of assets by type, one list, or assets by id; returns them by id.

    Raises:
        ConfigError: If it cannot be read or is none; names the file.
    """
    data = read_any_json(path, "asset database")
    rows: list[Any] = []
    for key, value in data.items() if isinstance(data, dict) else [("", data)]:
        for row in value if isinstance(value, list) else [value]:
            if isinstance(row, dict):
                rows.append({"assetId": key, **row})
    found = {str(row["assetId"]): row for row in rows if "boundingBox" in row}
    if not found:
        raise ConfigError(f"{path}: this is no asset database, for no asset in it has an assetId and a boundingBox.")
    if len(found) > MOST_ASSETS:
        raise ConfigError(f"{path}: an asset database holds at most {MOST_ASSETS} assets, not {len(found)}.")
    try:
        return {name: Asset.model_validate(row) for name, row in found.items()}
    except ValueError as err:
        raise ConfigError(f"{path}: an asset's boundingBox must have x, y and z in metres, above 0.") from err
