"""The `lora-instruct` classifier: the paper's instruction-tuned causal language model with LoRA (PAPER App. C.2)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import torch
from safetensors import SafetensorError
from safetensors.torch import load as load_tensors
from safetensors.torch import save as save_tensors
from torch import Tensor, nn

from coopera.core.errors import CooperaError
from coopera.core.hour import CandidateKind, Example
from coopera.models.classifiers.calibration import Scale, scale
from coopera.models.classifiers.causal import CausalBase, open_base
from coopera.models.classifiers.evening import Evening, balanced, evening, must_be_finite, one_thread
from coopera.models.classifiers.instruction import Instruct, InstructRecipe, read_recipe
from coopera.models.classifiers.state import read_manifest, replace_bytes, write_manifest
from coopera.models.classifiers.text import Inputs

VERSION = 1
WEIGHTS, CONFIG = "adapter_model.safetensors", "adapter_config.json"  # as peft names and reads them
_DECIMALS = 6


class LoraInstructClassifier:
    """Asks a causal model "likely or unlikely?" and reads P(yes) from its logits of Yes and No, in one forward pass.

    DEVIATES from the authors' code, which samples three texts of 100 tokens for each candidate and looks for "yes".
    """

    def __init__(
        self, *, kind: CandidateKind, inputs: Inputs, instruct: Instruct, recipe: InstructRecipe | None = None
    ) -> None:
        """Start untrained; the base is loaded once for all classifiers of a recipe.

        Raises:
            ConfigError: If the base cannot be loaded or adapted.
        """
        self._kind = kind
        self._inputs = inputs
        self._instruct = instruct
        self._recipe = recipe or read_recipe()
        self._learned: dict[str, Tensor] | None = None
        self._scale = Scale(1.0, 0.0)
        self._base()

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        """Return P(yes) per example, in [0, 1]; exactly 0.5 for all while untrained. See `calibration.scale`."""
        if self._learned is None or not examples:
            return [0.5] * len(examples)
        base = self._base()
        with base.lock, one_thread():
            base.put_in(self._kind, self._learned)
            scores = self._scores(base, [self._instruct(self._inputs.show(e)) for e in examples])
        return [round(float(p), _DECIMALS) for p in self._scale.probabilities(scores)]

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        """Learn from labelled examples, going on from what was learned before.

        A fourth of the hours is left out of learning and serves to choose slope and threshold of P(yes).

        Args:
            examples: In any order; of too many, the newest day's and a sample of the others are learned from.
            seed: Decides first weights, order, dropout, and the sample.

        Returns:
            `examples`, `positives`, `passes` (examples looked at) and `loss` (mean of the last epoch).

        Raises:
            LearningError: If the loss is no longer a finite number; what was learned before is kept.
        """
        counts, taught = evening(examples, self._inputs, most=self._recipe.most, seed=seed)
        if taught is None:
            return counts
        base = self._base()
        devices = list(range(torch.cuda.device_count()))
        with base.lock, one_thread(), torch.random.fork_rng(devices=devices):
            torch.manual_seed(seed % 2**63)
            base.put_in(self._kind, self._learned or base.fresh(self._kind, seed % 2**63))
            epochs = self._recipe.epochs if self._learned is None else self._recipe.later_epochs
            rows = np.flatnonzero(~taught.held_out)
            try:
                loss = self._fit(base, taught, rows, epochs)
                judged = taught.held_out if taught.held_out.any() else ~taught.held_out
                scores = self._scores(base, [self._instruct(example) for example in taught.examples])
                self._must_be_finite("answer", float(scores.sum()))
            finally:
                learned = base.take_out(self._kind)
        days = len({hour // 24 for hour in taught.hours})
        chosen = scale(scores[judged], taught.labels[judged], days=days)
        self._scale, self._learned = chosen.within(scores), learned
        return counts | {"passes": float(len(rows) * epochs), "loss": loss}

    def _fit(self, base: CausalBase, taught: Evening, rows: npt.NDArray[np.int64], epochs: int) -> float:
        """Train the active adapter to answer Yes or No, with balanced classes; return the last epoch's mean loss.

        DEVIATES: the authors repeat positives and train on the whole text with its padding; here classes are weighed
        and the loss is that of the answer's first token against the other answer.
        """
        recipe = self._recipe
        texts = [self._instruct(taught.examples[row]) for row in rows]
        labels, weights = torch.from_numpy(taught.labels[rows].astype(np.float32)), balanced(taught.labels[rows])
        optimizer = torch.optim.AdamW(
            base.parameters(self._kind), lr=recipe.learning_rate, weight_decay=recipe.weight_decay
        )
        base.model.train()
        mean = 0.0
        for _ in range(epochs):
            order, total = taught.rng.permutation(len(rows)), 0.0
            starts = range(0, len(order), recipe.batch)
            for number, start in enumerate(starts, 1):
                chosen = order[start : start + recipe.batch]
                scores = base.scores([texts[row] for row in chosen])
                given = labels[chosen].to(scores.device), weights[chosen].to(scores.device)
                loss = nn.functional.binary_cross_entropy_with_logits(scores, given[0], weight=given[1])
                self._must_be_finite("loss", float(loss.detach()))
                (loss / recipe.accumulation).backward()  # type: ignore[no-untyped-call]
                if number % recipe.accumulation == 0 or number == len(starts):
                    nn.utils.clip_grad_norm_(base.parameters(self._kind), 1.0)
                    optimizer.step()
                    optimizer.zero_grad()
                total += float(loss.detach()) * len(chosen)
            mean = total / len(rows)
        return mean

    def _scores(self, base: CausalBase, texts: Sequence[str]) -> npt.NDArray[np.float64]:
        """Logit of Yes less that of No per text, shape (n,); texts of like length go together."""
        base.model.eval()
        order = sorted(range(len(texts)), key=lambda row: (len(texts[row]), row))
        scores = np.empty(len(texts))
        with torch.no_grad():
            for start in range(0, len(order), self._recipe.verdicts):
                rows = order[start : start + self._recipe.verdicts]
                scores[rows] = base.scores([texts[row] for row in rows]).cpu().numpy()
        return scores

    def _must_be_finite(self, what: str, value: float) -> None:
        name = f"{self._kind} classifier (lora-instruct)"
        must_be_finite(what, value, classifier=name, rate=self._recipe.learning_rate)

    def _base(self) -> CausalBase:
        return open_base(self._recipe.model_dump_json())

    def save(self, folder: Path) -> None:
        """Write `classifier.json` and, once trained, the adapter in peft's own files.

        Raises:
            CooperaError: If the folder cannot be written.
        """
        manifest: dict[str, Any] = {**self._identity(), "trained": self._learned is not None}
        if self._learned is not None:
            base = self._base()
            replace_bytes(folder / CONFIG, base.config_file())
            replace_bytes(folder / WEIGHTS, save_tensors(self._learned))
            manifest |= {"scale": list(self._scale), "weights_of": base.name}
        write_manifest(folder, manifest)

    def load(self, folder: Path) -> None:
        """Read what `save` wrote.

        Raises:
            CooperaError: If the folder holds no state of this kind, of another base or recipe, or a damaged one.
        """
        manifest = read_manifest(folder, self._identity())
        if manifest.get("trained") is False:
            self._learned, self._scale = None, Scale(1.0, 0.0)
            return
        base = self._base()
        if (other := manifest.get("weights_of")) != base.name:
            raise CooperaError(f"{folder}: the adapter belongs to the base {other!r}, and this one is {base.name!r}")
        path = folder / WEIGHTS
        try:
            chosen = Scale(*map(float, manifest["scale"]))
            learned = load_tensors(path.read_bytes())
        except (KeyError, TypeError, ValueError, OSError, SafetensorError) as err:
            raise CooperaError(f"{path}: the classifier is damaged ({err})") from err
        if {name: tuple(value.shape) for name, value in learned.items()} != base.shapes(self._kind):
            raise CooperaError(f"{path}: the classifier is damaged (its tensors are not those of this base and recipe)")
        self._learned, self._scale = learned, chosen

    def _identity(self) -> dict[str, Any]:
        return {
            "classifier": "lora-instruct",
            "kind": self._kind,
            "version": VERSION,
            "inputs": self._inputs.names,
            "recipe": self._recipe.model_dump(exclude={"base", "devices", "verdicts"}),
        }
