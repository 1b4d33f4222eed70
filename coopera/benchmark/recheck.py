"""A submission run again by the keeper of a board, on hidden seeds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from coopera.benchmark.checked import Check, compare_hidden, hidden_seeds
from coopera.benchmark.grid_runs import Benchmark, gather, plan, shared_config
from coopera.core.errors import ConfigError
from coopera.evaluation.grid import Grid, read_grid
from coopera.evaluation.results import Card, Row


def plan_again(
    card: Card, rows: Sequence[Row], out: Path, secret: bytes, seeds: int, flags: dict[str, Any]
) -> Benchmark:
    """The submission's grid on hidden seeds, without controls.

    Args:
        card: The submission's.
        rows: Its rows.
        out: The keeper's folder.
        secret: The keeper's.
        seeds: How many hidden seeds.
        flags: What differs on the keeper's machine, such as the address of a server.

    Raises:
        ConfigError: If the card does not say how it was made, or this machine has other people or homes.
    """
    if card.config is None:
        raise ConfigError(
            f"{card.name}: these results are older than the check: their card does not say how to make them."
        )
    before = read_grid(card.grid, f"{card.name}: grid")
    grid = before.model_copy(
        update={"seeds": hidden_seeds(secret, card, seeds), "with_shared": [], "noise": 0, "methods": card.methods}
    )
    config = shared_config(Grid(run=card.config), None, flags)
    bench = plan(grid, out, config)
    if odd := _other_days(bench, rows):
        raise ConfigError(f"{card.name}: here {odd}; bring in the submission's people and homes first.")
    return bench


def _other_days(bench: Benchmark, rows: Sequence[Row]) -> str | None:
    """Where the people or homes of the planned days are not the submission's."""
    theirs = {(row.setting, row.collab, row.episode, row.day): (row.person, row.scene) for row in rows}
    planned = {
        (job.labels["setting"], job.labels["collab"], job.labels["episode"], day): where
        for job in bench.jobs
        for day, where in enumerate(job.config.schedule or [])
    }
    for key, where in sorted(theirs.items()):
        if planned.get(key) != where:
            here = " in ".join(planned.get(key, ("nobody", "no home")))
            return f"day {key[3]} of episode {key[2]} of setting {key[0]} is of {here}, not of {' in '.join(where)}"
    return None


def check_again(card: Card, rows: Sequence[Row], bench: Benchmark) -> Check:
    """Compare the submission with the runs on hidden seeds, which must be done."""
    hidden, other, _ = gather(bench)
    return compare_hidden(card, rows, hidden, other)
