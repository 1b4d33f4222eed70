"""What a benchmark's runs were made with, told from the runs themselves: person, judge, household, robot and code."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from coopera.config.files import canonical_json
from coopera.config.schema import Config
from coopera.core.naming import sha256
from coopera.evaluation.results import Fingerprints
from coopera.models.offline.household.knowledge import shipped
from coopera.models.settings import SHARED
from coopera.rundir.directory import RunDir

LIVING = {"person_model", "intentions", "absence", "person_memory", "changes"}
LIVING |= {"feedback", "feedback_rate", "feedback_noise"}
"""Settings that decide what a person does and answers."""
_PERSONS, _JUDGES = ("human/", "persona/"), ("judge/",)


def fingerprints(runs: Iterable[RunDir]) -> Fingerprints:
    """Of runs of methods as they are, at least one; where these differ in something, it is named in `mixed`."""
    each = [_of(run.config, run.info) for run in runs]
    first = each[0]
    odd = [name for name in first if any(one[name] != first[name] for one in each)]
    joined = {name: first[name] if name not in odd else _mark([one[name] for one in each]) for name in first}
    return Fingerprints(**joined, mixed=odd)


def _of(config: Config, info: Mapping[str, Any]) -> dict[str, str]:
    prompts, models = info.get("prompts", {}), {**info.get("models", {}), **info.get("model_objects", {})}
    knowledge = {**info.get("knowledge", {}), "person": shipped().sha256}
    living = config.model_dump(mode="json", include=LIVING)

    def chosen(mine: Callable[[str], bool]) -> dict[str, str]:
        return {name: sha for name, sha in prompts.items() if mine(name)}

    persons, judges = chosen(lambda name: name.startswith(_PERSONS)), chosen(lambda name: name.startswith(_JUDGES))
    robots = chosen(lambda name: not name.startswith((*_PERSONS, *_JUDGES)))
    return {
        "person": _mark([models.get("human"), living, persons]),
        "judge": _mark([models.get("judge"), judges]),
        "household": _mark([config.household == SHARED, knowledge]),
        "robot": _mark([models.get("robot"), config.robot, config.classifier]),
        "prompts": _mark([persons, judges, robots]),
        "code": info.get("versions", {}).get("code", "unknown"),
    }


def _mark(data: Any) -> str:
    return sha256(canonical_json(data))
