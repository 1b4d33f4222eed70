from __future__ import annotations

from pathlib import Path

import pytest
import torch

from benchmarks.tiny_mistral import make_recipe
from coopera.core.errors import ConfigError, CooperaError
from coopera.models.finetuning import WEIGHTS, FinetunedChat
from tests.tiny import byte_tokenizer, random_llama

QUESTIONS = ("nine nine nine", "TEN TEN TEN")
TEA, BOOK = '"tea"', '"book"'
LESSONS = [(QUESTIONS[0], TEA), (QUESTIONS[1], BOOK)] * 2
REVERSED = [(QUESTIONS[0], BOOK), (QUESTIONS[1], TEA)] * 2
MODULES = ["q_proj", "k_proj", "v_proj", "o_proj", "gate_proj", "up_proj", "down_proj"]
SCHEMA = {"enum": ["tea", "book"]}
CLEARLY = 2.0  # in logits; 3.9 is the least that 64 seeds of the weights reached, and rounding moves it by far less


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return random_llama(tmp_path_factory.mktemp("tiny-llama"), initializer_range=0.25)  # larger weights may get stuck


@pytest.fixture(scope="module")
def recipe(base: Path) -> Path:
    changes = {
        "learning_rate": 0.005,
        "accumulation": 4,
        "epochs": 100,
        "later_epochs": 5,
        "dropout": 0.0,
        "modules": MODULES,
    }
    return make_recipe(base / "recipe.yaml", Path("unused"), **changes)


@pytest.fixture(scope="module")
def taught(base: Path, recipe: Path) -> FinetunedChat:
    chat = FinetunedChat(str(base), recipe)
    chat.train(LESSONS, seed=1)
    return chat


def lead(chat: FinetunedChat, question: str, reply: str, other: str) -> float:
    """By how much a reply is liked better than another, in logits of the first token in which they differ."""
    (asked, said), (_, unsaid) = chat._row(question, reply), chat._row(question, other)
    at = next(n for n, (one, two) in enumerate(zip(said, unsaid, strict=False)) if one != two)
    base = chat._base()
    assert chat._learned is not None
    base.put_in("intention", chat._learned)
    base.model.eval()
    with torch.no_grad():
        logits = base.model(input_ids=torch.tensor([asked + said[:at]])).logits[0, -1]
    return float(logits[said[at]] - logits[unsaid[at]])


def test_it_answers_as_it_was_taught_and_the_other_way_round_where_it_was_taught_so(
    base: Path, recipe: Path, taught: FinetunedChat
) -> None:
    contrary = FinetunedChat(str(base), recipe)
    assert not contrary.trained
    contrary.train(REVERSED, seed=1)
    assert contrary.trained
    for chat, lessons, others in ((taught, LESSONS, REVERSED), (contrary, REVERSED, LESSONS)):
        for (question, reply), (_, other) in zip(lessons[:2], others[:2], strict=True):
            assert lead(chat, question, reply, other) > CLEARLY
            assert chat.reply(question, SCHEMA) == reply


def test_what_is_taught_becomes_likelier(base: Path, recipe: Path) -> None:
    once = make_recipe(recipe.with_name("once.yaml"), base, accumulation=4, epochs=1, dropout=0.0)
    before = FinetunedChat(str(base), once).train(LESSONS, seed=1)["loss"]  # its one step comes after the last lesson
    after = FinetunedChat(str(base), recipe).train(LESSONS, seed=1)["loss"]
    assert after < before / 5


def test_what_was_learned_goes_on_in_another_object_and_to_the_same_end(
    base: Path, recipe: Path, taught: FinetunedChat, tmp_path: Path
) -> None:
    taught.save(tmp_path)
    again = FinetunedChat(str(base), recipe)
    again.load(tmp_path)
    assert [again.reply(question, SCHEMA) for question in QUESTIONS] == [TEA, BOOK]
    anew = FinetunedChat(str(base), recipe)
    anew.train(LESSONS, seed=1)
    assert anew.train(LESSONS[:1], seed=2) == again.train(LESSONS[:1], seed=2)


def test_an_adapter_that_is_damaged_or_of_another_recipe_is_refused(
    base: Path, recipe: Path, taught: FinetunedChat, tmp_path: Path
) -> None:
    taught.save(tmp_path)
    with pytest.raises(CooperaError, match="field 'recipe' is"):
        FinetunedChat(str(base), make_recipe(tmp_path / "other.yaml", base, rank=4)).load(tmp_path)
    (tmp_path / WEIGHTS).write_bytes(b"nothing")
    with pytest.raises(CooperaError, match="the adapter is damaged"):
        FinetunedChat(str(base), recipe).load(tmp_path)


def test_a_model_without_a_chat_template_is_refused(tmp_path: Path, recipe: Path) -> None:
    bare = random_llama(tmp_path, byte_tokenizer(None))
    with pytest.raises(ConfigError, match="it has no chat template"):
        FinetunedChat(str(bare), recipe)
