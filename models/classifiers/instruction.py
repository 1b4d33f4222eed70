"""An example as an instruction for a causal language model, and the recipe by which one is tuned (PAPER App. C.2)."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import yaml
from pydantic import Field, ValidationError

from core.clock import hour_label
from core.errors import ConfigError
from core.hour import Example
from core.people import Frozen

SHIPPED = Path(__file__).with_name("lora_instruct.yaml")
TAIL = "### Response:\n"

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
        data: Any = yaml.safe_load(path.read_text(encoding="utf-8"))
        if not isinstance(data, dict):
            raise ConfigError(f"{path}: the classifier's recipe must be a mapping of fields, not {data!r}.")
        return InstructRecipe.model_validate(data)
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        field = ".".join(map(str, first["loc"]))
        raise ConfigError(f"{path}: {field}: {first['msg'].lower()}, not {first['input']!r}.") from None
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as err:
        raise ConfigError(f"{path}: the classifier's recipe cannot be read ({' '.join(str(err).split())}).") from err


def instruction(example: Example) -> str:
    """Say an example as an instruction that is answered with Yes or No, in the paper's parts and their order."""
    will = f"{example.candidate}, in order to {example.intention}" if example.intention else example.candidate
    return (
        "### Instruction:\n"
        "Considering the human's profile, traits, temporal dependence on past behaviors, and the current time, "
        f"determine if it is likely or unlikely that this human will: {will}. Respond with 'Yes' or 'No'.\n\n"
        "### Input:\n"
        f"Human Profile: {example.profile or 'unknown'}\n"
        f"Big Five Traits: {example.big_five or 'unknown'}\n"
        f"Previous Relevant Intentions: {'; '.join(example.intentions) or 'none'}\n"
        f"Previous Relevant Tasks: {'; '.join(example.tasks) or 'none'}\n"
        f"Current Time: {hour_label(example.hour)}\n"
        + (f"Place Among the Robot's Guesses: {example.rank + 1}\n" if example.rank is not None else "")
        + f"\n{TAIL}"
    )
