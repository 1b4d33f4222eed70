"""Readers of meshes of robots and homes that others made, and of Habitat data sets, for `benchmarks.fuzz`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import trimesh

from benchmarks.fuzzing import mutations as change
from benchmarks.fuzzing.kit import ROOT, Reader, Target, of_file
from coopera.simulation.drawing.files import read_solid
from coopera.simulation.homes.mesh_files import read_mesh
from coopera.simulation.making.habitat.files import Folder
from tests.simulation.synthetic_habitat import SCENE, SMALL, obj, write_habitat


def _box(kind: str) -> bytes:
    made = trimesh.creation.box((1, 0.5, 0.3)).export(file_type=kind)
    return made.encode() if isinstance(made, str) else bytes(made)


def _gltf(folder: Path) -> Target:
    parts = trimesh.Scene(trimesh.creation.box((1, 0.5, 0.3))).export(file_type="gltf")
    for name, data in parts.items():
        (folder / name).write_bytes(data)
    path = folder / "model.gltf"
    return Target(path, [path.read_bytes()], lambda: read_mesh(path))


def _ply() -> list[bytes]:
    made = trimesh.creation.box((1, 0.5, 0.3)).export(file_type="ply", encoding="ascii")
    return [_box("ply"), made.encode() if isinstance(made, str) else bytes(made)]


def _robot_part(name: str, seeds: Sequence[bytes]) -> Callable[[Path], Target]:
    return of_file(name, seeds, read_solid.__wrapped__)


def _habitat(name: str) -> Callable[[Path], Target]:
    def ready(folder: Path) -> Target:
        root = write_habitat(folder / "habitat")
        obj(root / "objects/alone.obj", SMALL["mug"])
        return Target(root / name, [(root / name).read_bytes()], lambda: _read_habitat(root))

    return ready


def _read_habitat(root: Path) -> object:
    found = Folder(root)
    scene, made = found.scene(SCENE), list[object]()
    for number, one in enumerate(scene.object_instances):
        try:
            made.append((found.template(SCENE, number, one.template_name), found.with_origin(SCENE, one).by_mass))
        except FileNotFoundError as err:  # a sentence for the user, who may leave such things out
            made.append(str(err))
    return made, found.stage(SCENE)


_BALL = (ROOT / "simulation/bodies/ball.obj").read_bytes()

READERS: dict[str, Reader] = {
    "habitat-data-set": Reader(_habitat("flat.scene_dataset_config.json"), change.in_json),
    "habitat-lexicon": Reader(_habitat("configs/ssd/flat_semantic_lexicon.json"), change.in_json),
    "habitat-scene": Reader(_habitat(f"configs/scenes/{SCENE}.scene_instance.json"), change.in_json),
    "habitat-stage": Reader(_habitat("configs/stages/flat_stage.stage_config.json"), change.in_json),
    "mesh-gltf": Reader(_gltf, change.in_json),
    "mesh-obj": Reader(of_file("thing.obj", [_box("obj")], read_mesh), change.anywhere),
    "mesh-ply": Reader(of_file("thing.ply", _ply(), read_mesh), change.anywhere),
    "mesh-stl": Reader(of_file("thing.stl", [_box("stl"), _box("stl_ascii")], read_mesh), change.anywhere),
    "robot-obj": Reader(_robot_part("part.obj", [_box("obj"), _BALL[:2000]]), change.anywhere),
    "robot-stl": Reader(_robot_part("part.stl", [_box("stl"), _box("stl_ascii")]), change.anywhere),
}
