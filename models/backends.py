"""From a model's name to a chat model: which backends there are, and what each of them can do.

A *spec* names a model: `offline`, `openai:MODEL` (any OpenAI-compatible server, at the base URL),
`huggingface:REPO-OR-FOLDER` (in this process), or `PROVIDER:MODEL` for the other providers of LangChain.
A spec that ends in `+images` says that the model looks at pictures, where that cannot be found out.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from langchain_core.embeddings import Embeddings
from langchain_core.exceptions import ModelError
from langchain_core.language_models import BaseChatModel

from core.errors import ConfigError
from core.protocols import Role

ROLES: tuple[Role, ...] = ("human", "robot", "judge")
TIMEOUT = 120.0  # seconds for one request
RETRIES = 3  # of a request that failed on its way, by the client, with growing pauses
_PICTURES = "+images"
_HELP = (
    "offline, openai:MODEL (with --base-url for a server of your own), huggingface:REPO-OR-FOLDER, "
    "or PROVIDER:MODEL where the langchain package of that provider is installed"
)


@dataclass(frozen=True, slots=True)
class Backend:
    """A chat model, and what the door must know of it.

    Attributes:
        name: As it stands in the trace and in the cache's keys.
        sees: Whether it looks at pictures.
        reads_variables: Whether it answers from the prompt's variables rather than from its text.
        seeded: Whether its `invoke` takes `temperature` and `seed`, or the temperature only.
        unreachable: What its client raises when the model cannot be asked.
        garbled: What its client raises when the server's answer is no chat completion.
        address: Where its server is, if it is not where the provider has it.
    """

    name: str
    model: BaseChatModel
    sees: bool = False
    reads_variables: bool = False
    seeded: bool = True
    unreachable: tuple[type[Exception], ...] = (ModelError, OSError)
    garbled: tuple[type[Exception], ...] = ()
    address: str | None = None

    def __str__(self) -> str:
        """The model as error messages call it."""
        return f"{self.name} at {self.address}" if self.address else self.name


def open_backends(
    specs: Mapping[Role, str], embeddings: Embeddings, base_url: str | None = None
) -> dict[Role, Backend]:
    """Open the model of each role; a role without a spec is played by the offline model.

    Raises:
        ConfigError: If a role or spec is unknown, or what a spec needs is not there.
    """
    if unknown := sorted(set(specs) - set(ROLES)):
        raise ConfigError(f'there is no role "{unknown[0]}" for a model: the roles are {", ".join(ROLES)}')
    return {role: open_backend(specs.get(role, "offline"), role, embeddings, base_url) for role in ROLES}


def open_backend(spec: str, role: Role, embeddings: Embeddings, base_url: str | None = None) -> Backend:
    """Open one model.

    Raises:
        ConfigError: If the spec is unknown, or what it needs is not there.
    """
    if spec == "offline":
        return _offline(role, embeddings)
    provider, colon, name = spec.removesuffix(_PICTURES).partition(":")
    if not colon or not provider or not name.strip():
        raise ConfigError(f'the model "{spec}" is unknown: it may be {_HELP}')
    known: dict[str, Callable[[str, str, str | None], Backend]] = {"openai": _openai, "huggingface": _huggingface}
    return known[provider](spec, name, base_url) if provider in known else _any_provider(spec, provider, name)


def _offline(role: Role, embeddings: Embeddings) -> Backend:
    offline = importlib.import_module("models.offline.chat")
    return Backend("offline", offline.OfflineChatModel(role=role, embeddings=embeddings), reads_variables=True)


def _openai(spec: str, name: str, base_url: str | None) -> Backend:
    package = _package("langchain_openai", spec, "langchain-openai")
    key = os.environ.get("OPENAI_API_KEY")
    if not key and not base_url:
        raise ConfigError(f"the model {spec} needs a key in the environment variable OPENAI_API_KEY, or --base-url")
    model = package.ChatOpenAI(
        model=name, base_url=base_url, api_key=key or "none", timeout=TIMEOUT, max_retries=RETRIES
    )
    errors = importlib.import_module("openai")
    return Backend(
        spec,
        model,
        sees=_sees(spec, model),
        unreachable=(ModelError, errors.OpenAIError, OSError),
        garbled=(ValueError, LookupError, TypeError, AttributeError),
        address=base_url,
    )


def _huggingface(spec: str, name: str, base_url: str | None) -> Backend:
    model = importlib.import_module("models.huggingface").open_model(name)
    return Backend(spec, model, sees=model.sees)


def _any_provider(spec: str, provider: str, name: str) -> Backend:
    chat_models = _package("langchain.chat_models", spec, "langchain", unless_known=True)
    try:
        model: Any = chat_models.init_chat_model(name, model_provider=provider, timeout=TIMEOUT, max_retries=RETRIES)
    except ImportError as err:
        raise ConfigError(f"the model {spec} needs a package that is not installed: {one_line(err)}") from err
    except (ValueError, TypeError) as err:
        raise ConfigError(f'the model "{spec}" cannot be opened: {one_line(err)}; a model may be {_HELP}') from err
    return Backend(
        spec,
        model,
        sees=_sees(spec, model),
        seeded=False,
        unreachable=(ModelError, OSError, RuntimeError),
        garbled=(ValueError, LookupError, TypeError, AttributeError),
    )


def _package(module: str, spec: str, package: str, *, unless_known: bool = False) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError as err:
        if unless_known:
            raise ConfigError(f'the model "{spec}" is unknown: it may be {_HELP}') from err
        raise ConfigError(f"the model {spec} needs the package {package}: pip install {package}") from err


def _sees(spec: str, model: BaseChatModel) -> bool:
    profile: Mapping[str, Any] = model.profile or {}
    return spec.endswith(_PICTURES) or bool(profile.get("image_inputs"))


def one_line(err: BaseException) -> str:
    """An error's text on one line of bounded length, without any key that the environment holds."""
    text = " ".join(str(err).split()) or type(err).__name__
    for name, value in os.environ.items():
        if name.endswith("_API_KEY") and len(value) > 3:
            text = text.replace(value, f"<{name}>")
    return text[:500]
