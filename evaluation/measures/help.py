"""What the robot's help was worth: need precision, recall and F1, effort saved, false help.

The paper's F1 asks how well the robot judged *what it proposed*; a robot that proposes little scores well on it. This
asks about what the person still had to do instead. `docs/measures.md` defines all figures with worked examples.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from coopera.core.household import Outcome
from coopera.core.success import Help
from coopera.evaluation.measuring import MeasuredHour, MeasureSpec, Pooled, sums


class Need(NamedTuple):
    """The headline of some hours, each in [0, 1] or None where it has no meaning.

    Attributes:
        precision: Share of the accepted acts that helped with a remaining task; None where none was accepted.
        recall: Share of the remaining tasks that were helped; None where none remained.
        f1: Their harmonic mean; 0 where one of them is 0, None where no task remained.
    """

    precision: float | None
    recall: float | None
    f1: float | None


def help_given(outcomes: Sequence[Outcome], useful: Sequence[Sequence[bool]], *, remaining: int) -> Help:
    """Measure an hour's help.

    Args:
        outcomes: What came of the robot's acts, in the order in which they were done.
        useful: For each of them, whether it helps with each of the person's remaining tasks (one row per outcome).
        remaining: How many tasks remained.
    """
    helped: set[int] = set()
    useless, saved = 0, 0.0
    for outcome, row in zip(outcomes, useful, strict=True):
        if not outcome.ok:
            continue
        met = {task for task, yes in enumerate(row) if yes}
        useless += not met
        if met - helped:
            saved += outcome.metres
            helped |= met
    return Help(
        remaining=remaining,
        helped=len(helped),
        accepted=len(outcomes),
        done=sum(outcome.ok for outcome in outcomes),
        useless=useless,
        metres=round(sum(outcome.metres for outcome in outcomes), 6),
        saved_metres=round(saved, 6),
    )


def pool_help(hours: Sequence[Help]) -> Help:
    """Add up hours."""
    return Help.model_validate(sums(Help)(hours))


def need(given: Help) -> Need:
    """Need precision, recall and F1 of pooled figures. A failed act was accepted and helped with nothing."""
    precision = (given.done - given.useless) / given.accepted if given.accepted else None
    recall = given.helped / given.remaining if given.remaining else None
    if recall is None:
        return Need(precision, None, None)
    both = (precision or 0.0) + recall
    return Need(precision, recall, 2 * (precision or 0.0) * recall / both if both else 0.0)


def false_help(given: Help, hours: int) -> float | None:
    """Acts per hour that were done and helped with nothing; None where no hour was scored."""
    return given.useless / hours if hours else None


def _measure(hour: MeasuredHour) -> Help:
    useful = [[hour.helps(done.act, task.act) for task in hour.remaining] for done in hour.outcomes]
    return help_given(hour.outcomes, useful, remaining=len(hour.remaining))


def _pool(hours: Sequence[Help]) -> Pooled:
    given = pool_help(hours)
    found = need(given)
    rates = {**found._asdict(), "score": found.recall, "false_per_hour": false_help(given, len(hours))}
    return {**given.model_dump(), **rates}  # `score` is what recall was called before


MEASURE = MeasureSpec(
    name="help",
    about="need F1: of the accepted acts, against what the person still had to do, by the predicate",
    title="need F1",
    figures=Help,
    measure=_measure,
    pool=_pool,
    headline="f1",
    beside=("precision", "recall"),
    row="predicate",  # by which it is measured
    order=0,
)
