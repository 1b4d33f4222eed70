"""A run killed after every node, one after the other, each time as it goes on: nothing of it is lost or different."""

from __future__ import annotations

import signal
from pathlib import Path

from benchmarks.one_life import in_a_process
from benchmarks.run_contents import contents, differences
from coopera.graphs import build_day_graph, build_study_graph
from coopera.graphs.hour import build_hour_graph
from tests.coopera.studies.killed import NODES, live
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
