from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from coopera.core.errors import ConfigError
from coopera.homes.stored import bring_in
from coopera.simulation.homes.glb import Mesh, read_glb
from coopera.simulation.homes.meshes import MOST_TRIANGLES, look_of, part_file, simplified
from coopera.simulation.homes.scene import MeshPart, Scene, load_scene
from coopera.simulation.making.overview import picture
from coopera.simulation.sight.build import build
from coopera.simulation.sight.engine import pybullet
from tests.simulation.synthetic_hssd import SCENE, TABLE, boxes_document, change, write_glb, write_hssd

LEGS = [((x, 0, z), (x + 0.06, 0.7, z + 0.06)) for x in (-0.6, 0.54) for z in (-0.4, 0.34)]
TOP = ((-0.6, 0.7, -0.4), (0.6, 0.75, 0.4))


def coloured(path: Path, factor: tuple[float, ...], image: bytes = b"") -> None:
    """A table of one material, with a picture as its texture where there is one."""
    document, data = boxes_document([TOP, *LEGS])
    metallic: dict[str, Any] = {"baseColorFactor": factor}
    if image:
        metallic["baseColorTexture"] = {"index": 0}
        document |= {"textures": [{"source": 0}], "images": [{"bufferView": 2, "mimeType": "image/png"}]}
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(image)})
    document["materials"] = [{"pbrMetallicRoughness": metallic}]
    document["meshes"][0]["primitives"][0]["material"] = 0
    write_glb(path, document, data + image)


@pytest.fixture
def hssd(tmp_path: Path) -> Path:
    root = write_hssd(tmp_path / "hssd")
    coloured(root / f"objects/a/{TABLE}.glb", (1.0, 0.0, 0.0, 1.0))
    return root


def test_a_table_of_hssd_is_seen_with_its_legs_and_in_its_colour(hssd: Path, tmp_path: Path) -> None:
    (arrival,) = bring_in(hssd, tmp_path / "scenes")
    assert not any("triangles" in line for line in arrival.told.guessed)
    home = load_scene(arrival.file)
    seen = from_the_side(home)
    red = (seen[:, :, 0] > 100) & (seen[:, :, 1] < 60)
    assert red[20:44, 20:108].mean() > 0.15
    assert not red[60:80, 50:78].any()  # between the legs one sees through
    assert red[60:80].any()
    plain = [thing.model_copy(update={"mesh": []}) for thing in home.objects]
    as_ours = from_the_side(home.model_copy(update={"objects": plain}))
    assert not np.array_equal(seen, as_ours)


def from_the_side(home: Scene) -> np.ndarray[Any, Any]:
    table = home.object("dining_table_1")
    assert table is not None
    alone = home.model_copy(update={"objects": [table.model_copy(update={"yaw": 0.0})], "stage": []})
    client = pybullet.connect(pybullet.DIRECT)
    try:
        build(alone, client)
        x, y = table.xy
        return picture(client, (x, y - 2.0, 0.5), (x, y, 0.4), 40.0, (128, 96))
    finally:
        pybullet.disconnect(client)


def test_what_is_drawn_lies_within_the_objects_box(hssd: Path, tmp_path: Path) -> None:
    (arrival,) = bring_in(hssd, tmp_path / "scenes")
    for thing in arrival.scene.objects:
        assert thing.mesh
        corners = np.concatenate([corners_of(arrival.file.with_suffix(".meshes") / part.file) for part in thing.mesh])
        w, d, h = thing.size
        assert corners.min(axis=0) == pytest.approx((-w / 2, -d / 2, 0), abs=1e-3)
        assert corners.max(axis=0) == pytest.approx((w / 2, d / 2, h), abs=1e-3)


def corners_of(path: Path) -> np.ndarray[Any, Any]:
    lines = [line.split()[1:] for line in path.read_text().splitlines() if line.startswith("v ")]
    return np.array(lines, dtype=float)


def test_equal_things_share_their_meshes_and_a_home_is_taken_along_with_them(hssd: Path, tmp_path: Path) -> None:
    change(
        hssd,
        f"scenes/{SCENE}.scene_instance.json",
        lambda scene: scene["object_instances"].append(scene["object_instances"][0] | {"translation": [3, 0, -3.4]}),
    )
    (arrival,) = bring_in(hssd, tmp_path / "scenes")
    one, two = (arrival.scene.object(name) for name in ("dining_table_1", "dining_table_2"))
    assert one is not None
    assert two is not None
    assert one.mesh == two.mesh
    (again,) = bring_in(arrival.file, tmp_path / "elsewhere")
    assert sorted(path.name for path in again.file.with_suffix(".meshes").iterdir()) == sorted(
        path.name for path in arrival.file.with_suffix(".meshes").iterdir()
    )


def test_a_home_whose_meshes_are_gone_is_refused(hssd: Path, tmp_path: Path) -> None:
    (arrival,) = bring_in(hssd, tmp_path / "scenes")
    for path in arrival.file.with_suffix(".meshes").iterdir():
        path.unlink()
    with pytest.raises(ConfigError, match=r"field objects.0.mesh: there is no file"):
        load_scene(arrival.file)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "garbage\n",
        "v 0.0 0.0 0.0\nvn 0.0 0.0 1.0\nf 1//1 1//1 2//1\n",
        "mtllib /etc/passwd\n",
        "f 0//1 1//1 1//1\n",
    ],
)
def test_a_mesh_that_names_corners_it_does_not_have_is_refused_before_it_is_drawn(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.obj").write_text(text)
    with pytest.raises(ConfigError, match=r"a\.obj: this is no mesh that coopera made"):
        part_file(tmp_path, MeshPart(file="a.obj", colour="#000000"))


def png(colour: tuple[int, int, int]) -> bytes:
    buffer = io.BytesIO()
    Image.new("RGB", (4, 4), colour).save(buffer, "PNG")
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("factor", "image", "colour"),
    [
        ((1.0, 0.0, 0.0, 1.0), b"", (1.0, 0.0, 0.0)),
        ((1.0, 1.0, 1.0, 1.0), png((0, 102, 204)), (0.0, 0.4, 0.8)),
        ((1.0, 1.0, 1.0, 1.0), b"KTX 20, which is not read", (np.nan, np.nan, np.nan)),
    ],
)
def test_the_colour_of_a_material_is_its_factor_times_the_mean_of_its_picture(tmp_path, factor, image, colour) -> None:
    coloured(tmp_path / "table.glb", factor, image)
    assert np.unique(read_glb(tmp_path / "table.glb").colours, axis=0)[0] == pytest.approx(colour, nan_ok=True)


def test_what_has_no_colour_of_its_own_takes_that_of_its_class() -> None:
    corner = np.eye(3)
    look = look_of(Mesh(corner, np.array([[0, 1, 2]]), np.full((1, 3), np.nan)), "#336699")
    assert [part.colour for part in look.parts] == ["#336699"]


def test_a_large_mesh_is_made_small_and_keeps_its_extent() -> None:
    angles = np.linspace(0, np.pi, 120)
    ring = np.stack(
        [
            np.outer(np.sin(angles), np.cos(2 * angles)),
            np.outer(np.sin(angles), np.sin(2 * angles)),
            np.outer(np.cos(angles), np.ones(120)),
        ],
        axis=-1,
    )
    corners = ring.reshape(-1, 3)
    here = np.array([i * 120 + j for i in range(119) for j in range(119)])
    faces = np.concatenate(
        [np.stack([here, here + 120, here + 121], axis=1), np.stack([here, here + 121, here + 1], axis=1)]
    )
    small = simplified(Mesh(corners, faces, np.tile((0.2, 0.4, 0.6), (len(faces), 1))))
    assert 200 < len(small.triangles) <= MOST_TRIANGLES
    assert small.triangles.max() < len(small.corners)
    used = small.corners[np.unique(small.triangles)]
    assert np.ptp(used, axis=0) == pytest.approx((2, 2, 2), abs=0.12)
    assert np.linalg.norm(used, axis=1) == pytest.approx(1, abs=0.06)


def test_no_triangles_no_look() -> None:
    assert look_of(Mesh(np.zeros((8, 3)), np.zeros((0, 3), dtype=np.int64), np.zeros((0, 3))), "#336699").parts == []
