"""A Hugging Face chat model that is finetuned itself: questions with their replies go in, its own replies come out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import torch
from langchain_core.messages import HumanMessage
from safetensors import SafetensorError
from safetensors.torch import load as load_tensors
from safetensors.torch import save as save_tensors
from torch import Tensor, nn

from coopera.core.errors import CooperaError
from coopera.core.hour import CandidateKind
from coopera.models.classifiers.causal import CausalBase, open_base
from coopera.models.classifiers.evening import must_be_finite, one_thread
from coopera.models.classifiers.instruction import InstructRecipe, read_recipe
from coopera.models.classifiers.state import read_manifest, replace_bytes, write_manifest
from coopera.models.huggingface import HuggingFaceChat, wrap

VERSION = 1
WEIGHTS, CONFIG = "adapter_model.safetensors", "adapter_config.json"  # as peft names and reads them
_KIND: CandidateKind = "intention"  # which of the base's two adapters is used

TokenPair: TypeAlias = tuple[list[int], list[int]]
"""A question and its reply as tokens."""


class FinetunedChat:
    """A text model with a low-rank adapter (LoRA) that learns to reply as it was told.

    Replies are drawn without chance and can be held to a JSON schema. Objects for the same model and recipe share its
    weights; each has an adapter of its own.
    """

    def __init__(self, model: str, recipe: Path | None = None) -> None:
        """Load the model, once for all of its recipe.

        Args:
            model: A repository or folder.
            recipe: As `lora-instruct` has one, by default the paper's; its `base` is replaced by the model.

        Raises:
            ConfigError: If the model cannot be loaded, is no chat model, or has no such modules to adapt.
        """
        shape = read_recipe(recipe) if recipe else read_recipe()
        self._recipe: InstructRecipe = shape.model_copy(update={"base": model})
        self._learned: dict[str, Tensor] | None = None
        self._chat: HuggingFaceChat = wrap(model, self._base().model, self._base().tokenizer)

    @property
    def trained(self) -> bool:
        """Whether it has learned anything yet."""
        return self._learned is not None

    @property
    def most(self) -> int:
        """How many lessons it takes in an evening."""
        return self._recipe.most

    def train(self, lessons: Sequence[tuple[str, str]], *, seed: int) -> dict[str, float]:
        """Learn questions with their replies, going on from what was learned before.

        Args:
            lessons: At least one, and of more than `most` the last ones are learned.
            seed: Decides first weights, order and dropout.

        Returns:
            `lessons` and `loss` (mean over the last epoch, per token of a reply).

        Raises:
            LearningError: If the loss is no longer a finite number; what was learned before is kept.
        """
        base, rows = self._base(), [self._row(*lesson) for lesson in lessons[-self.most :]]
        devices = list(range(torch.cuda.device_count()))
        with base.lock, one_thread(), torch.random.fork_rng(devices=devices):
            torch.manual_seed(seed % 2**63)
            base.put_in(_KIND, self._learned or base.fresh(_KIND, seed % 2**63))
            epochs = self._recipe.epochs if self._learned is None else self._recipe.later_epochs
            try:
                loss = self._fit(base, rows, epochs, np.random.default_rng(seed))
            finally:
                learned = base.take_out(_KIND)
        self._learned = learned
        return {"lessons": float(len(rows)), "loss": loss}

    def reply(self, question: str, schema: Mapping[str, Any] | None = None) -> str:
        """Answer a question; with a schema, by JSON that fits it."""
        base = self._base()
        with base.lock, one_thread():
            base.put_in(_KIND, self._learned or base.fresh(_KIND, 0))
            base.model.eval()
            return str(self._chat.invoke([HumanMessage(question)], schema=schema, temperature=0.0).text)

    def save(self, folder: Path) -> None:
        """Write `classifier.json` and, once trained, the adapter in peft's own files.

        Raises:
            CooperaError: If the folder cannot be written.
        """
        if self._learned is not None:
            replace_bytes(folder / CONFIG, self._base().config_file())
            replace_bytes(folder / WEIGHTS, save_tensors(self._learned))
        write_manifest(folder, {**self._identity(), "trained": self.trained})

    def load(self, folder: Path) -> None:
        """Read what `save` wrote.

        Raises:
            CooperaError: If the folder holds no adapter of this model and recipe, or a damaged one.
        """
        if not read_manifest(folder, self._identity())["trained"]:
            self._learned = None
            return
        path = folder / WEIGHTS
        try:
            learned = load_tensors(path.read_bytes())
        except (OSError, SafetensorError) as err:
            raise CooperaError(f"{path}: the adapter is damaged ({err})") from err
        if {name: tuple(value.shape) for name, value in learned.items()} != self._base().shapes(_KIND):
            raise CooperaError(f"{path}: the adapter is damaged (its tensors are not those of this model and recipe)")
        self._learned = learned

    def _fit(self, base: CausalBase, rows: Sequence[TokenPair], epochs: int, rng: np.random.Generator) -> float:
        """Train the active adapter to give the replies' tokens; return the last epoch's mean loss."""
        recipe, parameters = self._recipe, base.parameters(_KIND)
        optimizer = torch.optim.AdamW(parameters, lr=recipe.learning_rate, weight_decay=recipe.weight_decay)
        base.model.train()
        mean = 0.0
        for _ in range(epochs):
            total = 0.0
            for number, at in enumerate(rng.permutation(len(rows)), 1):
                loss = self._loss(base, *rows[at])
                must_be_finite("loss", float(loss.detach()), classifier="finetuned model", rate=recipe.learning_rate)
                (loss / recipe.accumulation).backward()  # type: ignore[no-untyped-call]
                if number % recipe.accumulation == 0 or number == len(rows):
                    nn.utils.clip_grad_norm_(parameters, 1.0)
                    optimizer.step()
                    optimizer.zero_grad()
                total += float(loss.detach())
            mean = total / len(rows)
        return mean

    @staticmethod
    def _loss(base: CausalBase, question: list[int], reply: list[int]) -> Tensor:
        ids = torch.tensor([question + reply], device=base.model.device)
        logits = base.model(input_ids=ids, use_cache=False).logits[0, len(question) - 1 : -1].float()
        return nn.functional.cross_entropy(logits, ids[0, len(question) :])

    def _row(self, question: str, reply: str) -> TokenPair:
        """The tokens of a question, in the model's own chat form, and of a reply with its end."""
        tokenizer = self._base().tokenizer
        asked = tokenizer.apply_chat_template(
            [{"role": "user", "content": question}], add_generation_prompt=True, tokenize=False
        )
        before = tokenizer(asked, add_special_tokens=False)["input_ids"]
        said = tokenizer(reply, add_special_tokens=False)["input_ids"]
        return before[-self._recipe.tokens :], [*said, int(tokenizer.eos_token_id)]

    def _base(self) -> CausalBase:
        return open_base(self._recipe.model_dump_json())

    def _identity(self) -> dict[str, Any]:
        recipe = self._recipe.model_dump(exclude={"base", "devices", "verdicts"})
        return {"finetuned": self._base().name, "version": VERSION, "recipe": recipe}
