"""A small body model in the layout of SMPL-X: a ball of points about each joint of a body that stands in a T."""

from __future__ import annotations

from pathlib import Path

import numpy as np

PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19)
PLACES = {
    **{0: (0, 0, 0), 1: (0.07, -0.09, 0), 2: (-0.07, -0.09, 0), 3: (0, 0.11, -0.02), 4: (0.11, -0.48, 0.01)},
    **{5: (-0.11, -0.48, 0.01), 6: (0, 0.25, -0.02), 7: (0.09, -0.90, -0.03), 8: (-0.09, -0.90, -0.03)},
    **{9: (0, 0.30, 0.01), 10: (0.12, -0.96, 0.08), 11: (-0.12, -0.96, 0.08), 12: (0, 0.48, -0.02)},
    **{13: (0.05, 0.42, 0), 14: (-0.05, 0.42, 0), 15: (0, 0.56, 0), 16: (0.17, 0.43, -0.02)},
    **{17: (-0.17, 0.43, -0.02), 18: (0.43, 0.42, -0.03), 19: (-0.43, 0.42, -0.03)},
    **{20: (0.69, 0.43, -0.03), 21: (-0.69, 0.43, -0.03)},
}
"""Joints of SMPL's axes: x left, y up, z forward (metres)."""
_BALL = 0.03 * np.array(((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)), dtype=float)
_FACES = ((0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5))


def arrays() -> dict[str, np.ndarray]:
    """The model's arrays; six vertices for each of the 55 joints, in their order."""
    places = np.array(
        [PLACES.get(joint, PLACES[15 if joint < 25 else 20 if joint < 40 else 21]) for joint in range(55)]
    )
    count = 55 * len(_BALL)
    parents = [*PARENTS, 15, 15, 15, *[20] * 15, *[21] * 15]
    owner = np.repeat(np.eye(55), len(_BALL), axis=0)
    shapes = np.zeros((count, 3, 20))
    shapes[:, :, 1] = -0.01 * np.tile(_BALL, (55, 1)) / 0.03
    return {
        "v_template": np.repeat(places, len(_BALL), axis=0) + np.tile(_BALL, (55, 1)),
        "shapedirs": shapes,
        "weights": owner,
        "J_regressor": owner.T / len(_BALL),
        "kintree_table": np.array([[2**32 - 1, *parents[1:]], list(range(55))], dtype=np.uint32),
        "f": np.concatenate([np.array(_FACES) + len(_BALL) * joint for joint in range(55)]).astype(np.uint32),
    }


def write_model(folder: Path, name: str = "SMPLX_NEUTRAL.npz", **changed: np.ndarray | None) -> Path:
    """Write the model's file; `changed` replaces arrays, or leaves them out where None."""
    kept = {key: value for key, value in {**arrays(), **changed}.items() if value is not None}
    np.savez(folder / name, **kept)
    return folder / name
