"""Readers of homes, their meshes and pictures, and goals in them, for `benchmarks.fuzz`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.fuzzing import mutations as change
from benchmarks.fuzzing.kit import ROOT, Reader, Target, a_picture, in_yaml, of_file
from coopera.core.foreign.pictures import open_picture
from coopera.simulation.goals.files import read_goals
from coopera.simulation.homes.glb import read_glb
from coopera.simulation.homes.meshes import look_of, part_file
from coopera.simulation.homes.scene import MeshPart, dump_scene, load_scene
from coopera.simulation.making.habitat.files import Folder
from coopera.simulation.making.procthor.files import read_assets, read_house
from coopera.simulation.making.procthor.plan import plan_of
from coopera.simulation.making.procthor.things import kind_of
from tests.simulation.polygons import polygon_flat
from tests.simulation.procthor_house import ASSETS, house
from tests.simulation.synthetic_hssd import SCENE, boxes_document, write_glb, write_hssd


def _hssd(name: str) -> Callable[[Path], Target]:
    def ready(folder: Path) -> Target:
        root = write_hssd(folder / "hssd")
        return Target(root / name, [(root / name).read_bytes()], lambda: _read_hssd(root))

    return ready


def _read_hssd(root: Path) -> object:
    hssd = Folder(root)
    scene = hssd.scene(SCENE)
    regions = [(one.title, one.floor, one.x0, one.x1, one.z0, one.z1) for one in hssd.regions(SCENE)]
    made: list[tuple[object, object, bool]] = []
    for number, one in enumerate(scene.object_instances):
        try:
            made.append((hssd.template(SCENE, number, one.template_name), one.scale, one.by_mass))
        except FileNotFoundError as err:  # a sentence for the user, who may leave such things out
            made.append((str(err), one.scale, one.by_mass))
    return regions, made, hssd.stage(SCENE)


def _glb() -> bytes:
    document, data = boxes_document([((0, 0, 0), (1, 1, 1)), ((2, 0, 0), (3, 1, 1))], translation=[1, 0, 0])
    picture = a_picture("PNG")
    document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(picture)})
    document |= {
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "baseColorTexture": {"index": 0}}}]
    }
    document |= {"textures": [{"source": 0}], "images": [{"bufferView": 2, "mimeType": "image/png"}]}
    document["meshes"][0]["primitives"][0]["material"] = 0
    document["nodes"] += [
        {"children": [0], "rotation": [0, 0, 0, 1], "scale": [2, 1, 1]},
        {"matrix": np.eye(4).ravel().tolist(), "mesh": 0},
    ]
    document["scenes"] = [{"nodes": [1, 2]}]
    path = Path("/dev/shm/coopera-fuzz-seed.glb") if Path("/dev/shm").is_dir() else Path("coopera-fuzz-seed.glb")
    write_glb(path, document, data + picture)
    found = path.read_bytes()
    path.unlink()
    return found


def _read_glb(path: Path) -> object:
    return look_of(read_glb(path), "#336699")


def _obj(path: Path) -> object:
    return part_file(path.parent, MeshPart(file=path.name, colour="#336699"))


def _scene(path: Path) -> object:
    scene = load_scene(path)
    return dump_scene(scene), scene.walls()


def _small_scene() -> bytes:
    data = json.loads((ROOT / "simulation/scenes/maple.json").read_text(encoding="utf-8"))
    fixed = [one for one in data["objects"] if one["fixed"]][:3]
    names = {one["name"] for one in fixed}
    loose = [one for one in data["objects"] if not one["fixed"] and one.get("on") in names][:3]
    return json.dumps({**data, "objects": fixed + loose}).encode()


def _read_picture(path: Path) -> object:
    with open_picture(path.read_bytes()) as image:
        return image.convert("RGB").resize((8, 8))


def _goals(path: Path) -> object:
    return [str(goal) for goal in read_goals(path).values()]


_GOALS = in_yaml(
    {
        "goals": {
            "tidy": {"all": ["clean(every plate)", {"not": "open(fridge)"}]},
            "mug": "on(mug, dining table) or inside(mug, dishwasher)",
            "day": {"then": ["at(human, kitchen)", "holding(human, mug)"]},
            "rest": {"eventually": "performed(human, sit and rest)"},
        }
    }
)


_BOX = (
    b"v 0.0000 0.0000 0.0000\nv 1.0000 0.0000 0.0000\nv 0.0000 1.0000 0.0000\nvn 0.000 0.000 1.000\nf 1//1 2//1 3//1\n"
)


def _house(path: Path) -> object:
    found = read_house(path)
    plan = plan_of(found, path)
    return [kind_of(item, {}) for item in found.items()], plan.rooms, plan.doors


READERS: dict[str, Reader] = {
    "polygons": Reader(of_file("flat.json", [json.dumps(polygon_flat()).encode()], _scene), change.in_json),
    "procthor": Reader(of_file("house.json", [json.dumps(house()).encode()], _house), change.in_json),
    "procthor-assets": Reader(of_file("assets.json", [json.dumps(ASSETS).encode()], read_assets), change.in_json),
    "scene": Reader(of_file("maple.json", [_small_scene()], _scene), change.in_json),
    "hssd-scene": Reader(_hssd(f"scenes/{SCENE}.scene_instance.json"), change.in_json),
    "hssd-rooms": Reader(_hssd(f"semantics/scenes/{SCENE}.semantic_config.json"), change.in_json),
    "hssd-object": Reader(_hssd("objects/b/b2mug.object_config.json"), change.in_json),
    "hssd-table": Reader(_hssd("semantics/objects.csv"), change.in_cells),
    "glb": Reader(of_file("thing.glb", [_glb()], _read_glb), change.in_glb),
    "obj": Reader(of_file("part.obj", [_BOX * 4], _obj), change.anywhere),
    "picture": Reader(
        of_file("p.png", [a_picture(kind) for kind in ("PNG", "JPEG", "WEBP")], _read_picture),
        change.anywhere,
        (ValueError,),
    ),
    "goals": Reader(of_file("goals.yaml", [_GOALS], _goals), change.in_yaml),
}
