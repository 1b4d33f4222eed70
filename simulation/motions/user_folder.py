"""A user's own motions: a folder of SMPL-X clips (Motion-X .npy, AMASS .npz) beside those that ship.

A clip's caption stands in NAME.txt beside it (its first line, as Motion-X has it), or is the file's name in words. What
is to be otherwise stands in motions.yaml: `NAME.npy: {caption: …, class: …, posture: stand|sit|lie|floor}`. Without a
class, a clip has that of the shipped motion that shares most words with its caption.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml
from pydantic import Field, ValidationError

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.people import Frozen
from coopera.core.strict_yaml import MOST_BYTES, load_yaml
from coopera.simulation.motions.library import Hold, Library, Motion, Posture, load_library
from coopera.simulation.motions.poses import clip

_LISTED = "motions.yaml"
_LONGEST = 60


class Entry(Frozen):
    """What motions.yaml may say of a clip."""

    caption: str | None = Field(None, min_length=1, max_length=_LONGEST)
    cls: str | None = Field(None, alias="class", min_length=1, max_length=_LONGEST)
    posture: Posture | None = None
    hold: Hold = "right"


def load_motions(folder: Path | None = None) -> Library:
    """The shipped motions, and those of a folder; one of the same caption replaces the shipped one.

    Raises:
        ConfigError: If there is no such folder, it holds no clip, or a file of it cannot be used.
    """
    shipped = load_library()
    if folder is None:
        return shipped
    files = sorted(path for path in folder.glob("*") if path.suffix in (".npy", ".npz")) if folder.is_dir() else []
    if not files:
        raise ConfigError(f"motions: {folder} must be a folder with .npy or .npz clips, and there are none.")
    entries = _entries(folder, {path.name for path in files})
    own: dict[str, Motion] = {}
    for path in files:
        motion = _motion(path, entries.get(path.name, Entry()), shipped)
        if motion.caption in own:
            raise ConfigError(f"The motion file {path}: another clip of {folder} is called {motion.caption!r}, too.")
        own[motion.caption] = motion
    return Library([*(motion for motion in shipped.motions if motion.caption not in own), *own.values()])


def _entries(folder: Path, names: set[str]) -> dict[str, Entry]:
    path = folder / _LISTED
    if not path.is_file():
        return {}
    try:
        data: Any = load_yaml(read_text(path, "motion list", MOST_BYTES))
    except yaml.YAMLError as err:
        raise ConfigError(f"The motion list {path} cannot be read: {' '.join(str(err).split())}.") from err
    if not isinstance(data, dict):
        raise ConfigError(f"The motion list {path} must hold a mapping of file names.")
    found = {}
    for name, entry in data.items():
        if name not in names:
            raise ConfigError(f"The motion list {path} names {name!r}, which is no clip of that folder.")
        try:
            found[name] = Entry.model_validate(entry)
        except ValidationError as err:
            first = err.errors()[0]
            field = ".".join([name, *(str(part) for part in first["loc"])])
            raise ConfigError(f"The motion list {path}, field {field}: {first['msg']}.") from err
    return found


def _motion(path: Path, entry: Entry, shipped: Library) -> Motion:
    caption = entry.caption or _caption(path)
    recorded = clip(str(path.resolve()))
    low = float(sorted(recorded.poses[:, 2].tolist())[len(recorded.poses) // 2]) < 0.4
    return Motion.model_validate(
        {
            "caption": caption,
            "class": entry.cls or shipped.match(caption).cls,
            "posture": entry.posture or ("floor" if low else "stand"),
            "keys": {"clip": str(path.resolve()), "period": recorded.seconds, "hold": entry.hold},
        }
    )


def _caption(path: Path) -> str:
    """The caption in the text beside a clip, else its name in words, in lower case and cut at a word."""
    beside = path.with_suffix(".txt")
    text = read_text(beside, "caption", MOST_BYTES).strip().split("\n")[0] if beside.is_file() else ""
    words = " ".join((text or path.stem.replace("_", " ").replace("-", " ")).lower().rstrip(".").split())
    return words if len(words) <= _LONGEST else words[:_LONGEST].rsplit(" ", 1)[0]
