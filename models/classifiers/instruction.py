"""The recipe by which a causal language model is tuned to answer instructions with Yes or No (PAPER App. C.2)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, TypeAlias

import yaml
from pydantic import Field, ValidationError

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.hour import Example
from coopera.core.people import Frozen
from coopera.core.strict_yaml import MOST_BYTES, load_yaml

SHIPPED = Path(__file__).with_name("lora_instruct.yaml")
TAIL = "### Response:\n"
"""How the shipped instruction ends; what counts is the line break, after which Yes and No are looked for."""

Instruct: TypeAlias = Callable[[Example], str]
"""Says an example as an instruction that ends with a line break: `prompts.PromptLibrary.instruct`."""

Whole = Annotated[int, Field(strict=True, ge=1)]
Share = Annotated[float, Field(ge=0, lt=1)]
Rate = Annotated[float, Field(gt=0, lt=1)]


class InstructRecipe(Frozen):
    """How a causal model is tuned; `lora_instruct.yaml` has the paper's values and says what each field is."""

    base: Annotated[str, Field(min_length=1)]
    rank: Whole
    alpha: Whole
    dropout: Share
    modules: Annotated[list[str], Field(min_length=1)]
    epochs: Whole
    later_epochs: Whole
    learning_rate: Rate
    weight_decay: Share
    batch: Whole
    accumulation: Whole
    most: Whole
    tokens: Annotated[int, Field(strict=True, ge=16)]
    verdicts: Whole
    devices: Annotated[str, Field(pattern=r"^(auto|cpu|cuda(:\d+)?)$")]


def read_recipe(path: Path = SHIPPED) -> InstructRecipe:
    """Read a recipe.

    Raises:
        ConfigError: If the file cannot be read or a field is missing, unknown or wrong; names both.
    """
    try:
        data: Any = load_yaml(read_text(path, "recipe", MOST_BYTES))
        if not isinstance(data, dict):
            raise ConfigError(f"{path}: the classifier's recipe must be a mapping of fields, not {data!r}.")
        return InstructRecipe.model_validate(data)
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        field = ".".join(map(str, first["loc"]))
        raise ConfigError(f"{path}: {field}: {first['msg'].lower()}, not {first['input']!r}.") from None
    except yaml.YAMLError as err:
        raise ConfigError(f"{path}: the classifier's recipe cannot be read ({' '.join(str(err).split())}).") from err
