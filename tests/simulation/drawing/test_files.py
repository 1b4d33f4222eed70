"""Meshes of robots: read, or refused in one sentence before they take memory or time."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest

from benchmarks.fuzzing.shapes import DAE
from coopera.core.errors import ConfigError
from coopera.simulation.drawing import collada, files
from coopera.simulation.drawing.files import read_solid


def dae(tmp_path: Path, old: str = "", new: str = "") -> Path:
    """A file of COLLADA, with some of its text replaced."""
    text = DAE.decode()
    assert old in text
    path = tmp_path / "part.dae"
    path.write_text(text.replace(old, new, 1))
    return path


def test_a_collada_mesh_is_read_as_its_nodes_show_it(tmp_path: Path) -> None:
    pytest.importorskip("collada")
    solid = read_solid(dae(tmp_path))
    assert np.allclose((solid.at.min(axis=0), solid.at.max(axis=0)), ((1, 0, 0), (2, 2, 1)), atol=1e-5)
    assert len(solid.faces) == 12  # a wedge of six triangles, shown twice


def test_a_collada_mesh_without_pycollada_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(collada, "find_spec", lambda _: None)
    with pytest.raises(ConfigError, match=r"part.dae: a mesh of this kind needs pycollada"):
        read_solid(dae(tmp_path))


TWICE = '<instance_node url="#n{next}"/>' * 2
LINKED = "".join(f'<node id="n{i}">{TWICE.format(next=i + 1)}</node>' for i in range(30))
ONCE = '<instance_geometry url="#wedge"/>'


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("</COLLADA>", "", "part.dae, line 33: this is not valid XML."),
        ("<COLLADA", "<!DOCTYPE COLLADA><COLLADA", "the mesh has a document type"),
        ('<instance_node url="#pair"/>', '<instance_node url="#part"/>', "its nodes lie more than 64 deep"),
        (
            "<library_nodes>",
            f"<library_nodes>{LINKED}<node id='pair'><instance_node url='#n0'/></node>",
            "it shows more",
        ),
        (ONCE, ONCE * 10_000, "it shows more than 10000 nodes and parts"),
    ],
    ids=["no XML", "names that stand for others", "a node that shows itself", "two to the thirtieth", "often"],
)
def test_hostile_collada_is_refused_before_pycollada_reads_it(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        read_solid(dae(tmp_path, old, new))
    assert said in str(caught.value)


def test_corners_count_at_each_node_that_shows_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    each = (15 + 4) // 3 + 6 + 7 + 3  # numbers by threes, and corners of triangles, of a polylist and of a polygon
    monkeypatch.setattr(collada, "MOST_CORNERS", 2 * each - 1)
    with pytest.raises(ConfigError, match=f"or {2 * each - 1} corners"):
        read_solid(dae(tmp_path))
    monkeypatch.setattr(collada, "MOST_CORNERS", 2 * each)
    monkeypatch.setattr(collada, "find_spec", lambda _: None)
    with pytest.raises(ConfigError, match="needs pycollada"):
        read_solid(dae(tmp_path))


def test_an_archive_is_no_collada_mesh(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "part.dae", "w") as archive:
        archive.writestr("part.dae", DAE)
    with pytest.raises(ConfigError, match=r"part.dae, line \d+: (the mesh must be UTF-8|this is not valid XML)"):
        read_solid(tmp_path / "part.dae")


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("a.obj", b"v 0 0 0\n" * 11, "more than 10 places"),
        ("b.obj", b"v 0 0 0\nf" + b" 1" * 13 + b"\n\n", "more than 10 places, normals or triangles"),
        ("c.obj", b"v 0 0 0\nf" + b" 1" * 40_000, "a line has more than 65536 characters"),
        ("d.obj", b"v 0 0 1e7\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "the mesh is out of all bounds"),
        ("e.obj", b"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "or has a number that is none"),
        ("f.stl", bytes(80) + b"\x0b\0\0\0" + bytes(50) * 11, "more than 10 places"),
        ("g.stl", b"solid a " + b"vertex 0 0 0 " * 33, "more than 10 places"),
    ],
)
def test_a_mesh_beyond_the_limits_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, data: bytes, said: str
) -> None:
    monkeypatch.setattr(files, "MOST", 10)
    (tmp_path / name).write_bytes(data)
    with pytest.raises(ConfigError) as caught:
        read_solid(tmp_path / name)
    assert said in str(caught.value)


def test_a_facet_of_text_is_read_like_one_of_bytes(tmp_path: Path) -> None:
    text = (
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.5\nvertex 1 0 0.5\nvertex 0 1 0.5\nendloop\nendfacet\n"
    )
    (tmp_path / "a.stl").write_text(text + "endsolid a\n")
    corners = np.array([(0, 0, 0.5), (1, 0, 0.5), (0, 1, 0.5)], "<f4")
    record = np.zeros(3, "<f4").tobytes() + corners.tobytes() + bytes(2)
    (tmp_path / "b.stl").write_bytes(bytes(80) + b"\1\0\0\0" + record)
    for one, other in zip(read_solid(tmp_path / "a.stl"), read_solid(tmp_path / "b.stl"), strict=True):
        assert np.array_equal(one, other)
