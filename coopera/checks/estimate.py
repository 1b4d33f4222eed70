"""What a run would ask of its models, from a few hours lived by the offline model for nothing.

The trial goes through the one door. Stand-ins take the place of the models: each is asked as the real one would be,
with the very messages and the schema that it is held to, counts them, and has the offline model answer.
"""

from __future__ import annotations

import json
import math
import tempfile
import threading
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from langchain_core.callbacks import CallbackManagerForLLMRun
from langchain_core.language_models import BaseChatModel
from langchain_core.messages import AIMessage, BaseMessage
from langchain_core.outputs import ChatGeneration, ChatResult
from pydantic import PrivateAttr

from coopera.config.prices import Prices, read_prices
from coopera.config.schema import Config, Models
from coopera.core.asks import ASKS
from coopera.core.errors import ConfigError
from coopera.core.hour import DayPlan, ModelCall
from coopera.core.protocols import Reply, Role
from coopera.core.randomness import Address
from coopera.evaluation import Measure
from coopera.graphs import build_study_graph
from coopera.models.backends import ROLES, Backend, Request, open_backend
from coopera.models.door import Door
from coopera.models.recorded import recorded_run
from coopera.models.settings import Budget, CallSettings, Structure
from coopera.models.specs import LETTERS, runs_here
from coopera.prompts import PromptLibrary
from coopera.studies.assemble import model_specs, open_embeddings
from coopera.studies.study import new_run, plan_days

_TRIED = 2, 4  # days, since a robot that was told of a day is asked more; and hours of each
_NOTE = (
    "Measured on {days} x {hours} hours of {person}'s life as the offline model lives it; {letters} characters count "
    "as a token, also of the schema that a model is held to. A talkative model writes more, at most max_tokens a "
    "reply; a bad reply is asked for again, up to {attempts} times in all. From the second day on, how many intentions "
    "the robot follows up depends on what it is told. Pictures cost tokens besides, as the model has it."
)


class Tried(NamedTuple):
    """A call of the trial, and how many of the whole run it stands for."""

    call: ModelCall
    times: float
    longer: float
    """By how much the messages of those are longer."""


def estimate(config: Config) -> dict[str, Any]:
    """Estimate calls, tokens and pictures of a whole run.

    Args:
        config: Resolved by `coopera.studies.catalogues.resolve`.

    Returns:
        `roles`, each with `model calls tokens_in tokens_out tokens_out_at_most pictures`, the totals, a `note`, and
        `money` where prices are given.
    """
    plans = plan_days(config)
    trial = _trial(config, plans)
    looks = _looks(config)
    total: dict[Role, Counter[str]] = {role: Counter() for role in ROLES}
    for call, times, longer in _weighed(_live(trial, config, looks), trial, plans):
        if not _is_asked(config, call):
            continue
        words = len(str(call.messages[0]["content"])) / LETTERS
        total[ASKS[call.prompt].role] += Counter(
            {
                "calls": times,
                "tokens_in": times * (call.tokens_in + (longer - 1) * words),
                "tokens_out": times * call.tokens_out,
                "pictures": times * _pictures(config, call) if looks else 0,
            }
        )
    roles = {role: _rounded(counts, config, role) for role, counts in total.items()}
    paid = [entry for entry in roles.values() if entry["paid"]]
    sums = {name: sum(entry[name] for entry in paid) for name in ("calls", "tokens_in", "tokens_out", "pictures")}
    note = _NOTE.format(
        days=trial.days,
        hours=trial.hours,
        person=(config.humans or [""])[0],
        letters=LETTERS,
        attempts=config.calls.attempts,
    )
    found = {"hours": sum(len(plan.hours) for plan in plans), "roles": roles, **sums, "note": note}
    return (
        found if config.budget.prices is None else {**found, "money": _bill(read_prices(config.budget.prices), roles)}
    )


def in_words(found: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    """The estimate as a table: its head, and a row for each role."""
    head = ["role", "model", "calls", "tokens in", "tokens out", "at most", "pictures"]
    names = ("calls", "tokens_in", "tokens_out", "tokens_out_at_most", "pictures")
    rows = [[role, entry["model"], *(f"{entry[name]:,}" for name in names)] for role, entry in found["roles"].items()]
    return head, rows


def _bill(prices: Prices, roles: Mapping[Role, Mapping[str, Any]]) -> dict[str, Any]:
    asked = [one for one in roles.values() if one["calls"]]
    spent = sum(prices.money(one["model"], one["tokens_in"], one["tokens_out"]) for one in asked)
    unpriced = sorted({one["model"] for one in asked if prices.of(one["model"]) is None})
    return {**prices.about(spent), "unpriced": unpriced}


def _trial(config: Config, plans: Sequence[DayPlan]) -> Config:
    """The first person's first days, as short as will do."""
    days, hours = _TRIED
    return config.model_copy(
        update={
            "setting": 1,
            "humans": (config.humans or [])[:1],
            "scenes": (config.scenes or [])[:1],
            "days": min(days, 1 + max(plan.episode_day for plan in plans)),
            "hours": min(config.hours, hours),
            "models": Models(),
            "played_by": "simulated" if config.attended else config.played_by,
            "backbone": "offline:words",
            "classifier": "kernel",
            "classifier_config": None,
            "schedule": None,
            "earlier_life": None,
            "pictures": "none",
            "budget": Budget(),
        }
    )


def _live(trial: Config, config: Config, looks: bool) -> list[tuple[int, bool, ModelCall]]:
    """The calls of the trial: the day, whether it stands for a day rather than for an hour, and the call."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        with new_run(trial.model_copy(update={"out": out}), resumable=False) as (run, services):
            specs = model_specs(config)
            standing_in = {role: _stand_in(specs[role], role, services.ask, config.calls, looks) for role in ROLES}
            prompts = PromptLibrary(config.prompts)
            ask = _Told(Door(prompts=prompts, backends=standing_in, seed=trial.seed, settings=config.calls))
            counting = replace(services, ask=ask, score=Measure(ask, services.embeddings))
            build_study_graph().invoke({"schedule": plan_days(run.config)}, context=counting)
            found = [(hour.episode_day, False, call) for hour in run.hours() for call in hour.calls]
            return found + [
                (evening.episode_day, call.node == "infer_traits", call)
                for evening in run.evenings()
                for call in evening.calls
            ]


def _weighed(calls: Sequence[tuple[int, bool, ModelCall]], trial: Config, plans: Sequence[DayPlan]) -> list[Tried]:
    """How many calls each of the trial's stands for: the first day for first days, the last for all others."""
    last = (trial.days or 1) - 1
    like = {day: [plan for plan in plans if min(plan.episode_day, last) == day] for day in range(last + 1)}
    found = []
    for day, daily, call in calls:
        hours = sum(len(plan.hours) for plan in like[day])
        longer = max(len(plan.hours) for plan in plans) / trial.hours if daily else 1.0
        found.append(Tried(call, len(like[day]) if daily else hours / trial.hours, longer))
    return found


def _is_asked(config: Config, call: ModelCall) -> bool:
    """Whether a call would be made at all: nobody asks a model what a person says, or has done in an earlier life."""
    decides = ASKS[call.prompt].role == "human" and call.node != "feedback"
    answers = ASKS[call.prompt].role == "human" and config.attended
    return not answers and not (decides and config.earlier_life is not None)


class _Told:
    """The door; what a call is filled with reaches the stand-in of this thread, which has the offline model answer."""

    now = threading.local()

    def __init__(self, door: Door) -> None:
        self._door = door
        self.sees, self.instant, self.take_calls = door.sees, door.instant, door.take_calls

    def __call__(
        self, prompt: str, reply: type[Reply], /, *, at: Address, variables: Mapping[str, Any], **_: Any
    ) -> Reply:
        self.now.call = (prompt, reply, at, variables)
        return self._door(prompt, reply, at=at, variables=variables)


class _StandIn(BaseChatModel):
    """Counts what a model is told, and answers as the offline model does."""

    _ask: Any = PrivateAttr()

    def __init__(self, ask: Any) -> None:
        super().__init__()
        self._ask = ask

    @property
    def _llm_type(self) -> str:
        return "stand-in"

    def _generate(
        self,
        messages: list[BaseMessage],
        stop: list[str] | None = None,
        run_manager: CallbackManagerForLLMRun | None = None,
        **kwargs: Any,
    ) -> ChatResult:
        prompt, reply, at, variables = _Told.now.call
        data, schema = self._ask(prompt, reply, at=at, variables=variables).model_dump(mode="json"), kwargs["schema"]
        text = json.dumps(_asked_for(data, schema, schema.get("$defs", {})), ensure_ascii=False)
        told = sum(len(str(message.content)) for message in messages)
        told += len(json.dumps(schema, ensure_ascii=False)) if kwargs["counts"] else 0
        tokens = {"input_tokens": told // LETTERS, "output_tokens": len(text) // LETTERS}
        usage: Any = {**tokens, "total_tokens": sum(tokens.values())}
        return ChatResult(generations=[ChatGeneration(message=AIMessage(content=text, usage_metadata=usage))])


def _asked_for(value: Any, schema: Mapping[str, Any], known: Mapping[str, Any]) -> Any:
    """The part of a reply that a schema asks for."""
    if "$ref" in schema:
        schema = known[schema["$ref"].rpartition("/")[2]]
    if "anyOf" in schema:
        schema = next((one for one in schema["anyOf"] if (one.get("type") == "null") == (value is None)), {})
        return _asked_for(value, schema, known) if value is not None else None
    if isinstance(value, list):
        return [_asked_for(item, schema.get("items", {}), known) for item in value[: schema.get("maxItems")]]
    if isinstance(value, str):
        return value[: schema.get("maxLength")]
    if not isinstance(value, dict) or "properties" not in schema:
        return value
    return {name: _asked_for(value[name], part, known) for name, part in schema["properties"].items() if name in value}


def _stand_in(spec: str, role: Role, ask: Any, settings: CallSettings, looks: bool) -> Backend:
    """What stands in for a model: asked in the form that its server is asked in first."""

    def options(request: Request, structure: Structure) -> dict[str, Any]:
        # weights in this process are held by a mask, which costs no token
        return {"schema": request.schema, "counts": structure in {"json_schema", "tools"} and not here}

    here = runs_here(spec)
    form: Structure = settings.structure
    if form == "auto" or (here and form != "text"):
        form = "json_schema"
    brief = spec == "smol" if settings.brief is None else settings.brief
    return Backend(
        spec, _StandIn(ask), sees=looks and role == "robot", options=options, structures=(form,), brief=brief
    )


def _looks(config: Config) -> bool:
    """Whether the robot's model looks at pictures, as far as that can be told without loading it."""
    spec = model_specs(config)["robot"]
    if not _paid(spec) or spec.endswith("+images"):
        return _paid(spec)
    if spec.startswith("huggingface:"):
        form = Path(spec.partition(":")[2]) / "config.json"
        return form.is_file() and "vision_config" in json.loads(form.read_text(encoding="utf-8"))
    if spec == "smol":
        return False
    try:
        with open_embeddings(config) as embeddings:
            return open_backend(spec, "robot", embeddings, config.base_url, config.calls).sees
    except ConfigError:  # as where a key is missing, which an estimate does not need
        return False


def _pictures(config: Config, call: ModelCall) -> int:
    """Frames from two views, where the robot's own model may look at them."""
    looks = call.prompt == "robot/intentions" and config.takes_pictures
    return 2 * config.frames if looks else 0


def _rounded(counts: Mapping[str, float], config: Config, role: str) -> dict[str, Any]:
    model = getattr(config.models, role)
    whole = {name: math.ceil(counts.get(name, 0)) for name in ("calls", "tokens_in", "tokens_out", "pictures")}
    most = whole["calls"] * config.calls.max_tokens * config.calls.attempts
    return {"model": model, "paid": _paid(model), **whole, "tokens_out_at_most": most}


def _paid(model: str) -> bool:
    return model.partition(":")[0] != "offline" and recorded_run(model) is None
