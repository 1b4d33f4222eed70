"""Homes made from seeds and stored: one, or many with a card that says what they are."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from coopera.config.files import write_output
from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_json
from coopera.homes.card import card_of, in_words
from coopera.homes.stored import place_for
from coopera.simulation.homes.scene import Scene, dump_scene, load_scene


class Wanted(NamedTuple):
    """What homes are asked for: how many rooms and movable things each has; None leaves it to the seed."""

    rooms: int | None = None
    things: int | None = None

    def flags(self) -> str:
        """As the command line has it."""
        return "".join(f" --{name} {value}" for name, value in self._asdict().items() if value is not None)


class Made(NamedTuple):
    """Many homes, their files in the same order, and the card (Markdown; JSON beside it)."""

    homes: list[Scene]
    files: list[Path]
    card: Path


_ANY = Wanted()


def make_one(
    rooms: int, seed: int, id: str, folder: Path, *, things: int | None = None, force: bool = False
) -> tuple[Scene, Path, list[str]]:
    """Make and store one home; returns it, its file and its problems.

    Raises:
        ConfigError: If it cannot be, or is there already.
    """
    from coopera.simulation.making.generate import generate_proved  # noqa: PLC0415 - heavy

    file = place_for(id, folder, force=force)
    home, problems = generate_proved(seed, rooms, id, things=things)
    write_output(file, dump_scene(home))
    return home, file, problems


def make_many(
    count: int,
    seed: int,
    id: str,
    folder: Path,
    *,
    wanted: Wanted = _ANY,
    force: bool = False,
    say: Callable[[str], None] = print,
) -> Made:
    """Make homes that differ and have no problem, from one seed each, `seed` on; each is stored as soon as it is made.

    Args:
        count: How many.
        seed: Of the first.
        id: What they are called before their number, and the card.
        folder: Where homes are stored; the card lies beside this folder.
        wanted: Rooms and things of each; else 3 to 11 rooms, and about 8 things for each room.
        force: Replace homes that are there already; else those of the same command, whatever its count, are kept, so
            that it goes on where it was ended. The card's JSON says whose they are, and is there first.
        say: Told what is done.

    Raises:
        ConfigError: If there are too many, an id cannot be, or another home is there: nothing is written then.
        SimulationError: If a seed gives no home without a problem.
    """
    from coopera.simulation.making.varied import MOST_HOMES, varied  # noqa: PLC0415 - heavy

    if not 1 <= count <= MOST_HOMES:
        raise ConfigError(f"--count must be from 1 to {MOST_HOMES}, not {count}.")
    ids = [f"{id}-{number:04d}" for number in range(count)]
    command = f"coopera scenes generate --count {count} --seed {seed} --id {id}{wanted.flags()}"
    begun = folder.parent / f"{id}.card.json"
    kept = {} if force or not _same(begun, command) else _kept(ids, seed, folder)
    files = [folder / f"{one}.json" if one in kept else place_for(one, folder, force=force) for one in ids]
    homes = []
    for number, (name, file) in enumerate(zip(ids, files, strict=True)):
        home = kept.get(name) or varied(seed + number, name, rooms=wanted.rooms, things=wanted.things)
        if name not in kept:
            if not _same(begun, command):
                write_output(begun, json.dumps({"command": command}) + "\n")
            write_output(file, dump_scene(home))
        homes.append(home)
        say(f"{name}: {len(home.rooms)} rooms, {len(home.fixed)} fixed and {len(home.movable)} movable objects")
    card = card_of(homes, id, command)
    write_output(begun, json.dumps(card, indent=1) + "\n")
    write_output(folder.parent / f"{id}.card.md", in_words(card))
    return Made(homes, files, folder.parent / f"{id}.card.md")


def _same(card: Path, command: str) -> bool:
    """Whether a card is of this command, whatever its count."""
    if not card.is_file():
        return False
    told = read_json(card, "card of homes")
    before = str(told.get("command")) if isinstance(told, dict) else ""
    return before.partition(" --seed ")[2] == command.partition(" --seed ")[2]


def _kept(ids: Sequence[str], seed: int, folder: Path) -> dict[str, Scene]:
    """The homes that are there, each from its seed."""
    there = {name: folder / f"{name}.json" for name in ids}
    found = {name: load_scene(file) for name, file in there.items() if file.is_file()}
    return {
        name: home
        for number, name in enumerate(ids)
        if (home := found.get(name)) is not None and home.seed == seed + number
    }
