"""Readers of studies and what participants answered, for `benchmarks.fuzz`."""

from __future__ import annotations

from pathlib import Path

from benchmarks.fuzzing import mutations as change
from benchmarks.fuzzing.kit import Reader, in_yaml, of_file
from coopera.benchmark.grid_runs import load_grid
from coopera.config.prices import read_prices
from coopera.config.schema import load_config
from coopera.report.study_forms import read_key, read_participants


def _answers(path: Path) -> object:
    return read_participants([path], "s1")


def _key(path: Path) -> object:
    return read_key(path)


def _config(path: Path) -> object:
    return load_config(path).to_yaml()


def _grid(path: Path) -> object:
    return load_grid(path, {})


def _prices(path: Path) -> object:
    return read_prices(path)


_STUDY = in_yaml(
    {
        "setting": 2,
        "collab": 1,
        "humans": ["amara", "bruno"],
        "scenes": ["maple"],
        "days": 2,
        "hours": 3,
        "method": "ours",
        "seed": 3,
        "models": {"human": "offline", "robot": "offline", "judge": "offline"},
        "budget": {"calls": 100},
        "pictures": "none",
    }
)


_GRID = in_yaml(
    {"methods": ["ours", "random"], "settings": ["1", "2"], "collab": [1, 2], "seeds": 2, "days": 2, "hours": 3}
)


_PRICES = in_yaml({"as_of": "2026-01-01", "currency": "USD", "models": {"openai:gpt-4o": {"in": 2.5, "out": 10}}})


_ANSWERS = b'{"study": "s1", "participant": "p", "answers": {"A1": "B", "M2": "C"}}'


_KEY = b'{"study": "s1", "choices": {"A1": "B"}, "matches": {"M1": "C"}, "people": {"A1": "amara"}}'

READERS: dict[str, Reader] = {
    "config": Reader(of_file("study.yaml", [_STUDY], _config), change.in_yaml),
    "grid": Reader(of_file("grid.yaml", [_GRID], _grid), change.in_yaml),
    "prices": Reader(of_file("prices.yaml", [_PRICES], _prices), change.in_yaml),
    "answers": Reader(of_file("a.json", [_ANSWERS], _answers), change.in_json),
    "answers-paper": Reader(
        of_file("a.csv", [b"participant,question,answer\np,A1,b\np,M1,c\nq,A1,a\n"], _answers), change.in_cells
    ),
    "key": Reader(of_file("key.json", [_KEY], _key), change.in_json),
}
