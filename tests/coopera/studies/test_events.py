from __future__ import annotations

import threading
from collections.abc import Callable
from contextvars import ContextVar
from typing import Any

import pytest
from langgraph.checkpoint.memory import InMemorySaver
from langgraph.graph import END, START, StateGraph
from langgraph.types import interrupt
from typing_extensions import TypedDict

from coopera.core.errors import StoppedError
from coopera.graphs.events import Said, say
from coopera.studies.events import Heard, Listener, listened_to


class State(TypedDict, total=False):
    seen: str


def graph_of(*nodes: Callable[[State], dict[str, Any]]) -> Any:
    graph = StateGraph(State)
    for node in nodes:
        graph.add_node(node)
    names = [START, *(node.__name__ for node in nodes), END]
    for one, then in zip(names, names[1:], strict=False):
        graph.add_edge(one, then)
    return graph.compile(checkpointer=False)


def outer(state: State) -> dict[str, Any]:
    return dict(graph_of(inner, also).invoke(state))


def inner(state: State) -> dict[str, Any]:
    say(3, 9)
    return {"seen": "inner"}


def also(state: State) -> dict[str, Any]:
    return {}


def fails(state: State) -> dict[str, Any]:
    raise StoppedError("The run was interrupted.")


def asks(state: State) -> dict[str, Any]:
    interrupt("what now?")
    return {}


def ignore(heard: Heard) -> None:
    pass


def run(graph: Any) -> Callable[[Listener], object]:
    return lambda listener: graph.invoke({}, {"callbacks": [listener]})


def test_nodes_are_heard_as_they_end_those_of_inner_graphs_first_and_what_they_say_as_they_say_it() -> None:
    said = Said(day=3, hour=9, success=None)
    heard = list(listened_to(run(graph_of(outer, also)), ignore))
    assert heard == [Heard("inner", said), Heard("inner"), Heard("also"), Heard("outer"), Heard("also")]


def test_the_error_that_ends_the_work_is_raised_where_it_is_waited_for_and_the_node_is_not_heard() -> None:
    events = listened_to(run(graph_of(also, fails)), ignore)
    assert next(events) == Heard("also")
    with pytest.raises(StoppedError):
        next(events)


def test_a_node_that_waits_for_a_person_is_not_heard() -> None:
    graph = StateGraph(State)
    graph.add_node(asks)
    graph.add_edge(START, "asks")
    whole = graph.compile(checkpointer=InMemorySaver())
    config: dict[str, Any] = {"configurable": {"thread_id": "1"}}
    assert list(listened_to(lambda listener: whole.invoke({}, {**config, "callbacks": [listener]}), ignore)) == []


def test_the_work_is_done_in_another_thread_with_what_the_caller_has_set() -> None:
    at: ContextVar[str] = ContextVar("at", default="nowhere")
    at.set("here")
    found: list[tuple[str, bool]] = []
    list(listened_to(lambda _: found.append((at.get(), threading.current_thread() is threading.main_thread())), ignore))
    assert found == [("here", False)]


def test_what_is_to_be_done_after_a_node_is_done_before_the_next_begins() -> None:
    order: list[str] = []

    def first(state: State) -> dict[str, Any]:
        order.append("first")
        return {}

    def second(state: State) -> dict[str, Any]:
        order.append("second")
        return {}

    list(listened_to(run(graph_of(first, second)), lambda heard: order.append(f"after {heard.node}")))
    assert order == ["first", "after first", "second", "after second"]


def test_to_stop_listening_is_to_wait_until_the_work_has_ended() -> None:
    go_on, ended = threading.Event(), threading.Event()

    def work(listener: Listener) -> None:
        graph_of(also).invoke({}, {"callbacks": [listener]})
        go_on.wait(10)
        ended.set()

    events = listened_to(work, ignore)
    assert next(events) == Heard("also")
    threading.Timer(0.05, go_on.set).start()
    events.close()
    assert ended.is_set()
