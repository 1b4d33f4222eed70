"""Names written into a picture for models with weak eyes: who is seen, what is in the hand, and the furniture there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image as Pictures
from PIL import ImageDraw, ImageFont

from coopera.simulation.sight.stage import Image

_LEAST = 0.0008
"""Smallest share of the picture that a thing fills whose name is written: one that could be seen."""
_TEXT = 0.05
"""Height of the letters, as a share of the picture's."""
_SMALLEST = 9  # pixels
_PAD = 2


class Name(NamedTuple):
    """What is written on a body of the picture; `small` where it should rather stand above or below it."""

    body: int
    text: str
    small: bool = False


def labelled(image: Image, mask: NDArray[np.int64], names: Sequence[Name]) -> Image:
    """Write each name on the body that is seen, the first ones first; whatever is not seen has no name.

    Args:
        image: Shape (height, width, 3).
        mask: The body in each pixel, shape (height, width).
        names: What may be written. A name that finds no free place is left out.
    """
    picture = Pictures.fromarray(image)
    draw = ImageDraw.Draw(picture)
    height, width = mask.shape
    font = ImageFont.load_default(size=max(round(_TEXT * height), _SMALLEST))
    taken: list[tuple[float, float, float, float]] = []
    for name in names:
        rows, columns = np.nonzero(mask == name.body)
        if len(rows) < max(_LEAST * mask.size, 1):
            continue
        left, top, right, bottom = draw.textbbox((0, 0), name.text, font=font)
        wide, high = right - left + 2 * _PAD, bottom - top + 2 * _PAD
        x = min(max(float(np.median(columns)) - wide / 2, 0.0), width - wide)
        heights = (
            [rows.min() - high - 1, rows.max() + 1] if name.small else [float(np.percentile(rows, 8)), rows.max() + 1]
        )
        for y in (min(max(float(value), 0.0), height - high) for value in (*heights, np.median(rows))):
            box = (x, y, x + wide, y + high)
            if not any(_meet(box, other) for other in taken):
                taken.append(box)
                draw.rectangle(box, fill=(20, 20, 24))
                draw.text((x + _PAD - left, y + _PAD - top), name.text, font=font, fill=(255, 255, 255))
                break
    return np.asarray(picture)


def _meet(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
