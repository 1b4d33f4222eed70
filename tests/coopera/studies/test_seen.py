from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from coopera.core.errors import ConfigError, RunError
from coopera.rundir.directory import RunDir
from coopera.simulation.drawing.context import problem
from coopera.studies.seen import export_views, kinds_of
from tests.coopera.conftest import Said

pytest.importorskip("pyarrow")
needs_gl = pytest.mark.skipif(bool(problem()), reason=f"nothing can be drawn with OpenGL here: {problem()}")


def test_an_unknown_kind_of_view_is_a_sentence() -> None:
    assert kinds_of("depth, classes") == ["depth", "classes"]
    with pytest.raises(ConfigError, match="views: 'smell' is unknown; there are depth, instances, classes"):
        kinds_of("depth,smell")


def test_a_run_whose_acts_come_out_otherwise_here_gives_no_views(small_run: RunDir, tmp_path: Path) -> None:
    with pytest.raises(RunError, match="so views would lie"):
        export_views(small_run, tmp_path / "views", [])


@needs_gl
def test_each_picture_of_a_run_is_exported_with_its_depth_instances_and_classes(coopera: Any, tmp_path: Path) -> None:
    (tmp_path / "small.yaml").write_text("frame_size: [128, 96]\nframes: 2\nhelp_frames: 0\n")
    ran: Said = coopera("run", "small.yaml", "--humans", "amara", "--days", "1", "--hours", "1", "--out", "run")
    assert ran.code == 0, ran.err
    said = coopera("export", "run", "--out", "set", "--views", "depth,instances,classes", "--json")
    assert said.code == 0, said.err
    assert said.json["views"] == 2 * 2 * 3
    (folder,) = (tmp_path / "set/views").glob("day-00/hour-*")
    pictures = sorted((tmp_path / "run/frames").glob("*/*/*.webp"))
    seen = {one["name"]: one for one in json.loads((folder / "views.json").read_text())}
    assert sorted(seen) == [path.stem for path in pictures]
    assert {one["picture"] for one in seen.values()} == {str(p.relative_to(tmp_path / "run")) for p in pictures}
    found: set[str] = set()
    kinds = ("depth", "instances", "classes")
    for path in pictures:
        about = seen[path.stem]
        depth, bodies, classes = (read(folder / f"{path.stem}-{kind}.png") for kind in kinds)
        colours = np.asarray(Image.open(path).convert("RGB")).astype(float)
        assert depth.shape == bodies.shape == classes.shape == colours.shape[:2] == (96, 128)
        assert ((bodies == 0) == (classes == 0)).all()
        assert 0 < np.median(depth[depth > 0]) < 10_000
        assert set(np.unique(bodies[bodies > 0]).astype(str)) == set(about["instances"])
        assert set(np.unique(classes[classes > 0]).astype(str)) == set(about["classes"])
        found |= {*about["instances"].values(), *about["classes"].values()}
        edges = np.argwhere(bodies[:, 1:] != bodies[:, :-1])
        assert steps(colours, edges) > 1.5 * steps(colours, np.argwhere(bodies[:, 1:] == bodies[:, :-1]))
        turn = np.array(about["world_to_camera"])[:3, :3]
        assert np.allclose(turn @ turn.T, np.eye(3))
    assert {"human", "person", "floor", "wall"} <= found


def read(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path)).astype(int)


def steps(colours: np.ndarray, places: np.ndarray) -> float:
    """How much colours change from these pixels to those on their right."""
    row, column = places.T
    return float(np.abs(colours[row, column + 1] - colours[row, column]).mean())
