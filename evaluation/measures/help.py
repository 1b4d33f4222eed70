"""What the robot's help was worth: coverage of the person's tasks, effort saved, false help.

F1 asks how well the robot judged *what it proposed*; a robot that proposes nothing useful can score well on it. This
asks about the person's tasks instead. `docs/measures.md` defines all figures with worked examples.
"""

from __future__ import annotations

from collections.abc import Sequence

from coopera.core.hour import Help
from coopera.core.household import Outcome
from coopera.evaluation.measuring import MeasuredHour, MeasureSpec, Pooled, sums


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
        done=sum(outcome.ok for outcome in outcomes),
        useless=useless,
        metres=round(sum(outcome.metres for outcome in outcomes), 6),
        saved_metres=round(saved, 6),
    )


def pool_help(hours: Sequence[Help]) -> Help:
    """Add up hours."""
    return Help.model_validate(sums(Help)(hours))


def help_score(given: Help) -> float | None:
    """Share of the person's remaining tasks that were really helped, in [0, 1]; None where no task remained."""
    return given.helped / given.remaining if given.remaining else None


def false_help(given: Help, hours: int) -> float | None:
    """Acts per hour that were done and helped with nothing; None where no hour was scored."""
    return given.useless / hours if hours else None


def _measure(hour: MeasuredHour) -> Help:
    useful = [[hour.helps(done.act, task.act) for task in hour.remaining] for done in hour.outcomes]
    return help_given(hour.outcomes, useful, remaining=len(hour.remaining))


def _pool(hours: Sequence[Help]) -> Pooled:
    given = pool_help(hours)
    return {**given.model_dump(), "score": help_score(given), "false_per_hour": false_help(given, len(hours))}


MEASURE = MeasureSpec(
    name="help",
    about="share of the person's remaining tasks that the robot's acts really helped with, by the predicate",
    title="help score",
    figures=Help,
    measure=_measure,
    pool=_pool,
    headline="score",
    row="predicate",  # by which it is measured
    order=2,
)
