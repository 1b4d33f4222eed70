"""The `kernel` classifier: ridge regression on a product kernel over frozen sentence embeddings."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from langchain_core.embeddings import Embeddings
from scipy.linalg import cholesky, solve_triangular
from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]

from coopera.core.errors import CooperaError
from coopera.core.hour import CandidateKind, Example
from coopera.core.lazy import made_once
from coopera.memory.embeddings import as_array
from coopera.models.classifiers.blend import Blend, blend, read_blend
from coopera.models.classifiers.calibration import Scale, scale
from coopera.models.classifiers.features import COLUMNS, Batch, Floats, Points, Similarity, centre_of, read
from coopera.models.classifiers.state import read_manifest, replace_bytes, write_manifest
from coopera.models.classifiers.text import Inputs, Lesson, lesson

VERSION = 1
ARRAYS = "kernel.npz"
MOST = 5_000
"""Examples learned from; beyond it each person's oldest are left out."""
LANDMARKS = 1_200
"""Examples that others are compared with: up to here the solution is exact, beyond it Nyström's approximation."""
RIDGE = 3.0
_PROBE = "The robot brings a cup of tea at four."
_DECIMALS = 6  # arithmetic on another machine, or of another batch, may differ further behind


@dataclass(frozen=True, slots=True)
class _Fitted:
    """What was learned: score(x) = similarity(x, landmarks) @ weights."""

    landmarks: dict[str, npt.NDArray[Any]]
    """As saved: the columns of a `Batch` and its texts. Versions before saved the vectors, a hundred times as much."""
    similarity: Similarity
    points: Points
    weights: Floats
    scale: Scale
    blend: Blend | None = None
    """Where the examples had evidence: it then gives P(yes) instead of the scale."""


class KernelClassifier:
    """Judges a candidate by its likeness to what got a yes or a no at like hours, from like people, after like things.

    DEVIATES: the paper finetunes a 7B language model each evening. Frozen embeddings and a convex fit learn more from a
    day's few dozen labels and take a fraction of a second; `lora` is the way closer to the paper.
    """

    def __init__(self, *, kind: CandidateKind, embeddings: Embeddings, inputs: Inputs) -> None:
        """Start untrained."""
        self._kind = kind
        self._embeddings = embeddings
        self._inputs = inputs
        self._fitted: _Fitted | None = None

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        """Return P(yes) per example, in [0, 1]; exactly 0.5 for all while untrained. See `calibration.scale`."""
        if self._fitted is None or not examples:
            return [0.5] * len(examples)
        with _threads().limit(limits=1, user_api="blas"):
            shown = [self._inputs.show(example) for example in examples]
            batch = read(shown, self._embeddings)
            fitted = self._fitted
            scores = fitted.similarity.gram(fitted.similarity.points(batch), fitted.points) @ fitted.weights
            chances = fitted.scale.probabilities(scores)
            known = np.array([bool(example.evidence) for example in shown])
            if fitted.blend and known.any():
                chances[known] = fitted.blend.probabilities(scores[known], [e for e in shown if e.evidence])
            return [round(float(p), _DECIMALS) for p in chances]

    @property
    def gives_chances(self) -> bool:
        """Whether P(yes) is a chance (`blend`), or is shifted so that 0.5 serves F1 (`calibration.scale`)."""
        return self._fitted is not None and self._fitted.blend is not None

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        """Learn anew from all labelled examples so far.

        With fewer than one example of each label the classifier stays as it was.

        Args:
            examples: All feedback so far, in any order; unlabelled ones are left out.
            seed: Only chooses the landmarks where there are more than `LANDMARKS` examples.

        Returns:
            `examples`, `positives`, `f1` at the chosen threshold, and `f1_always_yes`. Both F1 are measured on held-out
            days (with a single day: on held-out hours; with a single hour there is nothing to hold out), and only on
            the robot's candidates: the true intentions of the evening have no rank and do not count.
        """
        taught = lesson(examples, self._inputs, most=MOST)
        counts = {"examples": float(len(taught.labels)), "positives": float(sum(taught.labels))}
        if not taught.teaches:
            return counts
        with _threads().limit(limits=1, user_api="blas"):
            self._fitted, measured = self._fit(taught, np.random.default_rng(seed))
        return counts | measured

    def _fit(self, taught: Lesson, rng: np.random.Generator) -> tuple[_Fitted, dict[str, float]]:
        batch = read(taught.examples, self._embeddings)
        labels, hours = np.array(taught.labels), np.array(taught.hours)
        similarity = self._similarity(centre_of(batch))
        points = similarity.points(batch)
        kept_rows = _landmarks(labels, rng)
        landmarks = batch.take(kept_rows)
        standing = similarity.points(landmarks)
        alike = similarity.gram(points, standing)
        lower = cholesky(alike[kept_rows] + 1e-6 * np.eye(len(landmarks)), lower=True)
        features = solve_triangular(lower, alike.T, lower=True, overwrite_b=True, check_finite=False).T
        n_days = len(np.unique(hours // 24))
        counts = np.array([example.counts for example in taught.examples])
        weights, unseen = _ridge(features, labels, counts, hours // 24 if n_days > 1 else hours)
        asked = batch.rank >= 0
        if len(set(labels[asked])) < 2:
            asked[:] = True
        judged = [row for row in np.flatnonzero(asked) if taught.examples[row].evidence]
        counted = [taught.examples[row] for row in judged]
        mixed = blend(unseen[judged], counted, labels[judged]) if counted else None
        unseen, labels = unseen[asked], labels[asked]
        chosen = scale(unseen, labels, days=n_days)
        measured = {
            "f1": _f1(chosen.probabilities(unseen) >= 0.5, labels),
            "f1_always_yes": _f1(np.ones(len(labels), bool), labels),
        }
        solution = solve_triangular(lower, weights, lower=True, trans="T")
        chosen = chosen.within((features @ weights)[asked])
        kept = {**landmarks.columns(), "texts": np.frombuffer(json.dumps(landmarks.texts).encode(), np.uint8)}
        return _Fitted(kept, similarity, standing, solution, chosen, mixed), measured

    def _similarity(self, centre: Floats) -> Similarity:
        return Similarity(task=self._kind == "task", centre=centre)

    def save(self, folder: Path) -> None:
        """Write `classifier.json` and, once trained, `kernel.npz`.

        Raises:
            CooperaError: If the folder cannot be written.
        """
        manifest: dict[str, Any] = dict(self._identity())
        if (fitted := self._fitted) is not None:
            buffer = io.BytesIO()
            np.savez_compressed(
                buffer, allow_pickle=False, centre=fitted.similarity.centre, weights=fitted.weights, **fitted.landmarks
            )
            replace_bytes(folder / ARRAYS, buffer.getvalue())
            manifest["scale"] = list(fitted.scale)
            if fitted.blend:
                manifest["blend"] = fitted.blend._asdict()
        manifest["probe"] = self._probe().tolist()
        manifest["trained"] = self._fitted is not None
        write_manifest(folder, manifest)

    def load(self, folder: Path) -> None:
        """Read what `save` wrote.

        Raises:
            CooperaError: If the folder holds no state of this kind, of other embeddings, or a damaged one.
        """
        manifest = read_manifest(folder, self._identity())
        try:
            probe = np.array(manifest["probe"], np.float64)
            trained = bool(manifest["trained"])
            chosen = Scale(*map(float, manifest["scale"])) if trained else None
            mixed = read_blend(manifest["blend"]) if trained and "blend" in manifest else None
        except (KeyError, TypeError, ValueError) as err:
            raise CooperaError(f"{folder}: classifier.json is damaged ({err})") from err
        ours = self._probe()
        if probe.shape != ours.shape or not np.allclose(probe, ours, atol=1e-3):
            raise CooperaError(f"{folder}: the classifier was learned on other embeddings than those given")
        self._fitted = None if chosen is None else self._read_arrays(folder / ARRAYS, chosen, mixed)

    def _read_arrays(self, path: Path, chosen: Scale, mixed: Blend | None) -> _Fitted:
        try:
            with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as arrays:
                table = "texts" if "texts" in arrays else "vectors"
                kept = {name: arrays[name] for name in (*COLUMNS, table)}
                centre, weights = arrays["centre"], arrays["weights"]
            texts = json.loads(kept[table].tobytes()) if table == "texts" else []
        except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile) as err:
            raise CooperaError(f"{path}: the classifier is damaged ({err})") from err
        if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
            raise CooperaError(f"{path}: the classifier is damaged (its texts are none)")
        columns = {name: kept[name] for name in COLUMNS}
        vectors = as_array(self._embeddings, texts) if table == "texts" else kept[table].astype(np.float32)
        if {len(column) for column in columns.values()} != {len(weights)} or centre.shape != (2, vectors.shape[1]):
            raise CooperaError(f"{path}: the classifier is damaged (its arrays do not fit together)")
        similarity = self._similarity(centre)
        points = similarity.points(Batch(texts=texts, vectors=vectors, **columns))
        return _Fitted(kept, similarity, points, weights, chosen, mixed)

    def _identity(self) -> dict[str, Any]:
        return {"classifier": "kernel", "kind": self._kind, "version": VERSION, "inputs": self._inputs.names}

    def _probe(self) -> Floats:
        """Return the vector of a fixed sentence, by which embeddings are told apart; shape (d,)."""
        probe: Floats = as_array(self._embeddings, [_PROBE])[0].astype(np.float64).round(6)
        return probe


@made_once()
def _threads() -> Any:
    """Return the handle on numpy's and scipy's threads (slow to look up); on one thread sums have one order."""
    return ThreadpoolController()


def _landmarks(labels: npt.NDArray[np.bool_], rng: np.random.Generator) -> npt.NDArray[np.int64]:
    """Choose the examples that all are compared with: every one, or at random, up to half of them positives."""
    if len(labels) <= LANDMARKS:
        return np.arange(len(labels))
    yes, no = np.flatnonzero(labels), np.flatnonzero(~labels)
    n_yes = max(min(len(yes), LANDMARKS // 2), LANDMARKS - len(no))
    picked = [rng.choice(yes, n_yes, replace=False), rng.choice(no, LANDMARKS - n_yes, replace=False)]
    return np.sort(np.concatenate(picked))


def _ridge(
    features: Floats, labels: npt.NDArray[np.bool_], counts: Floats, group: npt.NDArray[np.int64]
) -> tuple[Floats, Floats]:
    """Fit +1/-1 by ridge regression with balanced classes.

    Args:
        features: Shape (n, m).
        labels: Shape (n,); both labels occur.
        counts: How much each example counts, shape (n,).
        group: Shape (n,); examples of one group are left out together.

    Returns:
        The weights, shape (m,), and each example's score by a fit without its group, shape (n,), which has a closed
        form: with H the hat matrix, the residuals of a group left out are (I - H_gg)^-1 times those of the fit.
        Without the only group nothing is known: all scores are 0.
    """
    target = np.where(labels, 1.0, -1.0)
    yes = float(np.average(labels, weights=counts))
    importance = counts * np.where(labels, 0.5 / yes, 0.5 / (1 - yes))
    root = np.sqrt(importance)
    weighted = features * root[:, None]
    normal = weighted.T @ weighted
    normal[np.diag_indices_from(normal)] += RIDGE
    lower = cholesky(normal, lower=True, overwrite_a=True)
    half = solve_triangular(lower, weighted.T, lower=True, check_finite=False).T
    weights: Floats = solve_triangular(lower, half.T @ (root * target), lower=True, trans="T")
    residual = root * target - weighted @ weights
    unseen, groups = np.zeros(len(labels)), np.unique(group)
    for name in groups if len(groups) > 1 else ():
        rows = np.flatnonzero(group == name)
        hat = half[rows] @ half[rows].T
        left_out = np.linalg.solve(np.eye(len(rows)) - hat, residual[rows])
        unseen[rows] = target[rows] - left_out / root[rows]
    return weights, unseen


def _f1(yes: npt.NDArray[np.bool_], labels: npt.NDArray[np.bool_]) -> float:
    return round(float(2 * (yes & labels).sum() / (yes.sum() + labels.sum())), _DECIMALS)
