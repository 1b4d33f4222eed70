"""Models in this process: what is refused, what a tiny one really does, and that it cannot leave the schema."""

from __future__ import annotations

import base64
import io
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from langchain_core.messages import AIMessage, HumanMessage
from PIL import Image

from coopera.core.asks import ASKS
from coopera.core.errors import ConfigError, ModelCallError, ModelOutputError
from coopera.core.randomness import Address
from coopera.core.replies import REPLIES, PickPlaceReply, VerdictsReply
from coopera.models.backends import Backend, open_backend
from coopera.models.batching import Batcher
from coopera.models.constrained import HeldReply
from coopera.models.door import Door
from coopera.models.huggingface import HuggingFaceChat, open_model
from coopera.models.parsing import Wanted, read_reply
from coopera.models.schemas import enforced_schema
from coopera.models.settings import CallSettings
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
from tests.fakes import LetterEmbeddings
from tests.tiny import byte_tokenizer, random_llama, random_llava, word_tokenizer

EMBEDDINGS = LetterEmbeddings()
AT = Address("nora", 0, 9, "score")
FEW = 24


@pytest.fixture(scope="module")
def llama(tmp_path_factory: pytest.TempPathFactory) -> HuggingFaceChat:
    return open_model(str(random_llama(tmp_path_factory.mktemp("llama"), word_tokenizer())))


@pytest.fixture(scope="module")
def llava(tmp_path_factory: pytest.TempPathFactory) -> Backend:
    return open_backend(f"huggingface:{random_llava(tmp_path_factory.mktemp('llava'))}", "robot", EMBEDDINGS)


def test_a_folder_without_a_model_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be loaded"):
        open_backend(f"huggingface:{tmp_path}", "human", EMBEDDINGS)


def test_a_folder_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="there is no such folder"):
        open_backend(f"huggingface:{tmp_path / 'nowhere'}", "human", EMBEDDINGS)


def test_a_model_without_a_chat_template_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no chat template"):
        open_backend(f"huggingface:{random_llama(tmp_path, byte_tokenizer(None))}", "human", EMBEDDINGS)


def test_a_model_in_pickle_files_is_refused(tmp_path: Path) -> None:
    folder = random_llama(tmp_path)
    (folder / "model.safetensors").rename(folder / "pytorch_model.bin")
    with pytest.raises(ConfigError, match="cannot be loaded"):
        open_backend(f"huggingface:{folder}", "human", EMBEDDINGS)


@pytest.mark.skipif(torch.cuda.is_available(), reason="there is a GPU")
def test_a_gpu_that_is_not_there_is_refused(llama: HuggingFaceChat) -> None:
    with pytest.raises(ConfigError, match="cannot go to cuda: there is no GPU"):
        open_backend(f"huggingface:{llama.path}", "human", EMBEDDINGS, settings=CallSettings(device="cuda"))


def test_a_model_is_loaded_once(llama: HuggingFaceChat) -> None:
    human, robot = (open_backend(f"huggingface:{llama.path}", role, EMBEDDINGS) for role in ("human", "robot"))
    assert human.model is robot.model
    assert not human.sees


def test_the_same_seed_says_the_same_and_the_global_random_state_is_left_alone(llama: HuggingFaceChat) -> None:
    before = torch.random.get_rng_state()
    said = [llama.invoke("hello", temperature=0.7, seed=seed, max_tokens=FEW).text for seed in (1, 1, 2)]
    assert said[0] == said[1] != said[2]
    assert torch.equal(before, torch.random.get_rng_state())
    cold = [llama.invoke("hello", temperature=0.0, seed=seed, max_tokens=FEW).text for seed in (1, 2)]
    assert cold[0] == cold[1]


def test_a_reply_tells_its_tokens_and_that_it_was_cut(llama: HuggingFaceChat) -> None:
    reply = llama.invoke("hello", temperature=0.7, seed=1, max_tokens=FEW)
    assert isinstance(reply, AIMessage)
    assert reply.usage_metadata is not None
    assert reply.usage_metadata["input_tokens"] > 5
    assert reply.usage_metadata["output_tokens"] == FEW
    assert reply.response_metadata["finish_reason"] == "length"


def test_a_prompt_that_does_not_fit_is_a_call_error(llama: HuggingFaceChat) -> None:
    with pytest.raises(ModelCallError, match="does not fit into its 16384"):
        llama.invoke("x " * 20_000, max_tokens=FEW)


def test_random_weights_without_constraint_end_in_an_output_error_and_a_full_record(llama: HuggingFaceChat) -> None:
    free = CallSettings(structure="text", max_tokens=64)
    backend = open_backend(f"huggingface:{llama.path}", "judge", EMBEDDINGS, settings=free)
    door = Door(prompts=PromptLibrary(), backends={"judge": backend}, seed=1, settings=free)
    with pytest.raises(ModelOutputError):
        door("judge/tasks", VerdictsReply, at=AT, variables=examples("judge/tasks")[0])
    (call,) = door.take_calls()
    assert (call.attempts, len(call.faults)) == (3, 3)
    assert 0 < call.tokens_out <= 3 * 64


@pytest.mark.parametrize("name", ["judge/tasks", "robot/tasks_type1", "robot/traits"])
def test_random_weights_answer_every_prompt_with_a_valid_reply(llama: HuggingFaceChat, name: str) -> None:
    brief = CallSettings(attempts=1, max_tokens=64)
    role = ASKS[name].role
    backend = open_backend(f"huggingface:{llama.path}", role, EMBEDDINGS, settings=brief)
    door = Door(prompts=PromptLibrary(), backends={role: backend}, seed=1, settings=brief)
    reply = door(name, REPLIES[ASKS[name].reply], at=AT, variables=examples(name)[0])
    assert reply.model_dump()


def test_a_constrained_reply_names_only_what_is_there_and_as_much_as_is_asked_for(llama: HuggingFaceChat) -> None:
    variables = examples("robot/tasks_type1")[0]
    wanted = Wanted(PickPlaceReply, variables)
    for seed in range(2):
        text = llama.invoke("Go!", temperature=1.0, seed=seed, schema=wanted.enforced, max_tokens=64).text
        assert "_id" not in text
        reply, leniencies, _ = read_reply(text, wanted)
        assert leniencies == {}
        assert len(reply.tasks) == variables["n_tasks"]
        for task in reply.tasks:
            assert task.act.object in variables["movable"]
            assert task.act.receptacle in variables["fixed"]
            assert task.act.receptacle_id == variables["fixed"][task.act.receptacle][0]


def test_prompts_that_arrive_together_are_answered_together_and_each_as_it_is_alone(llama: HuggingFaceChat) -> None:
    sizes: list[int] = []
    together = HuggingFaceChat(llama._loaded, batch=4)
    inner = together._answer_all

    def counted(questions: list[object]) -> object:
        sizes.append(len(questions))
        return inner(questions)  # type: ignore[arg-type]

    together._answer = Batcher(counted, size=4)  # type: ignore[arg-type]
    schema = enforced_schema(VerdictsReply, {"offers": [1, 2]})
    texts = [f"question {n} " * (1 + n % 3) for n in range(5)]

    def ask(model: HuggingFaceChat, n: int) -> str:
        return model.invoke(texts[n], temperature=1.0, seed=n, schema=schema, max_tokens=64).text

    with ThreadPoolExecutor(5) as pool:
        answers = list(pool.map(lambda n: ask(together, n), range(5)))
    assert answers == [ask(llama, n) for n in range(5)]
    assert sum(sizes) == 5
    assert max(sizes) > 1


def test_one_prompt_that_does_not_fit_does_not_spoil_the_others(llama: HuggingFaceChat) -> None:
    batched = HuggingFaceChat(llama._loaded, batch=3)
    with ThreadPoolExecutor(3) as pool:
        done = [pool.submit(batched.invoke, text, max_tokens=8) for text in ("hello", "x " * 20_000, "bye")]
    assert [future.exception() is None for future in done] == [True, False, True]


def test_draws_follow_the_softmax_at_the_temperature() -> None:
    scores = torch.tensor([2.0, 1.0, 0.0, -torch.inf])
    row = HeldReply(temperature=0.5, seed=3, limit=5000, ends=[9])
    drawn = [row.draw(scores) for _ in range(4000)]
    expected = torch.softmax(scores.double() / 0.5, dim=0).numpy()
    assert np.abs(np.bincount(drawn, minlength=4) / 4000 - expected).max() < 0.03


def test_a_model_with_eyes_is_shown_the_pictures(llava: Backend) -> None:
    assert llava.sees

    def look(colour: str) -> AIMessage:
        file = io.BytesIO()
        Image.new("RGB", (32, 24), colour).save(file, "WEBP")
        image = {"type": "image", "base64": base64.b64encode(file.getvalue()).decode(), "mime_type": "image/webp"}
        asked = [HumanMessage([image, {"type": "text", "text": "What is it?"}])]
        return llava.model.invoke(asked, temperature=0.7, seed=1, max_tokens=16)

    assert look("white").text == look("white").text
    assert look("white").text != look("black").text


WORK = st.lists(st.tuples(st.integers(0, 2), st.booleans()), min_size=1, max_size=12)


@settings(max_examples=40, deadline=None)
@given(WORK, st.integers(1, 4))
def test_a_batcher_gives_each_caller_its_own_result_or_error(jobs: list[tuple[int, bool]], size: int) -> None:
    def work(taken: list[tuple[int, tuple[int, bool]]]) -> list[int | Exception]:
        assert len(taken) <= size
        assert len({job[0] for _, job in taken}) == 1, "one kind at a time"
        return [n if good else ValueError(str(n)) for n, (_, good) in taken]

    batcher: Batcher[tuple[int, tuple[int, bool]], int] = Batcher(work, size=size, kind=lambda job: job[1][0])  # type: ignore[arg-type]
    with ThreadPoolExecutor(len(jobs)) as pool:
        futures = [pool.submit(batcher, entry) for entry in enumerate(jobs)]
    for n, (future, (_, good)) in enumerate(zip(futures, jobs, strict=True)):
        assert future.result() == n if good else str(future.exception()) == str(n)
