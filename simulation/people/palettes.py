"""Colours that people and their clothes have, from 0 to 1 for red, green and blue as a screen shows them."""

from __future__ import annotations

from typing import get_args

from coopera.core.people import HairColour, SkinTone

Colour = tuple[float, float, float]


def _of(*codes: str) -> tuple[Colour, ...]:
    return tuple((int(c[0:2], 16) / 255, int(c[2:4], 16) / 255, int(c[4:6], 16) / 255) for c in codes)


SKINS: dict[SkinTone, Colour] = dict(
    zip(
        get_args(SkinTone),
        _of("f1d3c2", "e8c0a6", "dcab8b", "c98f6c", "b98458", "8f5f41", "6b4530", "4a2f23"),
        strict=True,
    )
)
HAIRS: dict[HairColour, Colour] = dict(
    zip(
        get_args(HairColour),
        _of("1c1715", "35231a", "553825", "7d5a3a", "b8925a", "8c4524", "8f8d8a", "d6d3cd"),
        strict=True,
    )
)
IRISES = _of("3b2416", "4a3020", "5c4a2a", "4b5f4a", "4d6a80", "62707a")
TOPS = _of(
    *("8c2f39", "b5533c", "d08c45", "c9b458", "5f7f53", "2f6b62", "3f7fa6", "2e4a7d", "5b4a82", "8d5a86"),
    *("c98a94", "d9d2c5", "a7a39b", "55585e", "2b2f38", "7a5a44", "9db7c9", "b9c7a4"),
)
SHIRTS = _of("e9e6df", "b7cbe0", "c9d7c3", "e3c7c0", "8fa6c4", "d8cfe0", "6f86a8")
BOTTOMS = _of("26304a", "2a2c31", "3f5878", "5a4a3c", "8a7a60", "4d5544", "6b6e73", "3a2b33")
SHOES = _of("1d1b1b", "4b3426", "6a4a33", "2b3345", "7b7b7d")
TRAINERS = _of("d9d9d6", "3d4655", "a5423c", "2c2c2f", "5b8f8a")
NIGHT = _of("b9c6d8", "d8c3c8", "c6d3bd", "d9d0b8", "8796b0", "a79ab8")
SPORTS = _of("2f7fb5", "c8433f", "3d3f46", "4f9b6b", "8a4fa0", "e0a13a", "d9568c")
SWIM = _of("1f3a6b", "15161a", "7d2438", "1f6a6a", "5a3b80")
TOWELS = _of("ece7dd", "cfd9e2", "d9c2b4", "b7c9bd")
