"""From a spec to a chat model: what is refused at start, and what a tiny model in this process really does."""

from __future__ import annotations

import base64
import io
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from langchain_core.language_models import BaseChatModel, FakeListChatModel
from langchain_core.messages import AIMessage, HumanMessage
from PIL import Image
from tokenizers import Tokenizer, decoders, pre_tokenizers, trainers
from tokenizers.models import BPE
from transformers import (
    CLIPImageProcessor,
    CLIPVisionConfig,
    LlamaConfig,
    LlamaForCausalLM,
    LlavaConfig,
    LlavaForConditionalGeneration,
    LlavaProcessor,
    PreTrainedTokenizerFast,
)

from core.asks import ASKS
from core.errors import ConfigError, ModelCallError, ModelOutputError
from core.randomness import Address
from core.replies import REPLIES, VerdictsReply
from models.backends import Backend, open_backend, open_backends
from models.door import Door, open_door
from models.huggingface import GumbelDraw, HuggingFaceChat, open_model
from prompts import PromptLibrary
from prompts.examples import examples
from tests.fakes import LetterEmbeddings

EMBEDDINGS = LetterEmbeddings()
AT = Address("nora", 0, 9, "score")
TEMPLATE = (
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
    "max_position_embeddings": 4096,
    "bos_token_id": 0,
    "eos_token_id": 1,
    "initializer_range": 0.5,
}


def tokenizer(template: str | None = TEMPLATE, *more: str) -> PreTrainedTokenizerFast:
    """Bytes as tokens, so that nothing has to be learned."""
    bare = Tokenizer(BPE())
    bare.pre_tokenizer = pre_tokenizers.ByteLevel(add_prefix_space=False)
    bare.decoder = decoders.ByteLevel()
    alphabet = pre_tokenizers.ByteLevel.alphabet()
    trainer = trainers.BpeTrainer(special_tokens=["<s>", "</s>", *more], initial_alphabet=alphabet, show_progress=False)
    bare.train_from_iterator([], trainer)
    fast = PreTrainedTokenizerFast(tokenizer_object=bare, bos_token="<s>", eos_token="</s>")
    fast.chat_template = template
    return fast


def random_llama(folder: Path, template: str | None = TEMPLATE) -> Path:
    words = tokenizer(template)
    words.save_pretrained(folder)
    with torch.random.fork_rng():
        torch.manual_seed(0)
        LlamaForCausalLM(LlamaConfig(vocab_size=len(words), **LLAMA)).save_pretrained(folder)
    return folder


@pytest.fixture(scope="module")
def llama(tmp_path_factory: pytest.TempPathFactory) -> HuggingFaceChat:
    model = open_model(str(random_llama(tmp_path_factory.mktemp("llama"))))
    return model.model_copy(update={"new_tokens": 24})


def test_every_role_is_offline_unless_said_otherwise() -> None:
    backends = open_backends({}, EMBEDDINGS)
    assert {role: backend.name for role, backend in backends.items()} == dict.fromkeys(
        ("human", "robot", "judge"), "offline"
    )
    assert all(b.reads_variables and not b.sees for b in backends.values())


def test_the_offline_door_answers_a_shipped_prompt_and_leaves_no_cache_file(tmp_path: Path) -> None:
    cache = tmp_path / "llm_cache.sqlite"
    door = open_door(prompts=PromptLibrary(), specs={}, seed=1, embeddings=EMBEDDINGS, cache=cache)
    variables = examples("judge/tasks")[0]
    reply = door("judge/tasks", VerdictsReply, at=AT, variables=variables)
    assert len(reply.verdicts) == len(variables["offers"])
    (call,) = door.take_calls()
    assert (call.model, call.attempts, call.cached, call.node) == ("offline", 1, False, "score")
    assert "JSON schema" not in call.messages[0]["content"]
    assert not door.sees("robot")
    assert not cache.exists()


@pytest.mark.parametrize("name", sorted(ASKS))
def test_the_offline_door_answers_every_prompt_whatever_its_variables(name: str) -> None:
    door = open_door(prompts=PromptLibrary(), specs={}, seed=1, embeddings=EMBEDDINGS, max_attempts=1)
    for variables in examples(name):
        door(name, REPLIES[ASKS[name].reply], at=AT, variables=variables)


@pytest.mark.parametrize(
    "spec", ["", "gpt-4o", "Offline", "openai:", ":model", "nobody:model", "openai: ", "offline:x"]
)
def test_an_unknown_model_is_refused_with_what_there_is(spec: str) -> None:
    with pytest.raises(ConfigError, match=r"offline, openai:MODEL .*huggingface:REPO-OR-FOLDER"):
        open_backend(spec, "human", EMBEDDINGS)


def test_an_unknown_role_is_refused() -> None:
    with pytest.raises(ConfigError, match='no role "pet".*human, robot, judge'):
        open_backends({"pet": "offline"}, EMBEDDINGS)  # type: ignore[dict-item]


def test_a_missing_package_is_named_with_the_way_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "langchain_openai", None)
    with pytest.raises(ConfigError, match=r"openai:gpt needs the package langchain-openai: pip install"):
        open_backend("openai:gpt", "human", EMBEDDINGS)


class FakeOpenAI(FakeListChatModel):
    """Stands in for langchain_openai.ChatOpenAI: keeps what it was opened with."""

    responses: list[str] = ["{}"]
    given: dict[str, Any] = {}

    def __init__(self, **given: Any) -> None:
        super().__init__(given=given)


@pytest.fixture
def fake_openai(monkeypatch: pytest.MonkeyPatch) -> None:
    package, errors = types.ModuleType("langchain_openai"), types.ModuleType("openai")
    package.ChatOpenAI = FakeOpenAI  # type: ignore[attr-defined]
    errors.OpenAIError = type("OpenAIError", (Exception,), {})  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "langchain_openai", package)
    monkeypatch.setitem(sys.modules, "openai", errors)
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)


@pytest.mark.usefixtures("fake_openai")
def test_an_openai_model_takes_its_key_from_the_environment_only(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ConfigError, match="OPENAI_API_KEY"):
        open_backend("openai:gpt", "human", EMBEDDINGS)
    local = open_backend("openai:org/model", "human", EMBEDDINGS, "http://127.0.0.1:8000/v1").model
    assert isinstance(local, FakeOpenAI)
    assert local.given["model"] == "org/model"
    assert local.given["base_url"] == "http://127.0.0.1:8000/v1"
    assert local.given["api_key"], "the client wants some key, even where the server wants none"
    monkeypatch.setenv("OPENAI_API_KEY", "sk-secret")
    backend = open_backend("openai:gpt", "human", EMBEDDINGS)
    assert isinstance(backend.model, FakeOpenAI)
    assert backend.model.given["api_key"] == "sk-secret"
    assert "sk-secret" not in backend.name


@pytest.mark.usefixtures("fake_openai")
def test_a_spec_can_say_that_the_model_looks_at_pictures() -> None:
    url = "http://127.0.0.1:8000/v1"
    seeing = open_backend("openai:qwen-vl+images", "robot", EMBEDDINGS, url)
    assert seeing.sees
    assert isinstance(seeing.model, FakeOpenAI)
    assert seeing.model.given["model"] == "qwen-vl"
    assert not open_backend("openai:qwen", "robot", EMBEDDINGS, url).sees


def test_other_providers_come_through_langchain_where_it_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    def init_chat_model(name: str, *, model_provider: str, **options: Any) -> BaseChatModel:
        if model_provider != "acme":
            raise ValueError(f"Unsupported provider {model_provider}")
        return FakeListChatModel(responses=[f"{name} speaking"])

    langchain, chat_models = types.ModuleType("langchain"), types.ModuleType("langchain.chat_models")
    chat_models.init_chat_model = init_chat_model  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "langchain", langchain)
    monkeypatch.setitem(sys.modules, "langchain.chat_models", chat_models)
    assert open_backend("acme:big", "human", EMBEDDINGS).model.invoke("hi").text == "big speaking"
    with pytest.raises(ConfigError, match="Unsupported provider other; a model may be offline"):
        open_backend("other:big", "human", EMBEDDINGS)


def test_a_folder_without_a_model_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be loaded"):
        open_backend(f"huggingface:{tmp_path}", "human", EMBEDDINGS)


def test_a_model_without_a_chat_template_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no chat template"):
        open_backend(f"huggingface:{random_llama(tmp_path, None)}", "human", EMBEDDINGS)


def test_a_model_in_pickle_files_is_refused(tmp_path: Path) -> None:
    folder = random_llama(tmp_path)
    (folder / "model.safetensors").rename(folder / "pytorch_model.bin")
    with pytest.raises(ConfigError, match="cannot be loaded"):
        open_backend(f"huggingface:{folder}", "human", EMBEDDINGS)


def test_a_model_is_loaded_once(llama: HuggingFaceChat) -> None:
    human, robot = (open_backend(f"huggingface:{llama.path}", role, EMBEDDINGS) for role in ("human", "robot"))
    assert human.model is robot.model
    assert not human.sees


def test_the_same_seed_says_the_same_and_the_global_random_state_is_left_alone(llama: HuggingFaceChat) -> None:
    before = torch.random.get_rng_state()
    said = [llama.invoke("hello", temperature=0.7, seed=seed).text for seed in (1, 1, 2)]
    assert said[0] == said[1] != said[2]
    assert torch.equal(before, torch.random.get_rng_state())
    cold = [llama.invoke("hello", temperature=0.0, seed=seed).text for seed in (1, 2)]
    assert cold[0] == cold[1]


def test_a_reply_tells_its_tokens_and_that_it_was_cut(llama: HuggingFaceChat) -> None:
    reply = llama.invoke("hello", temperature=0.7, seed=1)
    assert isinstance(reply, AIMessage)
    assert reply.usage_metadata == {"input_tokens": 23, "output_tokens": 24, "total_tokens": 47}
    assert reply.response_metadata["finish_reason"] == "length"


def test_a_prompt_that_does_not_fit_is_a_call_error(llama: HuggingFaceChat) -> None:
    with pytest.raises(ModelCallError, match="does not fit into its 4096"):
        llama.invoke("x" * 5000)


def test_random_weights_behind_the_door_end_in_an_output_error_and_a_full_record(llama: HuggingFaceChat) -> None:
    backend = Backend("huggingface:tiny", llama)
    door = Door(prompts=PromptLibrary(), backends={"judge": backend}, seed=1)
    with pytest.raises(ModelOutputError):
        door("judge/tasks", VerdictsReply, at=AT, variables=examples("judge/tasks")[0])
    (call,) = door.take_calls()
    assert (call.attempts, len(call.faults)) == (3, 3)
    assert 0 < call.tokens_out <= 3 * 24


def test_gumbel_draws_follow_the_softmax_at_the_temperature() -> None:
    scores = torch.tensor([[2.0, 1.0, 0.0, -30.0]])
    draw = GumbelDraw(0.5, seed=3)
    drawn = [int(draw(torch.empty(1, 0), scores).argmax()) for _ in range(4000)]
    expected = torch.softmax(scores[0].double() / 0.5, dim=0).numpy()
    assert np.abs(np.bincount(drawn, minlength=4) / 4000 - expected).max() < 0.03


def test_a_model_with_eyes_is_shown_the_pictures(tmp_path: Path) -> None:
    words = tokenizer(SEEING, "<image>")
    size = {"height": 16, "width": 16}
    eyes = CLIPImageProcessor(size=size, crop_size=size)
    LlavaProcessor(
        image_processor=eyes, tokenizer=words, patch_size=8, vision_feature_select_strategy="default",
        num_additional_image_tokens=1, chat_template=SEEING,
    ).save_pretrained(tmp_path)  # fmt: skip
    vision = CLIPVisionConfig(
        hidden_size=16, intermediate_size=16, num_hidden_layers=2, num_attention_heads=2, image_size=16, patch_size=8,
        projection_dim=16, initializer_factor=20.0,
    )  # fmt: skip
    config = LlavaConfig(
        vision_config=vision, text_config=LlamaConfig(vocab_size=len(words), **LLAMA),
        image_token_id=words.convert_tokens_to_ids("<image>"),
    )  # fmt: skip
    with torch.random.fork_rng():
        torch.manual_seed(0)
        LlavaForConditionalGeneration(config).save_pretrained(tmp_path)
    backend = open_backend(f"huggingface:{tmp_path}", "robot", EMBEDDINGS)
    assert backend.sees
    model = backend.model.model_copy(update={"new_tokens": 16})

    def look(colour: str) -> AIMessage:
        file = io.BytesIO()
        Image.new("RGB", (32, 24), colour).save(file, "WEBP")
        image = {"type": "image", "base64": base64.b64encode(file.getvalue()).decode(), "mime_type": "image/webp"}
        return model.invoke([HumanMessage([image, {"type": "text", "text": "What is it?"}])], temperature=0.7, seed=1)

    assert look("white").text == look("white").text
    assert look("white").text != look("black").text
