"""Dropping a file into a folder of values, as a user would, and taking it out again."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

import pytest


def drop(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, package: str, name: str, text: str) -> None:
    """Have a package contain one more module until the test ends."""
    folder = tmp_path / package
    folder.mkdir()
    (folder / f"{name}.py").write_text(text)
    home = import_module(package)
    monkeypatch.setattr(home, "__path__", [*home.__path__, str(folder)])
    module = f"{package}.{name}"
    monkeypatch.setitem(sys.modules, module, None)  # so that it is out again afterwards
    monkeypatch.delitem(sys.modules, module)
