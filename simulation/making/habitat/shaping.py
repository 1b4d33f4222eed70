"""What the meshes of a foreign home give its objects: how they look, and what can be done on and in them."""

from __future__ import annotations

from collections import Counter
from typing import TypeAlias

import numpy as np

from coopera.core.affordances import affordances
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.measured import Measured
from coopera.simulation.homes.measuring import Use, measure
from coopera.simulation.homes.meshes import look_of
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.making.habitat.files import Template
from coopera.simulation.making.habitat.poses import own_mesh
from coopera.simulation.making.habitat.schema import Instance
from coopera.simulation.making.report import Report

Source: TypeAlias = tuple[Template, Instance]
_SEATS, _BEDS = ("seating furniture", "sleeping furniture"), ("sleeping furniture",)


def shaped(
    objects: list[SceneObject], sources: list[Source], report: Report
) -> tuple[list[SceneObject], dict[str, str]]:
    """The objects with their meshes and what is measured on them, and the meshes' files by their names.

    What has no triangles that we can read stays as it is: it is drawn from our own shapes and used by the catalogue.
    """
    files: dict[str, str] = {}
    known: dict[object, Measured] = {}
    seen: list[SceneObject] = []
    without: Counter[str] = Counter()
    for thing, (template, instance) in zip(objects, sources, strict=True):
        look = look_of(own_mesh(template, instance, whole=False), thing.colour)
        files |= look.files
        if not look.parts:
            without[thing.cls] += 1
            seen.append(thing)
            continue
        measured = None
        if thing.fixed or affordances().contains(thing.cls):
            key = (template.asset, thing.size, instance.scale, _tilt(instance), use_of(thing))
            if key not in known:
                known[key] = _measured(thing, template, instance, report)
            measured = known[key]
        seen.append(thing.model_copy(update={"mesh": look.parts, "measured": measured}))
    for cls, count in sorted(without.items()):
        report.guessed.append(
            f"{cls}: the meshes of {count} hold no triangles that we read; used as our shapes, or boxes"
        )
    return seen, files


def use_of(thing: SceneObject) -> Use:
    """What a thing is for, by its super-category or its class."""
    known = catalogue().fixed.get(thing.cls)
    return Use(
        sits=thing.fixed and (thing.category in _SEATS or (known is not None and known.seat is not None)),
        lies=thing.fixed and (thing.category in _BEDS or (known is not None and known.lie is not None)),
        carried=not thing.fixed,
    )


def _tilt(instance: Instance) -> tuple[float, ...]:
    w, x, y, z = instance.rotation
    return tuple(np.round((2 * (x * y - w * z), 2 * (y * z + w * x), w * w - x * x + y * y - z * z), 4).tolist())


def _measured(thing: SceneObject, template: Template, instance: Instance, report: Report) -> Measured:
    """What is measured on a thing's mesh; a closed one that holds things is given the inside of its class."""
    try:
        found = measure(own_mesh(template, instance, whole=True), use_of(thing))
    except ValueError as err:
        report.guessed.append(f"{thing.name}: {err}; things go on its top")
        w, d, h = thing.size
        return Measured(surfaces=[(h, -0.45 * w, 0.45 * w, -0.45 * d, 0.45 * d, 9.0)])
    known = catalogue().fixed.get(thing.cls) or catalogue().movable.get(thing.cls)
    if known is not None and known.inside and not found.inside:
        w, d, h = thing.size
        rows = [
            (z * h, x0 * w, x1 * w, y0 * d, y1 * d, clear * h / known.size[2])
            for z, x0, x1, y0, y1, clear in known.inside
        ]
        report.guessed.append(f"{thing.name}: its mesh is closed; its inside is that of its class, in its size")
        found = found.model_copy(update={"inside": [tuple(round(part, 4) for part in row) for row in rows]})
    report.understood.append(f"{thing.name}: {_in_words(found, thing.position[2])}")
    return found


def _in_words(found: Measured, base: float) -> str:
    """Heights above the floor."""
    said = []
    for what, levels in (("carries things at", found.surfaces), ("holds things at", found.inside)):
        heights = sorted({f"{base + level[0]:.2f}" for level in levels})
        said += [f"{what} {', '.join(heights)} m"] if heights else []
    said += [f"one sits at {base + found.seat.z:.2f} m"] if found.seat else []
    said += [f"one lies at {base + found.lie.z:.2f} m"] if found.lie else []
    return "; ".join(said) or "nothing is put on or in it"
