"""Read files that others have made: within bounds, and with one clear sentence for what is wrong in them."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_json as read_any_json
from coopera.core.foreign.files import read_text
from coopera.core.strict_yaml import MOST_BYTES, load_yaml


class Loose(BaseModel):
    """A part of somebody else's format: fields that we do not know are left alone, numbers are finite."""

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


Model = TypeVar("Model", bound=BaseModel)


def read_json(path: Path, model: type[Model]) -> Model:
    """Read a JSON file as a pydantic model.

    Raises:
        ConfigError: If the file cannot be read or does not fit; names file and field.
    """
    return as_model(path, read_any_json(path), model)


def as_model(path: Path, data: object, model: type[Model]) -> Model:
    """Take what was read from a file as a pydantic model.

    Raises:
        ConfigError: If it does not fit; names file and field.
    """
    try:
        return model.model_validate(data)
    except ValidationError as err:
        raise _does_not_fit(path, err) from err


def read_yaml(path: Path, model: type[Model]) -> Model:
    """Read a YAML file as a pydantic model.

    Raises:
        ConfigError: If the file cannot be read or does not fit; names file and field.
    """
    try:
        return model.model_validate(load_yaml(read_text(path, "file", MOST_BYTES)))
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
