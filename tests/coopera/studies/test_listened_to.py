"""Whoever listens to a run by LangChain's callbacks is told of each call of a model, and whose hour it is in."""

from __future__ import annotations

from collections import Counter
from typing import Any
from uuid import UUID

import pytest
from langchain_core.callbacks import BaseCallbackHandler
from langchain_core.messages import BaseMessage
from langchain_core.runnables import RunnableLambda

from coopera import Config, RunDir, run_study
from coopera.graphs.players.together import together


class Listener(BaseCallbackHandler):
    """Notes each call of a chat model: its name, tags and metadata."""

    def __init__(self) -> None:
        self.calls: list[tuple[str, list[str], dict[str, Any]]] = []
        self.chains: list[str] = []

    def on_chain_start(self, serialized: Any, inputs: Any, **about: Any) -> None:
        self.chains.append(about.get("name", ""))

    def on_chat_model_start(
        self,
        serialized: dict[str, Any],
        messages: list[list[BaseMessage]],
        *,
        run_id: UUID,
        parent_run_id: UUID | None = None,
        tags: list[str] | None = None,
        metadata: dict[str, Any] | None = None,
        **about: Any,
    ) -> None:
        assert parent_run_id is not None
        self.calls.append((about["name"], tags or [], metadata or {}))


@pytest.fixture(scope="module")
def heard(tmp_path_factory: pytest.TempPathFactory) -> tuple[Listener, RunDir]:
    root, listener = tmp_path_factory.mktemp("heard") / "run", Listener()
    config = Config(humans=["amara"], scenes=["maple"], days=1, hours=1, pictures="none", out=root)
    run_study(config, callbacks=[listener], resumable=False)
    return listener, RunDir.open(root)


def test_each_call_of_the_trace_is_heard_with_person_day_hour_and_node(heard: tuple[Listener, RunDir]) -> None:
    listener, run = heard
    said = [call for hour in run.hours() for call in hour.calls] + [c for e in run.evenings() for c in e.calls]
    places = [(name, about["node"], about["person"], about["hour"]) for name, _, about in listener.calls]
    assert Counter(places) == Counter((call.prompt, call.node, "amara", 9) for call in said)
    for _, tags, about in listener.calls:
        assert {"coopera", "person:amara", "day:0", "hour:9", f"node:{about['node']}", about["role"]} <= set(tags)


def test_the_graphs_and_their_nodes_are_heard_too(heard: tuple[Listener, RunDir]) -> None:
    assert {"study", "day", "hour", "human", "propose", "robot", "imagine_intentions", "feedback"} <= set(
        heard[0].chains
    )


def test_jobs_done_at_once_are_heard_by_whoever_listens_to_them() -> None:
    listener = Listener()
    asks = RunnableLambda(lambda number: number + 1).with_config(run_name="asked")
    ask_all = RunnableLambda(lambda _: together([lambda n=n: asks.invoke(n) for n in range(3)]))  # type: ignore[misc]
    assert ask_all.invoke(None, {"callbacks": [listener]}) == [1, 2, 3]
    assert listener.chains.count("asked") == 3
