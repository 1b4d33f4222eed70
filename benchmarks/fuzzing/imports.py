"""All that is done with a home of a Habitat data set when it is imported, for `benchmarks.fuzz`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from benchmarks.fuzzing import mutations as change
from benchmarks.fuzzing.kit import Reader, Target
from coopera.homes.stored import bring_in
from coopera.simulation.making.habitat import poses
from tests.simulation.synthetic_hssd import HALF, MUG, PART, SCENE, TABLE, boxes_document, write_glb, write_hssd
from tests.simulation.synthetic_hssd import change as edit

_ROOMS_FILE, _SCENE_FILE = f"semantics/scenes/{SCENE}.semantic_config.json", f"scenes/{SCENE}.scene_instance.json"
_ROOMS = [
    {"name": "kitchen_1", "label": "kitchen", "poly_loop": [[0, 0, 0], [3.5, 0, 0], [3.5, 0, -3], [0, 0, -3]]},
    {"name": "hall_1", "label": "hallway", "min_bounds": [0, 0, -4.5], "max_bounds": [3.5, 2.7, -3.1]},
]
_THINGS = [
    {"template_name": TABLE, "translation": [1.2, 0, -1.6], "motion_type": "STATIC"},
    {"template_name": MUG, "translation": [1.3, 0.75, -1.7], "rotation": [HALF, 0, HALF, 0], "uniform_scale": 1.2},
    {"template_name": PART, "translation": [2.5, 0.5, -4.1], "translation_origin": "COM"},
]
_WALLS: list[tuple[tuple[float, ...], tuple[float, ...]]] = [
    ((-0.1, 0, -4), (0.0, 2.5, 0)),
    ((0, 0, -3.1), (1.5, 2.5, -3.0)),
    ((2.5, 0, -3.1), (3.5, 2.5, -3.0)),
]


def _home(name: str) -> Callable[[Path], Target]:
    """A kitchen with a mug on a table, and a hall with a shelf: small, so that it is soon proved to be lived in."""

    def ready(folder: Path) -> Target:
        root = write_hssd(folder / "hssd")
        edit(
            root, f"semantics/scenes/{SCENE}.semantic_config.json", lambda data: data.update(region_annotations=_ROOMS)
        )
        edit(root, f"scenes/{SCENE}.scene_instance.json", lambda data: data.update(object_instances=_THINGS))
        write_glb(root / f"stages/{SCENE}.glb", *boxes_document(_WALLS))
        path = root / name
        return Target(path, [path.read_bytes()], lambda: _import(root, folder / "homes"))

    return ready


def _import(root: Path, homes: Path) -> object:
    for cache in (poses._whole, poses._small, poses._corners):
        cache.cache_clear()
    return bring_in(root, homes, skip_missing=True, force=True)


READERS: dict[str, Reader] = {
    "import-mesh": Reader(_home(f"objects/a/{TABLE}.glb"), change.in_glb),
    "import-object": Reader(_home(f"objects/a/{TABLE}.object_config.json"), change.in_json),
    "import-rooms": Reader(_home(_ROOMS_FILE), change.in_json),
    "import-scene": Reader(_home(_SCENE_FILE), change.in_json),
    "import-stage": Reader(_home(f"stages/{SCENE}.glb"), change.in_glb),
}
