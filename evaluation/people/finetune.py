"""The paper's machine: any Hugging Face encoder, finetuned as a classifier (PAPER §4.2: BERT-large-uncased)."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from typing import Any

import torch
from transformers import AutoModelForSequenceClassification, AutoTokenizer
from transformers.utils import logging as transformers_logging

from coopera.core.errors import ConfigError
from coopera.core.randomness import seed_at
from coopera.evaluation.people.learners import Step

_LOG = logging.getLogger(__name__)

Text = tuple[str, str | None]
"""A text, or two of which the second is to follow from the first."""


@dataclass(frozen=True, slots=True)
class Recipe:
    """How the encoder is trained. PAPER §4.2: 10, 20 and 20 epochs at 5e-6; the batch is not given.

    Attributes:
        epochs: Passes over the training texts, by what is learned.
        learning_rate: Of AdamW.
        batch: Texts per step.
        tokens: Longest text in tokens; longer ones are cut at the end.
    """

    epochs: dict[str, int] = field(default_factory=lambda: {"intentions": 10, "tasks": 20, "steps": 20})
    learning_rate: float = 5e-6
    batch: int = 8
    tokens: int = 512


class FinetunedEncoder:
    """Trains a fresh copy of the encoder for each question and fold. Implements `Learner`.

    Runs on the GPU where there is one. Weights are read from safetensors files only, and no code of a repository runs.
    """

    def __init__(self, model: str, *, recipe: Recipe | None = None, seed: int = 0) -> None:
        """Use an encoder by its name on Hugging Face, or by its folder.

        Raises:
            ConfigError: If it cannot be loaded as an encoder.
        """
        self.name = f"{model}, finetuned"
        self._model, self._recipe, self._seed = model, recipe or Recipe(), seed
        self._device = "cuda" if torch.cuda.is_available() else "cpu"
        self._tokenizer = self._load(AutoTokenizer)
        with self._own_generator():
            self._load_network(2)  # what cannot be trained is refused at once

    def people(
        self, train: Sequence[Sequence[str]], labels: Sequence[int], test: Sequence[Sequence[str]], *, kind: str
    ) -> list[int]:
        """Predict who lived each tested day; a day is one text (PAPER: aggregated into one data point)."""
        return self._learn(
            [(_paragraph(day), None) for day in train], labels, [(_paragraph(d), None) for d in test], kind
        )

    def steps(self, train: Sequence[Step], labels: Sequence[int], test: Sequence[Step]) -> list[int]:
        """Predict which steps are real, as next-sentence prediction."""

        def pair(step: Step) -> Text:
            return _paragraph(step.before), step.then

        return self._learn([pair(step) for step in train], labels, [pair(step) for step in test], "steps")

    def _learn(self, train: Sequence[Text], labels: Sequence[int], test: Sequence[Text], kind: str) -> list[int]:
        known = sorted(set(labels))
        place = {label: at for at, label in enumerate(known)}
        seed = seed_at(self._seed, "finetune", kind, len(train)) % 2**63
        with self._own_generator():
            torch.manual_seed(seed)
            network = self._load_network(len(known))
            self._fit(network, train, [place[label] for label in labels], self._recipe.epochs[kind])
        return [known[at] for at in self._answers(network, test)]

    def _own_generator(self) -> AbstractContextManager[None]:
        """Leave the global random state as it was."""
        return torch.random.fork_rng(devices=[0] if self._device == "cuda" else [])

    def _fit(self, network: Any, texts: Sequence[Text], labels: Sequence[int], epochs: int) -> None:
        optimizer = torch.optim.AdamW(network.parameters(), lr=self._recipe.learning_rate)
        network.train()
        for epoch in range(epochs):
            order = torch.randperm(len(texts)).tolist()
            total = 0.0
            for start in range(0, len(order), self._recipe.batch):
                rows = order[start : start + self._recipe.batch]
                given = self._tokens([texts[row] for row in rows])
                truth = torch.tensor([labels[row] for row in rows], device=self._device)
                loss = network(**given, labels=truth).loss
                optimizer.zero_grad()
                loss.backward()
                optimizer.step()
                total += float(loss.detach()) * len(rows)
            _LOG.info("epoch %d of %d: loss %.4f", epoch + 1, epochs, total / len(texts))

    def _answers(self, network: Any, texts: Sequence[Text]) -> list[int]:
        network.eval()
        answers: list[int] = []
        with torch.inference_mode():
            for start in range(0, len(texts), self._recipe.batch):
                logits = network(**self._tokens(texts[start : start + self._recipe.batch])).logits
                answers += [int(at) for at in logits.argmax(dim=1).tolist()]
        return answers

    def _tokens(self, texts: Sequence[Text]) -> Any:
        first = [text for text, _ in texts]
        second = [text for _, text in texts if text is not None]
        longest = min(self._recipe.tokens, self._tokenizer.model_max_length)
        return self._tokenizer(
            first, second or None, padding=True, truncation=True, max_length=longest, return_tensors="pt"
        ).to(self._device)

    def _load_network(self, labels: int) -> Any:
        return self._load(AutoModelForSequenceClassification, num_labels=labels, use_safetensors=True).to(self._device)

    def _load(self, kind: Any, **options: Any) -> Any:
        """Load a part of the model, without the warning that its new head is untrained: it is about to be trained."""
        before = transformers_logging.get_verbosity()
        transformers_logging.set_verbosity_error()  # type: ignore[no-untyped-call]
        transformers_logging.disable_progress_bar()  # type: ignore[no-untyped-call]
        try:
            return kind.from_pretrained(self._model, trust_remote_code=False, **options)
        except (OSError, ValueError, KeyError, ImportError, RuntimeError) as err:
            raise ConfigError(f"--encoder: {self._model} cannot be loaded: {' '.join(str(err).split())}") from err
        finally:
            transformers_logging.set_verbosity(before)


def _paragraph(texts: Sequence[str]) -> str:
    return ". ".join(text.strip().rstrip(".") for text in texts) + "."
