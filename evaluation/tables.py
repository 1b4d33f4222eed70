"""Tables in the paper's layout, as Markdown and as LaTeX."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from coopera.core.hour import Counts
from coopera.evaluation import paper
from coopera.evaluation.analysis import PEOPLE, Cell, agreement, comparisons, curve, effort, generalisation, last_day
from coopera.evaluation.measuring import all_measures, find_measure
from coopera.evaluation.results import Row

REFERENCE = "ours"
FRESH = "untrained"
NONE = "–"
_TYPES = {1: "type 1", 2: "type 2"}


class Table(NamedTuple):
    """A table: cells are text, the first column names the row."""

    name: str
    title: str
    columns: list[str]
    rows: list[list[str]]
    note: str = ""

    def markdown(self) -> str:
        """As Markdown."""
        lines = [f"### {self.title}", "", _line(self.columns), "|" + "---|" * len(self.columns)]
        lines += [_line(row) for row in self.rows]
        return "\n".join([*lines, "", *([self.note, ""] if self.note else [])])

    def latex(self) -> str:
        """As a LaTeX table for the package booktabs."""
        body = [" & ".join(map(_tex, row)) + r" \\" for row in self.rows]
        head = " & ".join(map(_tex, self.columns)) + r" \\"
        parts = [r"\begin{table}[t]", r"\centering\footnotesize", rf"\caption{{{_tex(self.title)}. {_tex(self.note)}}}"]
        parts += [rf"\begin{{tabular}}{{@{{}}l{'c' * (len(self.columns) - 1)}@{{}}}}", r"\toprule", head, r"\midrule"]
        return "\n".join(
            [*parts, *body, r"\bottomrule", r"\end{tabular}", rf"\label{{tab:{self.name}}}", r"\end{table}", ""]
        )


def all_tables(rows: Sequence[Row], methods: Sequence[str]) -> list[Table]:
    """Every table that the rows allow, methods in the given order."""
    tables = [
        *[last_day_table(rows, methods, measure) for measure in _measures(rows)],
        paper_table(rows, methods),
        comparison_table(rows, methods),
        order_table(rows),
        effort_table(rows, methods),
        generalisation_table(rows),
        agreement_table(rows, methods),
        activity_table(rows, methods),
    ]
    return [table for table in tables if table.rows]


def _measures(rows: Sequence[Row]) -> list[str]:
    """Every measure that some row has, the person's own after the predicate and the judge."""
    taken = [spec for spec in all_measures() if any(row.of(spec) is not None for row in rows)]
    counted = [spec.name for spec in taken if issubclass(spec.figures, Counts)]
    return [*counted, PEOPLE, *(spec.name for spec in taken if spec.name not in counted)]


def last_day_table(rows: Sequence[Row], methods: Sequence[str], measure: str) -> Table:
    """A measure on each person's last day, by setting and type."""
    places = sorted({(row.setting, row.collab) for row in rows})
    found = {place: last_day([row for row in rows if (row.setting, row.collab) == place], measure) for place in places}
    lines = [[method, *(_cell(found[place].get(method)) for place in places)] for method in methods]
    spec = None if measure == PEOPLE else find_measure(measure)
    what = f"F1 by {measure}" if spec is None or issubclass(spec.figures, Counts) else spec.title.capitalize()
    return Table(
        f"last_day_{measure}",
        f"{what} on each person's last day",
        ["method", *(f"S{setting} {_TYPES[collab]}" for setting, collab in places)],
        lines,
        "Mean over people's last days with a 95 % bootstrap interval clustered by person and home; n in parentheses. "
        "Where all are of one person there is no interval.",
    )


def paper_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """The paper's ablation table, ours beside theirs, both types together."""
    settings = sorted({row.setting for row in rows} & {"1", "2", "3", "4"})
    found = {setting: last_day([row for row in rows if row.setting == setting]) for setting in settings}
    lines: list[list[str]] = []
    for method in [name for name in (*paper.LAST_DAY, *methods) if settings and name in methods]:
        if method in [line[0] for line in lines]:
            continue
        cells = []
        for setting in settings:
            cell, theirs = found[setting].get(method), paper.LAST_DAY.get(method, {}).get(setting)
            cells += [f"{cell.interval.mean:.3f}" if cell else NONE, f"{theirs:.3f}" if theirs else NONE]
        lines.append([method, *cells])
    heads = [head for setting in settings for head in (f"S{setting}", f"S{setting} paper")]
    return Table(
        "paper",
        "Predicate success on the last day, mean of both types, beside the paper",
        ["method", *heads],
        lines,
        "The paper's baselines have no published numbers, only plots. Models differ, so levels are not comparable.",
    )


def comparison_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """Each method against ours on the same days, all settings and types together."""
    lines = [
        [
            found.method,
            f"{found.difference.mean:+.3f} [{found.difference.low:+.3f}, {found.difference.high:+.3f}]",
            f"{found.p:.4f}",
            f"{found.p_holm:.4f}",
            str(found.people),
            f"{found.detectable:.3f}" if found.detectable is not None else NONE,
        ]
        for found in sorted(comparisons(rows, REFERENCE), key=lambda one: list(methods).index(one.method))
    ]
    return Table(
        "comparisons",
        f"Difference to {REFERENCE} in predicate F1 on the same last days",
        ["method", "difference", "p", "p (Holm)", "people", "detectable"],
        lines,
        "Sign-flip permutation test over people, two-sided; the smallest p that it can give is 2 / 2^people. "
        "Detectable: the true difference found with 80 % power at this scatter.",
    )


def order_table(rows: Sequence[Row]) -> Table:
    """Where the order of methods is the paper's."""
    lines = []
    for better, worse, where in paper.ORDER:
        pair = [row for row in rows if row.method in (better, worse)]
        for found in comparisons(pair, worse):
            agrees = "yes" if found.difference.mean > 0 else "no"
            sure = "" if found.p < 0.05 else " (not significant)"
            gap = f"{found.difference.mean:+.3f} [{found.difference.low:+.3f}, {found.difference.high:+.3f}]"
            lines.append([f"{better} > {worse}", where, gap, f"{found.p:.4f}", agrees + sure])
    return Table(
        "order",
        "The paper's order of methods, and ours",
        ["the paper says", "where", "our difference", "p", "agrees"],
        lines,
        "Predicate F1 on last days, all settings and types together; p uncorrected.",
    )


def effort_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """What the person got per hour."""
    found = effort(rows)
    lines = [[method, *(f"{value:.2f}" for value in found[method])] for method in methods if method in found]
    columns = ["method", "tasks helped", "metres saved", "false help"]
    return Table("effort", "Per hour: the person's effort saved, and false help", columns, lines, "All days.")


def generalisation_table(rows: Sequence[Row]) -> Table:
    """An unseen home and an unseen person."""
    lines = []
    for what, setting in (("scene", "2"), ("human", "3+1")):
        found = generalisation(rows, setting, REFERENCE, FRESH)
        if found:
            theirs = paper.GENERALISATION[what]
            lines.append([what, _cell(found[0]), _cell(found[1]), f"{theirs[0]:.3f}", f"{theirs[1]:.3f}"])
    return Table(
        "generalisation",
        "Generalisation: a fresh robot, and one that has learned elsewhere, on the same unseen day",
        ["unseen", "fresh", "learned", "paper: fresh", "paper: learned"],
        lines,
        "Scene: day 4 of setting 2, after four other homes. Human: a stranger after nine days with three others.",
    )


def agreement_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """L1 of predicate and judge to the person's own answers."""
    settings = sorted({row.setting for row in rows})
    lines = []
    for measure in ("predicate", "judge"):
        for method in methods:
            found = [agreement([r for r in rows if r.method == method and r.setting == s], measure) for s in settings]
            if any(value is not None for value in found):
                lines.append([f"{measure}, {method}", *(NONE if v is None else f"{v:.3f}" for v in found)])
        theirs = [paper.L1[measure].get(setting) for setting in settings]
        lines.append([f"{measure}, paper (real people)", *(NONE if v is None else f"{v:.3f}" for v in theirs)])
    return Table(
        "agreement",
        "L1 between automatic success and the person's own evening answers, hour by hour",
        ["measure, method", *(f"S{setting}" for setting in settings)],
        lines,
        "Here the person is simulated; the paper's rows are of real people.",
    )


def activity_table(rows: Sequence[Row], methods: Sequence[str]) -> Table:
    """Predicate F1 by activity."""
    found = curve(rows, lambda row: row.activity)
    activities = sorted({str(name) for by in found.values() for name in by} - {""})
    hours = {name: sum(row.activity == name for row in rows if row.method == REFERENCE) for name in activities}
    lines = [
        [name, str(hours[name]), *(f"{found[m][name]:.3f}" if name in found.get(m, {}) else NONE for m in methods)]
        for name in sorted(activities, key=lambda name: -hours[name])
    ]
    columns = ["activity", "hours", *methods]
    return Table("activities", "Predicate F1 by activity, all days", columns, lines, "Hours pooled; no intervals.")


def _cell(cell: Cell | None) -> str:
    if cell is None:
        return NONE
    mean, low, high = cell.interval
    return f"{mean:.3f} [{low:.3f}, {high:.3f}] ({cell.n})" if low < high else f"{mean:.3f} ({cell.n})"


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _tex(text: str) -> str:
    for char in "&%_#$":
        text = text.replace(char, f"\\{char}")
    return text.replace("–", "--").replace("^", r"\^{}").replace(">", "$>$").replace("<", "$<$")
