"""Write a small home in Habitat's general layout: a stage, templates of furniture of realistic shape, no semantics.

Every height is known by construction, and none is that of the catalogue.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.simulation.synthetic_hssd import boxes_document, write_glb, write_json

Solid = tuple[NDArray[np.float64], NDArray[np.int64]]
SCENE = "flat_0"
MATTRESS, CUSHION, DESK, SHELF, DRAWER, FLOOR = 0.42, 0.39, 0.735, 0.83, 0.355, 0.0
"""Heights above the floor: of the mattress, the seat, the desk's top, a board and a drawer's bottom."""
_FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4)]
_FACES += [(1, 5, 7), (1, 7, 3)]


def box(x: Sequence[float], y: Sequence[float], z: Sequence[float]) -> Solid:
    """A box from and to, Z up, front towards +y."""
    return np.array([(a, b, c) for a in x for b in y for c in z]), np.array(_FACES)


def cushion(x: Sequence[float], y: Sequence[float], z: Sequence[float], soft: float = 0.03, n: int = 24) -> Solid:
    """A padded box: its upper side is flat in the middle and falls off by `soft` towards the edges."""
    u = np.linspace(-1, 1, n)
    grid = np.stack(np.meshgrid(u, u, indexing="ij"), axis=-1)
    drop = soft * np.maximum(np.abs(grid[..., 0]) ** 8, np.abs(grid[..., 1]) ** 8)
    px, py = ((low + high) / 2 + (high - low) / 2 * grid[..., i] for i, (low, high) in enumerate((x, y)))
    top = np.stack([px, py, z[1] - drop], axis=-1).reshape(-1, 3)
    bottom = np.stack([px, py, np.full_like(px, z[0])], axis=-1).reshape(-1, 3)
    faces = []
    for i in range(n - 1):
        for j in range(n - 1):
            a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1
            faces += [(a, b, c), (a, c, d), (a + n * n, c + n * n, b + n * n), (a + n * n, d + n * n, c + n * n)]
    rim = [*range(0, n * n, n)][::-1] + [*range(1, n)] + [(i + 1) * n - 1 for i in range(1, n)]
    rim += [n * (n - 1) + j for j in range(n - 2, 0, -1)]
    for p, q in zip(rim, [*rim[1:], rim[0]], strict=True):
        faces += [(p, p + n * n, q + n * n), (p, q + n * n, q)]
    return np.concatenate([top, bottom]), np.array(faces)


def leg(x: float, y: float, z: float, radius: float = 0.03, n: int = 12) -> Solid:
    """A round leg that stands on the floor."""
    turn = np.arange(n) * math.tau / n
    ring = np.stack([x + radius * np.cos(turn), y + radius * np.sin(turn)], axis=1)
    corners = [(*p, h) for h in (0.0, z) for p in ring.tolist()] + [(x, y, 0.0), (x, y, z)]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n + j), (i, n + j, n + i), (2 * n, j, i), (2 * n + 1, n + i, n + j)]
    return np.array(corners), np.array(faces)


def together(solids: Sequence[Solid]) -> Solid:
    corners, faces, count = [], [], 0
    for points, triangles in solids:
        corners.append(points)
        faces.append(triangles + count)
        count += len(points)
    return np.concatenate(corners), np.concatenate(faces)


def bed() -> Solid:
    """Head at the wall (-y), two pillows, a frame on four legs, a padded mattress."""
    legs = [leg(x, y, 0.15) for x in (-0.7, 0.7) for y in (-0.9, 0.9)]
    frame = [box((-0.8, 0.8), (-1.0, 1.0), (0.12, 0.26)), box((-0.82, 0.82), (-1.06, -1.0), (0.0, 1.3))]
    pillows = [cushion((x - 0.3, x + 0.3), (-0.95, -0.55), (0.40, 0.55), 0.06) for x in (-0.38, 0.38)]
    return together([*legs, *frame, cushion((-0.78, 0.78), (-0.98, 0.98), (0.26, MATTRESS)), *pillows])


def sofa() -> Solid:
    """Two arms, a back, two seat cushions."""
    base = [box((-1.05, 1.05), (-0.45, 0.45), (0.08, 0.24)), box((-1.05, 1.05), (-0.45, -0.22), (0.08, 0.88))]
    arms = [box(x, (-0.45, 0.45), (0.08, 0.6)) for x in ((-1.05, -0.85), (0.85, 1.05))]
    seats = [cushion(x, (-0.22, 0.46), (0.24, CUSHION)) for x in ((-0.85, -0.005), (0.005, 0.85))]
    return together([*base, *arms, *seats])


def bookshelf() -> Solid:
    """Two sides, a back, six boards of 2 cm."""
    sides = [box(x, (-0.16, 0.16), (0, 1.9)) for x in ((-0.5, -0.48), (0.48, 0.5))]
    boards = [box((-0.48, 0.48), (-0.15, 0.16), (z - 0.02, z)) for z in (0.09, 0.46, SHELF, 1.2, 1.55, 1.9)]
    return together([*sides, box((-0.5, 0.5), (-0.16, -0.15), (0, 1.9)), *boards])


def drawers() -> Solid:
    """A carcass with three drawers that are modelled with bottom, sides and front."""
    carcass = [box(x, (-0.24, 0.22), (0, 0.85)) for x in ((-0.45, -0.43), (0.43, 0.45))]
    carcass += [box((-0.45, 0.45), (-0.24, -0.23), (0, 0.85)), box((-0.45, 0.45), (-0.24, 0.24), (0.83, 0.85))]
    found = []
    for z in (0.09, DRAWER, 0.62):
        x, y, high = (-0.42, 0.42), (-0.22, 0.22), z + 0.14
        found += [box(x, y, (z - 0.01, z)), box(x, (y[0], y[0] + 0.012), (z - 0.01, high))]
        found += [box(side, y, (z - 0.01, high)) for side in ((-0.42, -0.408), (0.408, 0.42))]
        found += [box((-0.43, 0.43), (0.22, 0.24), (z - 0.04, z + 0.19))]
    return together([*carcass, *found])


def desk() -> Solid:
    """A top on a leg at one side and a block of drawers at the other, with a shelf along the back above the top."""
    top = [box((-0.75, 0.75), (-0.36, 0.36), (DESK - 0.03, DESK)), box((0.32, 0.75), (-0.36, 0.34), (0, DESK - 0.03))]
    legs = [leg(-0.7, y, DESK - 0.03) for y in (-0.3, 0.3)]
    above = [box(x, (-0.36, -0.14), (DESK, 1.15)) for x in ((-0.75, -0.73), (0.73, 0.75))]
    return together([*top, *legs, *above, box((-0.75, 0.75), (-0.36, -0.14), (1.13, 1.15))])


def chair() -> Solid:
    """Four legs, a seat, a back."""
    legs = [leg(x, y, 0.44, 0.02) for x in (-0.18, 0.18) for y in (-0.18, 0.18)]
    return together(
        [
            *legs,
            cushion((-0.22, 0.22), (-0.22, 0.22), (0.43, 0.47), 0.01),
            box((-0.2, 0.2), (-0.24, -0.21), (0.43, 0.95)),
        ]
    )


def glb(path: Path, solid: Solid) -> None:
    """Write a solid as Habitat has it: Y up, the front towards -Z."""
    corners, faces = solid
    points = np.stack([corners[:, 0], corners[:, 2], -corners[:, 1]], axis=1).astype("<f4")
    index = faces.astype("<u4").ravel()
    document, _ = boxes_document([((0, 0, 0), (1, 1, 1))])
    data = points.tobytes() + index.tobytes()
    document["bufferViews"] = [
        {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes},
        {"buffer": 0, "byteOffset": points.nbytes, "byteLength": index.nbytes},
    ]
    ends = {"min": np.nanmin(points, axis=0).tolist(), "max": np.nanmax(points, axis=0).tolist()}
    document["accessors"] = [
        {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", **ends},
        {"bufferView": 1, "componentType": 5125, "count": len(index), "type": "SCALAR"},
    ]
    document["buffers"] = [{"byteLength": len(data)}]
    write_glb(path, document, data)


def obj(path: Path, solid: Solid) -> None:
    """The same as a Wavefront OBJ file."""
    corners, faces = solid
    lines = [f"v {x:.5f} {z:.5f} {-y:.5f}" for x, y, z in corners.tolist()]
    path.write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]) + "\n")


FURNITURE = {"bed": bed, "sofa": sofa, "bookshelf": bookshelf, "drawers": drawers, "desk": desk, "chair": chair}
SMALL = {
    "mug": box((-0.04, 0.05), (-0.04, 0.04), (0, 0.09)),
    "book": box((-0.08, 0.08), (-0.11, 0.11), (0, 0.03)),
    "apple": cushion((-0.035, 0.035), (-0.035, 0.035), (0, 0.07), 0.02),
    "laptop": box((-0.16, 0.16), (-0.12, 0.12), (0, 0.03)),
    "plate": box((-0.12, 0.12), (-0.12, 0.12), (0, 0.02)),
    "water_bottle": leg(0, 0, 0.24, 0.035),
}


def placed(name: str, x: float, y: float, z: float = 0.0, yaw: float = 0.0, **more: Any) -> dict[str, Any]:
    """An instance where our frame has it."""
    turn = [math.cos(yaw / 2), 0.0, math.sin(yaw / 2), 0.0]
    motion = "STATIC" if name.removeprefix("frl_apartment_").removesuffix("_01") in FURNITURE else "DYNAMIC"
    return {
        "template_name": f"objects/{name}",
        "translation": [x, z, -y],
        "rotation": turn,
        "motion_type": motion,
    } | more


def write_habitat(root: Path) -> Path:
    """Write the data set: one room of 7 m by 6 m with the furniture along its walls, in the layout of ReplicaCAD."""
    objects = root / "configs/objects"
    for name, make in FURNITURE.items():
        glb(_asset(root, name), make())
    for name, solid in SMALL.items():
        glb(_asset(root, name), solid)
    obj(root / "objects/frl_apartment_desk_01.obj", desk())
    for name in (*FURNITURE, *SMALL):
        kind = "obj" if name == "desk" else "glb"
        config: dict[str, Any] = {"render_asset": f"../../objects/frl_apartment_{name}_01.{kind}", "mass": 3.0}
        if name == "drawers":
            config["semantic_id"] = 13
        write_json(objects / f"frl_apartment_{name}_01.object_config.json", config)
    write_json(root / "configs/ssd/flat_semantic_lexicon.json", {"classes": [{"id": 13, "name": "chest of drawers"}]})
    floor = [((0, -0.1, -6), (7, 0, 0))]
    walls = [((-0.1, 0, -6), (0, 2.6, 0)), ((7, 0, -6), (7.1, 2.6, 0)), ((0, 0, -0.05), (7, 2.6, 0.05))]
    walls += [((0, 0, -6.05), (7, 2.6, -5.95))]
    write_glb(root / "stages/flat_stage.glb", *boxes_document(floor + walls))
    stage = {"render_asset": "../../stages/flat_stage.glb", "up": [0, 1, 0], "front": [0, 0, -1], "margin": 0.03}
    write_json(root / "configs/stages/flat_stage.stage_config.json", stage)
    name = "frl_apartment_{}_01".format
    instances = [
        placed(name("bed"), 1.3, 1.15),
        placed(name("sofa"), 5.0, 0.55),
        placed(name("bookshelf"), 0.3, 4.0, yaw=-math.pi / 2),
        placed(name("drawers"), 6.7, 3.6, yaw=math.pi / 2),
        placed(name("desk"), 4.2, 5.55, yaw=math.pi),
        placed(name("chair"), 4.3, 4.85),
        placed(name("mug"), 4.4, 5.45, DESK),
        placed(name("laptop"), 3.95, 5.4, DESK + 0.01),  # hovers by a centimetre, as in many a data set
        placed(name("book"), 0.33, 4.1, SHELF),
        placed(name("book"), 0.33, 3.8, 1.2),
        placed(name("apple"), 6.7, 3.5, 0.85),
        placed(name("plate"), 6.7, 3.8, 0.85),
        placed(name("water_bottle"), 5.3, 0.6, CUSHION),
    ]
    scene = {
        "stage_instance": {"template_name": "stages/flat_stage", "translation_origin": "asset_local"},
        "default_lighting": "lighting/flat_stage",
        "object_instances": [{"translation_origin": "asset_local", **one} for one in instances],
        "navmesh_instance": "empty_stage_navmesh",
    }
    write_json(root / f"configs/scenes/{SCENE}.scene_instance.json", scene)
    paths = {"stages": "stages", "objects": "objects", "scene_instances": "scenes", "light_setups": "lighting"}
    config = {key: {"paths": {".json": [f"configs/{folder}"]}} for key, folder in paths.items()}
    write_json(root / "flat.scene_dataset_config.json", config)
    return root


def _asset(root: Path, name: str) -> Path:
    return root / f"objects/frl_apartment_{name}_01.glb"
