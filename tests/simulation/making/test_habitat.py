"""Homes in Habitat's general layout: what is read, what is guessed and said, and what is refused."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from coopera.cli import main
from coopera.core.errors import ConfigError
from coopera.simulation.homes.catalogue import interiors, surfaces
from coopera.simulation.homes.mesh_files import read_mesh
from coopera.simulation.making.habitat.files import Folder
from coopera.simulation.making.habitat.homes import import_scene
from coopera.simulation.making.habitat.names import Guesser
from coopera.simulation.making.report import Imported
from tests.simulation.synthetic_habitat import CUSHION, DESK, MATTRESS, SCENE, box, glb, obj, placed, write_habitat
from tests.simulation.synthetic_hssd import SCENE as HSSD_SCENE
from tests.simulation.synthetic_hssd import change, write_hssd, write_json

_SCENE = f"configs/scenes/{SCENE}.scene_instance.json"
_MUG = "configs/objects/frl_apartment_mug_01.object_config.json"
_GLB = "objects/frl_apartment_mug_01.glb"
_OBJ = "objects/frl_apartment_desk_01.obj"
_SET = "flat.scene_dataset_config.json"


@pytest.fixture
def flat(tmp_path: Path) -> Path:
    return write_habitat(tmp_path / "flat")


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> Imported:
    return import_scene(Folder(write_habitat(tmp_path_factory.mktemp("h") / "flat")), SCENE)


def test_a_home_without_semantics_is_understood_from_names_meshes_and_the_lexicon(imported: Imported) -> None:
    things = {thing.name: thing for thing in imported.scene.objects}
    assert {name for name, thing in things.items() if thing.fixed} == {
        *("bed_1", "sofa_1", "bookshelf_1", "dresser_1", "desk_1", "dining_chair_1"),
    }
    assert {name: thing.on for name, thing in things.items() if not thing.fixed} == {
        **{"mug_1": "desk_1", "laptop_1": "desk_1", "book_1": "bookshelf_1", "book_2": "bookshelf_1"},
        **{"apple_1": "dresser_1", "plate_1": "dresser_1", "water_bottle_1": "sofa_1"},
    }
    assert imported.problems == []
    (room,) = imported.scene.rooms
    assert room.bounds == (0.0, 0.0, 7.0, 6.0)


def test_the_report_says_what_was_understood_and_what_was_guessed(imported: Imported) -> None:
    understood, guessed = "\n".join(imported.report.understood), "\n".join(imported.report.guessed)
    assert f"one lies at {MATTRESS:.2f} m" in understood
    assert f"one sits at {CUSHION:.2f} m" in understood
    assert "dresser_1: carries things at 0.85 m; holds things at 0.09, 0.35, 0.62 m" in understood
    assert "dresser_1: taken for: dresser (the lexicon calls it 'chest of drawers')" in guessed
    assert "dining_chair_1: taken for: dining chair ('chair' in its name)" in guessed
    assert "no file tells regions, so all is one room" in guessed
    assert "laptop_1: moved by 1 cm so that it lies on the desk_1" in guessed


def test_a_thing_that_hovers_above_a_surface_is_put_onto_it(imported: Imported) -> None:
    laptop = imported.scene.object("laptop_1")
    assert laptop is not None
    assert laptop.position[2] == pytest.approx(DESK, abs=0.005)


def test_what_a_data_set_adds_to_its_templates_counts(flat: Path) -> None:
    """A template of its own, made from another one, with attributes above those of the file and of all."""
    entry = {
        "original_file": "configs/objects/frl_apartment_chair_01.object_config.json",
        "template_handle": "high_chair",
        "attributes": {"scale": [1, 1.5, 1]},
    }
    said = {"configs": [entry], "default_attributes": {"units_to_meters": 0.5}}
    change(flat, _SET, lambda data: data["objects"].update(said))
    change(flat, _SCENE, lambda data: data["object_instances"].append(placed("high_chair", 2.0, 4.0)))
    plain, high = (import_scene(Folder(flat), SCENE).scene.object(f"dining_chair_{n}") for n in (1, 2))
    assert plain is not None
    assert high is not None
    assert high.size[2] == pytest.approx(1.5 * plain.size[2], abs=1e-3)
    assert plain.size[2] == pytest.approx(0.475, abs=1e-3)


def test_a_template_is_found_by_a_part_of_its_name_as_in_habitat(flat: Path) -> None:
    change(flat, _SCENE, lambda data: data["object_instances"].append(placed("apartment_bed", 4.0, 3.0)))
    assert import_scene(Folder(flat), SCENE).scene.object("bed_2") is not None


def test_the_pose_of_a_stage_counts(flat: Path) -> None:
    def lift(data: dict[str, Any]) -> None:
        data["stage_instance"] = {"template_name": "flat_stage", "translation": [0.0, 0.5, 0.0]}
        for one in data["object_instances"]:
            one["translation"][1] += 0.5

    change(flat, _SCENE, lift)
    found = import_scene(Folder(flat), SCENE)
    bed = found.scene.object("bed_1")
    assert bed is not None
    assert bed.position[2] == pytest.approx(0.0, abs=1e-3)
    assert found.problems == []


def test_homes_of_hssd_need_no_table_of_objects_and_no_regions(tmp_path: Path) -> None:
    root = write_hssd(tmp_path / "hssd")
    (root / "semantics/objects.csv").unlink()
    (root / f"semantics/scenes/{HSSD_SCENE}.semantic_config.json").unlink()
    found = import_scene(Folder(root), HSSD_SCENE)
    assert [room.name for room in found.scene.rooms] == ["home"]
    assert {"bed_1", "dining_table_1"} <= {thing.name for thing in found.scene.fixed}
    assert any("'table' in its name" in line for line in found.report.guessed)


def test_a_region_that_is_no_rectangle_is_a_room_that_is_none(tmp_path: Path) -> None:
    root = write_hssd(tmp_path / "hssd")
    corner = [[0, 0, 0], [4.9, 0, 0], [4.9, 0, -2], [2, 0, -2], [2, 0, -4], [0, 0, -4]]
    file = f"semantics/scenes/{HSSD_SCENE}.semantic_config.json"
    change(root, file, lambda data: data["region_annotations"][0].update(poly_loop=corner))
    kitchen = import_scene(Folder(root), HSSD_SCENE).scene.room("kitchen")
    assert kitchen is not None
    assert kitchen.area == pytest.approx(4.9 * 2 + 2 * 2)
    assert not kitchen.contains(4.0, 3.0)


def test_a_word_that_nobody_knows_is_taken_for_the_nearest_in_meaning_if_its_size_fits() -> None:
    asked: list[str] = []

    def nearest(text: str, words: tuple[str, ...]) -> tuple[str, float]:
        asked.append(text)
        return "sofa", 0.71

    guesser = Guesser(["x_chesterfield_1", "x_bed", "x_mug", "x_chair"], nearest)
    guess = guesser.guess("x_chesterfield_1", "", (2.0, 0.9, 0.8))
    assert (guess.cls, guess.category) == ("sofa", "seating furniture")
    assert guess.why == "taken for: sofa, the class nearest in meaning (0.71)"
    assert asked == ["chesterfield"]
    assert guesser.guess("x_chesterfield_1", "", (0.2, 0.09, 0.08)).cls == "chesterfield"


def test_a_closed_fridge_gets_the_inside_of_its_class_and_this_is_said(flat: Path) -> None:
    glb(flat / "objects/fridge.glb", box((-0.35, 0.35), (-0.35, 0.35), (0, 1.8)))
    write_json(flat / "configs/objects/fridge.object_config.json", {"render_asset": "../../objects/fridge.glb"})
    change(flat, _SCENE, lambda data: data["object_instances"].append(placed("fridge", 6.0, 5.6, yaw=math.pi)))
    found = import_scene(Folder(flat), SCENE)
    fridge = found.scene.object("fridge_1")
    assert fridge is not None
    assert [surface.z for surface in surfaces(fridge)] == pytest.approx([1.8], abs=1e-3)
    assert len(interiors(fridge)) > 1
    assert any("fridge_1: its mesh is closed" in line for line in found.report.guessed)


def _truncate(name: str, size: int) -> Callable[[Path], Any]:
    return lambda root: os.truncate(root / name, size)


def _nan_glb(root: Path) -> None:
    corners, faces = box((0, 1), (0, 1), (0, 1))
    glb(root / _GLB, (np.where(corners == 1.0, np.nan, corners), faces))


def _text(name: str, text: str) -> Callable[[Path], Any]:
    return lambda root: (root / name).write_text(text)


def _asset(name: str) -> Callable[[Path], Any]:
    return lambda root: change(root, _MUG, lambda data: data.update(render_asset=name))


_BAD: list[tuple[Callable[[Path], Any], str]] = [
    (_nan_glb, r"mug_01\.glb, field accessors\.0: holds a number that is not finite"),
    (
        _text(_OBJ, "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        r"desk_01\.obj: the mesh holds a number that is",
    ),
    (_text(_OBJ, "v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), r"desk_01\.obj: the mesh is out of all bounds"),
    (_text(_OBJ, "v 0 0 0\nv 1 0 0\nf 1 2 9\n"), r"desk_01\.obj: the mesh"),
    (_text(_OBJ, "no mesh at all"), r"desk_01\.obj: the mesh"),
    (_truncate(_OBJ, 100 * 2**20), r"desk_01\.obj: the mesh has more than 64 MiB"),
    (lambda root: (root / _GLB).unlink(), r"render_asset: there is no file .*mug_01\.glb"),
    (_asset("../../../mug.glb"), r"render_asset: must name a file within"),
    (_asset("../../flat.scene_dataset_config.json"), r"config\.json: a mesh is a file of \.glb"),
    (_truncate(_SCENE, 100 * 2**20), r"scene_instance\.json: the file has more than 64 MiB|more than 64 MiB"),
    (_truncate(_SET, 100 * 2**20), r"scene_dataset_config\.json.* more than 64 MiB"),
    (_text(_SCENE, "[" * 100_000), "nested too deeply"),
    (_text(_SCENE, '{"object_instances": "many"}'), r"field object_instances: Input should be a valid list"),
    (_text(_MUG, "[1, 2]"), r"object_config\.json: a template is a JSON object"),
    (_text(_MUG, '{"render_asset": 7}'), r"field render_asset: Input should be a valid string"),
    (_text(_SET, '{"objects": {"configs": 7}}'), r"field objects\.configs: Input should be a valid list"),
    (_text(_SET, '{"objects": {"default_attributes": {"scale": [1, "big", 1]}}}'), r"field scale\.1: "),
]


@pytest.mark.parametrize(("spoil", "said"), _BAD)
def test_what_cannot_be_used_is_one_sentence_and_nothing_is_written(
    flat: Path, tmp_path: Path, spoil: Callable[[Path], Any], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    spoil(flat)
    out = tmp_path / "data"
    assert main(["scenes", "import", str(flat), "--out", str(out)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert re.search(said, line), line
    assert not out.exists()


def test_a_gltf_of_several_files_is_read_and_names_no_file_elsewhere(tmp_path: Path) -> None:
    written = trimesh.Trimesh(*box((0, 1), (0, 2), (0, 3)), process=False).export(file_type="gltf")
    for name, data in written.items():
        (tmp_path / name.replace("model", "box")).write_bytes(data)
    assert read_mesh(tmp_path / "box.gltf").corners.max(axis=0) == pytest.approx((1, 2, 3))
    document = json.loads((tmp_path / "box.gltf").read_text())
    for buffer in document["buffers"]:
        (tmp_path.parent / "elsewhere.bin").write_bytes((tmp_path / buffer["uri"]).read_bytes())
        buffer["uri"] = "../elsewhere.bin"
    (tmp_path / "box.gltf").write_text(json.dumps(document))
    with pytest.raises(ConfigError, match=r"box\.gltf: the mesh cannot be read"):
        read_mesh(tmp_path / "box.gltf")


def test_a_gltf_that_shows_one_mesh_a_thousand_times_is_refused_before_it_is_copied(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = trimesh.Scene()
    mesh = trimesh.creation.icosphere(subdivisions=4)
    for _ in range(1000):
        scene.add_geometry(mesh, geom_name="ball")
    for name, data in scene.export(file_type="gltf").items():
        (tmp_path / name.replace("model", "balls")).write_bytes(data)
    monkeypatch.setattr(trimesh.Scene, "dump", lambda *_: pytest.fail("copied"))
    with pytest.raises(ConfigError, match="more than 2000000 corners or triangles"):
        read_mesh(tmp_path / "balls.gltf")


@pytest.mark.parametrize(
    ("region", "said"),
    [
        ({"label": "hall", "poly_loop": [[0, 0, -6], [700, 0, -6], [700, 0, 0]]}, "region_annotations.0.poly_loop.1.0"),
        ({"label": "hall", "poly_loop": [[n / 99, 0, -6] for n in range(600)]}, "region_annotations.0.poly_loop"),
        ({"label": "hall", "min_bounds": [0, 0, -6], "max_bounds": [7, 1e9, 0]}, "region_annotations.0.max_bounds.1"),
    ],
)
def test_a_region_that_cannot_be_is_one_sentence(flat: Path, region: dict[str, object], said: str) -> None:
    write_json(flat / f"configs/scenes/{SCENE}.semantic_config.json", {"region_annotations": [region]})
    with pytest.raises(ConfigError, match=said):
        import_scene(Folder(flat), SCENE)


def test_a_region_with_a_long_name_is_a_room_with_a_shorter_one(flat: Path) -> None:
    halves = [
        {"label": "hall" * 30, "poly_loop": [[x, 0, -6], [x + 3.5, 0, -6], [x + 3.5, 0, 0], [x, 0, 0]]}
        for x in (0, 3.5)
    ]
    write_json(flat / f"configs/scenes/{SCENE}.semantic_config.json", {"region_annotations": halves})
    assert len({room.name for room in import_scene(Folder(flat), SCENE).scene.rooms}) == 2


@pytest.mark.parametrize("kind", ["ply", "stl", "obj"])
def test_meshes_of_other_formats_are_read_as_they_are(tmp_path: Path, kind: str) -> None:
    data = trimesh.Trimesh(*box((0, 1), (0, 2), (0, 3)), process=False).export(file_type=kind)
    (tmp_path / f"box.{kind}").write_bytes(data.encode() if isinstance(data, str) else data)
    mesh = read_mesh(tmp_path / f"box.{kind}")
    assert len(mesh.triangles) == 12
    assert mesh.corners.max(axis=0) == pytest.approx((1, 2, 3))


def test_what_a_mesh_lacks_leaves_no_traceback_in_the_terminal(tmp_path: Path) -> None:
    """trimesh does without a normal that is no number, and logs that as an error; nobody listens, so it is printed."""
    text = trimesh.Trimesh(*box((0, 1), (0, 2), (0, 3)), process=False).export(file_type="stl_ascii")
    (tmp_path / "box.stl").write_text(text.replace("facet normal", "facet normal x", 1))
    code = "import sys; from pathlib import Path; from coopera.simulation.homes.mesh_files import read_mesh; "
    code += "print(len(read_mesh(Path(sys.argv[1])).triangles))"
    command = [sys.executable, "-c", code, str(tmp_path / "box.stl")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("12\n", "")


def test_a_data_set_without_a_scene_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "stages").mkdir()
    obj(tmp_path / "stages/room.obj", box((0, 1), (0, 1), (0, 1)))
    assert main(["scenes", "import", str(tmp_path)]) == 2
    assert "there is no file <id>.scene_instance.json in this folder" in capsys.readouterr().err
