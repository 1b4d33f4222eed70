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


DAE = b"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><created>2026-01-01T00:00:00</created><unit meter="0.01" name="cm"/><up_axis>Z_UP</up_axis></asset>
  <library_images><image id="wood"><init_from>wood.png</init_from></image></library_images>
  <library_effects><effect id="paint"><profile_COMMON>
    <newparam sid="at"><surface type="2D"><init_from>wood</init_from></surface></newparam>
    <newparam sid="by"><sampler2D><source>at</source></sampler2D></newparam>
    <technique sid="common"><phong><diffuse><texture texture="by" texcoord="UV"/></diffuse>
      <transparent><color>1 1 1 1</color></transparent><shininess><float>20</float></shininess></phong></technique>
  </profile_COMMON></effect></library_effects>
  <library_materials><material id="oak"><instance_effect url="#paint"/></material></library_materials>
  <library_geometries><geometry id="wedge"><mesh>
    <source id="places"><float_array id="numbers" count="15">0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 1</float_array>
      <technique_common><accessor source="#numbers" count="5" stride="3"><param name="X" type="float"/>
        <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
    <source id="flats"><float_array id="parts" count="4">0 0 1 1</float_array><technique_common>
      <accessor source="#parts" count="2" stride="2"><param name="S" type="float"/><param name="T" type="float"/>
      </accessor></technique_common></source>
    <vertices id="all"><input semantic="POSITION" source="#places"/></vertices>
    <triangles material="skin" count="2"><input semantic="VERTEX" source="#all" offset="0"/>
      <input semantic="TEXCOORD" source="#flats" offset="1" set="0"/><p>0 0 1 1 4 0 1 0 2 1 4 0</p></triangles>
    <polylist count="2"><input semantic="VERTEX" source="#all" offset="0"/><vcount>4 3</vcount>
      <p>3 2 1 0 2 3 4</p></polylist>
    <polygons count="1"><input semantic="VERTEX" source="#all" offset="0"/><p>3 0 4</p></polygons>
  </mesh></geometry></library_geometries>
  <library_nodes><node id="pair"><rotate>0 0 1 90</rotate><instance_geometry url="#wedge"/></node></library_nodes>
  <library_visual_scenes><visual_scene id="view"><node id="part"><matrix>1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1</matrix>
    <node><translate>1 0 0</translate><scale>1 2 1</scale><instance_node url="#pair"/></node>
    <instance_geometry url="#wedge"><bind_material><technique_common><instance_material symbol="skin" target="#oak"/>
      </technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#view"/></scene>
</COLLADA>
"""
"""A wedge that is shown twice, of each kind of faces, with a texture: COLLADA as exporters write it."""
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
    "robot-dae": Reader(_robot_part("part.dae", [DAE]), change.in_xml),
    "robot-obj": Reader(_robot_part("part.obj", [_box("obj"), _BALL[:2000]]), change.anywhere),
    "robot-stl": Reader(_robot_part("part.stl", [_box("stl"), _box("stl_ascii")]), change.anywhere),
}
