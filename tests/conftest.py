"""Property tests: the same cases in every run, and no verdict that depends on how busy the machine is."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("coopera", deadline=None, derandomize=True)
settings.load_profile("coopera")
