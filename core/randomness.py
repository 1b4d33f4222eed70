"""Randomness has an address: every draw is derived from where it happens, never from a global state."""

from __future__ import annotations

import hashlib
from typing import NamedTuple

import numpy as np


class Address(NamedTuple):
    """Where a random draw happens; `draw` tells several draws at one place apart."""

    person: str
    day: int
    hour: int
    node: str
    draw: int = 0


def seed_at(seed: int, *address: object) -> int:
    """Return a 63-bit seed for an address: the same on every machine, process and hash seed."""
    text = "|".join(str(part) for part in (seed, *address))
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "little") >> 1


def rng_at(seed: int, *address: object) -> np.random.Generator:
    """Return a fresh generator for an address, so that an hour can be done again alone."""
    return np.random.default_rng(seed_at(seed, *address))
