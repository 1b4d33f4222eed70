"""The offline model as LangChain sees it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from langchain_core.messages import AIMessage, HumanMessage

from coopera.core.asks import ASKS
from coopera.core.errors import ModelCallError
from coopera.core.replies import REPLIES
from coopera.models.offline.chat import OfflineChatModel
from coopera.models.offline.household.knowledge import shipped
from tests.models.offline.questions import WORDS, ask, ask_model, live, model, person, sample

ROOT = Path(__file__).parents[3]


def _message(**asked: object) -> HumanMessage:
    return HumanMessage("text", additional_kwargs={"coopera": asked})


@pytest.mark.parametrize("prompt", sorted(ASKS))
def test_every_prompt_is_answered_in_its_reply_type(prompt: str) -> None:
    assert isinstance(ask(prompt, **sample(prompt)), REPLIES[ASKS[prompt].reply])


@pytest.mark.parametrize("prompt", sorted(ASKS))
def test_a_prompt_of_another_role_is_refused(prompt: str) -> None:
    for role in {"human", "robot", "judge"} - {ASKS[prompt].role}:
        with pytest.raises(ModelCallError, match=f"{prompt}.*role {role}"):
            model(role).invoke([_message(prompt=prompt, variables={}, seed=1, temperature=0.7)])


def test_the_message_says_which_model_it_is_of_and_counts_words() -> None:
    asked = {"prompt": "judge/tasks", "variables": sample("judge/tasks"), "seed": 1, "temperature": 0.25}
    reply = model("judge").invoke([HumanMessage("one two three", additional_kwargs={"coopera": asked})])
    assert isinstance(reply, AIMessage)
    assert reply.response_metadata["model_name"] == "offline"
    assert reply.usage_metadata is not None
    assert reply.usage_metadata["input_tokens"] == 3
    assert reply.usage_metadata["output_tokens"] > 3


@pytest.mark.parametrize(
    ("message", "said"),
    [
        (HumanMessage("tell me a joke"), "carries none"),
        (_message(prompt="judge/tasks", variables={}, temperature=0.7), "lacks its seed"),
        (_message(prompt="judge/poems", variables={}, seed=1, temperature=0.7), "not known to it"),
        (_message(prompt="judge/tasks", variables={"time": "9 am"}, seed=1, temperature=0.7), "'intention' is missing"),
    ],
)
def test_what_is_no_proper_question_gets_one_clear_sentence(message: HumanMessage, said: str) -> None:
    with pytest.raises(ModelCallError, match=said):
        model("judge").invoke([message])


def test_cache_keys_tell_roles_and_rules_apart() -> None:
    assert model("human")._identifying_params != model("robot")._identifying_params
    assert {"role", "rules"} <= set(model("human")._identifying_params)
    own = OfflineChatModel(role="robot", embeddings=WORDS)
    assert own._identifying_params != model("robot")._identifying_params


def _answers() -> str:
    told = {prompt: ask(prompt, seed=5, **sample(prompt)).model_dump_json() for prompt in sorted(ASKS)}
    return json.dumps([told, live(person(), seed=3)])


def test_another_process_with_another_hash_seed_gives_the_same_bytes() -> None:
    code = "import sys; from tests.models.offline.test_chat import _answers; sys.stdout.write(_answers())"
    env = {**os.environ, "PYTHONHASHSEED": "12345"}
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, env=env, capture_output=True, check=True)
    assert done.stdout.decode() == _answers()


def test_an_answer_does_not_depend_on_what_was_asked_before() -> None:
    fresh = OfflineChatModel(role="robot", embeddings=WORDS, household=shipped())
    used = model("robot")
    for _ in range(3):
        ask("robot/traits", **sample("robot/traits"))
    question = sample("robot/tasks_type2")
    assert ask_model(fresh, "robot/tasks_type2", seed=9, **question) == ask_model(
        used, "robot/tasks_type2", seed=9, **question
    )


def test_importing_the_package_loads_nothing_heavy() -> None:
    heavy = {"torch", "numpy", "langchain_core"}
    code = f"import coopera.models, coopera.models.offline, sys; assert not {heavy!r} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)
