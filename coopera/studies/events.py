"""What happens in a running study, node by node, told to whoever runs it.

LangGraph streams graphs within graphs by waking three threads for each piece, which costs 2 to 4 ms an hour. Here the
graphs run in one thread, which LangChain's callbacks listen to.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Generator, Mapping
from contextvars import copy_context
from queue import SimpleQueue
from typing import Any, NamedTuple
from uuid import UUID

from langchain_core.callbacks import BaseCallbackHandler
from langgraph.graph import START

from coopera.graphs.events import SAID, Said

Event = Mapping[str, Any]
"""That a node has ended: `day`, `hour` (None in the evening), `node`, `success` (predicate F1 so far, or None)."""

_NODE = "graph:step:"
"""Begins LangGraph's tag of a node's run, and of no run within it."""
_PAUSE = 0.02
"""Seconds for which what is heard waits to be told together: each waking takes from the work, in the same process."""


class Heard(NamedTuple):
    """That a node has ended, or what one says."""

    node: str
    said: Said | None = None


class Listener(BaseCallbackHandler):
    """Hears the nodes of graphs in the thread that runs them."""

    ignore_llm = ignore_chat_model = ignore_retriever = ignore_agent = True

    def __init__(self, hear: Callable[[Heard], None]) -> None:
        """Have `hear` called, which must not fail."""
        self._hear = hear
        self._running: dict[UUID, str] = {}

    def on_chain_start(self, serialized: Any, inputs: Any, *, run_id: UUID, **about: Any) -> None:
        """Note which node it is, since its end does not tell."""
        node = (about["metadata"] or {}).get("langgraph_node", START)
        if node != START and any(tag.startswith(_NODE) for tag in about["tags"] or ()):
            self._running[run_id] = node

    def on_chain_end(self, outputs: Any, *, run_id: UUID, **about: Any) -> None:
        """Hear that a node has ended."""
        if (node := self._running.pop(run_id, None)) is not None:
            self._hear(Heard(node))

    def on_chain_error(self, error: BaseException, *, run_id: UUID, **about: Any) -> None:
        """Let a node go that failed, or that waits for a person."""
        self._running.pop(run_id, None)

    def on_custom_event(self, name: str, data: Any, **about: Any) -> None:
        """Hear what a node says."""
        if name == SAID:
            self._hear(Heard(about["metadata"]["langgraph_node"], data))


def listened_to(work: Callable[[Listener], object], after: Callable[[Heard], None]) -> Generator[Heard]:
    """Do work in a thread of its own, and yield what its listener hears; the error that ends it is raised here.

    Ctrl-C reaches whoever waits here, not the work. To close this is to wait until the work has ended.

    Args:
        work: The work.
        after: Is told each thing first, in the work's thread, which goes on when it returns; it must not fail.
    """
    heard: SimpleQueue[Heard | None] = SimpleQueue()
    failed: list[BaseException] = []
    over = threading.Event()

    def hear(one: Heard) -> None:
        after(one)
        heard.put(one)

    def done() -> None:
        try:
            work(Listener(hear))
        except BaseException as err:  # noqa: BLE001 - it is raised where it is waited for
            failed.append(err)
        finally:
            heard.put(None)
            over.set()

    thread = threading.Thread(target=copy_context().run, args=(done,), name="study")
    thread.start()
    try:
        while (one := heard.get()) is not None:
            yield one
            if heard.empty():
                over.wait(_PAUSE)
    finally:
        thread.join()
    if failed:
        raise failed[0]
