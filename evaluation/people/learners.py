"""Machines that learn labels from what people did: here with a frozen sentence encoder and logistic regression."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt
from langchain_core.embeddings import Embeddings

from coopera.memory.embeddings import as_array

Floats = npt.NDArray[np.float64]
_COMPONENTS = (6, 12, 24)
"""How many principal components of the encoder the question "does this follow from that?" may be asked in."""


class Step(NamedTuple):
    """What was done in some hours in a row, and what may have come next."""

    before: tuple[str, ...]
    then: str


class Learner(Protocol):
    """Learns labels (0, 1, …) from examples and predicts those of others; the same each time for the same seed."""

    name: str

    def people(
        self, train: Sequence[Sequence[str]], labels: Sequence[int], test: Sequence[Sequence[str]], *, kind: str
    ) -> list[int]:
        """Predict who lived each tested day; a day is its sentences, `kind` is "intentions" or "tasks"."""
        ...

    def steps(self, train: Sequence[Step], labels: Sequence[int], test: Sequence[Step]) -> list[int]:
        """Predict whether each tested step is what came next (1) or not (0)."""
        ...


class FrozenEncoder:
    """Logistic regression over a sentence encoder that is not trained. Implements `Learner`.

    DEVIATES: the paper finetunes BERT-large-uncased, which takes a GPU; `coopera.evaluation.people.finetune` does so.
    """

    def __init__(self, embeddings: Embeddings, name: str) -> None:
        """Use an encoder of sentences; `name` stands in the results."""
        self.name = name
        self._embeddings = embeddings

    def people(
        self, train: Sequence[Sequence[str]], labels: Sequence[int], test: Sequence[Sequence[str]], *, kind: str
    ) -> list[int]:
        """Predict who lived each tested day from the mean of its sentences' vectors."""
        return _predict(self._means(train), labels, self._means(test), strength=1.0)

    def steps(self, train: Sequence[Step], labels: Sequence[int], test: Sequence[Step]) -> list[int]:
        """Predict which steps are real, from how the candidate relates to the hours before.

        The features are products of principal components: those of the candidate times those of the mean of the hours
        before. So the machine learns the order of intentions. Cross-validation within the training steps chooses the
        number of components.
        """
        scores = [self._cross_validated(train, labels, size) for size in _COMPONENTS]
        best = _COMPONENTS[max(range(len(scores)), key=lambda at: scores[at])]
        return self._follow(train, labels, test, best)

    def _cross_validated(self, train: Sequence[Step], labels: Sequence[int], size: int) -> int:
        """Right answers for each third of the steps after learning from the others; neighbours stay together."""
        right = 0
        thirds = [range(part * len(train) // 3, (part + 1) * len(train) // 3) for part in range(3)]
        for held_out in thirds:
            rest = [at for at in range(len(train)) if at not in held_out]
            if len({labels[at] for at in rest}) < 2:
                continue
            said = self._follow(
                [train[at] for at in rest], [labels[at] for at in rest], [train[at] for at in held_out], size
            )
            right += sum(label == labels[at] for at, label in zip(held_out, said, strict=True))
        return right

    def _follow(self, train: Sequence[Step], labels: Sequence[int], test: Sequence[Step], size: int) -> list[int]:
        from sklearn.decomposition import PCA  # noqa: PLC0415 - heavy

        texts = sorted({text for step in train for text in (*step.before, step.then)})
        axes = PCA(min(size, len(texts) - 1), whiten=True, svd_solver="full").fit(self._vectors(texts))
        return _predict(self._products(axes, train), labels, self._products(axes, test), strength=0.001)

    def _products(self, axes: Any, steps: Sequence[Step]) -> Floats:
        """Components of the candidate and of the hours before, and their products; shape (n, 2 k + k x k)."""
        then = axes.transform(self._vectors([step.then for step in steps]))
        before = axes.transform(self._means([step.before for step in steps]))
        return np.concatenate([then, before, (then[:, :, None] * before[:, None, :]).reshape(len(steps), -1)], axis=1)

    def _means(self, days: Sequence[Sequence[str]]) -> Floats:
        return np.stack([self._vectors(day).mean(axis=0) for day in days])

    def _vectors(self, texts: Sequence[str]) -> Floats:
        return as_array(self._embeddings, list(texts)).astype(np.float64)


def _predict(train: Floats, labels: Sequence[int], test: Floats, *, strength: float) -> list[int]:
    """Fit a logistic regression on standardised features and predict; `strength` is sklearn's C, fixed beforehand."""
    from sklearn.linear_model import LogisticRegression  # noqa: PLC0415 - heavy
    from sklearn.pipeline import make_pipeline  # noqa: PLC0415
    from sklearn.preprocessing import StandardScaler  # noqa: PLC0415

    machine = make_pipeline(StandardScaler(), LogisticRegression(C=strength, max_iter=2000))
    machine.fit(train, np.asarray(labels))
    return [int(label) for label in machine.predict(test)]
