"""Frames as data URIs, as many as fit, so that the report is one file that stays quick to open."""

from __future__ import annotations

import base64
import io
from collections import defaultdict
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import chain
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from coopera.core.hour import HourRecord
from coopera.rundir.helping import help_frames

SMALL = (160, 120)  # pixels, where even one full frame per view and hour is too much
TYPES = {".webp": "image/webp", ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}


class Album(NamedTuple):
    """Frames by hour and view, each a data URI in order of time.

    `kept` of `taken` frames per view are in it; `small` says that they were made smaller to fit.
    """

    views: dict[tuple[int, int], dict[str, list[str]]]
    kept: int
    taken: int
    small: bool

    @property
    def size(self) -> int:
        """Characters of all data URIs together."""
        return sum(len(uri) for views in self.views.values() for files in views.values() for uri in files)


class Frames(NamedTuple):
    """The pictures of hours by (day, hour) and view, in order of time, and how many bytes each has."""

    hours: dict[tuple[int, int], dict[str, list[Path]]]
    sizes: dict[Path, int]


def frames_by_view(root: Path, frames: Mapping[tuple[int, int], Sequence[str]]) -> Frames:
    """Sort pictures by view, and leave out what is no picture of the run.

    Args:
        root: The run directory, to which the frames' paths are relative.
        frames: Paths by (day, hour), in order of time; the file name but its number is the view ("robot-3.webp").
    """
    hours = {key: _by_view(root, paths) for key, paths in frames.items()}
    return Frames(hours, {path: path.stat().st_size for views in hours.values() for path in chain(*views.values())})


def embed(frames: Frames, budget: int) -> Album:
    """Embed the frames of all hours within `budget` characters, evenly thinned where there are too many.

    Args:
        frames: The frames.
        budget: Most characters that all data URIs together may take.
    """
    hours, sizes = frames
    taken = max((len(files) for views in hours.values() for files in views.values()), default=0)
    for kept in range(taken, 0, -1):
        chosen = [path for views in hours.values() for files in views.values() for path in thin(files, kept)]
        if sum(sizes[path] * 4 // 3 + 32 for path in chosen) <= budget:
            return Album(_encoded(hours, kept, small=False), kept, taken, small=False)
    if taken and len(sizes) // taken * 3000 <= budget:
        return Album(_encoded(hours, 1, small=True), 1, taken, small=True)
    return Album({}, 0, taken, small=False)


def pictures_of(root: Path, record: HourRecord) -> list[str]:
    """The pictures of an hour, relative to the run: those that the trace names, and those of the robot's help."""
    seen = list(record.robot.observation.frames) if record.robot else []
    return [*seen, *chain(*help_frames(root, record.day, record.hour).values())]


def view_of(path: PurePosixPath) -> str:
    """The view that a picture is of: "robot" of robot-3.webp, "help-0" of help-0-1.webp."""
    return path.stem.rpartition("-")[0]


def thin(files: Sequence[Path], count: int) -> list[Path]:
    """Keep `count` files, evenly spread, the first and the last among them where there are two or more."""
    if count >= len(files):
        return list(files)
    if count == 1:
        return [files[len(files) // 2]]
    return [files[round(index * (len(files) - 1) / (count - 1))] for index in range(count)]


def _by_view(root: Path, paths: Sequence[str]) -> dict[str, list[Path]]:
    views: dict[str, list[Path]] = defaultdict(list)
    for path in paths:
        pure = PurePosixPath(path)
        if pure.suffix in TYPES and is_of_the_run(root / pure, root):
            views[view_of(pure)].append(root / pure)
    return dict(views)


def is_of_the_run(path: Path, root: Path) -> bool:
    """Whether a path names a picture of the run: one from elsewhere, or a link, must not put other files on a page."""
    try:
        return path.resolve().is_relative_to(root.resolve()) and path.is_file()
    except (OSError, ValueError, RuntimeError):  # such as a name that no file can have, or a link in a circle
        return False


def _encoded(
    hours: Mapping[tuple[int, int], Mapping[str, Sequence[Path]]], kept: int, *, small: bool
) -> dict[tuple[int, int], dict[str, list[str]]]:
    chosen = {key: {view: thin(files, kept) for view, files in views.items()} for key, views in hours.items()}
    paths = [path for views in chosen.values() for files in views.values() for path in files]
    if small:
        with ThreadPoolExecutor() as pool:  # Pillow does not hold the interpreter
            uris = dict(zip(paths, pool.map(partial(_data_uri, small=True), paths), strict=True))
    else:
        uris = {path: _data_uri(path, small=False) for path in paths}
    return {
        key: {view: found for view, files in views.items() if (found := [uris[path] for path in files if uris[path]])}
        for key, views in chosen.items()
    }


def _data_uri(path: Path, *, small: bool) -> str:
    """A frame as text; empty where it should be made smaller and is no picture."""
    data, kind = path.read_bytes(), TYPES[path.suffix]
    if small:
        from PIL.Image import Resampling  # noqa: PLC0415  (most reports never need it)

        from coopera.core.foreign.pictures import open_picture  # noqa: PLC0415

        out = io.BytesIO()
        try:
            with open_picture(data) as image:
                image.thumbnail(SMALL, Resampling.BOX, reducing_gap=1.0)  # halves in a fifth of the time
                image.save(out, "WEBP", quality=40, method=2)  # half the time of the defaults, for 6 % more bytes
        except ValueError:
            return ""
        data, kind = out.getvalue(), "image/webp"
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"
