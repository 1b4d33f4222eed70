"""What runs inside a node: told to LangGraph, so that a drawing (`get_graph(xray=True)`) and Studio show it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

from langgraph.graph.state import CompiledStateGraph

Graph = TypeVar("Graph", bound=CompiledStateGraph[Any, Any, Any, Any])


def with_inside(graph: Graph, inside: Mapping[str, CompiledStateGraph[Any, Any, Any, Any]]) -> Graph:
    """Return the graph, knowing which graph each of some nodes runs.

    LangGraph finds out by itself, but only of graphs that keep checkpoints. Those of an hour keep none, since the hour
    is the unit of work. What is shown is a copy that says nothing of checkpoints, so that a state can be read with its
    subgraphs; what runs is what it was.
    """
    for name, inner in inside.items():
        graph.nodes[name].subgraphs = [inner.copy({"checkpointer": None})]
    return graph
