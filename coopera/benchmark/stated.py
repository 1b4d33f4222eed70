"""What a benchmark is to show, stamped before its first run: `endpoint.json`, and whether it was kept.

A statement is the primary endpoint with its test and its correction, and the planned sample. Its SHA-256 is the same
whenever and wherever it is made, so it can be published beforehand. The file only grows. It is a record for honest
people: whoever can write the folder can forge it, unless the hash was published.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import ConfigError, RunError
from coopera.core.naming import sha256
from coopera.core.people import Frozen
from coopera.evaluation.grid import Grid
from coopera.evaluation.results import Standing
from coopera.rundir.about import now
from coopera.rundir.trace_files import damaged, read_json

FILE = "endpoint.json"


class Statement(Frozen):
    """What was stated at one time.

    Attributes:
        endpoint: Measure, days, methods compared, test and correction.
        sample: Methods, settings, people, homes, seeds, days and hours.
        sha256: Of both.
        time: When, in UTC.
        begun: How many runs with a robot had begun by then.
    """

    endpoint: dict[str, Any]
    sample: dict[str, Any]
    sha256: str
    time: str
    begun: int


_FILE = TypeAdapter(list[Statement])


def statement(grid: Grid, lives: Sequence[tuple[int, Sequence[tuple[str, str]]]], begun: int) -> Statement:
    """What a grid states now.

    Args:
        grid: What is covered.
        lives: The seed of each life, and the person and the home of each of its days.
        begun: How many runs with a robot have begun.
    """
    endpoint = endpoint_of(grid)
    sample = {
        **grid.model_dump(mode="json", include={"methods", "settings", "collab", "hours"}),
        "people": sorted({person for _, days in lives for person, _ in days}),
        "homes": sorted({home for _, days in lives for _, home in days}),
        "seeds": sorted({seed for seed, _ in lives}),
        "person_days": sum(len(days) for _, days in lives),
    }
    return Statement(endpoint=endpoint, sample=sample, sha256=_mark(endpoint, sample), time=now(), begun=begun)


def endpoint_of(grid: Grid) -> dict[str, Any]:
    """The primary endpoint as a statement has it."""
    return {**grid.endpoint.model_dump(), **grid.model_dump(mode="json", include={"late_days", "early_days"})}


def _mark(endpoint: dict[str, Any], sample: dict[str, Any]) -> str:
    return sha256(canonical_json({"endpoint": endpoint, "sample": sample}))


def read_statements(root: Path) -> list[Statement]:
    """What was stated in a benchmark's folder, oldest first; nothing in one of before this was noted.

    Raises:
        RunError: If the file is damaged, or a statement is not what its hash says.
    """
    path = root / FILE
    if not path.is_file():
        return []
    try:
        found = _FILE.validate_python(read_json(path))
    except ValidationError as err:
        raise damaged(path, err) from err
    for number, one in enumerate(found):
        if one.sha256 != _mark(one.endpoint, one.sample):
            raise RunError(f"{path}: statement {number} was altered, since its SHA-256 is another; restore the file.")
    return found


def state(root: Path, today: Statement, former: dict[str, Any] | None, *, restate: bool = False) -> Statement:
    """Write what is stated today, if it is not what the folder says already.

    Args:
        root: The benchmark's folder.
        today: What its grid states.
        former: The endpoint that the folder's grid had, where nothing is stamped yet.
        restate: Whether the endpoint may differ although runs have begun; the results then say so for good.

    Raises:
        ConfigError: If it differs and may not, or cannot be written.
    """
    stated = read_statements(root)
    if not stated and former is not None and former != today.endpoint:
        old = {"endpoint": former, "sample": today.sample, "sha256": _mark(former, today.sample)}
        stated = [today.model_copy(update=old)]
    if stated and stated[-1].sha256 == today.sha256:
        return stated[-1]
    if stated and today.begun and not restate and (odd := _changes(stated[-1].endpoint, today.endpoint)):
        raise ConfigError(
            f"out: {root} has another endpoint, and {today.begun} of its runs have begun ({odd[0]}); choose another "
            "folder, or change it with --restate, which the results will say."
        )
    try:
        write_atomic(root / FILE, canonical_json([one.model_dump() for one in (*stated, today)]))
    except OSError as err:
        raise ConfigError(f"out: {root} cannot be written ({reason(err)}).") from err
    return today


def standing(statements: Sequence[Statement]) -> Standing | None:
    """Whether what was stated before the first run was kept; None where nothing was stated.

    The words hold no time, so that the same study gives the same tables; `endpoint.json` has it.
    """
    if not statements:
        return None
    last = statements[-1]
    before = [one for one in statements if not one.begun]
    late = f"Stated when {statements[0].begun} runs had begun already"
    words = "Stated before the first run" if before else late
    first = before[-1] if before else statements[0]
    after = statements[statements.index(first) + 1 :]
    changed, enlarged = [], []
    for older, newer in zip([first, *after], after, strict=False):
        changed += [f"{odd}, when {newer.begun} runs had begun" for odd in _changes(older.endpoint, newer.endpoint)]
        enlarged += [f"{odd}, when {newer.begun} runs had begun" for odd in _changes(older.sample, newer.sample)]
    words += f", and CHANGED: {'; '.join(changed)}" if changed else " and kept" if before else ""
    words += f"; the sample was changed: {'; '.join(enlarged)}" if enlarged else ""
    kept = bool(before) and not changed
    return Standing(sha256=last.sha256, kept=kept, words=f"{words} (SHA-256 {last.sha256[:12]}…)")


def _changes(older: dict[str, Any], newer: dict[str, Any]) -> list[str]:
    return [
        f"{name} was {_words(older.get(name))}, is {_words(newer.get(name))}"
        for name in newer
        if older.get(name) != newer.get(name)
    ]


def _words(value: Any) -> str:
    if isinstance(value, list):
        return ",".join(map(str, value)) if len(value) <= 6 else f"{len(value)} of them"
    return "the default" if value is None else str(value)
