"""Readers of bodies and motions, for `benchmarks.fuzz`."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.fuzzing import mutations as change
from benchmarks.fuzzing.kit import ROOT, Reader, Target, in_yaml, of_file
from coopera.simulation.bodies.body_file import read_body
from coopera.simulation.motions import user_folder
from coopera.simulation.motions.smplx import read_capture, retarget


def _body(name: str) -> Callable[[Path], Target]:
    def ready(folder: Path) -> Target:
        for one in ("fetch.yaml", "fetch.urdf", "ball.obj"):
            (folder / one).write_bytes((ROOT / "simulation/bodies" / one).read_bytes())
        return Target(folder / name, [(folder / name).read_bytes()], lambda: read_body(folder / "fetch.yaml"))

    return ready


def _capture(path: Path) -> object:
    return retarget(read_capture(path))


def _motion_x() -> bytes:
    out = io.BytesIO()
    np.save(out, np.linspace(-1, 1, 5 * 322, dtype=np.float32).reshape(5, 322))
    return out.getvalue()


def _amass() -> list[bytes]:
    rows = np.linspace(-1, 1, 8 * 156).reshape(8, 156)
    found = []
    for parts in ({"poses": rows}, {"root_orient": rows[:, :3], "pose_body": rows[:, 3:66]}):
        out = io.BytesIO()
        np.savez_compressed(out, trans=rows[:, :3], mocap_frame_rate=np.array(60.0), gender=np.array("x"), **parts)
        found.append(out.getvalue())
    return found


def _motions(folder: Path) -> Target:
    path = folder / "motions.yaml"
    seeds = [in_yaml({"wave.npy": {"caption": "wave the hand", "class": "stand", "posture": "stand", "hold": "right"}})]
    return Target(path, seeds, lambda: user_folder._entries(folder, {"wave.npy"}))


READERS: dict[str, Reader] = {
    "motions": Reader(_motions, change.in_yaml),
    "body": Reader(_body("fetch.yaml"), change.in_yaml),
    "urdf": Reader(_body("fetch.urdf"), change.anywhere),
    "npy": Reader(of_file("clip.npy", [_motion_x()], _capture), change.in_npy),
    "npz": Reader(of_file("clip.npz", _amass(), _capture), change.in_npz),
}
