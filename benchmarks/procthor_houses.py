"""Houses by ProcTHOR's own generator, without Unity.

    PYTHONHASHSEED=0 python -m benchmarks.procthor_houses OUT any:1 5-room:7

Needs `pip install --no-deps procthor networkx` (0.0.1.dev2) besides what coopera needs. Each house is SPEC:SEED, with
the name of one of its room specifications or `any`. Floor plans, doors, windows, furniture and what hangs on walls are
its code's. Two things need Unity and are not: groups of furniture such as chairs around a table do not come, and small
things are put at random places on the furniture that its table of receptacles names, with the chances of that table.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

_UNITY = {"ai2thor.controller": "Controller", "moviepy.editor": "ImageSequenceClip", "pysat.solvers": "Solver"}
"""Modules that the package imports and that are not needed without Unity, each with what is taken from it."""
_MORE, _MOST = 0.15, 6


def main() -> None:
    """Write the houses that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("houses", nargs="+", metavar="SPEC:SEED")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    making = _generator()
    for house in given.houses:
        spec, _, seed = house.partition(":")
        sampler = making.PROCTHOR10K_ROOM_SPEC_SAMPLER
        one = sampler if spec == "any" else SimpleNamespace(sample=lambda found=sampler[spec]: found)
        unity = SimpleNamespace(step=lambda **_: None, reset=lambda **_: None)
        generator = making.HouseGenerator(split="train", seed=int(seed), room_spec_sampler=one, controller=unity)
        data = generator.sample()[0].data
        data.pop("metadata", None)
        file = given.out / f"procthor-{spec}-{seed}.json"
        file.write_text(json.dumps(data, default=lambda number: number.item(), indent=1))
        print(f"{file}: {len(data['rooms'])} rooms, {len(data['objects'])} objects")


def _generator() -> Any:
    """The package's generator, with what needs Unity taken out."""
    for name, taken in _UNITY.items():
        for module in (name.partition(".")[0], name):
            sys.modules.setdefault(module, ModuleType(module))
        setattr(sys.modules[name], taken, type(taken, (), {}))
    making: Any = import_module("procthor.generation")
    objects: Any = import_module("procthor.generation.objects")
    known: Any = import_module("procthor.databases")
    pandas = import_module("pandas")
    columns = ["assetGroupName", *(f"in{room}s" for room in ("Kitchen", "LivingRoom", "Bedroom", "Bathroom"))]
    columns += ["xSize", "ySize", "zSize", "inCorner", "onEdge", "inMiddle", "allowDuplicates", "weight", "minXSize"]
    columns += [f"has{type_}" for type_ in known.asset_database]
    none = (
        pandas.DataFrame([dict.fromkeys(columns, 0)]).iloc[:0].astype({f"has{t}": bool for t in known.asset_database})
    )
    objects.P_CHOOSE_ASSET_GROUP = 0.0
    objects.get_spawnable_asset_group_info = lambda split, controller: none
    making.assign_layer_to_rooms = lambda partial_house: None
    making.add_small_objects = lambda partial_house, split, **_: _small_things(partial_house, split, known)
    return making


def _small_things(house: Any, split: str, known: Any) -> None:
    """Put things on furniture."""
    kinds = {room["id"]: room["roomType"] for room in house.room_types}
    for number, thing in enumerate(house.objects):
        asset = known.asset_id_database[thing["assetId"]]
        box: Any = asset["boundingBox"]
        children: list[dict[str, Any]] = []
        room = kinds[f"room|{thing['id'].split('|')[0]}"]
        for type_, chance in known.objects_in_receptacles.get(asset["objectType"], {}).items():
            belongs = known.placement_annotations.loc[type_].get(f"in{room}s", 0)
            if not belongs or random.random() > chance["p"] + _MORE or len(children) >= _MOST:
                continue
            fitting = [row for row in known.asset_database.get(type_, []) if row["split"] == split]
            fitting = [row for row in fitting if all(row["boundingBox"][side] <= box[side] for side in ("x", "z"))]
            if fitting:
                one = random.choice(fitting)
                children.append(_on(thing, box, one, f"{thing['id']}|{type_}|{number}"))
        if children:
            thing["children"] = children


def _on(thing: Any, box: Any, asset: Any, id: str) -> dict[str, Any]:
    """A thing at a random place on another, on half the height of what one sits on."""
    own, turn = asset["boundingBox"], -math.radians(thing["rotation"]["y"])
    x, z = (random.uniform(-0.5, 0.5) * (box[side] - own[side]) for side in ("x", "z"))
    soft = any(word in thing["assetId"].lower() for word in ("bed", "sofa", "chair"))
    place = {
        "x": thing["position"]["x"] + x * math.cos(turn) - z * math.sin(turn),
        "y": thing["position"]["y"] + (0.0 if soft else box["y"] / 2) + own["y"] / 2,
        "z": thing["position"]["z"] + x * math.sin(turn) + z * math.cos(turn),
    }
    turned = {"x": 0, "y": random.choice([0, 90, 180, 270]), "z": 0}
    return {"id": id, "assetId": asset["assetId"], "position": place, "rotation": turned, "kinematic": False}


if __name__ == "__main__":
    main()
