"""What speaks for a candidate before any verdict: the proposer's probability, and counts of what was told.

These are the features that a classifier reads beside words (`Example.evidence`), and until the first evening the robot
goes by their `prior` alone.

`prior` is the robot's own probability. Others are shares of the hours that the person told of: `told` among those of
like intentions, `sight` among those that looked like this one, `hour` among those at this time of day. `support` is the
logarithm of 1 + the number of hours that `told` rests on. All shares lie in (0, 1) and are smoothed, so that one hour
decides nothing.
DEVIATES: the paper's classifiers see neither; they see that a text is like another, not that it is the same.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from coopera.core.household import Act, Collab, FreeMotion, PickPlace, Use, plain
from coopera.graphs.robots.told import ToldHour, Uses, share, used_in

PATIENCE = 1.0
"""As many hours of common sense stand against what was told."""
USUAL_TASK: dict[Collab, float] = {1: 0.25, 2: 0.35}
"""How often a task of the true intention helps that nothing was told about."""
ELSEWHERE = 0.05  # how often a thing is used in any hour
_LEAST = 1e-3


def of_intentions(
    told: Sequence[ToldHour], alike: Sequence[Sequence[float]], probabilities: Sequence[float | None]
) -> list[dict[str, float]]:
    """Evidence for intention candidates.

    Args:
        told: The told hours.
        alike: For each candidate, how like it is to each of them.
        probabilities: The proposer's, which has read what was told. Where a model leaves them out, its order stands
            for them and is mixed with what was told.
    """
    speaks = [hour.speaks for hour in told]
    every = sum(speaks)
    mass = [sum(a * w for a, w in zip(one, speaks, strict=True)) for one in alike]
    by_order = [2.0**-rank for rank in range(1, len(alike) + 1)]
    found = []
    for by_rank, probability, weight in zip(by_order, probabilities, mass, strict=True):
        mixed = (PATIENCE * by_rank + weight) / (PATIENCE + every)
        found.append(
            {
                "prior": _clip(mixed if probability is None else probability),
                "told": _clip((weight + PATIENCE * ELSEWHERE) / (every + PATIENCE)),
                "support": _round(math.log1p(every)),
            }
        )
    return found


def of_task(
    act: Act,
    uses: Uses,
    looked: Sequence[float],
    near: Sequence[float],
    intentions: Sequence[tuple[float, Sequence[float]]],
    own: int,
    collab: Collab,
) -> dict[str, float]:
    """Evidence for one task.

    Args:
        act: The task.
        uses: What was used in the told hours (`uses_of`).
        looked: How much each of them says of what is wanted now.
        near: How much it counts at this hour of this day, whatever was seen.
        intentions: For each intention that tasks were imagined for, how probable it is, and how much each told hour
            counts for it (`weights_for`). Alike ones may both be right, so their chances may sum to more than 1.
        own: Which of these is the candidate's own.
        collab: The collaboration type.
    """
    used, usual = used_in(uses, _use(act)), USUAL_TASK[collab]
    within = [share(used, weights, usual=usual, patience=PATIENCE) for _, weights in intentions]
    sight, hour = (share(used, weights, usual=ELSEWHERE, patience=PATIENCE) for weights in (looked, near))
    total = sum(p for p, _ in intentions)
    meant = sum(p * s for (p, _), s in zip(intentions, within, strict=True)) / max(1.0, total)
    prior = meant + max(0.0, 1.0 - total) * sight  # if it is none of these intentions, it is an hour like this one
    return {
        "prior": _clip(prior),
        "told": _clip(within[own]),
        "sight": _clip(sight),
        "hour": _clip(hour),
        "support": _round(math.log1p(sum(intentions[own][1]))),
    }


def weights_for(told: Sequence[ToldHour], alike: Sequence[float]) -> list[float]:
    """How much each told hour counts for what an intention needs."""
    return [a * hour.wide * hour.looks**0.5 if a else 0.0 for hour, a in zip(told, alike, strict=True)]


def _use(act: Act) -> Use:
    if isinstance(act, PickPlace):
        return Use(plain(act.object), plain(act.receptacle))
    return Use(plain(act.in_hand if isinstance(act, FreeMotion) else act.object))


def _clip(probability: float) -> float:
    return _round(min(1 - _LEAST, max(_LEAST, probability)))


def _round(number: float) -> float:
    return round(number, 6)
