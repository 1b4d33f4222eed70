"""Tiny models with random weights and a tokenizer trained on the spot: they know nothing, but they are real models."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import torch
from transformers import (
    BertConfig,
    BertForMaskedLM,
    BertTokenizerFast,
    CLIPImageProcessor,
    CLIPVisionConfig,
    LlamaConfig,
    LlamaForCausalLM,
    LlavaConfig,
    LlavaForConditionalGeneration,
    LlavaProcessor,
    PreTrainedTokenizerFast,
)

from benchmarks.tiny_mistral import learned_words
from coopera.core.asks import ASKS
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples

SEED = int(os.environ.get("COOPERA_TEST_WEIGHTS_SEED", "0"))
"""Seed of all random weights: no test may need the weights, or the arithmetic, of one machine."""
TEXT = (
    "{% for m in messages %}{{ m['role'] }}: {{ m['content'] }}\n{% endfor %}"
    "{% if add_generation_prompt %}assistant: {% endif %}"
)
SEEING = (
    "{% for m in messages %}{{ m['role'] }}: {% for part in m['content'] %}"
    "{% if part['type'] == 'image' %}<image>{% else %}{{ part['text'] }}{% endif %}{% endfor %}\n{% endfor %}"
    "assistant: "
)
LLAMA: dict[str, Any] = {
    "hidden_size": 32,
    "intermediate_size": 32,
    "num_hidden_layers": 1,
    "num_attention_heads": 2,
    "num_key_value_heads": 1,
    "max_position_embeddings": 16_384,
    "bos_token_id": 0,
    "eos_token_id": 1,
    "initializer_range": 0.5,
}


def byte_tokenizer(template: str | None = TEXT, *more: str) -> PreTrainedTokenizerFast:
    """Bytes as tokens, so that nothing has to be learned."""
    return _trained(iter(()), template, *more)


def word_tokenizer(template: str | None = TEXT, *more: str) -> PreTrainedTokenizerFast:
    """Learned from the shipped prompts, so that they are short in it."""
    library = PromptLibrary()
    texts = (library.render(name, variables).text for name in sorted(ASKS) for variables in examples(name))
    return _trained(texts, template, *more)


def _trained(texts: Iterator[str], template: str | None, *more: str) -> PreTrainedTokenizerFast:
    fast = learned_words(texts, size=2000, special=more)
    fast.chat_template = template
    return fast


def random_llama(folder: Path, words: PreTrainedTokenizerFast | None = None, **changes: Any) -> Path:
    """Write a Llama of some thousand weights; `changes` are to its configuration."""
    words = words or byte_tokenizer()
    words.save_pretrained(folder)
    with torch.random.fork_rng():
        torch.manual_seed(SEED)
        LlamaForCausalLM(LlamaConfig(vocab_size=len(words), **{**LLAMA, **changes})).save_pretrained(folder)
    return folder


def random_llava(folder: Path, words: PreTrainedTokenizerFast | None = None) -> Path:
    """Write a Llava: a CLIP eye of 16 x 16 pixels before the same Llama. `words` must know <image>."""
    words = words or byte_tokenizer(SEEING, "<image>")
    size = {"height": 16, "width": 16}
    LlavaProcessor(
        image_processor=CLIPImageProcessor(size=size, crop_size=size),
        tokenizer=words,
        patch_size=8,
        vision_feature_select_strategy="default",
        num_additional_image_tokens=1,
        chat_template=SEEING,
    ).save_pretrained(folder)
    vision = CLIPVisionConfig(
        hidden_size=16,
        intermediate_size=16,
        num_hidden_layers=2,
        num_attention_heads=2,
        image_size=16,
        patch_size=8,
        projection_dim=16,
        initializer_factor=20.0,
    )
    text = LlamaConfig(vocab_size=len(words), **LLAMA)
    image = words.convert_tokens_to_ids("<image>")
    with torch.random.fork_rng():
        torch.manual_seed(SEED)
        config = LlavaConfig(vision_config=vision, text_config=text, image_token_id=image)
        LlavaForConditionalGeneration(config).save_pretrained(folder)
    return folder


def random_bert(folder: Path, words: Sequence[str]) -> Path:
    """Write a BERT of some thousand weights that knows these words and a full stop, without dropout."""
    vocabulary = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]", ".", *words]
    (folder / "vocab.txt").write_text("\n".join(vocabulary))
    BertTokenizerFast(vocab=str(folder / "vocab.txt"), model_max_length=512).save_pretrained(folder)
    with torch.random.fork_rng():
        torch.manual_seed(SEED)
        config = BertConfig(
            vocab_size=len(vocabulary),
            hidden_size=16,
            num_hidden_layers=1,
            num_attention_heads=2,
            intermediate_size=32,
            initializer_range=0.1,
            hidden_dropout_prob=0.0,
            attention_probs_dropout_prob=0.0,
        )
        BertForMaskedLM(config).save_pretrained(folder)
    return folder
