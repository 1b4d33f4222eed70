"""Look at a store in a process of its own: `python -m coopera.memory.probe FOLDER [--all]`.

Chroma's index is native code, and a damaged index file can end the process that reads it. So a copied store, or one
not closed properly, is first opened here: the end of this process loses nothing. Ends with status 0 if the store can be
read, else with the reason on standard error (or by a signal). The caller holds the store's lock.
"""

from __future__ import annotations

import struct
import sys
from functools import partial
from pathlib import Path

import numpy as np
import numpy.typing as npt

from coopera.core.errors import MemoryStoreError
from coopera.memory.client import open_client
from coopera.memory.folder import DamagedMemoryError
from coopera.memory.log import Log
from coopera.memory.scan import BLOCK
from coopera.memory.store import Store

_HEADER = struct.Struct("<iQQQQQQiIQQQdQ")  # of the index library in Chroma 1.5


def _check_index(folder: Path) -> None:
    """Check what Chroma does not: damaged links make it write files without end, or end the process that writes.

    Per element, link_lists.bin holds a length in bytes (uint32) and as many bytes of links; header.bin tells the
    number of elements, their size, and the highest level that links may be of. Each element of data_level0.bin begins
    with the number of its links on the lowest level (uint16, and two bytes of flags) and the elements they lead to.

    Raises:
        MemoryStoreError: If an index file cannot be what was written.
    """
    for header in sorted(folder.glob("*/header.bin")):
        data = header.read_bytes()
        if len(data) != _HEADER.size:
            raise MemoryStoreError(f"{header} has {len(data)} bytes, where {_HEADER.size} were expected")
        _, _, most, count, size, _, _, levels, _, links, lowest, *_ = _HEADER.unpack(data)
        vectors = header.with_name("data_level0.bin")
        held = vectors.stat().st_size
        if not count <= most or held not in (count * size, most * size) or size < 4 * (lowest + 1):
            raise MemoryStoreError(f"{header} tells of {count} vectors of {size} bytes, in a file of {held} bytes")
        if count and not _lead_somewhere(np.memmap(vectors, np.uint8, "r", shape=(count, size)), lowest):
            raise MemoryStoreError(f"{vectors} is damaged: its links lead nowhere")
        lists = header.with_name("link_lists.bin").read_bytes()
        place, longest = 0, max(0, levels) * 4 * (links + 1)
        for _ in range(count):
            length = int.from_bytes(lists[place : place + 4], "little")
            place += 4 + length
            if length > longest or place > len(lists):
                break
        if place != len(lists):
            raise MemoryStoreError(f"{header.with_name('link_lists.bin')} is damaged near byte {place}")


def _lead_somewhere(elements: npt.NDArray[np.uint8], most: int) -> bool:
    """Whether each element has at most so many links, all of them to elements that there are."""
    links = np.ascontiguousarray(elements[:, : 4 * (most + 1)])
    counted, to = links.view("<u2")[:, :1], links.view("<u4")[:, 1:]
    return bool((counted <= most).all() and (to < len(elements))[np.arange(most) < counted].all())


def _main(folder: str, *, everything: bool) -> None:
    """Read the store."""
    _check_index(Path(folder))
    store = Store(open_client(Path(folder)), "the store", folder, None)
    for name in store.streams():
        log = Log(partial(store.raw, name), f"the memory stream {name!r}", store.vectors(name), exclusive=True)
        last = (len(log) - 1) // BLOCK
        for number in range(last + 1) if everything else {0, max(0, last - 1)} if len(log) else ():
            log.block(number)
            if everything:
                log.records(range(number * BLOCK, min((number + 1) * BLOCK, len(log))))


def reason_against(folder: str, *, everything: bool) -> str | None:
    """Why a store cannot be read; None where it can."""
    try:
        _main(folder, everything=everything)
    except DamagedMemoryError as err:
        return f"{err.where}: {err.what}"
    except (MemoryStoreError, OSError) as err:
        return str(err)
    return None


if __name__ == "__main__":
    sys.exit(reason_against(sys.argv[1], everything="--all" in sys.argv))
