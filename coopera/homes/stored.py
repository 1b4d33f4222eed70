"""Homes as a user handles them: found by id, looked at in figures, stored in the data folder, imported into it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from coopera.config.files import write_output
from coopera.core.errors import ConfigError
from coopera.simulation.homes.scene import Scene, dump_scene, list_scenes, load_scene
from coopera.studies.own_files import meshes_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

_INSTANCE = ".scene_instance.json"


class Arrival(NamedTuple):
    """An imported home: its file, the parts left out, and the problems found by `prove`."""

    scene: Scene
    file: Path
    skipped: list[str]
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
    """Import homes into a folder: scenes of an HSSD folder, or one home that a person wrote as JSON.

    Args:
        path: An HSSD folder, one of its files scenes/<id>.scene_instance.json, or a home's JSON file.
        folder: Where the homes are stored, each with <id>.import.txt, which says what was left out.
        scenes: Which scenes of an HSSD folder; all without it.
        skip_missing: Leave out what refers to a missing file, instead of refusing the scene.
        force: Replace homes that are there already.

    Raises:
        ConfigError: If something is wrong with it; names file and field.
    """
    from coopera.simulation.making.proof import prove  # noqa: PLC0415  (slow to import)

    if not path.exists():
        raise ConfigError(f"{path}: there is no such file or folder.")
    if path.is_file() and not path.name.endswith(_INSTANCE):
        home = load_scene(path)
        return [_arrive(home, [], prove(home), folder, meshes=meshes_of(home), force=force)]
    from coopera.simulation.making.hssd.files import Folder  # noqa: PLC0415
    from coopera.simulation.making.hssd.homes import import_scene  # noqa: PLC0415

    hssd = Folder(path if path.is_dir() else path.parent.parent)
    known = hssd.ids()
    wanted = list(scenes) or ([path.name.removesuffix(_INSTANCE)] if path.is_file() else known)
    if not wanted:
        raise ConfigError(f"{path / 'scenes'}: there is no file <id>{_INSTANCE}.")
    unknown = sorted(set(wanted) - set(known))
    if unknown:
        raise ConfigError(f"{path}: there is no scene {unknown[0]!r} (known are {', '.join(known[:12]) or 'none'}).")
    arrivals = []
    for name in wanted:
        found = import_scene(hssd, name, skip_missing=skip_missing)
        skipped = [f"{item.what}: {item.why}" for item in found.skipped]
        arrivals.append(_arrive(found.scene, skipped, found.problems, folder, meshes=found.meshes, force=force))
    return arrivals


def _arrive(
    scene: Scene, skipped: list[str], problems: list[str], folder: Path, *, meshes: dict[str, str], force: bool
) -> Arrival:
    file = place_for(scene.id, folder, force=force)
    for name, text in meshes.items():
        write_output(folder / f"{scene.id}.meshes" / name, text)
    write_output(file, dump_scene(scene))
    lines = [f"left out: {line}" for line in skipped] + [f"problem: {line}" for line in problems]
    write_output(
        folder / f"{scene.id}.import.txt", "".join(f"{line}\n" for line in lines) or "Everything was taken over.\n"
    )
    return Arrival(scene, file, skipped, problems)
