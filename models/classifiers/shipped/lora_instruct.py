"""The classifier `lora-instruct`, the paper's."""

from __future__ import annotations

from coopera.core.errors import ConfigError
from coopera.core.protocols import Classifier
from coopera.models.classifiers.instruction import SHIPPED, read_recipe
from coopera.models.classifiers.registry import ClassifierSpec, Wanted


def _make(wanted: Wanted) -> Classifier:
    from coopera.models.classifiers.lora_instruct import LoraInstructClassifier  # noqa: PLC0415 - torch is heavy

    if wanted.instruct is None:
        raise ConfigError("the classifier lora-instruct needs an instruction: PromptLibrary().instruct")
    recipe = read_recipe(wanted.recipe or SHIPPED)
    return LoraInstructClassifier(kind=wanted.kind, inputs=wanted.inputs, instruct=wanted.instruct, recipe=recipe)


CLASSIFIER = ClassifierSpec(
    name="lora-instruct",
    about="LoRA adapters on a causal language model told to answer Yes or No, as in the paper; for GPUs",
    make=_make,
    check_recipe=read_recipe,
)
