from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coopera.core.errors import ConfigError
from coopera.simulation.homes import glb
from coopera.simulation.homes.glb import read_glb
from tests.simulation.synthetic_hssd import boxes_document, write_glb


def test_a_mesh_that_a_thousand_nodes_share_counts_at_each_of_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    document, data = boxes_document([((0, 0, 0), (1, 1, 1))])
    document["nodes"] = [{"mesh": 0}] * 1200
    document["scenes"] = [{"nodes": list(range(1200))}]
    write_glb(tmp_path / "many.glb", document, data)
    assert len(read_glb(tmp_path / "many.glb").corners) == 8 * 1200
    monkeypatch.setattr(glb, "MOST_CORNERS", 8 * 1000)
    with pytest.raises(ConfigError, match=r"many\.glb, field nodes\.\d+: the file shows more than 8000 corners"):
        read_glb(tmp_path / "many.glb")


def test_a_mesh_of_very_many_parts_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    document, data = boxes_document([((0, 0, 0), (1, 1, 1))])
    document["meshes"][0]["primitives"] *= 12
    write_glb(tmp_path / "parts.glb", document, data)
    monkeypatch.setattr(glb, "MOST_PARTS", 10)
    with pytest.raises(ConfigError, match="the file shows more than"):
        read_glb(tmp_path / "parts.glb")


@pytest.mark.parametrize(
    "node",
    [
        {"rotation": [0, 0, 0, 0]},
        {"scale": [1e308, 1e308, 1e308]},
        {"translation": [1e300, 0, 0]},
        {"matrix": [1e200] * 16},
        {"rotation": [1e308, 1e308, 1e308, 1e308], "scale": [1e308, 0, 0]},
    ],
)
def test_a_node_that_moves_its_mesh_out_of_all_bounds_is_named(tmp_path: Path, node: dict[str, list[float]]) -> None:
    document, data = boxes_document([((0, 0, 0), (1, 1, 1))], **node)
    write_glb(tmp_path / "far.glb", document, data)
    with pytest.raises(ConfigError, match=r"far\.glb, field nodes\.0: moves its mesh out of all bounds"):
        read_glb(tmp_path / "far.glb")


def test_an_offset_beyond_all_numbers_is_one_sentence(tmp_path: Path) -> None:
    document, data = boxes_document([((0, 0, 0), (1, 1, 1))])
    document["accessors"][0] |= {"count": 0, "byteOffset": 10**30}
    write_glb(tmp_path / "offset.glb", document, data)
    with pytest.raises(ConfigError, match="offset.glb, field accessors.0.byteOffset"):
        read_glb(tmp_path / "offset.glb")


def test_a_picture_is_read_once_however_often_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    document, data = boxes_document([((0, 0, 0), (1, 1, 1))])
    document["meshes"][0]["primitives"][0]["material"] = 0
    document["meshes"][0]["primitives"] *= 50
    document |= {"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]}
    document |= {"textures": [{"source": 0}], "images": [{"bufferView": 0}]}
    write_glb(tmp_path / "often.glb", document, data)
    seen: list[int] = []

    def colour_of(picture: bytes) -> np.ndarray:
        seen.append(len(picture))
        return np.zeros(3)

    monkeypatch.setattr(glb, "_mean", colour_of)
    read_glb(tmp_path / "often.glb")
    assert len(seen) == 1
