"""The structured calls of an hour at models as large as the paper's, with random weights: speed and memory.

    python -m benchmarks.gpu_models [--size tiny | full] [--frames 8] [--folder DIR]

`full` writes the architectures of Llama-3.1-8B and Llama-3.2-11B-Vision with random weights (16 and 22 GB) into the
folder. It then loads them as any `huggingface:` model, on a GPU with 48 GB. `tiny` does the same with two layers, on
any device. A model with random weights does not stop by itself: its replies are `--tokens` long. So the time is an
upper bound for a trained model.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import torch
from PIL import Image
from transformers import (
    LlamaConfig,
    LlamaForCausalLM,
    MllamaConfig,
    MllamaForConditionalGeneration,
    MllamaImageProcessor,
    MllamaProcessor,
    PreTrainedModel,
    PreTrainedTokenizerFast,
)

from benchmarks.constrained import enlarged
from coopera.core.asks import ASKS
from coopera.core.hour import ModelCall
from coopera.core.protocols import Role
from coopera.core.randomness import Address
from coopera.core.replies import REPLIES
from coopera.models.door import open_door
from coopera.models.settings import CallSettings
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
from coopera.simulation import World, load_scene
from tests.fakes import LetterEmbeddings
from tests.tiny import SEEING, TEXT, word_tokenizer

IMAGE = "<|image|>"
HOUR = ("human/intention", "human/tasks_type2", "human/reflect_profile_type2", "human/reflect_scene_type2")
GUESSES = 5  # intentions, each of which is asked about by itself
LLAMA: dict[str, dict[str, Any]] = {
    "full": {"hidden_size": 4096, "intermediate_size": 14336, "num_hidden_layers": 32, "num_attention_heads": 32},
    "tiny": {"hidden_size": 64, "intermediate_size": 64, "num_hidden_layers": 2, "num_attention_heads": 8},
}
TOKENS = {"full": 128_256, "tiny": 2_000}
PIXELS = {"full": 560, "tiny": 56}


def main() -> None:
    """Write both models, live the calls of an hour with them, and print what they took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", choices=sorted(LLAMA), default="tiny")
    parser.add_argument("--frames", type=int, default=8, help="moments, of which each viewpoint gives a picture")
    parser.add_argument("--tokens", type=int, default=512, help="the most of a reply")
    parser.add_argument("--folder", type=Path, default=None)
    given = parser.parse_args()
    gpu = torch.cuda.is_available()
    print(f"{given.size} models on {torch.cuda.get_device_name() if gpu else 'the CPU: no GPU is at hand'}")
    with tempfile.TemporaryDirectory(dir=given.folder) as name:
        folder = Path(name)
        text, seeing = write_text(folder / "text", given.size), write_seeing(folder / "seeing", given.size)
        specs: dict[Role, str] = {"human": text, "robot": seeing, "judge": text}
        settings = CallSettings(max_tokens=given.tokens)
        started = time.perf_counter()
        door = open_door(
            prompts=PromptLibrary(), model=specs, seed=0, embeddings=LetterEmbeddings(), settings=settings, root=folder
        )
        print(f"loading both: {time.perf_counter() - started:.1f} s")
        pictures = write_pictures(folder, 2 * given.frames)
        live_hour(door, pictures)  # the first hour compiles and warms up
        door.take_calls()
        started = time.perf_counter()
        live_hour(door, pictures)
        report(door.take_calls(), time.perf_counter() - started)
    if gpu:
        print(f"memory of the GPU: {torch.cuda.max_memory_allocated() / 2**30:.1f} GiB")
    print(f"memory of the process: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20:.1f} GiB")


def live_hour(door: Any, pictures: Sequence[Path]) -> None:
    """Ask what an hour of type 2 asks, in a shipped home; the tasks of all intentions at once, as the graph does."""
    home = World(load_scene("maple", []))
    objects = {"fixed": home.objects("fixed"), "movable": home.objects("movable"), "motions": home.motions[:5]}

    def ask(name: str, draw: int = 0, images: Sequence[Path] = ()) -> None:
        known: Mapping[str, Any] = examples(name)[0]
        variables = {key: objects.get(key, value) for key, value in known.items()}
        at = Address("nora", 0, 9, name, draw)
        door(name, REPLIES[ASKS[name].reply], at=at, variables=variables, images=images)

    for name in HOUR:
        ask(name)
    ask("robot/intentions", images=pictures)
    with ThreadPoolExecutor(GUESSES) as pool:
        list(pool.map(lambda draw: ask("robot/tasks_type2", draw), range(GUESSES)))
    ask("judge/tasks")


def report(calls: Sequence[ModelCall], seconds: float) -> None:
    """Print each call, and the hour."""
    for call in calls:
        said = f"{call.tokens_in} tokens in, {call.tokens_out} out, {call.seconds:.2f} s"
        print(f"{call.prompt}: {said}{'' if call.attempts == 1 else f', {call.attempts} attempts'}")
    out = sum(call.tokens_out for call in calls)
    print(f"the hour: {seconds:.1f} s, {out} tokens out, {out / seconds:.1f} tokens a second")


def write_text(folder: Path, size: str) -> str:
    """Write a Llama; returns its spec."""
    words = tokenizer(TEXT, size)
    config = LlamaConfig(
        vocab_size=len(words),
        num_key_value_heads=8,
        max_position_embeddings=131_072,
        bos_token_id=0,
        eos_token_id=1,
        **LLAMA[size],
    )
    words.save_pretrained(folder)
    return _written(LlamaForCausalLM, config, folder)


def write_seeing(folder: Path, size: str) -> str:
    """Write an Mllama, which is Llama 3.2's kind that sees; returns its spec."""
    words = tokenizer(SEEING.replace("<image>", IMAGE), size)
    own: dict[str, Any] = {"vocab_size": len(words), "bos_token_id": 0, "eos_token_id": 1, "pad_token_id": 1}
    eye: dict[str, Any] = {"image_size": PIXELS[size]}
    if size == "tiny":
        own |= {**LLAMA[size], "num_hidden_layers": 3, "num_key_value_heads": 8, "cross_attention_layers": [1]}
        own["rope_parameters"] = {"rope_type": "default", "rope_theta": 500_000.0}
        eye |= {"hidden_size": 64, "intermediate_size": 64, "num_hidden_layers": 2, "num_global_layers": 1}
        eye |= {"attention_heads": 4, "intermediate_layers_indices": [1], "vision_output_dim": 128}
    pixels = {"height": PIXELS[size], "width": PIXELS[size]}
    eyes = MllamaImageProcessor(size=pixels, max_image_tiles=4)
    MllamaProcessor(image_processor=eyes, tokenizer=words, chat_template=words.chat_template).save_pretrained(folder)
    config = MllamaConfig(vision_config=eye, text_config=own, image_token_index=words.vocab[IMAGE])
    return _written(MllamaForConditionalGeneration, config, folder)


def tokenizer(template: str, size: str) -> PreTrainedTokenizerFast:
    """As many tokens as the model has, most of them made up."""
    return enlarged(word_tokenizer(template, IMAGE), TOKENS[size])


def write_pictures(folder: Path, count: int) -> list[Path]:
    """Pictures of the paper's size (PAPER App. D)."""
    paths = [folder / f"view-{n}.png" for n in range(count)]
    for n, path in enumerate(paths):
        Image.effect_noise((1024, 768), 20 + n).convert("RGB").save(path, compress_level=1)
    return paths


def _written(kind: type[PreTrainedModel], config: Any, folder: Path) -> str:
    place = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    with torch.random.fork_rng(), place:
        torch.manual_seed(0)
        model = kind._from_config(config, dtype=torch.bfloat16)
        model.save_pretrained(folder)
    return f"huggingface:{folder}"


if __name__ == "__main__":
    main()
