"""Success by the predicate: a rule says which candidates help (`coopera.evaluation.predicate`)."""

from __future__ import annotations

from coopera.evaluation.measuring import by_counts

MEASURE = by_counts(
    "predicate",
    "F1 over the robot's candidates; a rule says which of them help with a remaining task",
    lambda hour: [candidate.correct for candidate in hour.candidates],
    short="F1",
    order=1,
)
