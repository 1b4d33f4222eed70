from __future__ import annotations

import json
import math
import os
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from coopera.core.errors import ConfigError
from coopera.simulation.homes.glb import read_glb
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.making.habitat.files import AssetConfig, CatalogueRow, Folder, Instance, Template
from coopera.simulation.making.habitat.homes import box_of, import_scene
from coopera.simulation.making.report import HIGHEST, Imported
from tests.simulation.synthetic_hssd import (
    BED,
    INSTANCES,
    MUG,
    PART,
    SCENE,
    TABLE,
    box_glb,
    boxes_document,
    change,
    write_glb,
    write_hssd,
)

SIZES = {
    TABLE: ((-0.6, 0, -0.4), (0.6, 0.75, 0.4)),
    MUG: ((-0.05, 0, -0.04), (0.07, 0.1, 0.04)),
    BED: ((-0.5, 0, -1.0), (0.5, 0.5, 1.0)),
    PART: ((0, 0, 0), (0.8, 1.0, 0.4)),
}
MILLIMETRE = 1e-3


@pytest.fixture
def hssd(tmp_path: Path) -> Path:
    return write_hssd(tmp_path / "hssd")


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> Imported:
    return import_scene(Folder(write_hssd(tmp_path_factory.mktemp("h") / "hssd")), SCENE)


def corners_of(thing: SceneObject) -> np.ndarray[Any, Any]:
    w, d, h = thing.size
    return np.array([thing.to_world(x, y, z) for x, y, z in product((-w / 2, w / 2), (-d / 2, d / 2), (0, h))])


def expected(instance: dict[str, Any]) -> np.ndarray[Any, Any]:
    """Corners of an instance's box by scipy's rotations, then from Y up to Z up."""
    low, high = SIZES[instance["template_name"]]
    points = np.array([[(low, high)[c][axis] for axis, c in enumerate(which)] for which in product((0, 1), repeat=3)])
    if instance.get("translation_origin") == "COM":
        points = points - (np.array(low) + np.array(high)) / 2
    points = points * np.array(instance.get("non_uniform_scale", [instance.get("uniform_scale", 1.0)] * 3))
    w, x, y, z = instance.get("rotation", [1, 0, 0, 0])
    placed = Rotation.from_quat([x, y, z, w]).apply(points) + np.array(instance["translation"])
    return np.stack([placed[:, 0], -placed[:, 2], placed[:, 1]], axis=1)


def in_order(points: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    rounded = np.round(points, 2) + 0.0
    return points[np.lexsort(rounded.T)]


@pytest.mark.parametrize("number", [0, 1, 2, 3, 5, 7])
def test_every_instance_has_its_own_box_to_the_millimetre(imported: Imported, number: int) -> None:
    thing = next(thing for thing in imported.scene.objects if thing.id == number)
    assert in_order(corners_of(thing)) == pytest.approx(in_order(expected(INSTANCES[number])), abs=MILLIMETRE)


def test_a_thing_in_any_pose_gets_the_least_upright_box_around_it(hssd: Path) -> None:
    asset = hssd / "objects/b/b2mug.glb"
    template = Template(AssetConfig(), asset, np.eye(3), CatalogueRow(), False)
    for seed in range(20):
        quaternion = np.random.default_rng(seed).normal(size=4)
        instance = Instance(template_name=MUG, rotation=tuple(quaternion), translation=(1, 2, 3))
        box = box_of(template, instance)
        w, x, y, z = quaternion
        points = Rotation.from_quat([x, y, z, w]).apply(read_glb(asset).corners) + np.array([1, 2, 3])
        points = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1) - np.array(box.position)
        own = points @ Rotation.from_euler("z", box.yaw).as_matrix()
        assert own.max(axis=0) - own.min(axis=0) == pytest.approx(box.size, abs=MILLIMETRE)
        assert own[:, 2].min() == pytest.approx(0, abs=MILLIMETRE)
        assert (own.max(axis=0) + own.min(axis=0))[:2] == pytest.approx((0, 0), abs=MILLIMETRE)


def test_objects_lie_in_their_rooms_and_on_what_carries_them(imported: Imported) -> None:
    places = {thing.name: (thing.room, thing.on) for thing in imported.scene.objects}
    assert places == {
        "dining_table_1": ("kitchen", None),
        "mug_1": ("kitchen", "dining_table_1"),
        "mug_2": ("kitchen", "dining_table_1"),
        "bed_1": ("bedroom", None),
        "shelf_1": ("hallway", None),
        "mug_3": ("hallway", None),
    }
    rooms = {room.name: room.bounds for room in imported.scene.rooms}
    assert rooms["kitchen"] == (0, 0, 4.9, 4)
    assert rooms["bedroom"] == (5.1, 0, 9.9, 4)


def test_what_moves_is_what_the_paper_lets_move(imported: Imported) -> None:
    assert [thing.name for thing in imported.scene.movable] == ["mug_1", "mug_2", "mug_3"]


def test_what_records_a_support_does_not_move(hssd: Path) -> None:
    table = hssd / "semantics/objects.csv"
    table.write_text(table.read_text().replace(f"{MUG},,mug.n.04,dining_ware,", f"{MUG},,mug.n.04,dining_ware,shelf"))
    assert import_scene(Folder(hssd), SCENE).scene.movable == ()


def test_what_was_left_out_is_reported_with_its_reason(imported: Imported) -> None:
    said = "\n".join(imported.report.left_out)
    assert "bedroom: the region is on another storey" in said
    assert "object_instances.4 (d4clock): hangs 2.50 m above the floor" in said
    assert HIGHEST < 2.5
    assert "object_instances.6 (f6door): a door or window" in said
    assert len(imported.report.left_out) == 3
    assert imported.report.guessed == []


def test_an_imported_home_can_be_lived_in(imported: Imported) -> None:
    assert imported.problems == []
    sides = [wall for wall in imported.scene.walls() if wall.axis == "x" and abs(wall.at - 4.1) < 0.02]
    assert [(wall.start, wall.end) for wall in sides] == [(0.0, 6.5), (7.5, 9.9)]


def test_the_asset_is_turned_so_that_its_front_and_up_are_those_of_its_config(hssd: Path) -> None:
    """An asset that lies on its back, Z up, its front towards +Y."""
    box_glb(hssd / "objects/a/a1table.glb", (-0.6, -0.4, 0), (0.6, 0.4, 0.75))
    change(hssd, "objects/a/a1table.object_config.json", lambda data: data.update(up=[0, 0, 1], front=[0, 1, 0]))
    table = import_scene(Folder(hssd), SCENE).scene.object("dining_table_1")
    assert table is not None
    assert table.size == pytest.approx((1.2, 0.8, 0.75), abs=MILLIMETRE)
    assert table.position == pytest.approx((2, 2, 0), abs=MILLIMETRE)


def test_the_transforms_of_nested_nodes_in_a_glb_count(tmp_path: Path) -> None:
    document, data = boxes_document([((-1, 0, 0), (1, 1, 1))])
    document["nodes"] = [
        {"children": [1], "translation": [5, 0, 0], "rotation": [0, 0, math.sqrt(0.5), math.sqrt(0.5)]},
        {"mesh": 0, "scale": [2, 1, 1]},
    ]
    write_glb(tmp_path / "nested.glb", document, data)
    corners = read_glb(tmp_path / "nested.glb").corners
    assert corners.min(axis=0) == pytest.approx((4, -2, 0), abs=1e-6)
    assert corners.max(axis=0) == pytest.approx((5, 2, 1), abs=1e-6)


def test_a_compressed_primitive_counts_as_the_box_that_its_accessor_gives(tmp_path: Path) -> None:
    document, _ = boxes_document([((-1, 0, 0), (1, 1, 1))])
    del document["accessors"][0]["bufferView"]
    write_glb(tmp_path / "draco.glb", document)
    assert read_glb(tmp_path / "draco.glb").corners.max(axis=0) == pytest.approx((1, 1, 1))


_GLB = "objects/b/b2mug.glb"
_CONFIG = "objects/b/b2mug.object_config.json"
_INSTANCE = f"scenes/{SCENE}.scene_instance.json"
_REGIONS = f"semantics/scenes/{SCENE}.semantic_config.json"


def _broken_glb(edit: Any) -> Any:
    def write(root: Path) -> None:
        document, data = boxes_document([((0, 0, 0), (1, 1, 1))])
        edit(document)
        write_glb(root / _GLB, document, data)

    return write


def _nan_corner(root: Path) -> None:
    document, data = boxes_document([((0, 0, 0), (1, 1, 1))])
    write_glb(root / _GLB, document, np.array([np.nan], "<f4").tobytes() + data[4:])


def _hundred_megabytes(name: str) -> Any:
    def write(root: Path) -> None:
        os.truncate(root / name, 100 * 2**20)

    return write


@pytest.mark.parametrize(
    ("spoil", "file", "field"),
    [
        (lambda r: (r / _INSTANCE).write_text("{"), _INSTANCE, "line 1"),
        (lambda r: (r / _REGIONS).write_text("[" * 100_000), _REGIONS, "nested too deeply"),
        (lambda r: (r / _CONFIG).write_bytes(b"\xff\xfe{"), _CONFIG, "must be UTF-8 text"),
        (lambda r: (r / "semantics/objects.csv").write_text("what,is\n1,2\n"), "objects.csv", "id and super_category"),
        (lambda r: (r / _CONFIG).unlink(), _INSTANCE, r"object_instances\.1\.template_name: there is no file b2mug"),
        (lambda r: (r / _GLB).unlink(), _CONFIG, "render_asset: there is no file"),
        (lambda r: change(r, _CONFIG, lambda d: d.clear()), _CONFIG, "render_asset: must name a glb"),
        (lambda r: change(r, _CONFIG, lambda d: d.update(render_asset="../../../x.glb")), _CONFIG, "file within"),
        (lambda r: change(r, _CONFIG, lambda d: d.update(up=[0, 0, 0])), _CONFIG, "up and front must be directions"),
        (
            lambda r: change(r, _INSTANCE, lambda d: d["object_instances"][1].update(translation=[0, math.nan, 0])),
            _INSTANCE,
            r"object_instances\.1\.translation\.1: Input should be a finite number",
        ),
        (
            lambda r: change(r, _INSTANCE, lambda d: d["object_instances"][3].update(non_uniform_scale=[1, -1, 1])),
            _INSTANCE,
            r"object_instances\.3\.non_uniform_scale\.1: Input should be greater than 0",
        ),
        (
            lambda r: change(r, _INSTANCE, lambda d: d["object_instances"][3].update(rotation=[0, 0, 0, 0])),
            _INSTANCE,
            r"object_instances\.3\.rotation",
        ),
        (
            lambda r: change(r, _INSTANCE, lambda d: d["object_instances"][0].pop("template_name")),
            _INSTANCE,
            r"object_instances\.0\.template_name: Field required",
        ),
        (
            lambda r: change(r, _REGIONS, lambda d: d["region_annotations"][1].pop("min_bounds")),
            _REGIONS,
            r"region_annotations\.1: must have poly_loop",
        ),
        (lambda r: (r / _GLB).write_bytes(b"glTF"), _GLB, "header"),
        (lambda r: (r / _GLB).write_bytes((r / _GLB).read_bytes()[:60]), _GLB, "header"),
        (_nan_corner, _GLB, r"accessors\.0: holds a number that is not finite"),
        (_broken_glb(lambda d: d["nodes"][0].update(children=[0])), _GLB, r"nodes\.0\.children: node 0 stands twice"),
        (_broken_glb(lambda d: d["nodes"][0].update(mesh=7)), _GLB, r"nodes\.0\.mesh: names number 7"),
        (_broken_glb(lambda d: d["accessors"][0].update(count=10**9)), _GLB, r"accessors\.0: must lie within"),
        (_broken_glb(lambda d: d["accessors"][0].update(count=-1)), _GLB, r"accessors\.0\.count"),
        (_broken_glb(lambda d: d.update(meshes=[])), _GLB, r"nodes\.0\.mesh"),
        (_broken_glb(lambda d: d.update(nodes=[], scenes=[])), _GLB, "shows nothing"),
        (
            lambda r: change(r, _INSTANCE, lambda d: d.update(object_instances=d["object_instances"][:1] * 1_501)),
            _INSTANCE,
            "object_instances: List should have at most 1500",
        ),
        (_hundred_megabytes(_INSTANCE), _INSTANCE, "more than 64 MiB"),
        (_hundred_megabytes("semantics/objects.csv"), "objects.csv", "more than 64 MiB"),
    ],
)
def test_what_is_wrong_in_a_folder_is_one_sentence_with_file_and_field(
    hssd: Path, spoil: Any, file: str, field: str
) -> None:
    spoil(hssd)
    with pytest.raises(ConfigError, match=rf"(?s)^[^\n]*{Path(file).name}[^\n]*{field}[^\n]*$"):
        import_scene(Folder(hssd), SCENE)


def test_a_hundred_megabytes_of_geometry_are_read(hssd: Path) -> None:
    glb = hssd / _GLB
    glb.write_bytes(glb.read_bytes() + bytes(1))
    os.truncate(glb, 100 * 2**20)
    assert import_scene(Folder(hssd), SCENE).problems == []


def test_what_refers_to_a_missing_file_is_left_out_on_demand(hssd: Path) -> None:
    (hssd / _CONFIG).unlink()
    (hssd / _REGIONS).unlink()
    found = import_scene(Folder(hssd), SCENE, skip_missing=True)
    assert found.scene.movable == ()
    assert [room.name for room in found.scene.rooms] == ["home"]
    assert sum("there is no file b2mug" in line for line in found.report.left_out) == 3


def test_a_scene_without_a_stage_has_no_walls_and_says_so(hssd: Path) -> None:
    change(hssd, _INSTANCE, lambda data: data.pop("stage_instance"))
    found = import_scene(Folder(hssd), SCENE)
    assert found.scene.walls() == []
    assert any(line.startswith("stage_instance") for line in found.report.left_out)
    assert json.loads(found.scene.model_dump_json())["stage"] == []


@pytest.mark.parametrize(
    ("kind", "number", "normalized"), [("<i2", 5122, True), ("<u2", 5123, True), ("<i2", 5122, False)]
)
def test_a_mesh_of_quantised_positions_is_read_as_it_is(
    tmp_path: Path, kind: str, number: int, normalized: bool
) -> None:
    """KHR_mesh_quantization, as gltfpack writes it: whole numbers, of which a node's scale makes metres."""
    document, data = boxes_document([((0, 0, 0), (1, 1, 1))], scale=[2, 1, 1])
    most = np.iinfo(kind).max if normalized else 1
    corners = (np.frombuffer(data[: 8 * 12], "<f4").reshape(8, 3) * most).astype(kind)
    padded = np.zeros((8, 4), kind)
    padded[:, :3] = corners
    document["accessors"][0] |= {"componentType": number, "normalized": normalized}
    document["bufferViews"] = [
        {"buffer": 0, "byteOffset": 0, "byteLength": 64, "byteStride": 8},
        {"buffer": 0, "byteOffset": 64, "byteLength": len(data) - 96},
    ]
    write_glb(tmp_path / "q.glb", document, padded.tobytes() + data[96:])
    mesh = read_glb(tmp_path / "q.glb")
    assert mesh.corners.max(axis=0) == pytest.approx((2, 1, 1))
    assert len(mesh.triangles) == 12
