"""A chat model that a script has made itself plays a role: with tools, without them, with its own count of tokens."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from langchain_core.callbacks import CallbackManagerForLLMRun
from langchain_core.language_models import BaseChatModel
from langchain_core.messages import AIMessage, BaseMessage
from langchain_core.outputs import ChatGeneration, ChatResult
from langchain_core.runnables import Runnable, RunnableLambda
from pydantic import PrivateAttr

from coopera import Config, RunDir, resume_study, run_studies, run_study
from coopera.config.schema import LARGE, load_config
from coopera.core.errors import BudgetError, ConfigError, ModelCallError
from coopera.core.randomness import Address
from coopera.core.replies import VerdictsReply
from coopera.models.backends import open_backends
from coopera.models.door import Door, open_door
from coopera.models.given import GivenModel
from coopera.models.offline.chat import OfflineChatModel
from coopera.models.settings import Budget, CallSettings
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
from tests.fakes import LetterEmbeddings
from tests.server import made_up

EMBEDDINGS = LetterEmbeddings()
AT = Address("nora", 0, 9, "score")
OFFERS = len(examples("judge/tasks")[0]["offers"])
YES = json.dumps({"verdicts": [{"yes": True, "reason": "it helps"}] * OFFERS})
USAGE = {"input_tokens": 100, "output_tokens": 7, "total_tokens": 107}


class Plain(BaseChatModel):
    """A chat model without tools that says yes to everything."""

    model: str = "plain 1"
    _asked: list[tuple[list[BaseMessage], dict[str, Any]]] = PrivateAttr(default_factory=list)

    @property
    def _llm_type(self) -> str:
        return "plain"

    @property
    def asked(self) -> list[tuple[list[BaseMessage], dict[str, Any]]]:
        return self._asked

    def _generate(
        self,
        messages: list[BaseMessage],
        stop: list[str] | None = None,
        run_manager: CallbackManagerForLLMRun | None = None,
        **kwargs: Any,
    ) -> ChatResult:
        self._asked.append((messages, kwargs))
        return ChatResult(generations=[ChatGeneration(message=self.answer(messages, kwargs))])

    def answer(self, messages: list[BaseMessage], options: dict[str, Any]) -> AIMessage:
        return AIMessage(content=f"Certainly!\n{YES}", usage_metadata=USAGE)


class WithTools(Plain):
    """One that calls the tool it is given, with arguments that fit and depend on what it was asked."""

    model: str = "with tools"
    temperature: float = 1.0

    def bind_tools(
        self, tools: Sequence[dict[str, Any] | type | Callable[..., Any] | Any], **kwargs: Any
    ) -> Runnable[Any, AIMessage]:
        return self.bind(tools=list(tools), **kwargs)

    def answer(self, messages: list[BaseMessage], options: dict[str, Any]) -> AIMessage:
        made = made_up(options["tools"][0]["function"]["parameters"], messages[0].text)
        call = {"name": options["tool_choice"], "args": made, "id": "1"}
        return AIMessage(content="", tool_calls=[call], usage_metadata=USAGE)


class ToolsFail(Plain):
    """One whose class says that it takes tools, which then fails."""

    failure: Any = None

    def bind_tools(
        self, tools: Sequence[dict[str, Any] | type | Callable[..., Any] | Any], **kwargs: Any
    ) -> Runnable[Any, AIMessage]:
        if self.failure is not None:
            raise self.failure
        return RunnableLambda(lambda _: AIMessage(content=""))


class Broken(Plain):
    """One whose client fails."""

    def answer(self, messages: list[BaseMessage], options: dict[str, Any]) -> AIMessage:
        raise KeyError("choices")


def door_to(model: Any, **settings: Any) -> Door:
    calls = CallSettings(**{"backoff": 0.001, **settings})
    return open_door(prompts=PromptLibrary(), seed=1, embeddings=EMBEDDINGS, model=model, settings=calls)


def judge(door: Door) -> VerdictsReply:
    return door("judge/tasks", VerdictsReply, at=AT, variables=examples("judge/tasks")[0])


@pytest.mark.parametrize("failure", [None, NotImplementedError(), TypeError("tools"), ValueError("no tools")])
def test_a_chat_model_whose_tools_fail_is_told_the_form_in_words(failure: Exception | None) -> None:
    model = ToolsFail(failure=failure)
    assert all(one.yes for one in judge(door_to(model)).verdicts)
    assert "JSON schema" in model.asked[0][0][0].text


def test_a_chat_model_without_tools_is_told_the_form_in_words() -> None:
    model = Plain()
    door = door_to(model)
    assert all(one.yes for one in judge(door).verdicts)
    ((messages, options),) = model.asked
    assert "JSON schema" in messages[0].text
    assert options == {}, "it has no temperature that could be set"
    (call,) = door.take_calls()
    assert (call.model, call.tokens_in, call.tokens_out) == ("object:Plain:plain_1", 100, 7)


def test_a_chat_model_with_tools_is_made_to_call_one() -> None:
    model = WithTools()
    door = door_to({"judge": model})
    assert len(judge(door).verdicts) == OFFERS
    ((messages, options),) = model.asked
    assert "JSON schema" not in messages[0].text
    assert options["tool_choice"] == "VerdictsReply"
    assert options["temperature"] == PromptLibrary().render("judge/tasks", examples("judge/tasks")[0]).temperature
    assert door.backends["human"].reads_variables, "roles without a model are offline"


def test_errors_of_a_chat_model_are_errors_of_the_call() -> None:
    door = door_to(Broken(), retries=1)
    with pytest.raises(ModelCallError, match="object:Broken:plain_1 cannot be asked: .*choices"):
        judge(door)
    assert len(door.take_calls()[0].faults) == 2


def test_other_weights_behind_the_same_class_have_other_places_in_the_cache() -> None:
    marks = [door_to(one).backends["judge"].weights for one in (Plain(), Plain(), WithTools(), WithTools(model="b"))]
    assert marks[0] == marks[1]
    assert len(set(marks)) == 3


def test_the_offline_model_may_be_given_as_an_object() -> None:
    door = door_to({"judge": OfflineChatModel(role="judge", embeddings=EMBEDDINGS)})
    assert len(judge(door).verdicts) == OFFERS


def test_the_spec_of_an_object_says_whether_it_looks_at_pictures() -> None:
    opened = open_backends({"robot": GivenModel(Plain(), images=True), "human": Plain()}, EMBEDDINGS)
    assert [opened[role].sees for role in ("human", "robot")] == [False, True]
    again = copy.deepcopy(GivenModel(Plain(), images=True))
    assert (again, type(again.model)) == ("object:Plain:plain_1+images", Plain)


def test_a_configuration_takes_objects_for_all_roles_or_for_one_beside_specs() -> None:
    model = Plain()
    assert set(dict(Config(models=model).models).values()) == {"object:Plain:plain_1"}  # type: ignore[arg-type]
    config = Config(models={"robot": model, "judge": "offline:words"})  # type: ignore[arg-type]
    assert isinstance(config.models.robot, GivenModel)
    assert config.models.robot.model is model
    assert (config.models.human, config.models.judge, config.frame_size) == ("offline", "offline:words", LARGE)
    assert "  robot: object:Plain:plain_1\n" in config.to_yaml()
    assert dict(Config(models="offline:words").models) == dict.fromkeys(  # type: ignore[arg-type]
        ("human", "robot", "judge"), "offline:words"
    )


def test_a_study_file_may_name_one_model_for_all_roles(tmp_path: Path) -> None:
    path = tmp_path / "study.yaml"
    path.write_text("models: offline:words\n")
    models = load_config(path, {"models": {"judge": "offline"}}).models
    assert list(dict(models).values()) == ["offline:words", "offline:words", "offline"]


def study(out: Path, data_dir: Path, **more: Any) -> Config:
    small = {"hours": 1, "days": 1, "pictures": "none"}
    return Config(out=out, data_dir=data_dir, **{**small, **more})


@pytest.fixture
def begun(tmp_path: Path, letters: Path) -> Path:
    """A run that was begun with an object as its judge, and has stopped before its first hour was over."""
    out = tmp_path / "run"
    with pytest.raises(BudgetError):
        run_study(study(out, letters, models={"judge": WithTools()}, budget=Budget(calls=1)))
    return out


def test_a_run_with_an_object_records_what_it_was_and_goes_on_only_with_it(begun: Path) -> None:
    spec = "object:WithTools:with_tools"
    assert RunDir.open(begun).config.models.judge == spec
    assert RunDir.open(begun).info["model_objects"] == {"judge": GivenModel(WithTools()).mark}
    assert GivenModel(WithTools(temperature=0.5)).mark != GivenModel(WithTools()).mark
    with pytest.raises(ConfigError, match=f"{spec} is an object of a Python script.* give it again.*resume_study"):
        resume_study(begun)
    with pytest.raises(ConfigError, match=f"played by {spec}, and can only go on with it, not with object:Plain"):
        resume_study(begun, models={"judge": Plain()})
    with pytest.raises(BudgetError):
        resume_study(begun, models={"judge": WithTools()})


@pytest.mark.slow
def test_a_run_with_an_object_is_brought_to_its_end(begun: Path) -> None:
    model = WithTools()
    summary = resume_study(begun, models={"judge": model}, budget=Budget())
    assert model.asked
    assert summary["models"]["judge"] == "object:WithTools:with_tools"
    assert (summary["hours"], summary["failed_hours"], summary["leniencies"]) == (1, 0, {})


def test_an_object_does_not_cross_into_other_processes(tmp_path: Path, data_dir: Path) -> None:
    configs = [study(tmp_path / name, data_dir, models={"judge": Plain()}) for name in "ab"]
    with pytest.raises(ConfigError, match="given as an object cannot be shared by processes"):
        run_studies(configs, processes=2)
