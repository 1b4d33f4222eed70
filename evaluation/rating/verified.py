"""What comes of ratings: success by raters, its distance from the automatic measures, and how far raters agree."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from coopera.core.hour import HourRecord
from coopera.core.success import Counts
from coopera.evaluation import paper
from coopera.evaluation.agreement import l1
from coopera.evaluation.counts import count, pool
from coopera.evaluation.rating.planning import Item, RaterId, RatingPlan, Unit
from coopera.evaluation.rating.reliability import fleiss, krippendorff, pairwise

Answers = Mapping[RaterId, Mapping[str, bool | None]]
"""By rater, then by item; None is a skipped one."""
MEASURES = ("predicate", "judge")


class Hour(NamedTuple):
    """One hour that was rated, with its success by each measure; `people` is by the majority of its raters."""

    unit: Unit
    people: Counts
    automatic: dict[str, float | None]


def verified(
    plan: RatingPlan, records: Callable[[int, int, int], HourRecord | None], answers: Answers
) -> dict[str, Any]:
    """The results as plain data, for `human_verification.json`.

    Args:
        plan: What was rated.
        records: Gives the hour of a run (by its place), day and hour; None where it is not there any more.
        answers: What the raters said.
    """
    hours = [hour for unit in plan.units if (hour := _hour(unit, records, answers)) is not None]
    return {
        "raters": {rater: _rater(plan, rater, answers.get(rater, {})) for rater in plan.order},
        "agreement": agreement(plan, answers),
        "runs": [
            {**rated.model_dump(), **_of_run([hour for hour in hours if hour.unit.run == place])}
            for place, rated in enumerate(plan.runs)
        ],
        "l1": _l1_table(plan, hours),
        "hours": [
            {
                "run": plan.runs[hour.unit.run].folder,
                "day": hour.unit.day,
                "hour": hour.unit.hour,
                "people": hour.people.f1,
                **hour.automatic,
            }
            for hour in hours
        ],
    }


def rows(
    plan: RatingPlan, records: Callable[[int, int, int], HourRecord | None], answers: Answers
) -> list[dict[str, Any]]:
    """One row for each answer, for a table; a check has its truth, and of what the robot did nothing."""
    found = []
    for rater, given in sorted(answers.items()):
        for unit in plan.units:
            record = records(unit.run, unit.day, unit.hour)
            for item in unit.items:
                if item.id in given:
                    found.append({**_of_item(plan, unit, item, record), "rater": rater, "yes": given[item.id]})
    return found


def agreement(plan: RatingPlan, answers: Answers) -> dict[str, Any]:
    """How far raters agree over tasks, without the attention checks."""
    real = {item.id for unit in plan.units for item in unit.items if item.truth is None}
    said = {
        rater: {item: yes for item, yes in given.items() if item in real and yes is not None}
        for rater, given in answers.items()
    }
    by_item: dict[str, list[bool]] = defaultdict(list)
    for given in said.values():
        for item, yes in given.items():
            by_item[item].append(yes)
    most = Counter(map(len, by_item.values())).most_common(1)
    alike = [labels for labels in by_item.values() if most and len(labels) == most[0][0]]
    kappas = {f"{one} and {other}": kappa for (one, other), kappa in pairwise(said).items()}
    known = [kappa for kappa in kappas.values() if kappa is not None]
    return {
        "cohen": kappas,
        "cohen_mean": float(np.mean(known)) if known else None,
        "fleiss": fleiss(alike),
        "fleiss_items": len(alike),
        "krippendorff": krippendorff(list(by_item.values())),
        "items": len(by_item),
    }


def _hour(unit: Unit, records: Callable[[int, int, int], HourRecord | None], answers: Answers) -> Hour | None:
    record = records(unit.run, unit.day, unit.hour)
    if record is None or record.robot is None:
        return None
    meant: list[bool | None] = [None] * len(record.robot.tasks)
    for item in unit.items:
        majority = _majority([given[item.id] for given in answers.values() if item.id in given])
        for place in item.places:
            meant[place] = majority
    if all(one is None for one in meant):
        return None
    success = record.success
    automatic = {name: getattr(success and success.of(name), "f1", None) for name in MEASURES}
    return Hour(unit, count([bool(task.accepted) for task in record.robot.tasks], meant), automatic)


def _majority(said: Sequence[bool | None]) -> bool | None:
    """What most raters say; None where nobody does, or as many say yes as no."""
    yes, no = sum(one is True for one in said), sum(one is False for one in said)
    return None if yes == no else yes > no


def _of_run(hours: Sequence[Hour]) -> dict[str, Any]:
    people = [hour.people.f1 for hour in hours]
    return {
        "hours": len(hours),
        "people": pool(hour.people for hour in hours).model_dump(exclude={"verdicts"}),
        "l1": {name: l1([hour.automatic[name] for hour in hours], people) for name in MEASURES},
    }


def _l1_table(plan: RatingPlan, hours: Sequence[Hour]) -> list[dict[str, Any]]:
    """L1 of each automatic measure to the raters, by method and setting, with the paper's figure (PAPER §4.4)."""
    found = []
    for method, setting in dict.fromkeys((rated.method, rated.setting) for rated in plan.runs):
        chosen = [
            hour
            for hour in hours
            if (plan.runs[hour.unit.run].method, plan.runs[hour.unit.run].setting) == (method, setting)
        ]
        people = [hour.people.f1 for hour in chosen]
        for name in MEASURES:
            found.append(
                {
                    "measure": name,
                    "method": method,
                    "setting": setting,
                    "l1": l1([hour.automatic[name] for hour in chosen], people),
                    "hours": len(chosen),
                    "paper": paper.L1.get(name, {}).get(str(setting)),
                }
            )
    return found


def _rater(plan: RatingPlan, rater: RaterId, given: Mapping[str, bool | None]) -> dict[str, Any]:
    mine = set(plan.order[rater])
    items = [item for unit in plan.units if unit.id in mine for item in unit.items]
    checks = [item for item in items if item.truth is not None and item.id in given]
    return {
        "items": len(items),
        "answered": sum(item.id in given for item in items),
        "skipped": sum(given.get(item.id, True) is None for item in items),
        "checks": len(checks),
        "checks_passed": sum(given[item.id] == item.truth for item in checks),
    }


def _of_item(plan: RatingPlan, unit: Unit, item: Item, record: HourRecord | None) -> dict[str, Any]:
    rated, first = plan.runs[unit.run], item.places[0] if item.places else None
    tasks = record.robot.tasks if record is not None and record.robot is not None else []
    success = record.success if record is not None else None
    row = {
        "run": rated.folder,
        "method": rated.method,
        "setting": rated.setting,
        "person": rated.person,
        "day": unit.day,
        "hour": unit.hour,
        "item": item.id,
        "task": item.text,
        "check": item.truth,
        "accepted": bool(tasks[first].accepted) if first is not None and first < len(tasks) else None,
    }
    for name in MEASURES:
        verdicts = getattr(success and success.of(name), "verdicts", [])
        row[name] = verdicts[first] if first is not None and first < len(verdicts) else None
    return row
