"""What a reader is to `benchmarks.fuzz`, and what readers of several kinds need."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml
from PIL import Image

from benchmarks.fuzzing import mutations as change
from coopera.core.errors import CooperaError

ROOT = Path(__file__).parents[2]


class Target(NamedTuple):
    """A reader made ready in a folder: the file that is changed, how it was, and what reads it."""

    path: Path
    seeds: Sequence[bytes]
    read: Callable[[], object]


class Reader(NamedTuple):
    """A reader, how its files are changed, and the errors that are its sentences."""

    ready: Callable[[Path], Target]
    mutate: change.Mutate
    ours: tuple[type[Exception], ...] = (CooperaError,)


def of_file(name: str, seeds: Sequence[bytes], read: Callable[[Path], object]) -> Callable[[Path], Target]:
    """Make ready the reader of one file that lies alone in its folder."""

    def ready(folder: Path) -> Target:
        return Target(folder / name, seeds, lambda: read(folder / name))

    return ready


def in_yaml(data: Any) -> bytes:
    """Data as a YAML file."""
    return yaml.dump(data, Dumper=yaml.CSafeDumper, allow_unicode=True, sort_keys=False).encode()


def loaded(name: str) -> Any:
    """What stands in a YAML file of this project, by its path from the root."""
    return yaml.load((ROOT / name).read_bytes(), yaml.CSafeLoader)


def a_picture(kind: str) -> bytes:
    """A small picture, as a file of a kind that Pillow knows."""
    out = io.BytesIO()
    Image.fromarray(np.arange(432, dtype=np.uint8).reshape(12, 12, 3)).save(out, kind)
    return out.getvalue()
