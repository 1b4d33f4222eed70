"""What is different these days, such as a cold or a new hobby, as pulls on activities. Person's side only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.models.offline.household.knowledge import Activity, Floats, Household
from coopera.models.offline.human.own_time import OCCUPATIONS
from coopera.models.offline.human.rhythm import Schedule


class Job(NamedTuple):
    """A job that came with a change: the place of what fills its hours, and these; neither where it is none."""

    occupation: int | None
    schedule: Schedule | None


class Circumstances(NamedTuple):
    """What is different: logits added to each activity, which are possible, shape (activities,) each, and a new job."""

    pull: Floats
    can_do: NDArray[np.bool_]
    job: Job | None


def circumstances(household: Household, changes: Sequence[Mapping[str, Any]], *, absence: bool) -> Circumstances:
    """Add up what is different: `more` at the strength that a change has today, the rest from its first day on.

    Of several jobs the last counts; work outside is none where people are never away.
    """
    job: Job | None = None
    pull, can_do = np.zeros(len(household.activities)), np.ones(len(household.activities), dtype=bool)
    for change in changes:
        for activity, logits in change["more"].items():
            if activity in household.index:
                pull[household.index[activity]] += float(change["strength"]) * float(logits)
        for activity in change["never"]:
            if activity in household.index:
                can_do[household.index[activity]] = False
        if change["work"]:
            job = _job(household, change["work"], absence=absence)
    return Circumstances(pull, can_do, job)


def _job(household: Household, work: Mapping[str, Any], *, absence: bool) -> Job:
    name = OCCUPATIONS.get(("employed", str(work["at"]), absence))
    if name is None:
        return Job(None, None)
    return Job(household.index.get(name), Schedule(days=work["days"], start=work["start"], end=work["end"]))


def speaks_for(change: Mapping[str, Any], activity: Activity) -> bool:
    """Whether a change is a reason to do something."""
    return float(change["more"].get(activity.id, 0.0)) * float(change["strength"]) > 0.2
