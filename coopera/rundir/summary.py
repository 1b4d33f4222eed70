"""The figures of a run, drawn from its trace alone: days by pooled counts, hours as rows."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from coopera.config.prices import Prices
from coopera.config.schema import Config
from coopera.core.hour import Evening, HourRecord
from coopera.core.success import Counts
from coopera.evaluation.agreement import l1
from coopera.evaluation.measures.help import need, pool_help
from coopera.evaluation.measuring import Pooled, all_measures, find_measure, told_in_the_evening

_HOUR = ("day", "episode", "episode_day", "hour", "person", "scene")
_NEED = ("need_precision", "need_recall", "need_f1")
_COUNTS = ("f1", "precision", "recall", "tp", "fp", "fn", "tn", "unscored")


def columns() -> list[str]:
    """The columns of metrics.csv: which hour, by which measure, and the figures of every measure."""
    figures = [name for spec in all_measures() if spec.figures is not Counts for name in spec.figures.model_fields]
    figures = [name for name in figures if name not in _COUNTS]
    return [*_HOUR, "measure", *_COUNTS, "status", *dict.fromkeys(figures), *_NEED]


def metrics_rows(record: HourRecord) -> list[dict[str, Any]]:
    """The hour's rows of metrics.csv, one per measure; a failed hour has rows without figures.

    What the help was worth (`coopera.core.success.Help`, and the hour's need precision, recall and F1) stands in the
    row of the predicate, which it is measured by.
    """
    blank: dict[str, Any] = dict.fromkeys(columns())
    blank |= {name: getattr(record, name) for name in (*_HOUR, "status")}
    rows: dict[str, dict[str, Any]] = {}
    for spec in all_measures():
        row = rows.setdefault(spec.row or spec.name, {**blank, "measure": spec.row or spec.name})
        found = spec.read(record.success) if record.success else None
        row |= found.model_dump(exclude={"verdicts"}) if found else {}
    if record.success and record.success.help:
        rows["predicate"] |= dict(zip(_NEED, need(record.success.help), strict=True))
    return list(rows.values())


def metrics_lines(record: HourRecord) -> str:
    """The hour's rows as lines of CSV; an empty cell is a figure that does not exist."""
    text = io.StringIO()
    csv.DictWriter(text, columns(), lineterminator="\n").writerows(metrics_rows(record))
    return text.getvalue()


def metrics_csv(lines: Iterable[str]) -> str:
    """The content of metrics.csv, of the lines of each hour."""
    text = io.StringIO()
    csv.DictWriter(text, columns(), lineterminator="\n").writeheader()
    return text.getvalue() + "".join(lines)


def summarise(
    config: Config, hours: Sequence[HourRecord], evenings: Sequence[Evening] = (), prices: Prices | None = None
) -> dict[str, Any]:
    """The content of summary.json, from the hours in order and the evenings.

    `unscored` counts candidates without a score by the predicate, `judge_unscored` those without a readable verdict of
    the judge. A failed hour counts in `failed_hours` alone. `repairs` counts the person's tasks mended by code.
    `money` is there only where prices are known.
    """
    days = sorted({record.day for record in hours})
    hours = told_in_the_evening(hours, evenings)
    calls = [call for hour in hours for call in hour.calls] + [call for evening in evenings for call in evening.calls]
    entries = [day_entry([record for record in hours if record.day == day]) for day in days]
    return {
        "method": config.method,
        "setting": config.setting,
        "collab": config.collab,
        "seed": config.seed,
        "people": config.humans or [],
        "scenes": config.scenes or [],
        "models": config.models.model_dump(),
        "need": needed(hours),
        "days": entries,
        "calls": len(calls),
        "calls_cached": sum(call.cached for call in calls),
        "calls_with_faults": sum(bool(call.faults) for call in calls),
        "leniencies": dict(sorted(sum((Counter(call.leniencies) for call in calls), Counter()).items())),
        "tokens": sum(call.tokens_in + call.tokens_out for call in calls),
        "tokens_cached": sum(call.tokens_in + call.tokens_out for call in calls if call.cached),
        "tokens_in": sum(call.tokens_in for call in calls),
        "tokens_out": sum(call.tokens_out for call in calls),
        **({"money": prices.bill(calls)} if prices else {}),
        "hours": len(hours),
        "failed_hours": sum(record.status == "failed" for record in hours),
        "failures": [
            {"day": record.day, "hour": record.hour, "reason": record.reason}
            for record in hours
            if record.status == "failed"
        ],
        "repairs": sum(len(record.human.repairs) for record in hours if record.human),
        "unscored": sum(entry["predicate"]["unscored"] for entry in entries),
        "fallbacks": fallbacks(hours),
        "identified": _identified(hours),
        "judge_unscored": sum(entry["judge"]["unscored"] for entry in entries),
        "agreement": _agreement(hours),
    }


def needed(hours: Iterable[HourRecord]) -> dict[str, float | None]:
    """Need precision, recall and F1 of some hours, their counts pooled: the headline (`docs/measures.md`)."""
    return need(pool_help([hour.success.help for hour in hours if hour.success and hour.success.help]))._asdict()


def fallbacks(hours: Iterable[HourRecord]) -> dict[str, int]:
    """How often the robot fell back, by what it says up to the colon or the first name in quotes."""
    said = [text for hour in hours if hour.robot for text in hour.robot.fallbacks]
    return dict(sorted(Counter(text.split(":")[0].split(' "')[0] for text in said).items()))


def _agreement(hours: Iterable[HourRecord]) -> dict[str, float | None]:
    """L1 of each measure of F1 to the person's own answers, hour by hour; None where no hour has both."""
    scored = [record.success for record in hours if record.success]
    counted = [spec for spec in all_measures() if issubclass(spec.figures, Counts)]
    f1 = {spec.name: [one.f1 if (one := spec.read(success)) else None for success in scored] for spec in counted}
    people = f1.pop("people")
    found = {measure: l1(values, people) for measure, values in f1.items()}
    return {measure: None if value is None else round(value, 6) for measure, value in found.items()}


def _identified(hours: Iterable[HourRecord]) -> dict[str, int]:
    """In how many hours the robot had to guess whom it was with, and in how many it was right."""
    guessed = [(hour.robot.with_whom, hour.person) for hour in hours if hour.robot and hour.robot.with_whom]
    return {"hours": len(guessed), "right": sum(one == other for one, other in guessed)}


def day_entry(hours: Sequence[HourRecord]) -> dict[str, Any]:
    """One day of the summary: by each measure, the figures of its hours together (PAPER §4.3)."""
    first = hours[0]
    return {
        "day": first.day,
        "episode": first.episode,
        "episode_day": first.episode_day,
        "person": first.person,
        "scene": first.scene,
        "hours": len(hours),
        "failed_hours": sum(record.status == "failed" for record in hours),
        "need": needed(hours),
        **{spec.name: dict(pooled(hours, spec.name)) for spec in all_measures()},
    }


def pooled(hours: Iterable[HourRecord], measure: str) -> Pooled:
    """Pool one measure's figures over hours; those that failed, or were not measured by it, are left out."""
    spec = find_measure(measure)
    figures = [spec.read(record.success) for record in hours if record.success]
    return spec.pool([one for one in figures if one is not None])


def headline(hours: Iterable[HourRecord], measure: str) -> float | None:
    """The one figure by a measure that tables and charts show of some hours."""
    return pooled(hours, measure)[find_measure(measure).headline]
