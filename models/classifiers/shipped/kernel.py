"""The classifier `kernel`."""

from __future__ import annotations

from coopera.core.protocols import Classifier
from coopera.models.classifiers.registry import ClassifierSpec, Wanted


def _make(wanted: Wanted) -> Classifier:
    from coopera.models.classifiers.kernel import KernelClassifier  # noqa: PLC0415 - scikit-learn is heavy

    return KernelClassifier(kind=wanted.kind, embeddings=wanted.embeddings, inputs=wanted.inputs)


CLASSIFIER = ClassifierSpec(
    name="kernel",
    about="ridge regression on a product kernel over frozen sentence embeddings; learns in a fraction of a second",
    make=_make,
)
