"""Results of several groups side by side, ranked where they can be: among the same person, judge and household.

Every results folder under a folder is checked before it is shown. A ranking holds results of one person-model, one
judge, one household and one model of the robot, on the same setting with as many and as long days.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from coopera.benchmark.checked import Check, read_check
from coopera.benchmark.results_page import CARD, read_results
from coopera.core.errors import ConfigError
from coopera.evaluation.analysis import Endpoint, endpoint_of, last_day, late_units, plain, variants
from coopera.evaluation.comparing import Noise, clustered_mean, noise
from coopera.evaluation.grid import OF, SHARED
from coopera.evaluation.results import Card, Row
from coopera.evaluation.statistics import Mean

UNKNOWN = "not known"


class Terms(NamedTuple):
    """What results must have in common to be ranked; fingerprints are cut to eight letters."""

    setting: str
    collab: int
    person: str
    judge: str
    household: str
    robot: str
    endpoint: str
    days: int
    hours: int

    def __str__(self) -> str:
        """As a heading."""
        return (
            f"Setting {self.setting}, type {self.collab}, days of a person: {self.days}, hours: {self.hours}; "
            f"person {self.person}; judge {self.judge}; household {self.household}; robot's model {self.robot}; "
            f"{self.endpoint}"
        )


class Entry(NamedTuple):
    """One method of one results folder in one ranking; an interval of too few people has no ends.

    Attributes:
        score: The primary endpoint: by default need F1, mean of the late days.
        noise: Its noise floor; None with a single seed.
        tied: Whether it is within the noise of the one before it.
        success: The paper's endpoint: predicate F1 on last days.
        kept: Whether the endpoint was stated before the first run and kept; None where that was not noted.
        hidden: What came of hidden seeds: agrees, DIFFERS, or not checked; without the secret as the folder claims.
        mixed: What was not the same in all its runs.
    """

    terms: Terms
    results: str
    method: str
    score: float | None
    low: float | None
    high: float | None
    noise: float | None
    tied: bool
    success: float
    success_low: float | None
    success_high: float | None
    people: int
    n: int
    kept: bool | None
    hidden: str
    code: str
    prompts: str
    mixed: list[str]


def entries(folder: Path, secret: bytes | None = None) -> list[Entry]:
    """Read all results below a folder, ranking by ranking, best first.

    Args:
        folder: Holds results folders at any depth.
        secret: The keeper's, by which hidden-seed checks are known to be the keeper's own.

    Raises:
        ConfigError: If there are none, or one of them is damaged or of another format; names the file.
    """
    cards = sorted(folder.rglob(CARD))
    if not cards:
        raise ConfigError(f"{folder}: no results are in this folder (no {CARD}, at any depth).")
    found: list[Entry] = []
    for path in cards:
        card, rows = read_results(path.parent)
        name = card.name if path.parent == folder else path.parent.relative_to(folder).as_posix()
        hidden = read_check(path.parent, card.sha256, secret)
        for setting, collab in sorted({(row.setting, row.collab) for row in rows}):
            chosen = [row for row in rows if (row.setting, row.collab) == (setting, collab)]
            found += _entries(name, card, chosen, hidden)
            found += _entries(name, card, chosen, None, shared=True)
    return _tied(sorted(found, key=_rank))


def _entries(name: str, card: Card, rows: Sequence[Row], hidden: Check | None, *, shared: bool = False) -> list[Entry]:
    """Of one setting and type; `shared` takes the control with shared common sense, which is another household."""
    chosen = variants(rows, SHARED) if shared else plain(rows)
    if not chosen:
        return []
    endpoint, marks = endpoint_of(card), card.fingerprints
    late, terms = late_units(chosen, endpoint.measure, endpoint), _terms(card, chosen, endpoint, shared=shared)
    found = []
    for method, cell in last_day(chosen).items():
        mean = clustered_mean(list(late[method].values())) if method in late else Mean(0, None, None, 0)
        floor: Noise | None = noise(late[method]) if method in late else None
        found.append(
            Entry(
                terms=terms,
                results=name,
                method=f"{method}{OF}{SHARED}" if shared else method,
                score=mean.mean if mean.people else None,
                low=mean.low,
                high=mean.high,
                noise=floor.floor if floor else None,
                tied=False,
                success=cell.interval.mean,
                success_low=cell.interval.low,
                success_high=cell.interval.high,
                people=len({row.person for row in chosen}),
                n=cell.n,
                kept=card.endpoint.kept if card.endpoint else None,
                hidden=hidden.of(method, terms.setting, terms.collab) if hidden else "not checked",
                code=_short(marks.code) if marks else UNKNOWN,
                prompts=_short(marks.prompts) if marks else UNKNOWN,
                mixed=marks.mixed if marks else [],
            )
        )
    return found


def _terms(card: Card, rows: Sequence[Row], endpoint: Endpoint, *, shared: bool) -> Terms:
    marks, models = card.fingerprints, card.models

    def of(role: str, mark: str | None) -> str:
        return f"{models.get(role, UNKNOWN)} ({_short(mark) if mark else UNKNOWN})"

    household = (card.config or {}).get("household", "own") if marks else UNKNOWN
    last = {None: "the late third", 1: "the last day"}.get(endpoint.late, f"the last {endpoint.late} days")
    return Terms(
        rows[0].setting,
        rows[0].collab,
        of("human", marks.person if marks else None),
        of("judge", marks.judge if marks else None),
        SHARED if shared else f"{household} ({_short(marks.household)})" if marks else UNKNOWN,
        models.get("robot", UNKNOWN),
        f"{endpoint.title}, mean of {last}",
        1 + max(row.round for row in rows),
        len({row.hour for row in rows}),
    )


def _tied(ranked: Sequence[Entry]) -> list[Entry]:
    """Mark whoever is within the noise of the one before; of a difference the floors add up as squares."""
    found: list[Entry] = []
    for one in ranked:
        before = found[-1] if found and found[-1].terms == one.terms else None
        if before and None not in (before.score, one.score, before.noise, one.noise):
            gap = (before.score or 0) - (one.score or 0)
            one = one._replace(tied=gap < ((before.noise or 0) ** 2 + (one.noise or 0) ** 2) ** 0.5)
        found.append(one)
    return found


def _short(mark: str) -> str:
    return mark[:8]


def _rank(one: Entry) -> tuple[object, ...]:
    return one.terms, -(one.score if one.score is not None else -1.0), -one.success, one.results, one.method
