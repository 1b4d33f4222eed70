"""A run killed after every node, one after the other, each time as it goes on: nothing of it is lost or different."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from benchmarks.one_life import in_a_process
from benchmarks.run_contents import contents, differences
from coopera.graphs import build_day_graph, build_study_graph
from coopera.graphs.hour import build_hour_graph
from coopera.rundir.directory import RunDir
from coopera.simulation.drawing.context import problem
from tests.coopera.studies.killed import NODES, live, live_ahead
from tests.fakes import LetterEmbeddings

RENAMED = {"live": "human", "help_person": "robot"}


def test_the_nodes_that_are_killed_are_all_of_the_study_the_day_and_the_hour() -> None:
    graphs = (build_study_graph(), build_day_graph(), build_hour_graph())
    nodes = {name for graph in graphs for name in graph.get_graph().nodes if not name.startswith("__")}
    assert {RENAMED.get(name, name) for _, name in NODES} == nodes - {"day"}


def test_a_run_killed_once_after_every_node_leaves_what_an_uninterrupted_one_leaves(tmp_path: Path) -> None:
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    assert in_a_process(live, whole, None) == 0
    assert [in_a_process(live, broken, place) for place in range(len(NODES))] == [-signal.SIGKILL] * len(NODES)
    assert in_a_process(live, broken, None) == 0
    embeddings = LetterEmbeddings()
    assert differences(contents(whole, embeddings), contents(broken, embeddings)) == []


@pytest.mark.skipif(bool(problem()), reason=f"nothing can be drawn with OpenGL here: {problem()}")
def test_a_run_killed_while_an_evening_and_the_next_day_s_hour_wait_to_be_written_lives_them_again(
    tmp_path: Path,
) -> None:
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    assert in_a_process(live_ahead, whole, False) == 0
    assert in_a_process(live_ahead, broken, True) == -signal.SIGKILL
    ahead = RunDir.open(broken)
    assert (len(ahead.hours_done()), ahead.evenings()) == (1, [])
    assert (broken / "frames" / "day-01").is_dir()
    assert in_a_process(live_ahead, broken, False) == 0
    embeddings = LetterEmbeddings()
    assert differences(contents(whole, embeddings), contents(broken, embeddings)) == []
