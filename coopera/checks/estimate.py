"""What a run would ask of its models, from a few hours lived by the offline model for nothing."""

from __future__ import annotations

import math
import tempfile
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from coopera.config.schema import Config, Models
from coopera.core.asks import ASKS
from coopera.core.hour import ModelCall
from coopera.core.replies import REPLIES
from coopera.models.recorded import recorded_run
from coopera.models.schemas import schema_of
from coopera.models.settings import Budget
from coopera.rundir.directory import RunDir
from coopera.studies.study import plan_days, run_study

_TRIED = 3  # hours
_LETTERS = 4  # characters of English that make a token, about
_NOTE = (
    "Measured on {hours} hours of {person}'s first day as the offline model lives it; {letters} characters count as a "
    "token. A talkative model writes more, at most max_tokens a reply; a bad reply is asked for again, up to "
    "{attempts} times in all. Pictures cost tokens besides, as the model has it."
)


def estimate(config: Config) -> dict[str, Any]:
    """Estimate calls, tokens and pictures of a whole run.

    Args:
        config: Resolved by `coopera.studies.catalogues.resolve`.

    Returns:
        `roles`, each with `model calls tokens_in tokens_out tokens_out_at_most pictures`, the totals, and a `note`.
    """
    hours = min(config.hours, _TRIED)
    calls = _tried(config, hours)
    plans = plan_days(config)
    lived = sum(len(plan.hours) for plan in plans)
    total: dict[str, Counter[str]] = {role: Counter() for role in Models.model_fields}
    for call in calls:
        spec = ASKS[call.prompt]
        per_day = call.node == "infer_traits"
        times = len(plans) if per_day else lived / hours
        longer = config.hours / hours if per_day else 1.0
        schema = len(schema_of(REPLIES[spec.reply]))
        total[spec.role] += Counter(
            {
                "calls": times,
                "tokens_in": times * (longer * len(str(call.messages[0]["content"])) + schema) / _LETTERS,
                "tokens_out": times * len(call.reply) / _LETTERS,
                "pictures": times * _pictures(config, call),
            }
        )
    roles = {role: _rounded(counts, config, role) for role, counts in total.items()}
    paid = [entry for entry in roles.values() if entry["paid"]]
    sums = {name: sum(entry[name] for entry in paid) for name in ("calls", "tokens_in", "tokens_out", "pictures")}
    person = (config.humans or [""])[0]
    note = _NOTE.format(hours=hours, person=person, letters=_LETTERS, attempts=config.calls.attempts)
    return {"hours": lived, "roles": roles, **sums, "note": note}


def in_words(found: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    """The estimate as a table: its head, and a row for each role."""
    head = ["role", "model", "calls", "tokens in", "tokens out", "at most", "pictures"]
    names = ("calls", "tokens_in", "tokens_out", "tokens_out_at_most", "pictures")
    rows = [[role, entry["model"], *(f"{entry[name]:,}" for name in names)] for role, entry in found["roles"].items()]
    return head, rows


def _tried(config: Config, hours: int) -> list[ModelCall]:
    with tempfile.TemporaryDirectory() as folder:
        trial = config.model_copy(
            update={
                "setting": 1,
                "humans": (config.humans or [])[:1],
                "scenes": (config.scenes or [])[:1],
                "days": 1,
                "hours": hours,
                "models": Models(),
                "backbone": "offline:words",
                "schedule": None,
                "earlier_life": None,
                "pictures": "none",
                "budget": Budget(),
                "out": Path(folder) / "run",
            }
        )
        run_study(trial)
        run = RunDir.open(Path(folder) / "run")
        calls = [call for hour in run.hours() for call in hour.calls]
        return calls + [call for evening in run.evenings() for call in evening.calls]


def _pictures(config: Config, call: ModelCall) -> int:
    """Frames from two views, where the robot's own model may look at them."""
    looks = call.prompt == "robot/intentions" and config.pictures == "sampled" and _paid(config.models.robot)
    return 2 * config.frames if looks else 0


def _rounded(counts: Mapping[str, float], config: Config, role: str) -> dict[str, Any]:
    model = getattr(config.models, role)
    whole = {name: math.ceil(counts.get(name, 0)) for name in ("calls", "tokens_in", "tokens_out", "pictures")}
    most = whole["calls"] * config.calls.max_tokens * config.calls.attempts
    return {"model": model, "paid": _paid(model), **whole, "tokens_out_at_most": most}


def _paid(model: str) -> bool:
    return model.partition(":")[0] != "offline" and recorded_run(model) is None
