"""From a spec to a chat model: what there is, and what is refused at start."""

from __future__ import annotations

import sys
import types
from pathlib import Path
from typing import Any

import pytest
from langchain_core.language_models import BaseChatModel, FakeListChatModel

from coopera.core.asks import ASKS
from coopera.core.errors import ConfigError
from coopera.core.randomness import Address
from coopera.core.replies import REPLIES, VerdictsReply
from coopera.models.backends import open_backend, open_backends
from coopera.models.door import open_door
from coopera.models.offline.chat import OfflineChatModel
from coopera.models.offline.household.knowledge import load, robots, shipped
from coopera.models.settings import CallSettings
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
from tests.fakes import LetterEmbeddings

EMBEDDINGS = LetterEmbeddings()
AT = Address("nora", 0, 9, "score")
ONCE = CallSettings(attempts=1)


def test_every_role_is_offline_unless_said_otherwise() -> None:
    backends = open_backends({}, EMBEDDINGS)
    assert {role: backend.name for role, backend in backends.items()} == dict.fromkeys(
        ("human", "robot", "judge"), "offline"
    )
    assert all(b.reads_variables and not b.sees for b in backends.values())


def test_the_offline_door_answers_a_shipped_prompt_and_leaves_no_cache_file(tmp_path: Path) -> None:
    cache = tmp_path / "llm_cache.sqlite"
    door = open_door(prompts=PromptLibrary(), seed=1, embeddings=EMBEDDINGS, cache=cache)
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
    door = open_door(prompts=PromptLibrary(), seed=1, embeddings=EMBEDDINGS, settings=ONCE)
    for variables in examples(name):
        door(name, REPLIES[ASKS[name].reply], at=AT, variables=variables)


@pytest.mark.parametrize(
    "spec", ["", "gpt-4o", "Offline", "openai:", ":model", "nobody:model", "openai: ", "offline:x"]
)
def test_an_unknown_model_is_refused_with_what_there_is(spec: str) -> None:
    with pytest.raises(ConfigError, match=r"is unknown: .*:HOUSEHOLD\.yaml, openai:MODEL .*huggingface:REPO-OR"):
        open_backend(spec, "human", EMBEDDINGS)


def test_an_offline_model_knows_the_household_of_the_file_that_it_names() -> None:
    own = Path(__file__).parents[2] / "examples" / "my_household.yaml"
    model: Any = open_backend(f"offline:{own}", "robot", EMBEDDINGS).model
    plain: Any = open_backend("offline", "human", EMBEDDINGS).model
    assert set(model.household.index) - set(plain.household.index) == {"model_railway"}


def _known(household: str, **specs: str) -> dict[str, Any]:
    given: Any = specs
    opened = open_backends(given, EMBEDDINGS, household=household)
    return {role: backend.model.household for role, backend in opened.items()}  # type: ignore[union-attr]


def test_robot_and_judge_know_a_household_file_of_their_own_unless_told_to_share_the_persons(tmp_path: Path) -> None:
    mine = tmp_path / "mine.yaml"
    mine.write_text("extends: shipped\n")
    assert _known("own") == {"human": shipped(), "robot": robots(), "judge": robots()}
    assert _known("shared") == dict.fromkeys(("human", "robot", "judge"), shipped())
    assert _known(str(mine), judge="offline:words") == dict.fromkeys(("human", "robot", "judge"), load(mine))
    assert robots() != shipped()
    default = {role: backend.model.household for role, backend in open_backends({}, EMBEDDINGS).items()}
    assert default == _known("own")
    for role, known in default.items():
        assert OfflineChatModel(role=role, embeddings=EMBEDDINGS).household == known


def test_a_file_that_a_model_names_wins_over_the_setting() -> None:
    own = Path(__file__).parents[2] / "examples" / "my_household.yaml"
    known = _known("own", robot=f"offline:{own}", human=f"offline:{own}")
    assert known == {"human": load(own), "robot": load(own), "judge": robots()}


def test_a_household_that_is_neither_a_word_nor_a_file_is_refused() -> None:
    with pytest.raises(ConfigError, match="household: ours is neither own nor shared, and there is no household file"):
        _known("ours")


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


def test_another_sample_asks_everything_with_other_seeds() -> None:
    def seed(sample: int) -> int:
        settings = CallSettings(sample=sample)
        return open_door(prompts=PromptLibrary(), seed=7, embeddings=EMBEDDINGS, settings=settings).seed

    assert seed(0) == 7
    assert len({seed(0), seed(1), seed(2)}) == 3
