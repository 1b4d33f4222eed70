"""The one reader of NumPy's files, .npy and .npz: numbers only, and never more than the file says and holds."""

from __future__ import annotations

import io
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_limited

Array = NDArray[Any]

MOST_BYTES = 128 * 2**20
"""Of the file, and of all that is unpacked of it."""
MOST_MEMBERS = 1000
_KINDS = "fiu"
_BEGINS = b"\x93NUMPY"
_ENTRY = b"PK\x01\x02"
_PLAIN = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # others may ask for gigabytes to unpack a few bytes
_FAILURES = (
    *(OSError, EOFError, ValueError, TypeError, LookupError, ArithmeticError, RuntimeError, SyntaxError),
    *(MemoryError, NotImplementedError, tokenize.TokenError, struct.error, zlib.error, zipfile.BadZipFile),
)


def read_arrays(
    path: Path, names: Collection[str], *, most_bytes: int = MOST_BYTES, what: str = "motion file"
) -> Array | dict[str, Array]:
    """Read a file's array, or of an .npz those of `names` that it holds; nothing in it is executed.

    `most_bytes` are allowed of the file, and of all that is unpacked of it; `what` names the kind of file in errors.

    Raises:
        ConfigError: If it cannot be read, is neither, holds something else than numbers, or is too large.
    """
    data = read_limited(path, most_bytes, what)
    try:
        if data.startswith(_BEGINS):
            return _array(data)
        if data.count(_ENTRY) > MOST_MEMBERS:
            raise ValueError(f"it holds more than {MOST_MEMBERS} arrays")
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return _members(archive, names, most_bytes)
    except _FAILURES as err:
        why = " ".join(str(err).split())[:200] or type(err).__name__
        raise ConfigError(f"The {what} {path} cannot be read: {why}.") from err


def _members(archive: zipfile.ZipFile, names: Collection[str], most_bytes: int) -> dict[str, Array]:
    wanted = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
    wanted = {name: info for name, info in wanted.items() if name in names}
    if sum(info.file_size for info in wanted.values()) > most_bytes:
        raise ValueError(f"unpacked it has more than {most_bytes >> 20} MiB")
    if any(info.compress_type not in _PLAIN for info in wanted.values()):
        raise ValueError("it is compressed in a way that NumPy does not use")
    return {name: _array(archive.read(info)) for name, info in wanted.items()}


def _array(data: bytes) -> Array:
    """An array of a .npy file's bytes, of which no more memory is asked for than the bytes have."""
    file = io.BytesIO(data)
    version = np.lib.format.read_magic(file)
    reads = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    if version not in reads:
        raise ValueError(f"version {version} of the format is not known")
    shape, by_column, kind = reads[version](file)
    if kind.kind not in _KINDS:
        raise ValueError(f"it must hold numbers, not {kind}")
    count = 1
    for size in shape:
        count *= size
    held = (len(data) - file.tell()) // kind.itemsize
    if not 0 <= count <= held or min(shape, default=0) < 0:
        raise ValueError(f"its shape {str(shape)[:80]} needs {count} numbers, and it has {held}")
    flat = np.frombuffer(data, kind, count, file.tell())
    return flat.reshape(shape, order="F" if by_column else "C")
