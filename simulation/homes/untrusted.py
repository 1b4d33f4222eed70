"""Read files that others have made: within bounds, and with one clear sentence for what is wrong in them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from coopera.core.errors import ConfigError
from coopera.core.strict_yaml import load_yaml

MOST_BYTES = 256 * 2**20
"""No file of geometry is larger."""
MOST_TEXT = 50 * 2**20
"""No JSON or CSV file is larger."""


class Loose(BaseModel):
    """A part of somebody else's format: fields that we do not know are left alone, numbers are finite."""

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


Model = TypeVar("Model", bound=BaseModel)


def read_text(path: Path) -> str:
    """Read a text file of a bearable size.

    Raises:
        ConfigError: If it is missing, too large or no text; names the file.
    """
    try:
        size = path.stat().st_size
        if size > MOST_TEXT:
            raise ConfigError(f"{path}: the file has {size >> 20} MB, and at most {MOST_TEXT >> 20} MB are read.")
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as err:
        reason = err.strerror if isinstance(err, OSError) and err.strerror else err
        raise ConfigError(f"{path}: the file cannot be read ({reason}).") from err


def read_json(path: Path, model: type[Model]) -> Model:
    """Read a JSON file as a pydantic model.

    Raises:
        ConfigError: If the file cannot be read or does not fit; names file and field.
    """
    try:
        # NaN is let through here, for the model refuses it and knows its field
        return model.model_validate(json.loads(read_text(path)))
    except json.JSONDecodeError as err:
        raise ConfigError(f"{path}, line {err.lineno}: this is not valid JSON ({err.msg}).") from err
    except RecursionError as err:
        raise ConfigError(f"{path}: this is not valid JSON (it is nested too deeply).") from err
    except ValidationError as err:
        raise _does_not_fit(path, err) from err


def read_yaml(path: Path, model: type[Model]) -> Model:
    """Read a YAML file as a pydantic model.

    Raises:
        ConfigError: If the file cannot be read or does not fit; names file and field.
    """
    try:
        return model.model_validate(load_yaml(read_text(path)))
    except yaml.MarkedYAMLError as err:
        line = f", line {err.problem_mark.line + 1}" if err.problem_mark else ""
        raise ConfigError(f"{path}{line}: this is not valid YAML ({err.problem}).") from err
    except ValidationError as err:
        raise _does_not_fit(path, err) from err


def _does_not_fit(path: Path, err: ValidationError) -> ConfigError:
    first = err.errors(include_url=False)[0]
    field = ".".join(str(part) for part in first["loc"])
    where = f"{path}, field {field}" if field else str(path)
    return ConfigError(f"{where}: {first['msg'].removeprefix('Value error, ')}.")
