"""People and homes that a run is given as files, in place of ids from a catalogue."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from coopera.config.schema import Config, Files
from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.people.shipped import read_persona
from coopera.simulation.homes.scene import Scene, dump_scene, load_scene


def names_file(name: str) -> bool:
    """Whether a name is the path of a file: no id has a dot or a slash."""
    return any(sign in name for sign in "./\\~")


def by_id(config: Config) -> Config:
    """Call people and homes that are given as files by the ids in these, and keep in `files` where they are.

    Raises:
        ConfigError: If a file cannot be used, or its id is that of another one who takes part.
    """
    people = [*(config.humans or []), *(person for person, _ in config.schedule or [])]
    homes = [*(config.scenes or []), *(home for _, home in config.schedule or [])]
    persons = _ids("humans", people, _person)
    scenes = _ids("scenes", homes, lambda path: load_scene(path).id)
    if not persons and not scenes:
        return config
    given = {
        "humans": config.files.humans | dict(persons.values()),
        "scenes": config.files.scenes | dict(scenes.values()),
    }

    def person(name: str) -> str:
        return persons[name][0] if name in persons else name

    def home(name: str) -> str:
        return scenes[name][0] if name in scenes else name

    return config.model_copy(
        update={
            "humans": config.humans and [person(name) for name in config.humans],
            "scenes": config.scenes and [home(name) for name in config.scenes],
            "schedule": config.schedule and [(person(who), home(where)) for who, where in config.schedule],
            "files": Files.model_validate(given),
        }
    )


def home_files(scene: Scene) -> dict[str, str]:
    """What a home is stored as, by name: <id>.json, and its meshes in <id>.meshes/."""
    meshes = {f"{scene.id}.meshes/{name}": text for name, text in meshes_of(scene).items()}
    return meshes | {f"{scene.id}.json": dump_scene(scene)}


def meshes_of(scene: Scene) -> dict[str, str]:
    """The files of a home's meshes, by their names."""
    names = {part.file for thing in scene.objects for part in thing.mesh}
    folder = scene.meshes
    return {} if folder is None else {name: read_text(folder / name, "mesh") for name in sorted(names)}


def _ids(field: str, names: Iterable[str], id_in: Callable[[Path], str]) -> dict[str, tuple[str, Path]]:
    """The id and the place of each name that is a file."""
    every = list(dict.fromkeys(names))
    found = {name: Path(name).expanduser().resolve() for name in every if names_file(name)}
    ids = {name: (id_in(path), path) for name, path in found.items()}
    owners: dict[str, str] = {name: name for name in every if name not in ids}
    for name, (id, path) in ids.items():
        other = owners.setdefault(id, name)
        if other != name and found.get(other) != path:
            raise ConfigError(f"{field}: {name} and {other} are both called {id!r}; give one of them another id.")
    return ids


def _person(path: Path) -> str:
    if path.suffix.lower() == ".csv":
        raise ConfigError(f"humans: {path} is a table; `coopera humans import {path}` makes people of it.")
    return read_persona(path).id
