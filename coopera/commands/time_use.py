"""The part of `coopera analyse humans` that compares people's hours with a table of time use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from coopera.core.errors import ConfigError

if TYPE_CHECKING:
    from coopera.evaluation.people.figures import Figure
    from coopera.evaluation.people.hours_spent import SpentDay
    from coopera.evaluation.people.lives import Lives
    from coopera.evaluation.people.time_use import TimeUse
    from coopera.evaluation.people.time_use_distance import HourRow


def open_table(name: str | None, stratum: str | None) -> TimeUse | None:
    """The table that `--time-use` names, of one stratum if `--stratum` names one; None without `--time-use`.

    Raises:
        ConfigError: If the table cannot be used or has no such stratum.
    """
    from coopera.evaluation.people.time_use import named_time_use

    if name is None:
        if stratum is not None:
            raise ConfigError("--stratum: it names people in a table, so it needs --time-use as well.")
        return None
    table = named_time_use(name)
    return table if stratum is None else table.only(stratum)


@dataclass(frozen=True, slots=True)
class Compared:
    """What was found, by how the person was simulated where it says `days`."""

    figures: list[Figure]
    rows: list[HourRow]
    days: dict[str, list[SpentDay]]
    table: TimeUse

    def write(self, out: Path, caption: str) -> None:
        """Write time-use.csv and time-use.png.

        Raises:
            ConfigError: If the folder cannot be written.
        """
        from coopera.evaluation.people.time_use_distance import HourRow
        from coopera.evaluation.people.time_use_plot import draw_time_use
        from coopera.rundir.lives import write_rows

        write_rows(out / "time-use.csv", self.rows, HourRow._fields)
        draw_time_use(self.days, self.table, out / "time-use.png", caption)

    def written_to(self, out: Path) -> str:
        """Where what was written stands, as a line for the screen."""
        return (
            f"Time use: {out}/time-use.png, hour by hour in {out}/time-use.csv, by category in {out}/people.md\n"
            f"Table: {self.table.source}"
        )


def compare(variants: Mapping[str, Lives], table: TimeUse, *, seed: int, tell: Callable[[str], None]) -> Compared:
    """Compare the hours of each variant of the simulated person with a table.

    What an intention is about is recognised with the bundled encoder, whatever `--encoder` says: what counts as
    television must not hang on it.
    """
    from coopera.config.schema import load_config
    from coopera.evaluation.people.figures import as_variant
    from coopera.evaluation.people.hours_spent import ActivityUses, recognised, spent
    from coopera.evaluation.people.rhythm import rhythm
    from coopera.evaluation.people.time_use_distance import hour_rows, time_use_figures, within_table
    from coopera.models.offline.household.knowledge import shipped
    from coopera.models.offline.household.sense import CommonSense
    from coopera.studies.assemble import open_embeddings

    found = Compared([], [], {}, table)
    with open_embeddings(load_config()) as embeddings:
        uses = ActivityUses(CommonSense(shipped(), embeddings))
        for variant, lives in variants.items():
            tell(f"{variant}: what hours are spent on")
            days = found.days[variant] = [spent(day, uses) for day in lives.days]
            figures = [*time_use_figures(days, table, seed=seed), recognised(lives, uses)]
            figures += rhythm(lives, uses.activity, seed=seed)
            found.figures.extend(as_variant(figures, variant))
            found.rows.extend(hour_rows(days, table, variant))
    found.figures.extend(within_table([day for days in found.days.values() for day in days], table))
    return found
