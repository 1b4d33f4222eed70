"""Retrieved memories, in the form in which prompts and the trace give them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from coopera.core.clock import Clock, hour_label
from coopera.core.hour import CandidateKind, Recalled
from coopera.graphs.robots.method import Numbers
from coopera.graphs.robots.robot_view import Memories, Readable, ReadMemories
from coopera.memory import MemoryStream


def recall_both(memories: Memories | ReadMemories, query: str, now: Clock, *, since: int | None) -> list[Recalled]:
    """The top intentions, then the top tasks, best first (PAPER §4.1: three and five)."""
    return [
        *_top(memories.intentions, "intention", query, now, Numbers.RECALL_INTENTIONS, since),
        *_top(memories.tasks, "task", query, now, Numbers.RECALL_TASKS, since),
    ]


def best(recalled: Iterable[Recalled]) -> list[Recalled]:
    """Merge recalls of several stores: again three intentions and five tasks, best and then newest first."""
    ranked = sorted(recalled, key=lambda memory: (-memory.score, -memory.hour, memory.text))
    intentions = [memory for memory in ranked if memory.kind == "intention"]
    tasks = [memory for memory in ranked if memory.kind == "task"]
    return intentions[: Numbers.RECALL_INTENTIONS] + tasks[: Numbers.RECALL_TASKS]


def as_variables(recalled: Iterable[Recalled], now: Clock) -> dict[str, list[dict[str, Any]]]:
    """The variables `recalled_intentions` and `recalled_tasks` of `coopera.core.asks`."""
    memories = list(recalled)
    return {
        f"recalled_{kind}s": [as_memory(m.text, m.hour, now) for m in memories if m.kind == kind]
        for kind in ("intention", "task")
    }


def as_memory(text: str, hour: int, now: Clock) -> dict[str, Any]:
    """One memory as prompts read it; `hour` is a global hour index."""
    day, hour_of_day = divmod(hour, 24)
    label = hour_label(hour_of_day)
    when = label if day == now.day else f"day {day + 1}, {label}"
    return {"when": when, "hours_ago": now.now - hour, "text": text}


def _top(
    stream: MemoryStream | Readable, kind: CandidateKind, query: str, now: Clock, k: int, since: int | None
) -> list[Recalled]:
    return [
        Recalled(kind=kind, text=r.text, hour=r.hour, relevance=r.relevance, recency=r.recency, score=r.score)
        for r in stream.recall(query, now.now, k, since=since)
    ]
