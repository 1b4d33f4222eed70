"""A day as a film, for a talk: what the robot sees on the left, what a third person sees on the right."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any, NamedTuple

from coopera.rundir.directory import RunDir
from coopera.simulation.sight.video import FPS, write_video
from coopera.web.replay3d.poses import acts_of


class Made(NamedTuple):
    """What came of it: the file, its size in bytes, how many moments it shows and for how many seconds."""

    file: Path
    bytes: int
    moments: int
    seconds: float


def write_film(run: RunDir, day: int, file: Path) -> Made:
    """Write a day of a run as an MP4 file.

    Raises:
        ConfigError: If PyAV is not installed.
        RunError: If there is no such day.
        SimulationError: If the file cannot be written.
    """
    count = 0

    def pictures() -> Iterator[Any]:
        nonlocal count
        with closing(acts_of(run, day)) as acts:
            for shown in acts:
                for picture in shown.home.filmed():
                    count += 1
                    yield picture

    write_video(file, pictures())
    return Made(file, file.stat().st_size, count, count / FPS)
