"""Do simulated people live like recorded ones? (PAPER §4.2, Alignment with Real-Human Behavior)."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.hour import LoggedHour
from coopera.core.people import PersonId
from coopera.evaluation.people.figures import Figure, unmeasured
from coopera.evaluation.people.learners import Floats
from coopera.evaluation.people.lives import Lives
from coopera.evaluation.statistics import mean_over_people
from coopera.memory.embeddings import as_array

_MEASURES = ("aligned", "generic", "mismatched")


def alignment(
    lives: Lives,
    recorded: Mapping[PersonId, Sequence[LoggedHour]],
    embeddings: Embeddings,
    *,
    generic: PersonId | None = None,
    seed: int = 0,
) -> list[Figure]:
    """Cosine of what simulated and recorded people intend over their days, over the recorded people.

    `aligned` compares a recorded person with their own simulation, `mismatched` with the simulations of the others,
    `generic` with somebody who was simulated without a profile (an id in `lives`). Of a recorded day only the hours of
    day that somebody in `lives` has lived count, and of these only those at home, since nobody is simulated elsewhere.
    """
    if not recorded:
        return unmeasured("like people", *_MEASURES, why="no log of a real person was given")
    lived = {hour for day in lives.days for hour in day.hours}
    days = {person: found for person, hours in sorted(recorded.items()) if (found := _days(hours, lived))}
    if not days:
        return unmeasured("like people", *_MEASURES, why="the logs have no hour at home of those that were simulated")
    simulated = {p: week([day.intentions for day in lives.of(p)], embeddings) for p in lives.people}
    real = {person: week(texts, embeddings) for person, texts in days.items()}
    nobody = simulated.pop(generic) if generic else None
    values: dict[str, list[float]] = {
        "aligned": [float(vector @ simulated[person]) for person, vector in real.items()],
        "generic": [] if nobody is None else [float(vector @ nobody) for vector in real.values()],
        "mismatched": [
            float(np.mean([vector @ other for name, other in simulated.items() if name != person]))
            for person, vector in real.items()
            if len(simulated) > 1
        ],
    }
    why = {"generic": "nobody without a profile was named", "mismatched": "it takes a second simulated person"}
    figures = []
    for name, cosines in values.items():
        if not cosines:
            figures += unmeasured("like people", name, why=why[name])
            continue
        mean = mean_over_people(cosines)
        figures.append(
            Figure(
                check="like people",
                measure=name,
                value=mean.mean,
                low=mean.low,
                high=mean.high,
                n=len(cosines),
                unit="recorded people",
            )
        )
    return figures


def week(days: Sequence[Sequence[str]], embeddings: Embeddings) -> Floats:
    """What somebody intends over some days as a unit vector, shape (d,): each day is one paragraph without times.

    DEVIATES: the paper makes one paragraph of all days, of which its encoder would read the first 384 tokens.
    """
    paragraphs = [". ".join(text.strip().rstrip(".") for text in day) + "." for day in days if day]
    mean = as_array(embeddings, paragraphs).astype(np.float64).mean(axis=0)
    return np.asarray(mean / np.linalg.norm(mean), dtype=np.float64)


def _days(hours: Sequence[LoggedHour], lived: Collection[int]) -> list[list[str]]:
    """The intentions of each recorded day, of the hours of day that count."""
    days: dict[int, list[str]] = {}
    counting = (hour for hour in hours if hour.hour in lived and not hour.away)
    for hour in sorted(counting, key=lambda one: (one.day, one.hour)):
        days.setdefault(hour.day, []).append(hour.intention)
    return list(days.values())
