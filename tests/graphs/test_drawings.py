"""Each graph is drawn as LangGraph draws it (Mermaid), and a changed drawing is seen in review.

After a change that is meant, renew them: `.venv/bin/python -m tests.graphs.test_drawings`.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from coopera.graphs.day import build_day_graph
from coopera.graphs.hour import build_hour_graph
from coopera.graphs.human import build_human_graph
from coopera.graphs.robot import build_own_robot_graph, build_robot_graph
from coopera.graphs.study import build_study_graph

DRAWINGS = Path(__file__).parent / "drawings"
GRAPHS: dict[str, Callable[[], Any]] = {
    "human": build_human_graph,
    "robot": build_robot_graph,
    "own_robot": build_own_robot_graph,
    "hour": build_hour_graph,
    "day": build_day_graph,
    "study": build_study_graph,
}


def drawn(name: str) -> str:
    drawing: str = GRAPHS[name]().get_graph().draw_mermaid()
    return drawing


@pytest.mark.parametrize("name", GRAPHS)
def test_a_graph_is_as_it_was_drawn(name: str) -> None:
    renew = "if that is meant, renew it: .venv/bin/python -m tests.graphs.test_drawings"
    assert drawn(name) == (DRAWINGS / f"{name}.mmd").read_text(encoding="utf-8"), renew


def test_no_drawing_is_of_a_graph_that_is_gone() -> None:
    assert {path.stem for path in DRAWINGS.iterdir()} == set(GRAPHS)


if __name__ == "__main__":
    for name in GRAPHS:
        (DRAWINGS / f"{name}.mmd").write_text(drawn(name), encoding="utf-8")
