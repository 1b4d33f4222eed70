from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from itertools import accumulate
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from coopera.memory import CachedEmbeddings, MemoryStream
from coopera.memory.embeddings import unit
from coopera.memory.minilm import Vector
from coopera.memory.scan import ArrayRows, every, top

QUERIES_EACH = 10


class Case(NamedTuple):
    """A stream and questions to it: everything follows from `seed`, so that hypothesis can shrink the rest."""

    seed: int
    hours: list[int]
    dimension: int
    distinct: int
    sign: int
    decay: float


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Streams with pauses of any length, several records an hour, and few or many different vectors.

    `distinct` small gives ties; `sign` -1 makes all cosines negative, 1 all positive, 0 mixed.
    """
    steps = draw(st.lists(st.sampled_from([0, 0, 0, 1, 1, 2, 11, 500, 20_000]), max_size=60))
    return Case(
        seed=draw(st.integers(0, 2**32)),
        hours=list(accumulate([draw(st.integers(-50, 50)), *steps]))[: draw(st.integers(0, 61))],
        dimension=draw(st.sampled_from([1, 2, 3, 8, 384])),
        distinct=draw(st.sampled_from([1, 2, 5, 1000])),
        sign=draw(st.sampled_from([-1, 0, 1])),
        decay=draw(st.sampled_from([0.95, 0.95, 0.5, 0.999, 0.01, 1.0])),
    )


def build(case: Case) -> tuple[np.random.Generator, Vector]:
    """Return the case's generator and its records' unit vectors."""
    rng = np.random.default_rng(case.seed)
    pool = directions(case, rng, case.distinct)
    return rng, pool[rng.integers(0, case.distinct, len(case.hours))]


def directions(case: Case, rng: np.random.Generator, n: int, *, query: bool = False) -> Vector:
    drawn = rng.standard_normal((n, case.dimension))
    if case.sign:
        drawn = np.abs(drawn) * (1 if query else case.sign)
    return unit(drawn.astype(np.float32), [""] * n)


def brute_force(
    vectors: Vector, hours: list[int], query: Vector, k: int, now: int, decay: float, since: int | None
) -> list[tuple[int, float]]:
    """Score every record by the definition, in plain Python; return positions and relevances."""
    scope = [place for place, hour in enumerate(hours) if hour <= now and (since is None or hour >= since)]
    if not scope:
        return []
    newest = max(hours[place] for place in scope)
    relevance = {place: float((vectors[place].astype(float) * query.astype(float)).sum()) for place in scope}
    scope.sort(key=lambda place: (relevance[place] * math.pow(decay, newest - hours[place]), place), reverse=True)
    return [(place, relevance[place]) for place in scope[:k]]


def questions(case: Case, rng: np.random.Generator) -> Iterator[tuple[Vector, int, int, int | None]]:
    first, last = (case.hours[0], case.hours[-1]) if case.hours else (0, 0)
    for _ in range(QUERIES_EACH):
        now = int(rng.choice([last, last, last + 3, last + 5000, int(rng.integers(first - 2, last + 3))]))
        since = None if rng.random() < 0.5 else int(rng.integers(first - 2, last + 3))
        yield directions(case, rng, 1, query=True)[0], int(rng.choice([1, 2, 5, 80])), now, since


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a few records fill many blocks, and little of it stay in RAM."""
    for module in ("coopera.memory.scan", "coopera.memory.log"):
        monkeypatch.setattr(f"{module}.BLOCK", 4)
        monkeypatch.setattr(f"{module}.AT_ONCE", 2)
    monkeypatch.setattr("coopera.memory.scan.STEP", 3)
    monkeypatch.setattr("coopera.memory.log._TEXTS_IN_RAM", 8)
    monkeypatch.setattr("coopera.memory.lately.PIECE", 4)
    monkeypatch.setattr("coopera.memory.log._FAN", 2)


def check_arrays(case: Case) -> None:
    rng, vectors = build(case)
    rows = ArrayRows(vectors, np.array(case.hours, np.int64))
    for query, k, now, since in questions(case, rng):
        found = top(rows, query, k, now=now, decay=case.decay, since=since)
        expected = brute_force(vectors, case.hours, query, k, now, case.decay, since)
        assert [(hit.position, hit.relevance) for hit in found.hits] == expected
        other = directions(case, rng, 1, query=True)[0]
        start, cosines = every(rows, np.stack((other, query)), now=now, since=since)
        for one, of_one in zip((other, query), cosines.tolist(), strict=True):
            compared = [(start + place, cosine) for place, cosine in enumerate(of_one)]
            assert compared == all_of(vectors, case.hours, one, now, since)
        near = cosines.ravel() - 1e-9  # float32 cannot tell on which side of these a cosine lies
        low, high = sorted(rng.choice([*near, *-near, *rng.uniform(-1, 1, 3)], 2))
        bounded = every(rows, np.stack((other, query)), now=now, since=since, within=(low, high))
        assert bounded.start == start
        assert bounded.cosines.tolist() == np.clip(cosines, low, high).tolist()


def all_of(vectors: Vector, hours: list[int], query: Vector, now: int, since: int | None) -> list[tuple[int, float]]:
    return sorted(brute_force(vectors, hours, query, len(hours), now, 1.0, since))


def check_stream(case: Case, folder: Path) -> None:
    """The same through Chroma: added by the hour, reopened once in the middle, asked before and after reopening."""
    rng, vectors = build(case)
    asked: dict[str, Vector] = {f"record {place}": vector for place, vector in enumerate(vectors)}
    embeddings = CachedEmbeddings(lambda text: asked[text], "by name", None, case.dimension)
    store, half = tempfile.mkdtemp(dir=folder), len(case.hours) // 2
    for part in (range(half), range(half, len(case.hours))):
        with MemoryStream.open(store, "x", embeddings, case.decay) as stream:
            for hour in sorted({case.hours[place] for place in part}):
                stream.add([f"record {place}" for place in part if case.hours[place] == hour], hour)
            seen = case.hours[: len(stream)]
            assert stream.texts() == ([record.text for record in stream.records()], seen)
            for number, (query, k, now, since) in enumerate(questions(case, rng)):
                question = f"question {part.start} {number}"
                asked[question] = query
                found = stream.recall(question, now, k, since)
                expected = brute_force(vectors, seen, query, k, now, case.decay, since)
                assert [(int(f.text.split()[1]), f.relevance) for f in found] == expected
                texts, of, [relevances] = stream.relevances([question], now, since)
                compared = [(int(text.split()[1]), one) for text, one in zip(texts, relevances.tolist(), strict=True)]
                assert compared == all_of(vectors, seen, query, now, since)
                assert of == [case.hours[place] for place, _ in compared]
                if since is not None:
                    after = [place for place, hour in enumerate(seen) if hour >= since]
                    assert stream.texts(since) == ([f"record {n}" for n in after], [seen[n] for n in after])
                for item in found:
                    assert item.recency == case.decay ** (now - item.hour)
                    assert item.score == item.relevance * item.recency


DEFAULT = settings(max_examples=100, phases=[Phase.generate, Phase.shrink])
THROUGH_CHROMA = settings(
    DEFAULT, max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
NIGHTLY = settings(THROUGH_CHROMA, max_examples=600, derandomize=False)


@pytest.mark.usefixtures("small_blocks")
@settings(DEFAULT, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cases())
def test_the_windowed_scan_equals_brute_force(case: Case) -> None:
    check_arrays(case)


@pytest.mark.usefixtures("small_blocks")
@THROUGH_CHROMA
@given(case=cases())
def test_recall_through_chroma_equals_brute_force(case: Case, tmp_path: Path) -> None:
    """25 streams x 2 openings x 10 queries."""
    check_stream(case, tmp_path)


@pytest.mark.nightly
@pytest.mark.usefixtures("small_blocks")
@NIGHTLY
@given(case=cases())
def test_recall_through_chroma_equals_brute_force_twelve_thousand_times(case: Case, tmp_path: Path) -> None:
    check_stream(case, tmp_path)


@pytest.mark.nightly
@settings(NIGHTLY, max_examples=5000)
@given(cases())
def test_the_windowed_scan_equals_brute_force_fifty_thousand_times(case: Case) -> None:
    check_arrays(case)


def lifetime(n: int) -> tuple[np.random.Generator, ArrayRows, Vector, list[int]]:
    """Six records per waking hour, thirteen hours a day, with vectors as alike as sentences are."""
    rng = np.random.default_rng(7)
    common = rng.standard_normal(64)
    vectors = unit((rng.standard_normal((n, 64)) + 0.6 * common).astype(np.float32), [""] * n)
    hours = [place // 78 * 24 + 9 + place % 78 // 6 for place in range(n)]
    return rng, ArrayRows(vectors, np.array(hours, np.int64)), vectors, hours


def test_a_long_life_is_recalled_exactly_and_by_looking_at_its_last_days_only() -> None:
    rng, rows, vectors, hours = lifetime(60_000)
    for _ in range(20):
        query = vectors[rng.integers(len(rows))]
        found = top(rows, query, 5, now=hours[-1] + 1, decay=0.95)
        expected = brute_force(vectors[-6000:], hours[-6000:], query, 5, hours[-1] + 1, 0.95, None)
        assert [(hit.position - 54_000, hit.relevance) for hit in found.hits] == expected
        assert found.scanned <= 2048


def test_how_much_is_read_does_not_depend_on_how_long_a_life_is() -> None:
    scanned = []
    for n in (6000, 60_000):
        rng, rows, vectors, hours = lifetime(n)
        rng = np.random.default_rng(1)
        queries = vectors[rng.integers(5000, 6000, 20)]
        scanned.append([top(rows, query, 5, now=hours[-1], decay=0.95).scanned for query in queries])
    assert np.median(scanned[1]) <= np.median(scanned[0]) + 512


@pytest.mark.usefixtures("small_blocks")
def test_what_has_left_ram_while_the_rest_is_read_is_scored_by_its_own_vector(tmp_path: Path) -> None:
    vectors = unit(np.random.default_rng(3).standard_normal((80, 5)).astype(np.float32), [""] * 80)
    asked = {f"record {place}": vector for place, vector in enumerate(vectors)} | {"question": vectors[7]}
    embeddings = CachedEmbeddings(lambda text: asked[text], "by name", None, 5)
    with MemoryStream.open(tmp_path, "x", embeddings, 1.0) as stream:
        for hour in range(80):
            stream.add([f"record {hour}"], hour)
        found = [(int(one.text.split()[1]), one.relevance) for one in stream.recall("question", 80, 80)]
        [compared] = stream.relevances(["question"], 80).relevances
    assert list(enumerate(compared)) == sorted(found)
    assert found == brute_force(vectors, list(range(80)), vectors[7], 80, 80, 1.0, None)
