"""What is different these days, such as a cold or a new hobby, as pulls on activities. Person's side only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.models.offline.household.knowledge import Activity, Floats, Household


class Circumstances(NamedTuple):
    """Logits added to each activity, and which are possible; shape (activities,) each."""

    pull: Floats
    can_do: NDArray[np.bool_]


def circumstances(household: Household, changes: Sequence[Mapping[str, Any]]) -> Circumstances:
    """Add up what is different: `more` at the strength that a change has today, `never` from its first day on."""
    pull, can_do = np.zeros(len(household.activities)), np.ones(len(household.activities), dtype=bool)
    for change in changes:
        for activity, logits in change["more"].items():
            if activity in household.index:
                pull[household.index[activity]] += float(change["strength"]) * float(logits)
        for activity in change["never"]:
            if activity in household.index:
                can_do[household.index[activity]] = False
    return Circumstances(pull, can_do)


def speaks_for(change: Mapping[str, Any], activity: Activity) -> bool:
    """Whether a change is a reason to do something."""
    return float(change["more"].get(activity.id, 0.0)) * float(change["strength"]) > 0.2
