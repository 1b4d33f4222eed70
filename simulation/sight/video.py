"""Recordings as pictures, and as H.264 video by PyAV (the extra `video`).

The same pictures give the same video on any processor.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from coopera.core.errors import ConfigError, SimulationError

FPS = 10
WEBP = {"quality": 82, "method": 2}
"""How single pictures are encoded: method 4 takes twice the time for the same size."""
_QUALITY = "28"
"""The encoder's constant rate factor: 40 pictures of 512x384 take about 32 kB."""


def need_video() -> None:
    """Say how to get the encoder, if it is not there.

    Raises:
        ConfigError: If PyAV is not installed.
    """
    if find_spec("av") is None:
        raise ConfigError("pictures: video needs PyAV; install it with: pip install -c constraints.txt -e '.[video]'")


def frame_file(folder: Path, name: str, number: int) -> Path:
    """The file of a picture."""
    return folder / f"{name}-{number}.webp"


def write_frame(path: Path, picture: NDArray[np.uint8]) -> None:
    """Write a picture (height, width, 3) as WebP.

    Raises:
        SimulationError: If its folder cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(picture).save(path, "WEBP", **WEBP)
    except OSError as err:
        raise SimulationError(f"The frames cannot be written to {path.parent}: {err}.") from err


def write_video(path: Path, pictures: Iterable[NDArray[np.uint8]]) -> Path:
    """Write pictures (height, width, 3) of one size as an MP4 file that browsers play.

    Raises:
        SimulationError: If the file cannot be written.
        ConfigError: If PyAV is not installed.
    """
    need_video()
    import av  # noqa: PLC0415  (an extra)

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with av.open(str(path), "w", format="mp4", options={"movflags": "faststart"}) as container:
            options = {"crf": _QUALITY, "threads": "1", "x264-params": "asm=0"}  # with AVX-512 its bytes vary
            stream = container.add_stream("libx264", rate=FPS, options=options)
            stream.pix_fmt = "yuv420p"
            stream.time_base = Fraction(1, FPS)
            for number, picture in enumerate(pictures):
                height, width = picture.shape[0] // 2 * 2, picture.shape[1] // 2 * 2  # the format wants even sizes
                if number == 0:
                    stream.width, stream.height = width, height
                frame = av.VideoFrame.from_ndarray(picture[:height, :width].copy(), format="rgb24")
                container.mux(stream.encode(frame))
            container.mux(stream.encode())
    except OSError as err:
        raise SimulationError(f"The video {path} cannot be written: {err}.") from err
    return path
