from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from coopera.core.errors import ConfigError, RunError
from coopera.core.household import HUMAN
from coopera.rundir.directory import RunDir
from coopera.simulation.drawing.context import problem
from coopera.simulation.world import World
from coopera.studies import seen
from coopera.studies.replay import Look, Replayed
from coopera.studies.seen import KINDS, export_views, kinds_of
from tests.coopera.conftest import Said
from tests.simulation.flat import flat, move

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
def test_each_picture_is_exported_with_its_depth_instances_and_classes(
    small_run: RunDir, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    record = small_run.hours()[0]
    with World(flat(), renderer="gl", frame_size=(128, 96)) as world:
        assert world.perform(HUMAN, move("sofa_1", "book", "sit and read"), record=True).ok
        pictures = world.frames(small_run.config.frames, tmp_path / "frames")

        def replayed(_: RunDir, look: Look) -> Iterator[Replayed]:
            look(record, world)
            yield Replayed(record.day, record.hour, 1, "", world.state)

        monkeypatch.setattr(seen, "replay", replayed)
        assert export_views(small_run, tmp_path / "views", list(KINDS)) == 3 * len(pictures)
    told = check(tmp_path / f"views/day-{record.day:02d}/hour-{record.hour:02d}", pictures)
    assert record.robot is not None
    assert {one["picture"] for one in told.values()} == set(record.robot.observation.frames)


@needs_gl
@pytest.mark.slow
def test_a_run_is_exported_with_views_of_its_own_pictures(coopera: Any, tmp_path: Path) -> None:
    (tmp_path / "small.yaml").write_text("frame_size: [128, 96]\nframes: 2\nhelp_frames: 0\n")
    ran: Said = coopera("run", "small.yaml", "--humans", "amara", "--days", "1", "--hours", "1", "--out", "run")
    assert ran.code == 0, ran.err
    said = coopera("export", "run", "--out", "set", "--views", "depth,instances,classes", "--json")
    assert said.code == 0, said.err
    assert said.json["views"] == 2 * 2 * 3
    (folder,) = (tmp_path / "set/views").glob("day-00/hour-*")
    pictures = sorted((tmp_path / "run/frames").glob("*/*/*.webp"))
    told = check(folder, pictures)
    assert {one["picture"] for one in told.values()} == {str(p.relative_to(tmp_path / "run")) for p in pictures}


def check(folder: Path, pictures: list[Path]) -> dict[str, Any]:
    """Hold the views of an hour against its pictures; returns what is told of each."""
    told = {one["name"]: one for one in json.loads((folder / "views.json").read_text())}
    assert sorted(told) == sorted(path.stem for path in pictures)
    found: set[str] = set()
    kinds = ("depth", "instances", "classes")
    for path in pictures:
        about = told[path.stem]
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
    return told


def read(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path)).astype(int)


def steps(colours: np.ndarray, places: np.ndarray) -> float:
    """How much colours change from these pixels to those on their right."""
    row, column = places.T
    return float(np.abs(colours[row, column + 1] - colours[row, column]).mean())
