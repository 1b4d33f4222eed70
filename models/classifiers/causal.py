"""One causal language model, loaded once, with an adapter for each kind of candidate that is swapped in when needed."""

from __future__ import annotations

import hashlib
import json
import threading
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import torch
from peft import LoraConfig, get_peft_model, get_peft_model_state_dict, set_peft_model_state_dict
from torch import Tensor
from transformers import AutoModelForCausalLM, AutoTokenizer

from coopera.core.errors import ConfigError
from coopera.core.hour import CandidateKind
from coopera.core.lazy import made_once
from coopera.models.classifiers.instruction import TAIL, InstructRecipe
from coopera.models.small.weights import folder_of

KINDS: tuple[CandidateKind, CandidateKind] = ("intention", "task")


class CausalBase:
    """A frozen causal model with two adapters; `lock` is held while one of them is in use."""

    def __init__(self, recipe: InstructRecipe) -> None:
        """Load weights (safetensors only; code that a repository brings along is never run) and add the adapters.

        Raises:
            ConfigError: If the base cannot be loaded, has no such modules, or its tokeniser confuses Yes and No.
        """
        self.recipe = recipe
        self.lock = threading.RLock()
        self._inside: dict[CandidateKind, object] = {}
        model, self.tokenizer = _load(recipe)
        self.name = _name(model, recipe.base)
        config = LoraConfig(
            r=recipe.rank,
            lora_alpha=recipe.alpha,
            lora_dropout=recipe.dropout,
            target_modules=list(recipe.modules),
            task_type="CAUSAL_LM",
        )
        self.config: dict[str, Any] = {
            **config.to_dict(),  # type: ignore[no-untyped-call]
            "base_model_name_or_path": recipe.base,
        }
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", FutureWarning)
                self.model: Any = get_peft_model(model, config, adapter_name="intention")
                self.model.add_adapter("task", config)
        except ValueError as err:
            raise ConfigError(f"modules: {recipe.base} has none of {', '.join(recipe.modules)} to adapt.") from err
        self._shapes = {kind: {name: tuple(t.shape) for name, t in self._read(kind).items()} for kind in KINDS}
        self.answers = _answers(self.tokenizer, recipe.base)

    def put_in(self, kind: CandidateKind, learned: Mapping[str, Tensor]) -> None:
        """Make an adapter the active one and give it these tensors, which are not copied again while they are in it."""
        if self._inside.get(kind) is not learned:
            set_peft_model_state_dict(self.model, dict(learned), adapter_name=kind)
            self._inside[kind] = learned
        self.model.set_adapter(kind)

    def take_out(self, kind: CandidateKind) -> dict[str, Tensor]:
        """Return copies of an adapter's tensors, after training them; what was put in is in it no longer."""
        self._inside.pop(kind, None)
        return self._read(kind)

    def fresh(self, kind: CandidateKind, seed: int) -> dict[str, Tensor]:
        """Return the tensors of a new adapter: B at zero, A drawn, so that it changes nothing at first."""
        generator, drawn = torch.Generator().manual_seed(seed), {}
        for name, shape in self.shapes(kind).items():
            drawn[name] = torch.zeros(shape)
            if ".lora_A." in name:
                bound = 1.0 / shape[1] ** 0.5
                drawn[name].uniform_(-bound, bound, generator=generator)
        return drawn

    def parameters(self, kind: CandidateKind) -> list[Any]:
        """What is trained of the active adapter."""
        return [p for name, p in self.model.named_parameters() if p.requires_grad and f".{kind}." in name]

    def shapes(self, kind: CandidateKind) -> dict[str, tuple[int, ...]]:
        """Names and shapes of an adapter's tensors."""
        return self._shapes[kind]

    def scores(self, texts: Sequence[str]) -> Tensor:
        """Logit of Yes less that of No, right after each instruction, shape (B,): one forward pass."""
        ids = [self._ids(text) for text in texts]
        longest = max(map(len, ids))
        pad = self.tokenizer.pad_token_id or 0
        rows = torch.tensor([[pad] * (longest - len(one)) + one for one in ids])
        mask = torch.tensor([[0] * (longest - len(one)) + [1] * len(one) for one in ids])
        device = self.model.device
        out = self.model(
            input_ids=rows.to(device),
            attention_mask=mask.to(device),
            position_ids=(mask.cumsum(1) - 1).clamp_min(0).to(device),
            logits_to_keep=1,
            use_cache=False,
        )
        last = out.logits[:, -1].float()
        yes, no = self.answers
        scores: Tensor = last[:, yes] - last[:, no]
        return scores

    def config_file(self) -> bytes:
        """The adapters' configuration as peft writes it."""
        return (json.dumps(self.config, indent=1, sort_keys=True, default=_plain) + "\n").encode()

    def _ids(self, text: str) -> list[int]:
        ids: list[int] = self.tokenizer(text)["input_ids"]
        half = self.recipe.tokens // 2
        return ids if len(ids) <= self.recipe.tokens else ids[:half] + ids[-half:]

    def _read(self, kind: CandidateKind) -> dict[str, Tensor]:
        found = get_peft_model_state_dict(self.model, adapter_name=kind, save_embedding_layers=False)
        return {name: found[name].detach().cpu().clone().contiguous() for name in sorted(found)}


@made_once(1)
def open_base(recipe_json: str) -> CausalBase:
    """Load a base once in a process, for all classifiers that share a recipe (as JSON, so that it can be a key)."""
    return CausalBase(InstructRecipe.model_validate_json(recipe_json))


def _load(recipe: InstructRecipe) -> tuple[Any, Any]:
    safe: dict[str, Any] = {"trust_remote_code": False}
    gpu = torch.cuda.is_available() and recipe.devices != "cpu"
    if recipe.devices.startswith("cuda") and not gpu:
        raise ConfigError(f"devices: there is no {recipe.devices} here; choose auto or cpu.")
    place = {"device_map": recipe.devices} if gpu else {}
    folder = folder_of(recipe.base)
    try:
        tokenizer: Any = AutoTokenizer.from_pretrained(folder, **safe)
        model = AutoModelForCausalLM.from_pretrained(
            folder, dtype=torch.bfloat16 if gpu else torch.float32, use_safetensors=True, **place, **safe
        )
    except (OSError, ValueError, KeyError, ImportError, RuntimeError) as err:
        raise ConfigError(f"base: {recipe.base} cannot be loaded: {' '.join(str(err).split())}") from err
    return model, tokenizer


def _name(model: Any, base: str) -> str:
    """The base's name with a fingerprint of its shape and first weights, since folders and repositories change."""
    config = {
        k: v for k, v in model.config.to_dict().items() if k not in ("_name_or_path", "transformers_version", "dtype")
    }
    sample = model.get_input_embeddings().weight[:8].detach().float().cpu().contiguous()
    digest = hashlib.sha256(json.dumps(config, sort_keys=True, default=str).encode())
    digest.update(sample.numpy().tobytes())
    return f"{base.rstrip('/').rsplit('/', 1)[-1]} {digest.hexdigest()[:12]}"


def _answers(tokenizer: Any, base: str) -> tuple[int, int]:
    """Ids of the tokens by which Yes and No begin right after an instruction."""
    before = len(tokenizer(TAIL)["input_ids"])
    yes, no = (tokenizer(f"{TAIL}{word}")["input_ids"][before:] for word in ("Yes", "No"))
    if not yes or not no or yes[0] == no[0]:
        raise ConfigError(f"base: the tokeniser of {base} does not tell Yes from No.")
    return int(yes[0]), int(no[0])


def _plain(value: object) -> object:
    """What JSON does not know in peft's configuration: sets, and enumerations by their value."""
    return sorted(value) if isinstance(value, set | frozenset) else getattr(value, "value", str(value))
