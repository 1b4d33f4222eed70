"""One table of results, as Markdown and as LaTeX, and how figures stand in its cells."""

from __future__ import annotations

from typing import NamedTuple

from coopera.evaluation.analysis import Cell
from coopera.evaluation.statistics import Mean

NONE = "–"


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


def cell(found: Cell | None) -> str:
    """A mean with its interval and of how many episodes' people it is."""
    if found is None:
        return NONE
    mean = found.interval
    return f"{mean.mean:.3f} ({found.n})" if mean.low is None else f"{mean} ({found.n})"


def signed(found: Mean) -> str:
    """A difference with its interval."""
    if found.low is None or found.high is None:
        return f"{found.mean:+.3f} {found.interval}"
    return f"{found.mean:+.3f} [{found.low:+.3f}, {found.high:+.3f}]"


def _line(cells: list[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _tex(text: str) -> str:
    for char in "&%_#$":
        text = text.replace(char, f"\\{char}")
    return text.replace("–", "--").replace("^", r"\^{}").replace(">", "$>$").replace("<", "$<$")
