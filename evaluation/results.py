"""The results of a benchmark as a table: one row per method and hour, in an open format that anybody can check.

A results folder holds two files. `results.json` names the runs, the version and the SHA-256 of the table. `hours.csv`
has the sorted rows, also as `hours.parquet` if pyarrow is installed. All tables, figures and statistics use these two.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from pydantic import ConfigDict, Field, ValidationError, model_validator

from coopera.core.errors import ConfigError
from coopera.core.foreign.tables import read_table
from coopera.core.hour import Evening, HourRecord
from coopera.core.naming import sha256
from coopera.core.people import Frozen
from coopera.core.success import Counts
from coopera.evaluation.measuring import F, MeasureSpec, all_measures, told_in_the_evening

FORMAT = 1
"""Raised whenever a column changes its meaning; readers refuse other numbers."""

Share = Field(None, ge=0)


class Row(Frozen):
    """One hour under one method.

    `day` is the day of the episode. `round` counts this person's earlier days in the episode. `human` is the SHA-256
    of the person's decisions in the hour; it is the same under every method. `activity` is the group of household
    activities nearest to the true intention. docs/measures.md defines the measures. The figures of
    further ones (`coopera.evaluation.measuring`) stand in further columns, MEASURE_FIGURE.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, int | float | None] = Field(init=False)

    method: str
    setting: str
    collab: int = Field(ge=1, le=2)
    seed: int = Field(ge=0)
    episode: int = Field(ge=0)
    day: int = Field(ge=0)
    round: int = Field(ge=0)
    last: bool
    """Whether this is the person's last day of the episode."""
    hour: int = Field(ge=0, le=23)
    person: str
    scene: str
    status: Literal["ok", "failed"]
    activity: str
    human: str
    predicate_tp: int | None = Share
    predicate_fp: int | None = Share
    predicate_fn: int | None = Share
    predicate_tn: int | None = Share
    predicate_unscored: int | None = Share
    judge_tp: int | None = Share
    judge_fp: int | None = Share
    judge_fn: int | None = Share
    judge_tn: int | None = Share
    judge_unscored: int | None = Share
    people_tp: int | None = Share
    people_fp: int | None = Share
    people_fn: int | None = Share
    people_tn: int | None = Share
    people_unscored: int | None = Share
    remaining: int | None = Share
    helped: int | None = Share
    done: int | None = Share
    useless: int | None = Share
    metres: float | None = Share
    saved_metres: float | None = Share
    accepted: int | None = Share

    @model_validator(mode="before")
    @classmethod
    def _of_before(cls, data: Any) -> Any:
        """Complete tables of before `accepted`: each accepted candidate is a tp or an fp of the predicate."""
        if not isinstance(data, dict) or data.get("accepted") is not None or data.get("remaining") is None:
            return data
        counts = [data.get(f"predicate_{name}") for name in ("tp", "fp")]
        given = [int(value) for value in counts if value is not None and str(value).isdigit()]
        return {**data, "accepted": sum(given)} if len(given) == len(counts) else data

    @property
    def key(self) -> tuple[Any, ...]:
        """What no two rows share, and the order of the table."""
        return (self.setting, self.collab, self.seed, self.episode, self.day, self.hour, self.method)

    def counts(self, measure: str) -> Counts | None:
        """The confusion counts by "predicate", "judge" or "people"; None in a failed hour."""
        return self._read(measure, Counts)

    def of(self, spec: MeasureSpec[F]) -> F | None:
        """The figures by a measure; None in a failed hour, and where the measure was not taken."""
        return self._read(spec.name, spec.figures)

    def _read(self, measure: str, figures: type[F]) -> F | None:
        found = {field: getattr(self, column, None) for column, field in columns_of(measure, figures).items()}
        given = {field: value for field, value in found.items() if value is not None}
        try:
            return figures.model_validate(given) if given else None
        except ValidationError as err:
            field = err.errors(include_url=False)[0]["loc"][0]
            raise ConfigError(f"{measure}_{field}: this column is missing, or not what {measure} measures.") from None


_COUNTS = ("tp", "fp", "fn", "tn", "unscored")
COLUMNS = tuple(Row.model_fields)
"""The columns that every table has; one of before `accepted` lacks that."""
_BARE = "help"  # in format 1 the columns of this measure do not bear its name
_FURTHER = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)+")


def columns_of(measure: str, figures: type[Frozen]) -> dict[str, str]:
    """Each column of a measure, and the figure in it. Rates of counts have none: they follow from the counts."""
    fields = _COUNTS if issubclass(figures, Counts) else tuple(figures.model_fields)
    return {field if measure == _BARE else f"{measure}_{field}": field for field in fields}


class Standing(Frozen):
    """Whether the primary endpoint that was stated before the first run was kept.

    Attributes:
        sha256: Of the endpoint in force and the planned sample.
        kept: Whether it was stated before the first run with a robot, and not changed since.
        words: The same in words.
    """

    sha256: str
    kept: bool
    words: str


class Fingerprints(Frozen):
    """SHA-256 of what a benchmark's runs were made with.

    Attributes:
        person: The person's model with its prompts and the settings of how people live and answer.
        judge: The judge's model with its prompts.
        household: The household files of person, robot and judge, and whether they share one.
        robot: The robot's model, body and classifier.
        prompts: All prompts.
        code: Modules, prompts and knowledge files of coopera.
        mixed: Which of these are not the same in all runs.
    """

    person: str
    judge: str
    household: str
    robot: str
    prompts: str
    code: str
    mixed: list[str] = []


class Card(Frozen):
    """What results.json says of a table."""

    format: int
    coopera: str
    name: str
    offline: bool
    """Whether the offline routine model played any role, so that the figures say nothing of language models."""
    models: dict[str, str]
    methods: list[str]
    settings: list[str]
    seeds: list[int]
    rows: int
    failed_hours: int
    sha256: str
    grid: dict[str, Any]
    endpoint: Standing | None = None
    """None in results of before endpoints were stamped, as are those below."""
    fingerprints: Fingerprints | None = None
    config: dict[str, Any] | None = None
    """What the runs shared, so far as it is not the default of settings."""


def rows_of(
    hours: Sequence[HourRecord],
    evenings: Iterable[Evening],
    activity: Callable[[str], str],
    labels: Mapping[str, Any],
) -> list[Row]:
    """The rows of one run.

    Args:
        hours: In order.
        evenings: Of the same days.
        activity: Finds the group of an intention.
        labels: method, setting, collab, seed and episode.
    """
    hours = told_in_the_evening(hours, evenings)
    lived = list(dict.fromkeys((hour.day, hour.person) for hour in hours))
    rounds = {day: sum(who == person for _, who in lived[:place]) for place, (day, person) in enumerate(lived)}
    last = {person: day for day, person in lived}
    rows = []
    for hour in hours:
        measured: dict[str, Any] = {}
        if hour.success:
            taken = {spec.name: spec.read(hour.success) for spec in all_measures()}
            for name, figures in taken.items():
                if figures is not None:
                    measured |= {at: getattr(figures, field) for at, field in columns_of(name, type(figures)).items()}
        rows.append(
            Row(
                **labels,
                day=hour.episode_day,
                round=rounds[hour.day],
                last=last[hour.person] == hour.day,
                hour=hour.hour,
                person=hour.person,
                scene=hour.scene,
                status=hour.status,
                activity=activity(hour.human.intention.text) if hour.human else "",
                human=sha256(hour.human.model_dump_json()) if hour.human else "",
                **measured,
            )
        )
    return rows


def to_csv(rows: Iterable[Row]) -> str:
    """The table as text, sorted; an empty cell is a figure that does not exist."""
    text, table = io.StringIO(), sorted(rows, key=lambda row: row.key)
    further = dict.fromkeys(name for row in table for name in row.model_extra or {})
    writer = csv.DictWriter(text, [*COLUMNS, *further], lineterminator="\n")
    writer.writeheader()
    writer.writerows(row.model_dump() for row in table)
    return text.getvalue()


def from_csv(text: str, source: str) -> list[Row]:
    """Read and check a table.

    Raises:
        ConfigError: Naming the file, the line, the column and what was expected.
    """
    lines = read_table(Path(source), text)
    names = tuple(next(lines).cells)
    fixed = COLUMNS if "accepted" in names else COLUMNS[: COLUMNS.index("accepted")]
    further = names[len(fixed) :]
    if names[: len(fixed)] != fixed or len(set(names)) < len(names) or not all(map(_FURTHER.fullmatch, further)):
        odd = sorted(set(names) ^ set(COLUMNS))
        raise ConfigError(
            f"{source}: the columns must be those of format {FORMAT}; check {', '.join(odd) or 'their order'}."
        )
    rows = []
    for number, cells in lines:
        if len(cells) != len(names):
            raise ConfigError(f"{source}, line {number}: expected {len(names)} cells, found {len(cells)}.")
        data = dict(zip(names, cells, strict=True))
        try:
            rows.append(Row.model_validate({name: value for name, value in data.items() if value != ""} | _texts(data)))
        except ValidationError as err:
            first = err.errors(include_url=False)[0]
            column = first["loc"][0] if first["loc"] else "?"
            raise ConfigError(f"{source}, line {number}: {column} cannot be {first['input']!r}.") from None
    if doubled := len(rows) - len({row.key for row in rows}):
        raise ConfigError(f"{source}: {doubled} hours stand there twice.")
    return rows


def _texts(data: Mapping[str, Any]) -> dict[str, str]:
    return {name: data[name] for name in ("activity", "human")}


def check_card(data: Any, table: str, source: str) -> Card:
    """Check a results folder's card against its table.

    Raises:
        ConfigError: If the card is of another format, incomplete, or not of this table.
    """
    found = data.get("format") if isinstance(data, dict) else None
    if found != FORMAT:
        raise ConfigError(f"{source}: the results are of format {found}, and this coopera reads format {FORMAT}.")
    try:
        card = Card.model_validate(data)
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        raise ConfigError(f"{source}: the field {where} is missing or wrong ({first['msg'].lower()}).") from None
    if card.sha256 != sha256(table):
        raise ConfigError(f"{source}: hours.csv is not the table that this card describes (its SHA-256 differs).")
    return card


def unpaired(rows: Iterable[Row]) -> list[str]:
    """Hours in which the person did not do the same under every method; empty where all comparisons are paired."""
    humans: dict[tuple[Any, ...], set[str]] = {}
    for row in rows:
        humans.setdefault(row.key[:-1], set()).add(row.human)
    return [
        f"setting {setting} type {collab} seed {seed} episode {episode} day {day} hour {hour}"
        for (setting, collab, seed, episode, day, hour), seen in sorted(humans.items())
        if len(seen) > 1
    ]
