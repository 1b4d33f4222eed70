from __future__ import annotations

from pathlib import Path

import pytest
import torch

from coopera.core.errors import ConfigError
from coopera.evaluation.people.finetune import FinetunedEncoder, Recipe
from coopera.evaluation.people.learners import Step
from tests.tiny import random_bert

WORDS = ["tea", "soup", "rest", "read", "run", "sing"]
FAST = Recipe(epochs=dict.fromkeys(("intentions", "tasks", "steps"), 40), learning_rate=3e-3, tokens=32)


@pytest.fixture(scope="module")
def tiny_bert(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(random_bert(tmp_path_factory.mktemp("tiny-bert"), WORDS))


def test_a_finetuned_encoder_learns_who_is_who_whatever_the_labels(tiny_bert: str) -> None:
    learner = FinetunedEncoder(tiny_bert, recipe=FAST)
    train = [["tea", "read"], ["tea", "rest"], ["soup", "read"], ["soup", "rest"]] * 3
    test = [["tea", "sing"], ["soup", "sing"]]
    answers = learner.people(train, [4, 4, 7, 7] * 3, test, kind="intentions")
    assert answers == [4, 7]
    assert learner.people(train, [7, 7, 4, 4] * 3, test, kind="intentions") == [7, 4]
    assert answers == FinetunedEncoder(tiny_bert, recipe=FAST).people(train, [4, 4, 7, 7] * 3, test, kind="intentions")


def test_a_finetuned_encoder_learns_what_comes_next_and_leaves_the_global_generator_alone(tiny_bert: str) -> None:
    torch.manual_seed(5)
    before = torch.random.get_rng_state()
    steps = [Step((first, "rest"), then) for first in ("tea", "read") for then in ("soup", "run")]
    labels = [int(step.then == "soup") for step in steps]
    assert FinetunedEncoder(tiny_bert, recipe=FAST).steps(steps * 4, labels * 4, steps) == labels
    assert torch.equal(torch.random.get_rng_state(), before)


def test_the_recipe_is_the_papers() -> None:
    assert Recipe().epochs == {"intentions": 10, "tasks": 20, "steps": 20}
    assert Recipe().learning_rate == 5e-6


def test_what_is_no_encoder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="--encoder: .* cannot be loaded"):
        FinetunedEncoder(str(tmp_path))
