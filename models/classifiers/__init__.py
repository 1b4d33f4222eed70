"""The yes/no classifiers of the robot's candidates (PAPER §3.3).

The person's feedback trains them each evening.

>>> from coopera.memory.embeddings import bundled
>>> judge = make_classifier("kernel", kind="intention", embeddings=bundled())
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.errors import ConfigError
from coopera.core.hour import CandidateKind
from coopera.models.classifiers.text import Inputs

if TYPE_CHECKING:
    from pathlib import Path

    from langchain_core.embeddings import Embeddings

    from coopera.core.protocols import Classifier
    from coopera.models.classifiers.instruction import Instruct

__all__ = ["CLASSIFIERS", "Inputs", "make_classifier"]

CLASSIFIERS: dict[str, str] = {
    "kernel": "ridge regression on a product kernel over frozen sentence embeddings; learns in a fraction of a second",
    "lora-instruct": "LoRA adapters on a causal language model told to answer Yes or No, as in the paper; for GPUs",
    "lora": "LoRA adapters on the bundled sentence encoder with a classification head; learns in minutes",
}
"""Every classifier's name and what it is."""


def make_classifier(
    name: str,
    *,
    kind: CandidateKind,
    embeddings: Embeddings,
    inputs: Inputs | None = None,
    recipe: Path | None = None,
    instruct: Instruct | None = None,
) -> Classifier:
    """Return a new, untrained classifier.

    Args:
        name: One of `CLASSIFIERS`.
        kind: What it judges: "intention" or "task".
        embeddings: Sentence embeddings; must give a text the same vector every time.
        inputs: What the method lets it see; by default everything.
        recipe: File with the recipe of `lora-instruct`; by default the paper's.
        instruct: What `lora-instruct` tells its model: `PromptLibrary().instruct` of the room `prompts`.

    Raises:
        ConfigError: If there is no classifier of that name, or its recipe is wrong.
    """
    inputs = inputs or Inputs()
    if name == "kernel":
        from coopera.models.classifiers.kernel import KernelClassifier  # noqa: PLC0415 - scikit-learn is heavy

        return KernelClassifier(kind=kind, embeddings=embeddings, inputs=inputs)
    if name == "lora":
        from coopera.models.classifiers.lora import LoraClassifier  # noqa: PLC0415 - torch is heavier

        return LoraClassifier(kind=kind, inputs=inputs)
    if name == "lora-instruct":
        from coopera.models.classifiers.instruction import SHIPPED, read_recipe  # noqa: PLC0415
        from coopera.models.classifiers.lora_instruct import LoraInstructClassifier  # noqa: PLC0415

        if instruct is None:
            raise ConfigError("the classifier lora-instruct needs an instruction: PromptLibrary().instruct")
        recipe_read = read_recipe(recipe or SHIPPED)
        return LoraInstructClassifier(kind=kind, inputs=inputs, instruct=instruct, recipe=recipe_read)
    raise ConfigError(f"there is no classifier {name!r}; known: {', '.join(CLASSIFIERS)}")
