"""Whether a household file speaks of what the homes have: furniture, things, and motions that a body can make."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from coopera.models.offline.household.knowledge import Household
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.scene import list_scenes, load_scene
from coopera.simulation.motions.library import load_library


class Words(NamedTuple):
    """The words that homes and bodies understand: classes of furniture and of things, captions and their classes."""

    fixed: Collection[str]
    movable: Collection[str]
    motions: dict[str, str]


def words_of_homes(folders: Sequence[Path] = ()) -> Words:
    """The words of the catalogue, of the homes in some folders, and of the shipped motions."""
    homes = [load_scene(scene, folders) for scene in list_scenes(folders)] if folders else []
    known, library = catalogue(), load_library()
    return Words(
        fixed={*known.fixed, *(thing.cls for home in homes for thing in home.fixed)},
        movable={*known.movable, *(thing.cls for home in homes for thing in home.movable)},
        motions={caption: library[caption].cls for caption in library.captions},
    )


def strange_words(household: Household, words: Words) -> Iterator[str]:
    """Say what no home has or no body can do; a person can still live by it, but less well than was meant."""
    for activity in household.activities:
        spots = {spot: "places" for _, spot in activity.places} | dict.fromkeys(activity.fixed, "fixed")
        for spot, field in sorted(spots.items()):
            if spot not in words.fixed:
                yield _strange(
                    f"activity {activity.id!r}, field {field!r}", "home has the furniture", spot, words.fixed
                )
        for thing in sorted({thing for thing, _ in activity.places} - set(words.movable)):
            yield _strange(f"activity {activity.id!r}, field 'places'", "home has the thing", thing, words.movable)
    for motion, looks in household.looks_like.items():
        if motion not in words.motions:
            yield _strange("field 'looks_like'", "body makes the motion", motion, words.motions)
        elif looks != words.motions[motion]:
            yield f"field 'looks_like': {motion!r} looks like {words.motions[motion]!r}, not like {looks!r}"


def _strange(where: str, what: str, word: str, known: Collection[str]) -> str:
    near = difflib.get_close_matches(word, sorted(known), n=1)
    return f"{where}: no {what} {word!r}" + (f"; did you mean {near[0]!r}?" if near else "")
