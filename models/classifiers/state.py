"""The folder of a learned classifier: a JSON manifest that says what it is, beside arrays in an open format."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from coopera.core.errors import CooperaError

MANIFEST = "classifier.json"


def write_manifest(folder: Path, manifest: Mapping[str, Any]) -> None:
    """Write the manifest; it comes last, so that a folder with a manifest is complete.

    Raises:
        CooperaError: If the folder cannot be written.
    """
    text = json.dumps(manifest, indent=1, sort_keys=True, allow_nan=False) + "\n"
    replace_bytes(folder / MANIFEST, text.encode())


def replace_bytes(path: Path, content: bytes) -> None:
    """Write a whole file or nothing.

    Raises:
        CooperaError: If the file cannot be written.
    """
    draft = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        draft.write_bytes(content)
        os.replace(draft, path)
    except OSError as err:
        raise CooperaError(f"{path}: the classifier cannot be saved ({err})") from err


def read_manifest(folder: Path, expected: Mapping[str, Any]) -> dict[str, Any]:
    """Read the manifest and check that it describes the classifier that is to be loaded.

    Raises:
        CooperaError: If there is no manifest, it is damaged, or one of the `expected` values differs.
    """
    path = folder / MANIFEST
    try:
        manifest = json.loads(path.read_bytes())
    except OSError as err:
        raise CooperaError(f"{path}: there is no saved classifier to read ({err})") from err
    except ValueError as err:
        raise CooperaError(f"{path}: is damaged, not a JSON file ({err})") from err
    if not isinstance(manifest, dict):
        raise CooperaError(f"{path}: is damaged, expected a JSON object")
    for name, value in json.loads(json.dumps(expected)).items():  # as JSON has it: tuples are lists
        if manifest.get(name) != value:
            raise CooperaError(f"{path}: field {name!r} is {manifest.get(name)!r}, expected {value!r}")
    return manifest
