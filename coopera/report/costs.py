"""What a run asked of its models, hour by hour and evening by evening, from its trace.

A round trip is a wait for one reply. Calls that are made at once share one, as this version of the graphs makes them:
both reflections, the robot's questions about its intentions, and in the evening all feedback and the judge's calls.
Each further attempt at a reply is a trip more. Replies from the cache, and those of an offline model, take none.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from coopera.config.prices import Prices
from coopera.core.hour import ModelCall
from coopera.rundir.directory import RunDir

_AT_ONCE = {"reflect_profile": "reflections", "reflect_scene": "reflections", "score": "feedback"}
"""Nodes whose calls are made together with those of others, by what these are called here."""
_IN_TURN = {"reflect_scene"}
"""Nodes of which a further call comes after the one before."""
_SUMS = ("calls", "round_trips", "tokens_in", "tokens_out", "seconds", "money")


def costs_of(run: RunDir, prices: Prices | None = None) -> dict[str, Any]:
    """The costs of a run.

    Args:
        run: The run, open for reading.
        prices: What its models cost, if not what the run was told.

    Returns:
        `hours` and `evenings`, each with its place; `prompts`, by model; and `money`, where prices are known.
        `seconds` is how long the run waited for replies.

    Raises:
        RunError: If the trace is damaged.
    """
    known = prices or run.prices
    hours, late = [], defaultdict[int, list[ModelCall]](list)
    calls: list[ModelCall] = []
    for hour in run.hours():
        hours.append({"day": hour.day, "hour": hour.hour, **_spent([c for c in hour.calls if not c.late], known)})
        late[hour.day] += [call for call in hour.calls if call.late]
        calls += hour.calls
    evenings = []
    for evening in run.evenings():
        evenings.append({"day": evening.day, **_spent([*evening.calls, *late[evening.day]], known)})
        calls += evening.calls
    found = {"hours": hours, "evenings": evenings, "prompts": _by_prompt(calls, known)}
    return {**found, "money": known.bill(calls)} if known else found


def in_words(found: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    """Costs as a table: an hour and an evening on average, the whole run, and each prompt's calls."""
    names = [name for name in _SUMS if name != "money" or "money" in found]
    rows = [
        ["an hour, on average", *(_figure(name, _mean(found["hours"], name)) for name in names)],
        ["an evening, on average", *(_figure(name, _mean(found["evenings"], name)) for name in names)],
        ["the run", *(_figure(name, sum(one[name] for kind in _KINDS for one in found[kind])) for name in names)],
    ]
    for one in found["prompts"]:
        cells = (_figure(name, one[name]) if name in one else "" for name in names)
        rows.append([f"  {one['prompt']} ({one['model']})", *cells])
    return ["asked in", *(name.replace("_", " ") for name in names)], rows


_KINDS = ("hours", "evenings")


def _spent(calls: Sequence[ModelCall], prices: Prices | None) -> dict[str, Any]:
    """What some calls of one hour, or of one evening, took."""
    steps: dict[tuple[str, int], list[ModelCall]] = defaultdict(list)
    seen: dict[str, int] = defaultdict(int)
    for call in calls:
        seen[call.node] += 1
        turn = seen[call.node] if call.node in _IN_TURN else 1
        steps[_AT_ONCE.get(call.node, call.node), turn].append(call)
    asked = [[call for call in step if not call.cached] for step in steps.values()]
    sent = [[call for call in step if not call.model.startswith("offline")] for step in asked]
    return {
        **_sums(calls, prices),
        "round_trips": sum(max((call.attempts for call in step), default=0) for step in sent),
        "seconds": round(sum(max((call.seconds for call in step), default=0.0) for step in asked), 3),
    }


def _sums(calls: Iterable[ModelCall], prices: Prices | None) -> dict[str, Any]:
    paid = [call for call in calls if not call.cached]
    sums: dict[str, Any] = {
        "calls": len(paid),
        "tokens_in": sum(call.tokens_in for call in paid),
        "tokens_out": sum(call.tokens_out for call in paid),
    }
    return {**sums, "money": prices.bill(paid)["spent"]} if prices else sums


def _by_prompt(calls: Iterable[ModelCall], prices: Prices | None) -> list[dict[str, Any]]:
    together: dict[tuple[str, str], list[ModelCall]] = defaultdict(list)
    for call in calls:
        together[call.prompt, call.model].append(call)
    return [
        {"prompt": prompt, "model": model, **_sums(asked, prices)}
        for (prompt, model), asked in sorted(together.items())
    ]


def _mean(places: Sequence[Mapping[str, Any]], name: str) -> float:
    return sum(place[name] for place in places) / len(places) if places else 0.0


def _figure(name: str, value: float) -> str:
    return f"{value:,.4f}" if name == "money" else f"{value:,.1f}" if value != int(value) else f"{int(value):,}"
