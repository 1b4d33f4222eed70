"""Figures of the checks, and what the paper reports for each (PAPER §4.2, §4.5, Tables 1, 2 and 5)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

from coopera.core.people import Frozen, PersonId
from coopera.evaluation.statistics import bootstrap

Unit = TypeVar("Unit")

FULL = "full"
"""The person as the paper simulates it; every other variant is an ablation."""

IN_DETAIL = ("time use by category",)
"""Checks of many figures, in hours of the day: they stand in the files alone, not on the screen nor in the picture."""


class Figure(Frozen):
    """One measured number.

    Attributes:
        check: Such as "distinct".
        measure: What of it, such as "intentions".
        variant: How the person was simulated: "full", or an ablation's name.
        value: The number; None where it could not be measured, and `note` says why.
        low: Lower end of its 95 % interval, None where there is none: `mean_over_people` for such a mean, else a
            bootstrap that resamples people, since an accuracy or a divergence is no mean over people.
        high: Upper end.
        n: How many of `unit` it is drawn from.
        unit: Such as "days".
        control: The same computation where it must find nothing, named in `control_is`.
        paper: What the paper reports, None where it reports nothing.
    """

    check: str
    measure: str
    variant: str = FULL
    value: float | None = None
    low: float | None = None
    high: float | None = None
    n: int = 0
    unit: str = ""
    control: float | None = None
    control_is: str = ""
    paper: float | None = None
    note: str = ""


PAPER: dict[tuple[str, str, str], float] = {
    ("distinct", "intentions", FULL): 0.995,
    ("distinct", "tasks", FULL): 0.830,
    ("distinct", "intentions", "no_extension"): 0.950,
    ("distinct", "tasks", "no_extension"): 0.800,
    ("diverse", "SD", FULL): 0.939,
    ("coherent", "aligned", FULL): 0.342,
    ("coherent", "mismatched", FULL): -0.497,
    ("temporal", "accuracy", FULL): 0.789,
    ("temporal", "F1", FULL): 0.790,
    ("temporal", "accuracy", "single_shot"): 0.751,
    ("temporal", "F1", "single_shot"): 0.740,
    ("like people", "aligned", FULL): 0.810,
    ("like people", "generic", FULL): 0.554,
    ("like people", "mismatched", FULL): 0.523,
    ("seen by people", "multiple choice", FULL): 0.764,
    ("seen by people", "matching", FULL): 0.712,
}
"""(check, measure, variant) -> the published figure (Llama-3.1-8B people, 10 in 5 scenes for 20 days; BERT-large)."""


def unmeasured(check: str, *measures: str, why: str) -> list[Figure]:
    """Figures that could not be measured, with the reason."""
    return [Figure(check=check, measure=measure, note=why) for measure in measures]


def over_people(
    check: str,
    measure: str,
    units: Mapping[PersonId, Unit],
    statistic: Callable[[Sequence[Unit]], float],
    *,
    chance: Mapping[PersonId, Unit],
    seed: int,
    **about: str | int,
) -> Figure:
    """A statistic of what was counted by person, with an interval that resamples people.

    Args:
        check: As in `Figure`.
        measure: As in `Figure`.
        units: What was counted, by person; at least one.
        statistic: The number from some people's counts.
        chance: The same counts of a control that must find nothing; none gives none.
        seed: Of the resampling.
        about: Further fields of the figure.
    """
    interval = bootstrap([units[person] for person in sorted(units)], statistic, seed=seed)
    control = [chance[person] for person in sorted(chance)]
    return Figure.model_validate(
        {
            **about,
            "check": check,
            "measure": measure,
            "value": interval.mean,
            "low": interval.low,
            "high": interval.high,
            "control": statistic(control) if control else None,
        }
    )


def as_variant(figures: list[Figure], variant: str) -> list[Figure]:
    """The figures of one way of simulating a person, each with what the paper reports of it."""
    return [
        figure.model_copy(
            update={"variant": variant, "paper": PAPER.get((figure.check, figure.measure, variant), figure.paper)}
        )
        for figure in figures
    ]
