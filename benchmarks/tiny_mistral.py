"""A random model of Mistral's architecture, small enough for a laptop, with a tokeniser made from the instructions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import torch
import yaml
from tokenizers import Tokenizer, decoders, pre_tokenizers, trainers
from tokenizers.models import BPE
from transformers import MistralConfig, MistralForCausalLM, PreTrainedTokenizerFast

from coopera.core.hour import Example
from coopera.core.people import BigFive, PersonId
from coopera.models.classifiers.instruction import SHIPPED
from coopera.prompts import PromptLibrary

RATE = 5e-3
"""Learning rate for a model so small; 1e-5, the paper's for 7 billion weights, would not move it."""


def learned_words(texts: Iterable[str], *, size: int, special: Sequence[str] = ()) -> PreTrainedTokenizerFast:
    """A byte-level BPE tokeniser learned from some texts; without any, each byte is a token."""
    bare = Tokenizer(BPE())
    bare.pre_tokenizer = pre_tokenizers.ByteLevel(add_prefix_space=False)
    bare.decoder = decoders.ByteLevel()
    trainer = trainers.BpeTrainer(
        vocab_size=size,
        special_tokens=["<s>", "</s>", *special],
        initial_alphabet=pre_tokenizers.ByteLevel.alphabet(),
        show_progress=False,
    )
    bare.train_from_iterator(texts, trainer)
    return PreTrainedTokenizerFast(tokenizer_object=bare, bos_token="<s>", eos_token="</s>")


def make_model(folder: Path, *, hidden: int = 32, layers: int = 2, seed: int = 0) -> Path:
    """Write the model and its tokeniser; equal arguments give the same one."""
    folder.mkdir(parents=True, exist_ok=True)
    shown = Example(person=PersonId("a"), day=0, hour=9, candidate="drink tea", big_five=BigFive(), rank=0)
    words = learned_words([PromptLibrary().instruct(shown)] * 3, size=600)
    words.save_pretrained(folder)
    config = MistralConfig(
        vocab_size=len(words),
        hidden_size=hidden,
        intermediate_size=2 * hidden,
        num_hidden_layers=layers,
        num_attention_heads=4,
        num_key_value_heads=2,
        max_position_embeddings=2048,
        initializer_range=0.2,
        bos_token_id=0,
        eos_token_id=1,
    )
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        MistralForCausalLM(config).save_pretrained(folder)
    return folder


def tiny_recipe(folder: Path, *, hidden: int = 64, layers: int = 2) -> Path:
    """Write a model and the recipe that the benchmarks tune it by; nothing where they are there already."""
    path = folder / "recipe.yaml"
    if not path.is_file():
        base = make_model(folder / "base", hidden=hidden, layers=layers)
        make_recipe(path, base, learning_rate=RATE, batch=8, accumulation=1)
    return path


def make_recipe(path: Path, base: Path, **changes: object) -> Path:
    """Write the shipped recipe with another base and whatever else differs."""
    shipped = yaml.safe_load(SHIPPED.read_text(encoding="utf-8"))
    path.write_text(yaml.safe_dump({**shipped, "base": str(base), "devices": "cpu", **changes}), encoding="utf-8")
    return path
