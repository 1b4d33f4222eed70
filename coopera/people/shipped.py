"""The people who can take part: ten that ship with coopera, and those a user imported."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

import yaml
from pydantic import ValidationError

from coopera.config.files import read_yaml, write_atomic
from coopera.core.errors import ConfigError
from coopera.core.people import Looks, Persona, PersonId

SHIPPED = Path(__file__).parents[1] / "personas"
_MOST_BYTES = 2**20  # of a persona file
_ID = re.compile(r"[a-z0-9][a-z0-9_-]{0,63}")


def catalogue(data_dir: Path) -> list[Persona]:
    """Everybody there is: the shipped people by id, then the imported ones by id.

    Raises:
        ConfigError: If a persona file cannot be used.
    """
    files = [*_files(SHIPPED), *_files(data_dir / "humans")]
    return [_read_shipped(path) if path.parent == SHIPPED else read_persona(path) for path in files]


def shipped_ids() -> list[PersonId]:
    """Ids of the people that ship with coopera, sorted: the order in which a setting takes them."""
    return [PersonId(path.stem) for path in _files(SHIPPED)]


def known_ids(data_dir: Path) -> list[PersonId]:
    """Ids of everybody there is, without reading their files."""
    return [*shipped_ids(), *(PersonId(path.stem) for path in _files(data_dir / "humans"))]


def find(person: str, data_dir: Path) -> Persona:
    """Return one person by id.

    Raises:
        ConfigError: If there is nobody of that id, or the file cannot be used.
    """
    if _ID.fullmatch(person):  # an id is a file name: nothing else may reach the file system
        for folder in (SHIPPED, data_dir / "humans"):
            if (path := folder / f"{person}.yaml").is_file():
                return read_persona(path)
    raise ConfigError(_nobody(person, known_ids(data_dir)))


def read_persona(path: Path) -> Persona:
    """Read one persona file.

    Raises:
        ConfigError: Naming the file, the field and what was expected.
    """
    data = read_yaml(path, "persona file", _MOST_BYTES)
    try:
        persona = Persona.model_validate(data)
    except ValidationError as err:
        raise ConfigError(_complaint(err, path)) from None
    if persona.id != path.stem:
        raise ConfigError(f"{path}: id must be the file's name, {path.stem!r}, not {persona.id!r}.")
    return persona


def write_persona(persona: Persona, folder: Path) -> Path:
    """Write <folder>/<id>.yaml as a whole and return its path.

    Raises:
        ConfigError: If the folder cannot be written.
    """
    path = folder / f"{persona.id}.yaml"
    data = persona.model_dump(mode="json", exclude_none=True)
    text = yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110, default_flow_style=None)
    try:
        write_atomic(path, text)
    except OSError as err:
        raise ConfigError(f"{folder}: people cannot be stored here ({err.strerror or err}).") from err
    return path


@lru_cache(maxsize=64)
def _read_shipped(path: Path) -> Persona:
    return read_persona(path)


def _files(folder: Path) -> Iterator[Path]:
    """Persona files of a folder, sorted by id; a name that is no id is not one of them."""
    return iter(sorted(path for path in folder.glob("*.yaml") if _ID.fullmatch(path.stem)))


def _nobody(person: str, known: list[PersonId]) -> str:
    near = difflib.get_close_matches(person, known, n=1)
    shown = ", ".join(known[:12]) + (f" and {len(known) - 12} more" if len(known) > 12 else "")
    hint = f"did you mean {near[0]}? " if near else ""
    return f"humans: there is no person {person!r} ({hint}known are {shown}; see `coopera humans list`)."


def _complaint(err: ValidationError, path: Path) -> str:
    """Turn the first of pydantic's complaints into one sentence."""
    first = err.errors(include_url=False)[0]
    field = ".".join(str(part) for part in first["loc"])
    if first["type"] == "extra_forbidden":
        known = Looks.model_fields if field.startswith("appearance.") else Persona.model_fields
        return f"{path}: there is no field {field!r} (known are {', '.join(known)})."
    if first["type"] == "missing":
        return f"{path}: the field {field} is missing."
    expected = {
        "id": "lower-case letters, digits, - and _, at most 64",
        "name": "a text of 1 to 80 characters",
        "profile": "a text of 1 to 20000 characters",
        "notes": "a text of at most 20000 characters",
        "source": "a text",
        "appearance": f"a mapping of some of {', '.join(Looks.model_fields)}",
        "appearance.age": "a whole number from 16 to 110",
        "appearance.glasses": "true or false",
    }.get(field, "a number from 1 to 5" if field.startswith("big_five.") else "a mapping of five numbers from 1 to 5")
    if first["type"] == "literal_error":
        expected = str(first.get("ctx", {}).get("expected")).replace("'", "")
    return f"{path}: {field} must be {expected}, not {str(first['input'])[:60]!r}."
