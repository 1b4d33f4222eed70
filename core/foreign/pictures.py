"""The one reader of pictures: PNG, JPEG and WebP, of a bearable number of pixels."""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager

from PIL import Image

MOST_PIXELS = 2**25
"""Some 8000 times 4000: a picture of a few kilobytes may claim a thousand times as many."""
FORMATS = ("PNG", "JPEG", "WEBP")
_FAILURES = (
    *(OSError, EOFError, ValueError, TypeError, LookupError, ArithmeticError, SyntaxError, RuntimeError),
    *(AttributeError, MemoryError, struct.error, zlib.error, Image.DecompressionBombError),
)


@contextmanager
def open_picture(data: bytes) -> Iterator[Image.Image]:
    """Open a picture, whose pixels are decoded when they are asked for.

    Raises:
        ValueError: If it is none, is damaged, or has more than `MOST_PIXELS`; also where it turns out within the block.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Image.open(io.BytesIO(data), formats=FORMATS) as image:
                if image.width * image.height > MOST_PIXELS:
                    raise ValueError(f"a picture of {image.width} x {image.height} is too large")
                yield image
    except _FAILURES as err:
        raise ValueError(" ".join(str(err).split())[:200] or type(err).__name__) from err
