"""Bodies of the SMPL-X model, where the user has its files: SMPLX_NEUTRAL.npz, SMPLX_FEMALE.npz or SMPLX_MALE.npz.

The published arrays are read: v_template (V, 3), shapedirs (V, 3, at least 10), weights (V, 55), J_regressor (55, V),
kintree_table (2, 55) and f (F, 3); SMPL-X of G. Pavlakos et al., "Expressive Body Capture", CVPR 2019. The model is
shaped by its first two shape parameters, brought to our skeleton bone by bone, and painted with clothes.

DEVIATES: our skeleton has lengths of its own, so each bone is stretched to ours; pose-dependent corrections
(posedirs), fingers and the face's expressions are left out.
"""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.core.errors import ConfigError
from coopera.core.foreign.arrays import read_arrays
from coopera.simulation.bodies.humanoid import CHEST, FOREARM, NECK, SIDES, SIZE, SLICES, Frames, forward
from coopera.simulation.people.appearance import Appearance
from coopera.simulation.people.assembly import Parts
from coopera.simulation.people.clothes import Clothes
from coopera.simulation.people.figure import Measures
from coopera.simulation.people.weights import PARTS, strongest
from coopera.simulation.shapes.rotations import about_x, quaternion

Array = NDArray[np.float64]

JOINTS = 55
_NAMES = ("v_template", "shapedirs", "weights", "J_regressor", "kintree_table", "f")
_MOST_BYTES = 256 * 2**20
_MOST_VERTICES, _MOST_FACES = 100_000, 200_000
_LARGEST = 1e3
_AXES = np.array(((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))  # from SMPL's axes to ours
_PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19)
_HIPS, _NECK = (1, 2), 12
_LIMBS = {"left": ((16, 18, 20), (1, 4, 7)), "right": ((17, 19, 21), (2, 5, 8))}


class Model(NamedTuple):
    """A body model: its mean shape (V, 3), the first shape directions (V, 3, 2), weights (V, 55) and faces (F, 3).

    `joints` is the joint regressor (55, V).
    """

    template: Array
    shapes: Array
    weights: Array
    joints: Array
    faces: NDArray[np.int64]


@lru_cache(maxsize=3)
def read_model(path: Path) -> Model:
    """Read a model's file; nothing in it is executed.

    Raises:
        ConfigError: If an array is missing, has another shape or holds what is no finite number; names file and array.
    """
    data = read_arrays(path, _NAMES, most_bytes=_MOST_BYTES, what="body model")
    if not isinstance(data, dict):
        raise ConfigError(f"The body model {path} must be an .npz of the SMPL-X model, not a single array.")
    _check_shapes(path, data)
    _check_values(path, data)
    weights = data["weights"].astype(np.float64)
    return Model(
        data["v_template"].astype(np.float64),
        data["shapedirs"][:, :, :2].astype(np.float64),
        weights / weights.sum(axis=1, keepdims=True),
        data["J_regressor"].astype(np.float64),
        data["f"].astype(np.int64),
    )


def _check_shapes(path: Path, data: dict[str, NDArray[Any]]) -> None:
    missing = [name for name in _NAMES if name not in data]
    if missing:
        raise ConfigError(f"The body model {path} has no {missing[0]}: an .npz of the SMPL-X model is expected.")
    count = len(data["v_template"]) if data["v_template"].ndim == 2 else 0
    faces, shapes = data["f"], data["shapedirs"]
    expected = {
        "v_template": ((count, 3), "(vertices, 3)"),
        "weights": ((count, JOINTS), f"(vertices, {JOINTS})"),
        "J_regressor": ((JOINTS, count), f"({JOINTS}, vertices)"),
        "kintree_table": ((2, JOINTS), f"(2, {JOINTS})"),
    }
    for name, (shape, words) in expected.items():
        if data[name].shape != shape or not 0 < count <= _MOST_VERTICES:
            raise ConfigError(f"The body model {path}: {name} must have shape {words}, not {data[name].shape}.")
    if shapes.ndim != 3 or shapes.shape[:2] != (count, 3) or shapes.shape[2] < 10:
        raise ConfigError(f"The body model {path}: shapedirs must have shape (vertices, 3, 10), not {shapes.shape}.")
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu" or not 0 < len(faces) <= _MOST_FACES:
        raise ConfigError(f"The body model {path}: f must have shape (faces, 3) and whole numbers, not {faces.shape}.")


def _check_values(path: Path, data: dict[str, NDArray[Any]]) -> None:
    count, faces = len(data["v_template"]), data["f"].astype(np.int64)
    if faces.min() < 0 or faces.max() >= count:
        raise ConfigError(f"The body model {path}: f must count its {count} vertices, but goes to {faces.max()}.")
    for name in ("v_template", "shapedirs", "weights", "J_regressor"):
        if not (np.abs(data[name]) < _LARGEST).all():
            raise ConfigError(f"The body model {path}: {name} must hold finite numbers below {_LARGEST:g}.")
    if tuple(data["kintree_table"].astype(np.int64)[0, 1 : len(_PARENTS)]) != _PARENTS[1:]:
        raise ConfigError(f"The body model {path}: kintree_table must be the joint tree of SMPL-X.")
    if data["weights"].min() < -1e-6 or np.abs(data["weights"].sum(axis=1) - 1.0).max() > 0.01:
        raise ConfigError(f"The body model {path}: weights must be at least 0 and sum to 1 for each vertex.")


def rest_upright() -> Frames:
    """Our body as the model stands at rest: upright, the arms out to the sides."""
    pose = np.zeros(SIZE)
    for name, where in SLICES.items():
        if where.stop - where.start == 4:
            sign = {"left_shoulder": 1.0, "right_shoulder": -1.0}.get(name, 0.0)
            pose[where] = quaternion(about_x(sign * math.pi / 2))
    return forward(pose)


def fitted(model: Model, measures: Measures) -> tuple[Array, Array, Frames]:
    """The model in our skeleton at rest: vertices (V, 3), shares of `PARTS` (V, 16), and the rest pose's frames."""
    betas = np.array((0.0, -6.0 * (measures.girth - 1.0)))
    vertices = (model.template + model.shapes @ betas) @ _AXES.T
    joints = model.joints @ vertices
    shares = model.weights @ _to_parts()
    rest = rest_upright()
    hips = joints[list(_HIPS)].mean(axis=0)
    ankles = joints[[7, 8]].mean(axis=0)
    ours = rest.place["neck"][2] - (rest.place["left_ankle"][2] + rest.place["right_ankle"][2]) / 2
    size = ours / max(float(joints[_NECK][2] - ankles[2]), 1e-3)
    moved = np.zeros_like(vertices)
    spine = joints[_NECK] - hips
    share = float(CHEST[2] / (CHEST[2] + NECK[2]))
    ends: dict[str, tuple[Array, Array, Array, Array]] = {
        "pelvis": (hips, hips + spine, rest.place["pelvis"], rest.place["neck"]),
        "chest": (hips + share * spine, joints[_NECK], rest.place["chest"], rest.place["neck"]),
        "neck": (
            joints[_NECK],
            joints[_NECK] + (0.0, 0.0, 1.0 / size),
            rest.place["neck"],
            rest.place["neck"] + (0, 0, 1.0),
        ),
    }
    ends["head"] = ends["neck"]
    for side in SIDES:
        (shoulder, elbow, wrist), (hip, knee, ankle) = _LIMBS[side]
        hand = rest.point(f"{side}_elbow", 0.0, 0.0, -FOREARM)
        out = (hand - rest.place[f"{side}_elbow"]) / FOREARM
        arm = (rest.place[f"{side}_shoulder"], rest.place[f"{side}_elbow"], hand, hand + out)
        leg = tuple(rest.place[f"{side}_{part}"] for part in ("hip", "knee", "ankle"))
        ends[f"{side}_shoulder"] = (joints[shoulder], joints[elbow], arm[0], arm[1])
        ends[f"{side}_elbow"] = (joints[elbow], joints[wrist], arm[1], arm[2])
        ends[f"{side}_hand"] = (joints[wrist], joints[wrist] + out / size, arm[2], arm[3])
        ends[f"{side}_hip"] = (joints[hip], joints[knee], leg[0], leg[1])
        ends[f"{side}_knee"] = (joints[knee], joints[ankle], leg[1], leg[2])
        ends[f"{side}_ankle"] = (joints[ankle], joints[ankle] + (0, 0, 1.0 / size), leg[2], leg[2] + (0, 0, 1.0))
    for number, part in enumerate(PARTS):
        rows = shares[:, number] > 0
        moved[rows] += shares[rows, number, None] * _bone(vertices[rows], *ends[part], size)
    return moved, shares, rest


def _bone(points: Array, start: Array, end: Array, to_start: Array, to_end: Array, size: float) -> Array:
    """Points carried with a bone from one place to another: turned, stretched along it, and sized across it."""
    line, to_line = end - start, to_end - to_start
    length, to_length = float(np.linalg.norm(line)), float(np.linalg.norm(to_line))
    line, to_line = line / max(length, 1e-6), to_line / max(to_length, 1e-6)
    away = points - start
    along = away @ line
    across = away - along[:, None] * line
    cross, cos = np.cross(line, to_line), float(line @ to_line)
    turned = across + np.cross(cross, across) + np.cross(cross, np.cross(cross, across)) / max(1.0 + cos, 1e-6)
    found: Array = to_start + (along * to_length / max(length, 1e-6))[:, None] * to_line + size * turned
    return found


def _to_parts() -> Array:
    """The share of each of `PARTS` in what a joint of the model carries (55, 16)."""
    found = np.zeros((JOINTS, len(PARTS)))
    names = {0: "pelvis", 6: "chest", 9: "chest", 13: "chest", 14: "chest", 12: "neck"}
    names |= dict.fromkeys((15, 22, 23, 24), "head")
    for side, fingers, foot in (("left", range(25, 40), 10), ("right", range(40, 55), 11)):
        (shoulder, elbow, wrist), (hip, knee, ankle) = _LIMBS[side]
        names |= {shoulder: f"{side}_shoulder", elbow: f"{side}_elbow", hip: f"{side}_hip", knee: f"{side}_knee"}
        names |= dict.fromkeys((wrist, *fingers), f"{side}_hand") | dict.fromkeys((ankle, foot), f"{side}_ankle")
    for joint, name in names.items():
        found[joint, PARTS.index(name)] = 1.0
    found[3, PARTS.index("pelvis")] = found[3, PARTS.index("chest")] = 0.5  # the lowest of the spine's three
    return found


def painted(vertices: Array, shares: Array, rest: Frames, clothes: Clothes) -> NDArray[np.int64]:
    """What covers each vertex: 0 skin, 1 hair, 2 a top, 3 trousers or a skirt, 4 a shoe."""
    own = np.array([PARTS[number].removeprefix("left_").removeprefix("right_") for number in shares.argmax(axis=1)])
    z = vertices[:, 2]
    found = np.zeros(len(vertices), dtype=np.int64)
    head = vertices - rest.place["head"]
    found[(own == "head") & ((head[:, 2] > 0.075) | ((head[:, 0] < -0.01) & (head[:, 2] > -0.05)))] = 1
    sleeves = {"nothing": (), "tank": (), "swimsuit": (), "towel": (), "tee": ("shoulder",), "polo": ("shoulder",)}
    sleeved = sleeves.get(clothes.top, ("shoulder", "elbow"))
    if clothes.top != "nothing":
        found[np.isin(own, ("chest", "pelvis", *sleeved)) & (z < rest.place["neck"][2] + 0.01)] = 2
    if clothes.bottom != "nothing":
        low = {"trunks": -0.20, "shorts": -0.32, "skirt": -0.36}.get(clothes.bottom, -2.0)
        found[np.isin(own, ("hip", "knee")) & (z > low) | (own == "pelvis") & (z < 0.02)] = 3
    if clothes.top in ("dress", "towel"):
        found[(own == "hip") & (z > -0.34)] = 2
    if clothes.footwear != "bare":
        found[own == "ankle"] = 4
    return found


def modelled(looks: Appearance, clothes: Clothes, path: Path) -> Parts:
    """A person of the model in our skeleton, in painted clothes.

    Raises:
        ConfigError: If the model's file cannot be used.
    """
    model = read_model(path)
    vertices, shares, rest = fitted(model, looks.measures)
    covered = painted(vertices, shares, rest, clothes)
    colours = np.array((looks.skin, looks.hair, clothes.top_colour, clothes.bottom_colour, clothes.shoe_colour))
    if looks.hair_style == "bald":
        colours[1] = looks.skin
    corners = vertices[model.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, model.faces[:, corner], across)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    parts, weights = strongest(shares)
    materials = ("skin", "hair", "cloth", "cloth", "shoe")
    return Parts(vertices, normals, colours[covered], covered, materials, parts, weights, model.faces, rest)
