"""The data card of a set of homes: what is in it, how it was made, what it is good for; as JSON and in words."""

from __future__ import annotations

import statistics
from collections import Counter
from collections.abc import Sequence
from typing import Any

from coopera.core.version import __version__
from coopera.homes.stored import figures
from coopera.simulation.homes.categories import DYNAMIC, STATIC
from coopera.simulation.homes.scene import Scene

PAPER = {"homes": 5, "rooms": [4, 11], "fixed": [51, 140], "movable": [33, 94], "categories": 32}
"""PAPER App. B: its five homes of HSSD, from the least to the most."""


def card_of(homes: Sequence[Scene], id: str, command: str) -> dict[str, Any]:
    """The card of some homes that one command made, as plain data."""
    rows = [figures(home) for home in homes]
    rooms = [room for home in homes for room in home.rooms]
    categories = Counter(thing.category for home in homes for thing in home.objects)
    return {
        "name": id,
        "made_by": f"coopera {__version__}",
        "command": command,
        "licence": "Apache-2.0",
        "seeds": [home.seed for home in homes],
        "homes": len(homes),
        "ranges": {
            what: _range([row[what] for row in rows]) for what in ("rooms", "square_metres", "fixed", "movable")
        },
        "rooms": {
            "all": len(rooms),
            "by_kind": dict(Counter(room.kind for room in rooms).most_common()),
            "no_rectangles": sum(room.polygon is not None for room in rooms),
            "with_slanted_walls": sum(any(edge.wall.rise for edge in room.edges) for room in rooms),
            "homes_with_a_polygon": sum(any(room.polygon is not None for room in home.rooms) for home in homes),
        },
        "objects": {
            "fixed": sum(row["fixed"] for row in rows),
            "movable": sum(row["movable"] for row in rows),
            "classes": len({thing.cls for home in homes for thing in home.objects}),
            "by_category": dict(categories.most_common()),
        },
        "paper": PAPER,
    }


def _range(values: Sequence[float]) -> dict[str, float]:
    return {"least": min(values), "median": statistics.median(values), "most": max(values)}


def in_words(card: dict[str, Any]) -> str:
    """The card as Markdown."""
    ranges, rooms, objects, paper = card["ranges"], card["rooms"], card["objects"], card["paper"]

    def row(what: str, key: str) -> str:
        one, theirs = ranges[key], paper.get(key)
        said = f"{theirs[0]} to {theirs[1]}" if theirs else "not said"
        return f"| {what} | {one['least']:g} to {one['most']:g} (median {one['median']:g}) | {said} |"

    known = [name for name in objects["by_category"] if name in (*DYNAMIC, *STATIC)]
    lines = [
        f"# {card['name']}: {card['homes']} homes",
        "",
        f"Homes that were generated from seeds by {card['made_by']}: `{card['command']}`. The same command gives the "
        "same files. Licence: Apache-2.0, as that of coopera; nothing in them was taken from elsewhere.",
        "",
        "Rooms are drawn by kind, laid out, given corners of their neighbours or cut off at the home's corners, and "
        "furnished so that all can be walked up to; then things are put where they belong. Each home passed `coopera "
        "scenes check`: both bodies get to every thing and take it. A draw that did not pass was drawn again.",
        "",
        "| of a home | here | the paper's homes |",
        "|---|---|---|",
        f"| homes | {card['homes']} | {paper['homes']} |",
        row("rooms", "rooms"),
        row("floor, square metres", "square_metres"),
        row("fixed objects", "fixed"),
        row("movable objects", "movable"),
        f"| super-categories | {len(known)} in all | {paper['categories']} in all |",
        "",
        f"{rooms['all']} rooms, of which {rooms['no_rectangles']} are no rectangles and {rooms['with_slanted_walls']} "
        f"have slanted walls; {rooms['homes_with_a_polygon']} homes have such a room. {objects['fixed']} fixed and "
        f"{objects['movable']} movable objects of {objects['classes']} classes.",
        "",
        "| kind of room | rooms |",
        "|---|---|",
        *(f"| {kind} | {count} |" for kind, count in rooms["by_kind"].items()),
        "",
        "| super-category | objects |",
        "|---|---|",
        *(f"| {name} | {count} |" for name, count in objects["by_category"].items()),
        "",
        "Good for: training and testing a robot's learner on homes that differ in plan, size and content. Not good "
        "for: claims about real homes. The classes are those of coopera's catalogue, no furniture stands aslant, and "
        "every home has one storey.",
    ]
    return "\n".join(lines) + "\n"
