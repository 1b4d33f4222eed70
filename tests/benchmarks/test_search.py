"""The benchmark of what people are offered for what they want."""

from __future__ import annotations

import json

import pytest

from benchmarks import search
from coopera.simulation import list_scenes, load_scene


def test_there_are_ten_intentions_for_each_shipped_home_half_of_either_type() -> None:
    wanted = search.samples()
    assert sorted(wanted) == sorted(list_scenes())
    assert all([sample.type for sample in samples].count(1) == 5 == len(samples) / 2 for samples in wanted.values())
    assert all(2 <= len(sample.wants) <= 8 for samples in wanted.values() for sample in samples)


def test_what_an_intention_needs_exists_in_its_home() -> None:
    for home, samples in search.samples().items():
        layout = load_scene(home)
        furniture = {thing.cls.replace("_", " ") for thing in layout.fixed}
        things = {thing.cls.replace("_", " ") for thing in layout.movable}
        for sample in samples:
            assert set(sample.needed.furniture) <= furniture, sample.intention
            assert set(sample.needed.things) <= things, sample.intention
            assert 1 <= len(sample.needed.furniture) <= 4


def test_who_is_shown_everything_misses_nothing_and_a_few_objects_are_not_enough(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert search.main(["--objects", "3", "--json"]) == 0
    said = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert said["all"]["all"]["complete"] == said["all"]["all"]["intentions"] == 50
    assert said["intention"]["all"]["complete"] < 25
    assert said["intention"]["all"]["characters"] < said["all"]["all"]["characters"] / 4
