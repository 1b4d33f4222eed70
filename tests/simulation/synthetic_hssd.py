"""Write a small HSSD folder in the published layout: three rooms, a stage with walls, and things of every odd kind."""

from __future__ import annotations

import json
import math
import struct
from pathlib import Path
from typing import Any

import numpy as np

SCENE = "102344049"
HALF = math.sqrt(0.5)
_FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4)]
_FACES += [(1, 5, 7), (1, 7, 3)]


def write_glb(path: Path, document: dict[str, Any], binary: bytes = b"") -> None:
    """Write a binary glTF file of a JSON document and its data."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        body += struct.pack("<II", len(binary), 0x004E4942) + binary
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body)


def boxes_document(
    boxes: list[tuple[tuple[float, ...], tuple[float, ...]]], **node: Any
) -> tuple[dict[str, Any], bytes]:
    """A glTF document of axis-aligned boxes, each (low corner, high corner), below one node."""
    corners, faces = [], []
    for low, high in boxes:
        faces.append(np.array(_FACES) + 8 * len(corners))
        corners.append(
            [[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
        )
    points, index = np.array(corners, "<f4").reshape(-1, 3), np.array(faces, "<u2").ravel()
    data = points.tobytes() + index.tobytes()
    views = [
        {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes},
        {"buffer": 0, "byteOffset": points.nbytes, "byteLength": index.nbytes},
    ]
    ends = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", **ends},
        {"bufferView": 1, "componentType": 5123, "count": len(index), "type": "SCALAR"},
    ]
    mesh = {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, **node}],
        "meshes": [mesh],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }
    return document, data


def box_glb(path: Path, low: tuple[float, ...], high: tuple[float, ...], **node: Any) -> None:
    write_glb(path, *boxes_document([(low, high)], **node))


def write_json(path: Path, data: Any) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(data), encoding="utf-8")


def change(root: Path, name: str, edit: Any) -> None:
    """Edit a JSON file of the folder in place."""
    path = root / name
    data = json.loads(path.read_text(encoding="utf-8"))
    edit(data)
    path.write_text(json.dumps(data), encoding="utf-8")


TABLE, MUG, BED, CLOCK, PART, DOOR = "a1table", "b2mug", "c3bed", "d4clock", "e5shelf_part_1", "f6door"

INSTANCES: list[dict[str, Any]] = [
    {"template_name": TABLE, "translation": [2, 0, -2], "motion_type": "STATIC"},  # no rotation, no scale
    {"template_name": MUG, "translation": [2.3, 0.75, -2.1], "rotation": [HALF, 0, HALF, 0]},
    {"template_name": MUG, "translation": [1.7, 0.75, -1.9], "rotation": [1, 0, 0, 0], "uniform_scale": 2.0},
    {
        "template_name": BED,
        "translation": [7, 0, -1.5],
        "rotation": [math.cos(math.pi / 12), 0, math.sin(math.pi / 12), 0],
        "non_uniform_scale": [1.5, 1.0, 0.5],
    },
    {"template_name": CLOCK, "translation": [0.1, 2.6, -2], "rotation": [1, 0, 0, 0]},  # too high to reach
    {"template_name": PART, "translation": [8, 0.5, -5], "translation_origin": "COM"},
    {"template_name": DOOR, "translation": [5, 0, -2]},
    {"template_name": MUG, "translation": [7, 0.06, -5], "rotation": [HALF, HALF, 0, 0]},  # lies on its side
]


def write_hssd(root: Path) -> Path:
    """Write the folder: a kitchen and a bedroom side by side, a hall behind both, doorways between them."""
    (root / "hssd.scene_dataset_config.json").parent.mkdir(parents=True, exist_ok=True)
    write_json(root / "hssd.scene_dataset_config.json", {"objects": {"paths": {".json": ["objects/*"]}}})
    for name, folder, low, high, more in (
        (TABLE, "a", (-0.6, 0, -0.4), (0.6, 0.75, 0.4), {}),
        (MUG, "b", (-0.05, 0, -0.04), (0.07, 0.1, 0.04), {}),
        (BED, "c", (-0.5, 0, -1.0), (0.5, 0.5, 1.0), {}),
        (CLOCK, "d", (-0.1, -0.1, 0), (0.1, 0.1, 0.05), {}),
        (PART, "decomposed/e5shelf", (0, 0, 0), (0.8, 1.0, 0.4), {}),
        (DOOR, "openings", (-0.05, 0, -0.5), (0.05, 2, 0.5), {}),
    ):
        box_glb(root / "objects" / folder / f"{name}.glb", low, high)
        config = {"render_asset": f"{name}.glb", "collision_asset": f"{name}.collider.glb", **more}
        write_json(root / "objects" / folder / f"{name}.object_config.json", config)
    (root / "semantics").mkdir()
    (root / "semantics/objects.csv").write_text(
        "id,name,wnsynsetkey,super_category,support\n"
        f'{TABLE},"Dining table, oak",table.n.02,support_furniture,floor\n'
        f"{MUG},,mug.n.04,dining_ware,\n"
        f"{BED},Bed,bed.n.01,sleeping_furniture,\n"
        f"{CLOCK},Wall Clock,,decor,\n"
        f"e5shelf,shelf,,storage_furniture,\n",
        encoding="utf-8",
    )
    regions = [
        {"name": "kitchen_1", "label": "kitchen", "poly_loop": [[0, 0, 0], [4.9, 0, 0], [4.9, 0, -4], [0, 0, -4]]},
        {"name": "bedroom_1", "label": "bedroom", "min_bounds": [5.1, 0, -4], "max_bounds": [9.9, 2.7, 0]},
        {"name": "hall_1", "label": "hallway", "min_bounds": [0, 0, -6.5], "max_bounds": [9.9, 2.7, -4.1]},
        {"name": "attic", "label": "bedroom", "floor_height": 3.0, "min_bounds": [0, 3, -4], "max_bounds": [9, 5, 0]},
    ]
    write_json(root / f"semantics/scenes/{SCENE}.semantic_config.json", {"region_annotations": regions})
    scene = {"translation_origin": "asset_local", "stage_instance": {"template_name": f"stages/{SCENE}"}}
    write_json(root / f"scenes/{SCENE}.scene_instance.json", {**scene, "object_instances": INSTANCES})
    walls = [
        ((-0.1, 0, -4), (0.0, 2.5, 0)),  # west of the kitchen
        ((4.9, 0, -1.5), (5.1, 2.5, 0)),  # between kitchen and bedroom, a doorway behind it
        ((4.9, 0, -4.1), (5.1, 2.5, -2.7)),
        ((0, 0, -4.1), (6.5, 2.5, -4.0)),  # before the hall, a doorway at x = 6.5 to 7.5
        ((7.5, 0, -4.1), (9.9, 2.5, -4.0)),
    ]
    write_glb(root / f"stages/{SCENE}.glb", *boxes_document(walls))
    write_json(root / f"stages/{SCENE}.stage_config.json", {"render_asset": f"{SCENE}.glb"})
    return root
