"""What a benchmark leaves behind: the table of its hours, the card that describes it, and what is drawn from them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from coopera.benchmark import Benchmark, gather
from coopera.files import canonical_json, read_text, reason, write_atomic
from coopera.trace_files import read_json
from core.errors import ConfigError, RunError
from evaluation.results import Card, Row, check_card, from_csv, to_csv

CARD, TABLE, PARQUET = "results.json", "hours.csv", "hours.parquet"


def write_results(bench: Benchmark) -> dict[str, Any]:
    """Write the results folder of a benchmark, from the runs that are done; returns what it holds.

    Raises:
        RunError: If nothing is done, or the folder cannot be written.
    """
    rows, card, seconds = gather(bench)
    folder = bench.root / "results"
    try:
        write_atomic(folder / TABLE, to_csv(rows))
        write_atomic(folder / CARD, canonical_json(card.model_dump()))
        write_atomic(folder / "timings.csv", _timings(seconds))
        _write_parquet(folder)
    except OSError as err:
        raise RunError(f"{folder}: the results cannot be written ({reason(err)}).") from err
    return {"page": str(folder), "rows": len(rows)}


def read_results(folder: Path) -> tuple[Card, list[Row]]:
    """Read and check a results folder.

    Raises:
        ConfigError: If a file is missing, of another format, or not what its card describes.
    """
    if not (folder / CARD).is_file():
        raise ConfigError(f"{folder}: this folder holds no results (there is no {CARD} in it).")
    table = read_text(folder / TABLE, "table of results")
    try:
        data = read_json(folder / CARD)
    except RunError as err:
        raise ConfigError(str(err)) from None
    return check_card(data, table, str(folder / CARD)), from_csv(table, str(folder / TABLE))


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
