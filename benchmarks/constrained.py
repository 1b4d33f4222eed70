"""What it costs to hold a model of this process to a reply's schema: the same tiny model, free and held, in turns.

    python -m benchmarks.constrained [--rounds 5] [--vocabulary 128000]

The model is a random Llama of some thousand weights, and its network costs next to nothing. So the share is far above a
real model's: look at the difference in milliseconds. A mask's time grows with the vocabulary. Random words are added to
the small vocabulary to make it as large as Llama 3's.
"""

from __future__ import annotations

import argparse
import json
import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import torch
from tokenizers import Tokenizer
from transformers import LlamaConfig, LlamaForCausalLM, PreTrainedTokenizerFast

from coopera.core.asks import ASKS
from coopera.core.replies import REPLIES
from coopera.models.constrained import Grammars
from coopera.models.huggingface import open_model
from coopera.models.schemas import enforced_schema
from coopera.prompts.examples import examples
from tests.tiny import LLAMA, word_tokenizer

PROMPTS = ("human/intention", "human/tasks_type1", "robot/tasks_type2", "judge/tasks")


def main() -> None:
    """Print milliseconds per token, free and held, and the time to compile a schema."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--vocabulary", type=int, default=128_000)
    given = parser.parse_args()
    torch.set_num_threads(1)
    small = word_tokenizer()
    for words in (small, enlarged(small, given.vocabulary)):
        measure(words, given.rounds)


def measure(words: PreTrainedTokenizerFast, rounds: int) -> None:
    """Print what holding costs with one tokenizer."""
    started = time.perf_counter()
    grammars = Grammars(words, len(words), [1])
    print(f"reading a tokenizer of {len(words):,} tokens, once: {time.perf_counter() - started:.2f} s")
    with tempfile.TemporaryDirectory() as folder:
        words.save_pretrained(folder)
        LlamaForCausalLM(LlamaConfig(vocab_size=len(words), **LLAMA)).save_pretrained(folder)
        model = open_model(str(Path(folder)))
        for name in PROMPTS:
            schema = enforced_schema(REPLIES[ASKS[name].reply], examples(name)[0])
            started = time.perf_counter()
            grammars.matcher(schema)
            compiled = time.perf_counter() - started
            free, held = [], []
            for seed in range(rounds):
                free.append(_per_token(model, seed, None))
                held.append(_per_token(model, seed, schema))
            ms = [1000 * statistics.median(times) for times in (free, held)]
            said = f"free {ms[0]:.2f}, held {ms[1]:.2f} ms a token ({ms[1] / ms[0]:.2f} times)"
            print(f"{name}: {said}; compiling its schema {1000 * compiled:.1f} ms")


def enlarged(words: PreTrainedTokenizerFast, size: int) -> PreTrainedTokenizerFast:
    """A tokenizer of so many tokens: random words of 2 to 10 letters are added, half of them with a space before."""
    data, rng = json.loads(words.backend_tokenizer.to_str()), np.random.default_rng(0)
    vocabulary = data["model"]["vocab"]
    while len(vocabulary) < size:
        letters = rng.choice(list("abcdefghijklmnopqrstuvwxyz"), size=rng.integers(2, 11))
        vocabulary.setdefault("".join(["\u0120", *letters][rng.integers(2) :]), len(vocabulary))
    large = PreTrainedTokenizerFast(
        tokenizer_object=Tokenizer.from_str(json.dumps(data)), bos_token=words.bos_token, eos_token=words.eos_token
    )
    large.chat_template = words.chat_template
    return large


def _per_token(model: Any, seed: int, schema: dict[str, Any] | None) -> float:
    started = time.process_time()
    reply = model.invoke("Hello.", temperature=1.0, seed=seed, max_tokens=96, schema=schema)
    return (time.process_time() - started) / int(reply.usage_metadata["output_tokens"])


if __name__ == "__main__":
    main()
