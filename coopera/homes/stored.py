"""Homes as a user handles them: found by id, looked at in figures, stored in the data folder, imported into it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from coopera.config.files import write_output
from coopera.config.schema import default_data_dir
from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_json
from coopera.simulation.homes.scene import Scene, dump_scene, list_scenes, load_scene
from coopera.studies.own_files import meshes_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from coopera.simulation.making.report import Imported

_INSTANCE = ".scene_instance.json"
_DATASET = ".scene_dataset_config.json"
_NEAR = 0.5
"""Names whose cosine to a class of ours is less mean something else."""


class Told(NamedTuple):
    """What an import says: what was left out, the problems found by `prove`, what was understood, what was guessed."""

    skipped: Sequence[str]
    problems: Sequence[str]
    understood: Sequence[str] = ()
    guessed: Sequence[str] = ()

    @classmethod
    def of(cls, found: Imported) -> Told:
        """What an importer says."""
        said = found.report
        return cls(said.left_out, found.problems, said.understood, said.guessed)

    def lines(self) -> list[str]:
        """All of it, a sentence each."""
        kinds = {"understood": self.understood, "guessed": self.guessed}
        kinds |= {"left out": self.skipped, "problem": self.problems}
        return [f"{kind}: {line}" for kind, told in kinds.items() for line in told]


class Arrival(NamedTuple):
    """An imported home, its file, and what the import says."""

    scene: Scene
    file: Path
    told: Told


def figures(scene: Scene) -> dict[str, Any]:
    """How much there is of a home; `categories` counts its objects by super-category."""
    return {
        "id": scene.id,
        "rooms": len(scene.rooms),
        "fixed": len(scene.fixed),
        "movable": len(scene.movable),
        "square_metres": round(sum(room.area for room in scene.rooms)),
        "categories": dict(Counter(sorted(thing.category for thing in scene.objects))),
    }


def place_for(id: str, folder: Path, *, force: bool = False) -> Path:
    """Where a home of this id would be stored, <folder>/<id>.json.

    Raises:
        ConfigError: If it is the id of a shipped home, or of one that lies there already.
    """
    path = folder / f"{id}.json"
    if id in list_scenes():
        raise ConfigError(f"id: {id!r} is a home that ships with coopera; choose another id.")
    if path.exists() and not force:
        raise ConfigError(f"{path}: there is a home of this id already; --force replaces it.")
    return path


def write_picture(path: Path, pixels: NDArray[Any]) -> None:
    """Write pixels of shape (height, width, 3) as a picture in the format that the file's name says.

    Raises:
        ConfigError: If it cannot be written.
    """
    from PIL import Image  # noqa: PLC0415  (most commands draw nothing)

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(pixels).save(path)
    except (OSError, ValueError) as err:
        raise ConfigError(f"{path}: the picture cannot be written ({err}).") from err


def bring_in(
    path: Path,
    folder: Path,
    *,
    scenes: Sequence[str] = (),
    skip_missing: bool = False,
    force: bool = False,
    assets: Path | None = None,
) -> list[Arrival]:
    """Import homes into a folder: Habitat's scenes, a house of ProcTHOR, or a home that a person wrote as JSON.

    Args:
        path: A folder in Habitat's layout, its *.scene_dataset_config.json, one of its *.scene_instance.json, or a
            house's or a home's JSON file.
        folder: Where the homes are stored, each with <id>.import.txt, which is what the import says.
        scenes: Which scenes of a folder; all without it.
        skip_missing: Leave out what refers to a missing file, instead of refusing the scene.
        force: Replace homes that are there already.
        assets: ProcTHOR's asset database, which says how large its objects are.

    Raises:
        ConfigError: If something is wrong with it; names file and field. Nothing of that home is written then.
    """
    from coopera.simulation.making.proof import prove  # noqa: PLC0415  (slow to import)

    if not path.exists():
        raise ConfigError(f"{path}: there is no such file or folder.")
    if path.is_file() and not path.name.endswith((_INSTANCE, _DATASET)):
        house = _house(path, folder, assets, force=force)
        if house is not None:
            return [house]
        home = load_scene(path)
        if home.stage is None:
            _need_doors(home, path)
        return [_arrive(home, Told([], prove(home)), folder, meshes=meshes_of(home), force=force)]
    from coopera.simulation.making.habitat.files import Folder  # noqa: PLC0415
    from coopera.simulation.making.habitat.homes import import_scene, scene_id  # noqa: PLC0415

    dataset = Folder.around(path)
    known = dataset.ids()
    wanted = list(scenes) or ([path.name.removesuffix(_INSTANCE)] if path.name.endswith(_INSTANCE) else known)
    unknown = sorted(set(wanted) - set(known))
    if unknown:
        raise ConfigError(f"{path}: there is no scene {unknown[0]!r} (known are {', '.join(known[:12]) or 'none'}).")
    arrivals = []
    for name in wanted:
        place_for(scene_id(name), folder, force=force)
        found = import_scene(dataset, name, skip_missing=skip_missing, nearest=_nearest)
        arrivals.append(_arrive(found.scene, Told.of(found), folder, meshes=found.meshes, force=force))
    return arrivals


def _house(path: Path, folder: Path, assets: Path | None, *, force: bool) -> Arrival | None:
    """Import a file that is a house of ProcTHOR; None for any other."""
    from coopera.simulation.making.procthor.files import is_house, read_assets, read_house  # noqa: PLC0415

    if not is_house(read_json(path, "scene file")):
        if assets is not None:
            raise ConfigError(f"{path}: an asset database is for a house of ProcTHOR, which this is not.")
        return None
    from coopera.simulation.making.procthor.homes import import_house  # noqa: PLC0415

    id = "-".join(re.findall(r"[a-z0-9]+", path.name.lower().removesuffix(".json")))[:60] or "house"
    place_for(id, folder, force=force)
    found = import_house(read_house(path), id, path, read_assets(assets) if assets else None)
    return _arrive(found.scene, Told.of(found), folder, meshes=found.meshes, force=force)


def _need_doors(home: Scene, path: Path) -> None:
    reached = {name for door in home.doors for name in door.between}
    for number, room in enumerate(home.rooms):
        if len(home.rooms) > 1 and room.name not in reached:
            raise ConfigError(
                f"The scene file {path}, field rooms.{number}: no door leads into the room {room.name!r}."
            )


def _arrive(scene: Scene, told: Told, folder: Path, *, meshes: Mapping[str, str], force: bool) -> Arrival:
    file = place_for(scene.id, folder, force=force)
    for name, text in meshes.items():
        write_output(folder / f"{scene.id}.meshes" / name, text)
    write_output(file, dump_scene(scene))
    lines = told.lines() or ["Everything was taken over."]
    write_output(folder / f"{scene.id}.import.txt", "".join(f"{line}\n" for line in lines))
    return Arrival(scene, file, told)


def _nearest(text: str, words: tuple[str, ...]) -> tuple[str, float] | None:
    """The word that comes nearest to a text in meaning, by the bundled sentence encoder; None where none is near."""
    from coopera.memory import Search, bundled  # noqa: PLC0415  (some seconds, and most names are known words)

    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        word, cosine = Search(embeddings, words).top(text, 1)[0]
    return (word, cosine) if cosine >= _NEAR else None
