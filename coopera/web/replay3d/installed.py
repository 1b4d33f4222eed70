"""Whether what draws in three dimensions is installed (the extra `replay3d`)."""

from __future__ import annotations

import importlib
from typing import Any

from coopera.core.errors import ConfigError


def need_viser() -> Any:
    """The library, where it is installed.

    Raises:
        ConfigError: If it is not, or cannot make a page of one file.
    """
    try:
        viser: Any = importlib.import_module("viser")
    except ImportError as err:
        raise ConfigError("--html: a day in 3D needs viser 1.0 or newer; install it with: pip install viser.") from err
    if int(str(viser.__version__).partition(".")[0]) < 1:
        raise ConfigError(f"--html: a day in 3D needs viser 1.0 or newer, not {viser.__version__}.")
    return viser
