"""Homes as a user handles them: found by id, looked at in figures, stored in the data folder, imported into it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from coopera.config.files import write_output
from coopera.config.schema import default_data_dir
from coopera.core.errors import ConfigError
from coopera.simulation.homes.scene import Scene, dump_scene, list_scenes, load_scene
from coopera.simulation.making.report import KINDS, Said, lines_of
from coopera.studies.own_files import meshes_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

_INSTANCE = ".scene_instance.json"
_DATASET = ".scene_dataset_config.json"
_NEAR = 0.5
"""Names whose cosine to a class of ours is less mean something else."""


class Arrival(NamedTuple):
    """An imported home: its file, what its import reports, and the problems found by `prove`."""

    scene: Scene
    file: Path
    report: list[Said]
    problems: list[str]


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
    path: Path, folder: Path, *, scenes: Sequence[str] = (), skip_missing: bool = False, force: bool = False
) -> list[Arrival]:
    """Import homes into a folder: scenes of a Habitat data set, or one home that a person wrote as JSON.

    Args:
        path: A folder with a data set, its *.scene_dataset_config.json, one of its *.scene_instance.json, or a home's
            JSON file.
        folder: Where the homes are stored, each with <id>.import.txt, the report of its import.
        scenes: Which scenes of a data set; all without it.
        skip_missing: Leave out what refers to a missing file, instead of refusing the scene.
        force: Replace homes that are there already.

    Raises:
        ConfigError: If something is wrong with it; names file and field.
    """
    from coopera.simulation.making.proof import prove  # noqa: PLC0415  (slow to import)

    if not path.exists():
        raise ConfigError(f"{path}: there is no such file or folder.")
    if path.is_file() and not path.name.endswith((_INSTANCE, _DATASET)):
        home = load_scene(path)
        return [_arrive(home, [], prove(home), folder, meshes=meshes_of(home), force=force)]
    from coopera.simulation.making.habitat.files import Folder  # noqa: PLC0415
    from coopera.simulation.making.habitat.homes import import_scene  # noqa: PLC0415

    dataset = Folder.around(path)
    known = dataset.ids()
    wanted = list(scenes) or ([path.name.removesuffix(_INSTANCE)] if path.name.endswith(_INSTANCE) else known)
    unknown = sorted(set(wanted) - set(known))
    if unknown:
        raise ConfigError(f"{path}: there is no scene {unknown[0]!r} (known are {', '.join(known[:12]) or 'none'}).")
    arrivals = []
    for name in wanted:
        found = import_scene(dataset, name, skip_missing=skip_missing, nearest=_nearest)
        arrivals.append(_arrive(found.scene, found.report, found.problems, folder, meshes=found.meshes, force=force))
    return arrivals


def _arrive(
    scene: Scene, report: list[Said], problems: list[str], folder: Path, *, meshes: dict[str, str], force: bool
) -> Arrival:
    file = place_for(scene.id, folder, force=force)
    for name, text in meshes.items():
        write_output(folder / f"{scene.id}.meshes" / name, text)
    write_output(file, dump_scene(scene))
    lines = [line for kind in KINDS for line in lines_of(report, kind)] + [f"problem: {line}" for line in problems]
    write_output(
        folder / f"{scene.id}.import.txt", "".join(f"{line}\n" for line in lines) or "Everything was taken over.\n"
    )
    return Arrival(scene, file, report, problems)


def _nearest(text: str, words: tuple[str, ...]) -> tuple[str, float] | None:
    """The word that comes nearest to a text in meaning, by the bundled sentence encoder; None where none is near."""
    from coopera.memory import Search, bundled  # noqa: PLC0415  (some seconds, and most names are known words)

    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        word, cosine = Search(embeddings, words).top(text, 1)[0]
    return (word, cosine) if cosine >= _NEAR else None
