"""Where a run's processor time goes: by stage of the hour, and by kind of work, each moment counted once.

Functions of coopera and LangGraph are wrapped for the time of a measurement; nothing of a run is changed by it. Time is
the processor's, of the thread that works, so that other work on the machine counts little. Chroma and the encoder of
texts work in threads of their own, while the one that asked waits: theirs is the time that the process takes besides.
"""

from __future__ import annotations

import functools
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest.mock import patch

from chromadb.api.rust import RustBindingsAPI
from langgraph.checkpoint.sqlite import SqliteSaver
from langgraph.graph import StateGraph
from langgraph.pregel import Pregel

from coopera import Config
from coopera.graphs import day, hour, life
from coopera.graphs.robots import robot_view
from coopera.graphs.robots.learning import Learner
from coopera.memory import CachedEmbeddings, MemoryStream
from coopera.models.asking import Backend
from coopera.rundir.directory import RunDir
from coopera.simulation.world import World
from coopera.studies import study

NODES = {
    "coopera.graphs.hour": {"live": "person", "demonstrate": "world", "help_person": "robot", "finish": "world"},
    "coopera.graphs.day": {"feedback": "evening", "infer_traits": "evening", "learn": "evening"},
}
ROOMS = {"coopera.graphs.human": "person", "coopera.graphs.players": "person", "coopera.graphs.robot": "robot"}
"""The stage that a node of a module belongs to; the others (start, hour, record, end) are LangGraph's "between"."""
FRAMEWORK = ("LangGraph", "checkpoints", "trace", "memory")
_PICTURES = ("frames", "film")
_TRACE = ("write_hour", "write_evening", "read_hour", "read_evening", "read_day", "seal_days")


class Clock:
    """Processor seconds by (stage, kind of work) since it was made."""

    def __init__(self) -> None:
        self.seconds: dict[tuple[str, str], float] = defaultdict(float)
        self._here = threading.local()
        self._lock = threading.Lock()

    @contextmanager
    def within(self, stage: str | None, kind: str) -> Iterator[None]:
        """Count what follows in this thread as a kind of work, of the stage given or else of that around it."""
        stack = self._stack()
        self._switch(stack)
        stack.append((stage or (stack[-1][0] if stack else "between"), kind))
        try:
            yield
        finally:
            self._switch(stack)
            stack.pop()

    def wrapped(self, function: Callable[..., Any], stage: str | None, kind: str) -> Callable[..., Any]:
        """The function, with its time counted."""

        @functools.wraps(function)
        def counted(*args: Any, **kwargs: Any) -> Any:
            with self.within(stage, kind):
                return function(*args, **kwargs)

        return counted

    def elsewhere(self, function: Callable[..., Any], kind: str) -> Callable[..., Any]:
        """The function, with the time counted that other threads take meanwhile."""

        @functools.wraps(function)
        def counted(*args: Any, **kwargs: Any) -> Any:
            began = time.process_time() - time.thread_time()
            try:
                return function(*args, **kwargs)
            finally:
                spent = time.process_time() - time.thread_time() - began
                stack = self._stack()
                with self._lock:
                    self.seconds[stack[-1][0] if stack else "between", kind] += max(spent, 0.0)

        return counted

    def _stack(self) -> list[tuple[str, str]]:
        if not hasattr(self._here, "stack"):
            self._here.stack, self._here.since = [], time.thread_time()
        found: list[tuple[str, str]] = self._here.stack
        return found

    def _switch(self, stack: Sequence[tuple[str, str]]) -> None:
        """Give the time since the last switch of this thread to what it was doing."""
        now = time.thread_time()
        if stack:
            with self._lock:
                self.seconds[stack[-1]] += now - self._here.since
        self._here.since = now


class Lived:
    """What a study took: seconds by (stage, kind) after each day, the work between nodes included."""

    def __init__(self, clock: Clock) -> None:
        self._clock, self._began = clock, time.process_time()
        self.days: list[dict[tuple[str, str], float]] = []

    def note(self, event: Mapping[str, Any]) -> None:
        """Take in the end of a node."""
        if event["node"] == "day":
            self.days.append(self.now())

    def now(self) -> dict[tuple[str, str], float]:
        """Seconds so far; what no wrapped function accounts for is LangGraph's, with what it leaves to threads."""
        found = dict(self._clock.seconds)
        rest = time.process_time() - self._began - sum(found.values())
        found["between", "LangGraph"] = found.get(("between", "LangGraph"), 0.0) + max(rest, 0.0)
        return found


def lived(config: Config) -> Lived:
    """Live a study and count its time; imports and what is made once are paid by an hour lived before."""
    study.run_study(_first_hour(config))
    clock = Clock()
    _forget_graphs()
    with ExitStack() as stack:
        stack.callback(_forget_graphs)
        for place, name, made in _wraps(clock):
            stack.enter_context(patch.object(place, name, made))
        watch: list[Lived] = []

        def begin(*args: Any, **kwargs: Any) -> Any:
            watch.append(Lived(clock))
            return inner(*args, **kwargs)

        inner = study._run_on
        stack.enter_context(patch.object(study, "_run_on", begin))
        study.run_study(config, on_event=lambda event: watch[0].note(event))
    return watch[0]


def _forget_graphs() -> None:
    """Have graphs be built anew, of nodes that are wrapped or of those that no longer are."""
    for made in (day._hour_graph, hour._robot, hour._oracle, hour._own_robot, life._graph):
        made.forget()


def _first_hour(config: Config) -> Config:
    assert config.out is not None
    return config.model_copy(
        update={"days": 1, "hours": 1, "out": config.out.with_name(f"{config.out.name}-first"), "schedule": []}
    )


def _wraps(clock: Clock) -> Iterator[tuple[Any, str, Callable[..., Any]]]:
    """Each function that is wrapped: where it stands, its name, and what counts it."""
    add = StateGraph.add_node

    def add_counted(graph: Any, node: Any, action: Any = None, **more: Any) -> Any:
        named, work = (node, action) if isinstance(node, str) else (getattr(node, "__name__", ""), node)
        stage = _stage(work, named)
        if callable(work) and not hasattr(work, "invoke") and stage:
            work = clock.wrapped(work, stage, "their own work")
            return add(graph, named, work, **more)
        return add(graph, node, action, **more)

    yield StateGraph, "add_node", add_counted
    yield Pregel, "invoke", clock.wrapped(Pregel.invoke, None, "LangGraph")
    yield Backend, "ask", clock.wrapped(Backend.ask, None, "models")
    encoded = clock.wrapped(CachedEmbeddings._made, None, "models")
    yield CachedEmbeddings, "_made", clock.elsewhere(encoded, "models")
    yield Learner, "learn", clock.wrapped(Learner.learn, None, "training")
    together = "extend_together"
    yield robot_view, together, clock.wrapped(getattr(robot_view, together), None, "memory")
    for name in ("_add", "_get", "_count", "_modify", "get_or_create_collection", "get_collection"):
        yield RustBindingsAPI, name, clock.elsewhere(getattr(RustBindingsAPI, name), "memory")
    for name in ("put", "put_writes"):
        yield SqliteSaver, name, clock.wrapped(getattr(SqliteSaver, name), "between", "checkpoints")
    for owner, kind, names in (
        (MemoryStream, "memory", _public(MemoryStream)),
        (RunDir, "trace", [name for name in _TRACE if hasattr(RunDir, name)]),
        (World, "pictures", _PICTURES),
        (World, "world", [name for name in _public(World) if name not in _PICTURES]),
    ):
        for name in names:
            yield owner, name, clock.wrapped(getattr(owner, name), None, kind)


def _public(owner: type) -> list[str]:
    """The methods that others call, iterators apart."""
    skip = ("records", "filmed", "open")
    return [name for name, value in vars(owner).items() if callable(value) and name[0] != "_" and name not in skip]


def _stage(work: Any, name: str) -> str | None:
    module = getattr(work, "__module__", "")
    if module == "coopera.graphs.hour" and name == "human":
        return "person"
    if module == "coopera.graphs.hour":
        return {**NODES[module], "robot": "robot", "score": "score"}.get(name)
    if module in NODES:
        return NODES[module].get(name)
    return next((stage for room, stage in ROOMS.items() if module.startswith(room)), None)
