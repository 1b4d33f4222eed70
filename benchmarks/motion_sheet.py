"""A contact sheet of all motions: `python -m benchmarks.motion_sheet [--motions DIR] [--out docs/motions.webp]`.

Each motion is shown at two moments of its cycle from either side, at a usual piece of furniture with a usual thing in
hand.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from benchmarks.studio import take
from coopera.simulation.motions.library import Motion
from coopera.simulation.motions.user_folder import load_motions

TILE = (112, 128)
COLUMNS = 3
SHARES = ((0.04, 0.4), (0.29, 0.65))
"""The moments at which each camera looks, as shares of the period."""


def pictures(motion: Motion) -> list[Image.Image]:
    """The motion at its moments, seen from both sides."""
    with take(motion) as made:
        rows = zip(made.views, SHARES, strict=True)
        return [made.picture(share, view, TILE) for view, shares in rows for share in shares]


def main() -> None:
    """Draw the sheet."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--motions", type=Path, help="a folder of clips of one's own")
    parser.add_argument("--out", type=Path, default=Path("docs/motions.webp"))
    args = parser.parse_args()
    motions = load_motions(args.motions).motions
    wide, high = TILE[0] * 4 + 8, TILE[1] + 20
    rows = math.ceil(len(motions) / COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * wide, rows * high), "white")
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(size=13)
    for number, motion in enumerate(motions):
        x, y = number % COLUMNS * wide, number // COLUMNS * high
        for k, picture in enumerate(pictures(motion)):
            sheet.paste(picture, (x + k * TILE[0], y))
        draw.text((x + 3, y + TILE[1] + 1), motion.caption, fill="black", font=font)
    sheet.save(args.out, "WEBP", quality=70, method=6)
    size = np.prod(sheet.size)
    print(f"{args.out}: {len(motions)} motions, {args.out.stat().st_size / 1e3:.0f} kB, {size / 1e6:.1f} megapixels")


if __name__ == "__main__":
    main()
