from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
import torch
from peft import PeftModel
from safetensors.torch import load_file, save_file
from transformers import AutoModelForCausalLM

from benchmarks.tiny_mistral import make_model, make_recipe
from coopera.core.errors import ConfigError, CooperaError, LearningError
from coopera.core.hour import Example
from coopera.core.people import PersonId
from coopera.models.classifiers import Inputs, make_classifier
from coopera.models.classifiers.causal import open_base
from coopera.models.classifiers.instruction import SHIPPED, read_recipe
from coopera.models.classifiers.lora_instruct import LoraInstructClassifier
from coopera.prompts import PromptLibrary
from tests.fakes import LetterEmbeddings
from tests.models.classifiers.few import BOTH, never_constant, undecided_without_a_difference
from tests.tiny import SEED

INSTRUCT = PromptLibrary().instruct


def ask(candidate: str, hour: int, *, day: int = 0, label: bool | None = None) -> Example:
    return Example(person=PersonId("ann"), day=day, hour=hour, candidate=candidate, label=label, rank=0)


def feedback(days: int = 2) -> list[Example]:
    things = ("drink tea", "read books", "lift weights")
    return [
        ask(thing, hour, day=day, label=thing == "drink tea")
        for day in range(days)
        for hour in (9, 10, 11, 12)
        for thing in things
    ]


QUESTIONS = [ask("drink tea", 9), ask("lift weights", 9), ask("read books", 14), ask("drink tea", 15)]


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_model(tmp_path_factory.mktemp("tiny-mistral") / "base", seed=SEED)


@pytest.fixture(scope="module")
def recipe(base: Path) -> Path:
    return make_recipe(base.parent / "recipe.yaml", base, learning_rate=0.005, batch=4, accumulation=1, epochs=12)


def classifier(recipe: Path, kind: str = "intention") -> LoraInstructClassifier:
    return LoraInstructClassifier(kind=kind, inputs=Inputs(), instruct=INSTRUCT, recipe=read_recipe(recipe))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def trained(recipe: Path) -> LoraInstructClassifier:
    judge = classifier(recipe)
    judge.train(feedback(), seed=1)
    return judge


def test_the_shipped_recipe_is_the_papers() -> None:
    recipe = read_recipe()
    assert recipe.base == "mistralai/Mistral-7B-Instruct-v0.2"
    assert (recipe.rank, recipe.alpha, recipe.dropout, recipe.modules) == (
        *(8, 16, 0.2),
        ["q_proj", "k_proj", "v_proj", "o_proj"],
    )
    assert (recipe.epochs, recipe.learning_rate, recipe.weight_decay, recipe.batch, recipe.accumulation) == (
        *(5, 1e-5, 0.01),
        *(1, 4),
    )


def test_the_instruction_has_the_papers_parts_in_their_order() -> None:
    text = INSTRUCT(ask("drink tea", 9).model_copy(update={"intention": "Rest", "tasks": ["boil water"]}))
    parts = ["### Instruction:", "drink tea, in order to Rest", "### Input:", "Human Profile: unknown", "Big Five"]
    parts += ["Previous Relevant Intentions: none", "Previous Relevant Tasks: boil water", "Current Time: 9 am"]
    places = [text.index(part) for part in [*parts, "### Response:"]]
    assert places == sorted(places)
    assert text.endswith("### Response:\n"), "the next token is the answer"


def test_the_instruction_is_a_prompt_that_can_be_reworded(tmp_path: Path) -> None:
    file = tmp_path / "classifier" / "instruction.md"
    file.parent.mkdir()
    shipped = PromptLibrary().show("classifier/instruction")
    file.write_text(shipped.replace("determine if it is likely or unlikely", "say whether it is likely"))
    text = PromptLibrary(tmp_path).instruct(QUESTIONS[0])
    assert "say whether it is likely that this human will: drink tea" in text
    with pytest.raises(ConfigError, match="needs an instruction"):
        make_classifier("lora-instruct", kind="task", embeddings=LetterEmbeddings())


def test_untrained_it_is_undecided_and_trained_it_knows_what_is_liked(
    recipe: Path, trained: LoraInstructClassifier
) -> None:
    assert classifier(recipe).probabilities(QUESTIONS) == [0.5] * 4
    assert [p >= 0.5 for p in trained.probabilities(QUESTIONS)] == [True, False, False, True]


def test_the_same_seed_learns_the_same_whatever_the_base_was_used_for_before(
    recipe: Path, trained: LoraInstructClassifier
) -> None:
    first = trained.probabilities(QUESTIONS)
    classifier(recipe).train([e.model_copy(update={"label": not e.label}) for e in feedback()], seed=3)
    again, other = classifier(recipe), classifier(recipe)
    again.train(feedback(), seed=1)
    other.train(feedback(), seed=2)
    assert again.probabilities(QUESTIONS) == first != other.probabilities(QUESTIONS)


def test_the_same_seed_learns_the_same_on_a_base_loaded_anew_as_in_another_process(
    recipe: Path, trained: LoraInstructClassifier
) -> None:
    first = trained.probabilities(QUESTIONS)
    open_base.forget()
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(12345)  # peft draws first weights from the global generator, and they must not matter
        again = classifier(recipe)
    again.train(feedback(), seed=1)
    assert again.probabilities(QUESTIONS) == first


def test_saved_and_loaded_it_answers_identically_and_goes_on_identically(
    recipe: Path, tmp_path: Path, trained: LoraInstructClassifier
) -> None:
    trained.save(tmp_path)
    again = classifier(recipe)
    again.load(tmp_path)
    assert again.probabilities(QUESTIONS) == trained.probabilities(QUESTIONS)
    other = classifier(recipe)
    other.load(tmp_path)
    measured = [judge.train(feedback(3), seed=5) for judge in (again, other)]
    assert measured[0] == measured[1]
    assert again.probabilities(QUESTIONS) == other.probabilities(QUESTIONS) != trained.probabilities(QUESTIONS)
    assert measured[0]["passes"] == 2 * 27  # the later epochs, over three hours in four


def test_the_adapters_of_intentions_and_tasks_share_one_base_and_do_not_touch_each_other(
    recipe: Path, trained: LoraInstructClassifier
) -> None:
    before = trained.probabilities(QUESTIONS)
    tasks = classifier(recipe, "task")
    tasks.train([e.model_copy(update={"label": not e.label}) for e in feedback()], seed=2)
    assert [p >= 0.5 for p in tasks.probabilities(QUESTIONS)] != [p >= 0.5 for p in before]
    assert trained.probabilities(QUESTIONS) == before
    assert tasks._base() is trained._base()


def test_an_answer_does_not_depend_on_what_it_is_asked_together_with(trained: LoraInstructClassifier) -> None:
    together = trained.probabilities(QUESTIONS)
    alone = [trained.probabilities([question])[0] for question in QUESTIONS]
    assert together == pytest.approx(alone, abs=1e-4)


@pytest.mark.filterwarnings("ignore::FutureWarning")  # peft 0.21 asks transformers 5 by an older name
def test_the_score_is_the_logit_of_yes_less_that_of_no_of_the_plain_model_with_the_saved_adapter(
    base: Path, tmp_path: Path, trained: LoraInstructClassifier
) -> None:
    trained.save(tmp_path)
    plain = PeftModel.from_pretrained(AutoModelForCausalLM.from_pretrained(base), tmp_path).eval()
    ours = open_base(trained._recipe.model_dump_json())
    text = INSTRUCT(QUESTIONS[0])
    with torch.no_grad():
        logits = plain(torch.tensor([ours.tokenizer(text)["input_ids"]])).logits[0, -1]
    yes, no = (ours.tokenizer(word)["input_ids"][0] for word in ("Yes", "No"))
    score = float(logits[yes] - logits[no])
    scaled = trained._scale.probabilities(torch.tensor([score]).double().numpy())
    assert trained.probabilities(QUESTIONS[:1]) == pytest.approx(scaled, abs=1e-4)


def test_an_adapter_of_another_base_is_refused(tmp_path: Path, recipe: Path, trained: LoraInstructClassifier) -> None:
    trained.save(tmp_path / "saved")
    other = make_model(tmp_path / "base", seed=SEED + 9)
    changed = make_recipe(tmp_path / "other.yaml", other, **read_recipe(recipe).model_dump(exclude={"base", "devices"}))
    with pytest.raises(CooperaError, match=r"the adapter belongs to the base 'base \w+', and this one is 'base \w+'"):
        classifier(changed).load(tmp_path / "saved")
    open_base.forget()


def test_a_damaged_adapter_is_refused(tmp_path: Path, recipe: Path, trained: LoraInstructClassifier) -> None:
    trained.save(tmp_path)
    weights = tmp_path / "adapter_model.safetensors"
    whole = weights.read_bytes()
    for damaged in (whole[:-10], b""):
        weights.write_bytes(damaged)
        with pytest.raises(CooperaError, match="is damaged"):
            classifier(recipe).load(tmp_path)
    save_file({"other": torch.zeros(1)}, weights)
    with pytest.raises(CooperaError, match="its tensors are not those of this base"):
        classifier(recipe).load(tmp_path)


def test_a_loss_that_is_no_number_is_said_and_what_was_known_is_kept(
    tmp_path: Path, base: Path, recipe: Path, trained: LoraInstructClassifier
) -> None:
    broken = shutil.copytree(base, tmp_path / "broken")
    tensors = load_file(broken / "model.safetensors")
    tensors["model.norm.weight"] *= float("nan")
    save_file(tensors, broken / "model.safetensors", {"format": "pt"})
    judge = classifier(make_recipe(tmp_path / "nan.yaml", broken))
    with pytest.raises(
        LearningError, match=r"intention classifier \(lora-instruct\) could not learn: its loss became nan"
    ):
        judge.train(feedback(), seed=1)
    assert judge.probabilities(QUESTIONS) == [0.5] * 4
    open_base.forget()


@pytest.mark.parametrize("label", [True, False, None])
def test_with_one_kind_of_answer_or_none_nothing_is_learned(recipe: Path, label: bool | None) -> None:
    judge = classifier(recipe)
    measured = judge.train([e.model_copy(update={"label": label}) for e in feedback(1)], seed=1)
    assert measured["positives"] == (12 if label else 0)
    assert judge.probabilities(QUESTIONS) == [0.5] * 4


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"rank": 0}, r"rank: input should be greater than or equal to 1, not 0"),
        ({"rnk": 8}, "rnk: extra inputs are not permitted"),
        ({"devices": "tpu"}, "devices: string should match pattern"),
    ],
)
def test_a_wrong_recipe_is_refused_naming_file_and_field(tmp_path: Path, change: dict[str, object], why: str) -> None:
    path = make_recipe(tmp_path / "mine.yaml", tmp_path, **change)
    with pytest.raises(ConfigError, match=f"mine.yaml: {why}"):
        make_classifier("lora-instruct", kind="task", embeddings=LetterEmbeddings(), recipe=path, instruct=INSTRUCT)


def test_a_recipe_that_is_no_mapping_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("rank 8")
    with pytest.raises(ConfigError, match="must be a mapping of fields, not 'rank 8'"):
        read_recipe(tmp_path / "mine.yaml")


def test_a_base_that_is_not_there_is_named_before_anything_is_done(tmp_path: Path) -> None:
    path = make_recipe(tmp_path / "mine.yaml", tmp_path / "nowhere")
    with pytest.raises(ConfigError, match=r"base: .*nowhere cannot be loaded"):
        make_classifier("lora-instruct", kind="task", embeddings=LetterEmbeddings(), recipe=path, instruct=INSTRUCT)


def test_the_manifest_says_what_it_is(tmp_path: Path, trained: LoraInstructClassifier) -> None:
    trained.save(tmp_path)
    manifest = json.loads((tmp_path / "classifier.json").read_text())
    assert manifest["classifier"] == "lora-instruct"
    assert manifest["recipe"]["rank"] == read_recipe(SHIPPED).rank
    assert json.loads((tmp_path / "adapter_config.json").read_text())["target_modules"] == [
        "k_proj",
        "o_proj",
        "q_proj",
        "v_proj",
    ]


@pytest.mark.parametrize("case", BOTH)
def test_after_a_few_answers_it_says_yes_to_some_and_no_to_others(recipe: Path, case: str) -> None:
    never_constant(lambda: classifier(recipe), case)


def test_answers_of_one_kind_or_that_contradict_each_other_decide_nothing(recipe: Path) -> None:
    undecided_without_a_difference(lambda: classifier(recipe))
