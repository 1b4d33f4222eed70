"""Depth, instances and classes of each picture of a run's first tasks, as files beside a data set.

No run keeps them: the acts are done again from the trace (`coopera.studies.replay`), and seen through the same cameras.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import ConfigError, RunError
from coopera.core.hour import HourRecord
from coopera.rundir.directory import RunDir
from coopera.simulation import World
from coopera.simulation.drawing.view import View
from coopera.studies.replay import replay

_FARTHEST = 65.535
"""Metres that a file can tell; what is farther away is nothing."""


def _millimetres(view: View) -> NDArray[np.uint16]:
    known = np.where(view.depth <= _FARTHEST, view.depth, 0.0)
    return np.round(1e3 * known).astype(np.uint16)


KINDS: Mapping[str, Callable[[View], NDArray[np.uint16]]] = {
    "depth": _millimetres,
    "instances": lambda view: (view.instances + 1).astype(np.uint16),
    "classes": lambda view: view.classes.astype(np.uint16),
}
"""What a view's file holds in each pixel, (height, width): millimetres, or a number of which `views.json` has the name.

0 is nothing.
"""


def kinds_of(text: str) -> list[str]:
    """The kinds of a list such as "depth,classes".

    Raises:
        ConfigError: If one of them is unknown.
    """
    kinds = [one.strip() for one in text.split(",") if one.strip()]
    for one in kinds:
        if one not in KINDS:
            raise ConfigError(f"views: {one!r} is unknown; there are {', '.join(KINDS)}.")
    return kinds


def export_views(run: RunDir, out: Path, kinds: Sequence[str]) -> int:
    """Write out/day-DD/hour-HH/NAME-KIND.png of 16 bits for each picture NAME, and what belongs to it in views.json.

    Returns:
        How many files were made, views.json not counted.

    Raises:
        ConfigError: If our own renderer is not to be had.
        RunError: If the run has no hours, met days lived before, comes out otherwise here, or a file cannot be written.
    """
    drawn = run.config.model_copy(update={"renderer": "gl", "labels": False})
    made = 0

    def look(record: HourRecord, world: World) -> None:
        nonlocal made
        folder = out / f"day-{record.day:02d}" / f"hour-{record.hour:02d}"
        folder.mkdir(parents=True)
        views = world.frame_views(run.config.frames)
        for name, view in views.items():
            for kind in kinds:
                Image.fromarray(KINDS[kind](view)).save(folder / f"{name}-{kind}.png")
                made += 1
        kept = set(record.robot.observation.frames) if record.robot else set()
        write_atomic(folder / "views.json", canonical_json([_about(name, view, kept) for name, view in views.items()]))

    try:
        for hour in replay(RunDir(run.root, drawn, run.info, None), look):
            if hour.difference:
                raise RunError(f"{run.root}: day {hour.day}, hour {hour.hour}: {hour.difference}, so views would lie.")
    except OSError as err:
        raise RunError(f"{out}: the views cannot be written ({reason(err)}).") from err
    return made


def _about(name: str, view: View, kept: set[str]) -> dict[str, Any]:
    """What belongs to a view, besides its files."""
    instances, classes = np.unique(view.instances[view.instances >= 0]), np.unique(view.classes[view.classes > 0])
    return {
        "name": name,
        "picture": next((file for file in kept if Path(file).stem == name), None),
        "intrinsics": view.intrinsics.tolist(),
        "world_to_camera": view.extrinsics.tolist(),
        "instances": {str(body + 1): view.names.get(body, "") for body in instances.tolist()},
        "classes": {str(number): view.class_names[number] for number in classes.tolist()},
    }
