"""Ways put together from those within the rooms are as short as those looked for in the whole home."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from coopera.simulation.ways.floor import CELL, RADIUS, Floor
from coopera.simulation.ways.paths import Ways

WIDE, DEEP = 24, 16


def grid(rng: np.random.Generator, closed: float) -> csr_matrix:
    """A grid of nodes with steps of random cost to the four neighbours; some nodes lead nowhere."""
    numbers = np.arange(WIDE * DEEP).reshape(WIDE, DEEP)
    pairs = np.concatenate(
        [
            np.stack([numbers[:-1].ravel(), numbers[1:].ravel()], axis=1),
            np.stack([numbers[:, :-1].ravel(), numbers[:, 1:].ravel()], axis=1),
        ]
    )
    walled = rng.random(WIDE * DEEP) < closed
    pairs = pairs[~walled[pairs].any(axis=1)]
    cost = rng.uniform(0.5, 2.0, len(pairs))
    both = (np.concatenate([pairs[:, 0], pairs[:, 1]]), np.concatenate([pairs[:, 1], pairs[:, 0]]))
    return csr_matrix((np.concatenate([cost, cost]), both), shape=(WIDE * DEEP,) * 2)


def rooms_in_quarters() -> np.ndarray:
    x, y = np.divmod(np.arange(WIDE * DEEP), DEEP)
    return 2 * (x >= WIDE // 2) + (y >= DEEP // 2)


ROOMS = {
    "four rooms": rooms_in_quarters(),
    "one room": np.zeros(WIDE * DEEP, dtype=np.int64),
    "rooms in pieces": np.arange(WIDE * DEEP) // 7 % 3,
}


@pytest.mark.parametrize("rooms", ROOMS.values(), ids=ROOMS.keys())
@pytest.mark.parametrize("closed", [0.0, 0.35])
def test_ways_cost_what_they_cost_in_the_whole_home(rooms: np.ndarray, closed: float) -> None:
    rng = np.random.default_rng(1)
    graph = grid(rng, closed)
    ways = Ways(graph, rooms)
    for first in rng.integers(WIDE * DEEP, size=12).tolist():
        whole = dijkstra(graph, indices=first)
        for room in range(int(rooms.max()) + 1):
            nodes = np.flatnonzero(rooms == room)
            np.testing.assert_allclose(ways.costs(first, nodes), whole[nodes], atol=1e-9)
        for last in rng.integers(WIDE * DEEP, size=12).tolist():
            chain = ways.chain(first, last)
            if chain is None:
                assert np.isinf(whole[last])
                continue
            assert (chain[0], chain[-1]) == (first, last)
            steps = [graph[a, b] for a, b in zip(chain, chain[1:], strict=False)]
            assert all(step > 0 for step in steps)
            assert sum(steps) == pytest.approx(whole[last])


def test_a_home_whose_rooms_are_too_open_to_one_another_is_taken_as_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coopera.simulation.ways.paths._MOST_DOORS", 3)
    graph = grid(np.random.default_rng(1), 0.1)
    ways = Ways(graph, rooms_in_quarters())
    np.testing.assert_allclose(ways.costs(5, np.arange(WIDE * DEEP)), dijkstra(graph, indices=5), atol=1e-9)


def test_ways_around_closed_nodes_do_not_pass_them() -> None:
    graph = grid(np.random.default_rng(2), 0.0)
    ways = Ways(graph, rooms_in_quarters())
    wall = np.arange(DEEP * 10, DEEP * 11 - 1)  # all but one of a row
    chain = ways.chain_around(0, WIDE * DEEP - 1, wall)
    assert chain is not None
    assert not set(chain) & set(wall.tolist())
    assert ways.chain_around(0, WIDE * DEEP - 1, np.arange(DEEP * 10, DEEP * 11)) is None


def test_a_straight_walk_is_possible_just_where_there_is_space_all_along() -> None:
    rng = np.random.default_rng(3)
    clear = rng.uniform(0.2, 0.6, (30, 30)) + 0.2 * (rng.random((30, 30)) < 0.7)
    floor = Floor(clear, (1.0, 2.0))
    answers = set()
    for _ in range(2000):
        x0, y0, x1, y1 = (rng.random(4) * 28 * CELL).tolist()
        a, b = (1.0 + x0, 2.0 + y0), (1.0 + x0 + 0.1 * (x1 - x0), 2.0 + y0 + 0.1 * (y1 - y0))
        steps = max(1, int(np.ceil(np.hypot(b[0] - a[0], b[1] - a[1]) / (CELL / 2))))
        points = [(a[0] + (b[0] - a[0]) * i / steps, a[1] + (b[1] - a[1]) * i / steps) for i in range(steps + 1)]
        lowest = min(floor.clearance(*point) for point in points)
        if abs(lowest - RADIUS) > 1e-6:
            assert floor.straight(a, b, ()) == (lowest > RADIUS)
            answers.add(lowest > RADIUS)
    assert answers == {True, False}
