from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.tiny_mistral import make_recipe
from coopera.core.errors import ConfigError, CooperaError
from coopera.models.finetuning import WEIGHTS, FinetunedChat
from tests.tiny import byte_tokenizer, random_llama

LESSONS = [("At nine?", '{"thing": "tea"}'), ("At ten?", '{"thing": "book"}')] * 2
MODULES = ["q_proj", "k_proj", "v_proj", "o_proj", "gate_proj", "up_proj", "down_proj"]
SCHEMA = {
    "type": "object",
    "properties": {"thing": {"type": "string", "maxLength": 8}},
    "required": ["thing"],
    "additionalProperties": False,
}


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return random_llama(tmp_path_factory.mktemp("tiny-llama"))


@pytest.fixture(scope="module")
def recipe(base: Path) -> Path:
    changes = {
        "learning_rate": 0.03,
        "accumulation": 4,
        "epochs": 80,
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


def test_it_answers_as_it_was_taught(base: Path, recipe: Path, taught: FinetunedChat) -> None:
    assert [taught.reply(question, SCHEMA) for question, _ in LESSONS[:2]] == [reply for _, reply in LESSONS[:2]]
    untaught = FinetunedChat(str(base), recipe)
    assert not untaught.trained
    assert untaught.reply("At nine?", SCHEMA) != LESSONS[0][1]


def test_what_was_learned_goes_on_in_another_object_and_to_the_same_end(
    base: Path, recipe: Path, taught: FinetunedChat, tmp_path: Path
) -> None:
    taught.save(tmp_path)
    again = FinetunedChat(str(base), recipe)
    again.load(tmp_path)
    assert again.reply("At ten?", SCHEMA) == LESSONS[1][1]
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
