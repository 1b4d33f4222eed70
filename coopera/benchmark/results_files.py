"""The result files of a benchmark: the table of its hours, the card with its description, tables and figures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from markupsafe import Markup

from coopera.benchmark.grid_runs import Benchmark, gather
from coopera.benchmark.results_page import CARD, TABLE, shown
from coopera.benchmark.stated import FILE
from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import RunError
from coopera.evaluation.analysis import endpoint_of, plain
from coopera.evaluation.figures import all_figures
from coopera.evaluation.results import Card, Row, to_csv, unpaired
from coopera.evaluation.table import Table
from coopera.evaluation.tables import all_tables
from coopera.report.environment import environment
from coopera.report.look import TEMPLATES, style_with
from coopera.report.policy import content_policy

PARQUET = "hours.parquet"


def write_results(bench: Benchmark) -> dict[str, Any]:
    """Write the results folder of a benchmark, from the runs that are done; returns what it holds.

    Raises:
        RunError: If nothing is done, or the folder cannot be written.
    """
    rows, card, seconds = gather(bench)
    if odd := unpaired(rows):
        raise RunError(f"{bench.root}: methods met different days in {len(odd)} hours, first in {odd[0]}.")
    folder = bench.root / "results"
    try:
        write_atomic(folder / TABLE, to_csv(rows))
        write_atomic(folder / CARD, canonical_json(card.model_dump()))
        write_atomic(folder / "timings.csv", _timings(seconds))
        if (bench.root / FILE).is_file():
            write_atomic(folder / FILE, (bench.root / FILE).read_text(encoding="utf-8"))
        _write_parquet(folder)
        page = write_views(folder, card, rows, left=len(bench.left), total=len(bench.jobs))
    except OSError as err:
        raise RunError(f"{folder}: the results cannot be written ({reason(err)}).") from err
    return {"page": str(page), "rows": len(rows)}


def write_views(folder: Path, card: Card, rows: list[Row], *, left: int = 0, total: int = 0) -> Path:
    """Write tables (Markdown and LaTeX), figures (SVG) and the page that holds all of them; returns the page's path.

    Raises:
        OSError: If the folder cannot be written.
    """
    tables, figures = all_tables(rows, card.methods, endpoint_of(card)), all_figures(plain(rows), card.methods)
    head = f"# Results of {card.name}\n\n{_coverage(card, rows, left, total)}\n\n"
    drawn = "".join(f"![{name}](figures/{name}.svg)\n\n" for name in figures)
    write_atomic(folder / "tables.md", head + drawn + "\n".join(table.markdown() for table in tables))
    write_atomic(folder / "tables.tex", "\n".join(table.latex() for table in tables))
    for name, svg in figures.items():
        write_atomic(folder / "figures" / f"{name}.svg", svg)
    page = folder / "index.html"
    write_atomic(page, _page(card, _coverage(card, rows, left, total), rows, tables, list(figures)))
    return page


def _coverage(card: Card, rows: list[Row], left: int, total: int) -> str:
    """In words, what these results are of."""
    people, scenes = {row.person for row in rows}, {row.scene for row in rows}
    days = {(row.setting, row.collab, row.seed, row.episode, row.day) for row in rows}
    parts = [
        f"{len(card.methods)} methods on the same {len(days)} person-days ({len(people)} people, homes: {len(scenes)},",
        f"settings: {', '.join(card.settings)}, seeds: {len(card.seeds)}):",
        f"{card.rows} hours, {card.failed_hours} of them failed and in no figure.",
    ]
    if card.endpoint:
        parts.append(f"Primary endpoint: {card.endpoint.words}.")
    if left:
        parts.append(
            f"Not complete: {left} of {total} runs are still to be done; lives that not all methods have met are "
            "left out where there are whole ones."
        )
    if card.offline:
        parts.append("The offline routine model played a role: these figures say nothing about language models.")
    return " ".join(parts)


def _page(card: Card, coverage: str, rows: list[Row], tables: list[Table], figures: list[str]) -> str:
    """The page as text; `figures` are the names of the drawings for a paper that lie beside it."""
    style = style_with("benchmark.css")
    script = "".join((TEMPLATES / name).read_text(encoding="utf-8") for name in ("theme.js", "tables.js"))
    return (
        environment()
        .get_template("benchmark.html.j2")
        .render(
            **shown(card, rows, tables),
            coverage=coverage,
            drawn=figures,
            style=Markup(style),
            script=Markup(script),
            policy=content_policy(styles=[style], scripts=[script]),
        )
    )


def _timings(seconds: dict[str, list[float]]) -> str:
    """Latency by method: differs from machine to machine, so it stands apart from what can be compared."""
    lines = ["method,hours,mean_seconds,max_seconds"]
    for method, each in sorted(seconds.items()):
        mean = sum(each) / len(each) if each else 0.0
        lines.append(f"{method},{len(each)},{mean:.4f},{max(each, default=0.0):.4f}")
    return "\n".join(lines) + "\n"


def _write_parquet(folder: Path) -> None:
    """The same table as Parquet, where pyarrow is installed (the optional extra `parquet`)."""
    try:
        from pyarrow import csv, parquet  # noqa: PLC0415 - an optional extra
    except ImportError:
        return
    parquet.write_table(csv.read_csv(folder / TABLE), folder / PARQUET)
