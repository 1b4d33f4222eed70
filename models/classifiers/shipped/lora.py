"""The classifier `lora`."""

from __future__ import annotations

from coopera.core.protocols import Classifier
from coopera.models.classifiers.registry import ClassifierSpec, Wanted


def _make(wanted: Wanted) -> Classifier:
    from coopera.models.classifiers.lora import LoraClassifier  # noqa: PLC0415 - torch is heavy

    return LoraClassifier(kind=wanted.kind, inputs=wanted.inputs)


CLASSIFIER = ClassifierSpec(
    name="lora",
    about="LoRA adapters on the bundled sentence encoder with a classification head; learns in minutes",
    make=_make,
)
