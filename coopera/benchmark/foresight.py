"""What a planned benchmark would find: its endpoint's test in simulated studies of its very people, homes and seeds."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from coopera.benchmark.grid_runs import Benchmark
from coopera.benchmark.results_page import read_results
from coopera.core.errors import ConfigError
from coopera.evaluation.analysis import Endpoint
from coopera.evaluation.comparing import people_needed
from coopera.evaluation.power.power import Forecast, Sample, Simulated, by_people, foresee
from coopera.evaluation.power.scatter import ASSUMED, Seen, seen

NONE = "–"


class Foresight(NamedTuple):
    """A forecast with what it is of.

    Attributes:
        lives: How many lives a person has on average.
        late: How many late days a life has on average.
        by_people: The detectable difference of the method that scatters most, by the number of people.
        source: Where the scatter is from, in words.
    """

    endpoint: Endpoint
    forecast: Forecast
    lives: float
    late: float
    by_people: dict[int, Simulated | None]
    source: str


def foresight(bench: Benchmark, results: Path | None = None) -> Foresight:
    """Simulate a planned benchmark.

    Args:
        bench: As planned; nothing of it is written or run.
        results: Finished results whose scatter is taken; a method that is not in them gets the assumed one.

    Raises:
        ConfigError: If the benchmark compares nothing, or the results have nothing of what it compares.
    """
    endpoint = Endpoint.of(bench.grid.model_dump(mode="json"))
    # variants of a method are none themselves
    methods = list(dict.fromkeys(job.config.method for job in bench.jobs if job.after is not None))
    others = [name for name in endpoint.against or methods if name != endpoint.reference]
    if endpoint.reference not in methods or not others:
        raise ConfigError(
            f"power: nothing is compared with {endpoint.reference}; name it and at least one more in methods."
        )
    known = _seen(results, endpoint, others) if results else {}
    scatters = {name: known[name].scatter if name in known else ASSUMED for name in others}
    sample = _sample(bench, endpoint)
    test, correction = endpoint.test, endpoint.correction
    forecast = foresee(sample, scatters, test=test, correction=correction, results=known)
    sizes = by_people(sample, list(scatters.values()), test=test, correction=correction)
    days = [late for each in sample.lives for late in each]
    assumed = [name for name in others if name not in known]
    parts = [f"scatter of {', '.join(known)} from {results}"] if known else []
    parts += [f"assumed for {', '.join(assumed)}"] if known and assumed else ["scatter assumed"] if assumed else []
    lives, late = len(days) / len(sample.lives), sum(days) / len(days)
    return Foresight(endpoint, forecast, lives, late, sizes, "; ".join(parts))


def _seen(results: Path, endpoint: Endpoint, others: list[str]) -> dict[str, Seen]:
    _, rows = read_results(results)
    found = seen(rows, endpoint)
    if not (shared := {name: found[name] for name in others if name in found}):
        raise ConfigError(
            f"{results}: two people or more who met {endpoint.reference} and one of {', '.join(others)} are needed."
        )
    return shared


def _sample(bench: Benchmark, endpoint: Endpoint) -> Sample:
    """Whom the study meets, and for how many late days in each life."""
    people: dict[str, list[int]] = defaultdict(list)
    for job in bench.jobs:
        if job.after is None:
            who = [person for person, _ in job.config.schedule or []]
            for person in dict.fromkeys(who):
                people[person].append(len(endpoint.late_days(who.count(person))))
    return Sample(tuple(tuple(each) for _, each in sorted(people.items())))


def as_table(found: Foresight) -> tuple[list[str], list[list[str]]]:
    """Columns and rows, a method in each."""
    given = any(one.expected is not None for one in found.forecast.comparisons)
    columns = ["method", "SD people", "lives", "days"]
    columns += [f"power at {true:g}" for true in found.forecast.comparisons[0].power]
    columns += ["detectable at 80 %", *(["if unlucky", "seen there", "power at it"] if given else [])]
    rows = []
    for one in found.forecast.comparisons:
        more = [
            NONE if one.cautious is None else f"{one.cautious:.3f}",
            NONE if one.expected is None else f"{one.expected:+.3f}",
            _text(one.at_expected),
        ]
        rows.append([
            one.method, *(f"{value:.3f}" for value in one.scatter[:3]), *map(str, one.power.values()),
            _text(one.detectable), *(more if given else []),
        ])  # fmt: skip
    return columns, rows


def in_words(found: Foresight) -> Iterator[str]:
    """What stands around the table, line by line."""
    forecast, endpoint = found.forecast, found.endpoint
    compared = len(forecast.comparisons)
    yield (
        f"{forecast.people} people with {found.lives:.1f} lives of {found.late:.1f} late days each on average; "
        f"{endpoint.title}; methods compared with {endpoint.reference}: {compared}; test {endpoint.test}, correction "
        f"{endpoint.correction}; {found.source}."
    )
    yield "Power where no other method differs, ± Monte-Carlo error. Detectable: found in 80 % of studies."
    if any(one.cautious is not None for one in forecast.comparisons):
        yield "If unlucky: detectable where the scatter is at the upper 80 % limit of what so few people can tell."
    needed = people_needed(compared if endpoint.correction == "holm" else 1)
    if endpoint.test == "sign_flip" and forecast.people < needed:
        yield f"NOTHING CAN BE FOUND: the smallest p of this test needs {needed} people for {compared} comparisons."
    if forecast.coverage:
        held = ", ".join(f"{share} if people are {name}" for name, share in forecast.coverage.items())
        yield f"The 95 % intervals hold the truth in {held}."
    yield f"Any false alarm where nothing differs: {forecast.false_alarms}."
    sizes = ", ".join(f"{people}: {_text(one)}" for people, one in found.by_people.items())
    yield f"Detectable by the number of people, of the method that scatters most: {sizes}."


def as_json(found: Foresight) -> dict[str, Any]:
    """Everything, for programs."""
    forecast = found.forecast
    return {
        "endpoint": found.endpoint.title,
        "test": found.endpoint.test,
        "correction": found.endpoint.correction,
        "people": forecast.people,
        "lives": found.lives,
        "late_days": found.late,
        "source": found.source,
        "coverage": {name: share._asdict() for name, share in forecast.coverage.items()},
        "false_alarms": forecast.false_alarms._asdict(),
        "by_people": {people: _plain(one) for people, one in found.by_people.items()},
        "comparisons": [
            {
                **one._asdict(),
                "scatter": one.scatter._asdict(),
                "power": {f"{true:g}": share._asdict() for true, share in one.power.items()},
                "detectable": _plain(one.detectable),
                "at_expected": _plain(one.at_expected),
            }
            for one in forecast.comparisons
        ],
    }


def _plain(one: Simulated | None) -> dict[str, float] | None:
    return one._asdict() if one else None


def _text(one: Simulated | None) -> str:
    return str(one) if one else NONE
