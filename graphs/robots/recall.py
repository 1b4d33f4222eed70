"""Retrieved memories, in the form in which prompts and the trace give them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any, Literal, TypeAlias

import numpy as np

from coopera.core.clock import Clock, hour_label
from coopera.core.hour import CandidateKind, Recalled
from coopera.core.time_use import day_type
from coopera.graphs.robots.method import Numbers
from coopera.graphs.robots.robot_view import Memories, Readable, ReadMemories, RobotView
from coopera.memory import MemoryStream

DAYS = 60
"""How many days back a robot recalls what it was told."""
FADING = 0.99  # per day: half after ten weeks; what was told before a turn fades by itself (`graphs.robots.turns`)
OTHER_KIND = 0.7  # an hour of a working day counts so much on a free one, and the reverse
NARROW, WIDE = 1.5, 3.0  # hours of day: for what is wanted, and for what is used for it
_AT_ANY_HOUR = {NARROW: 0.15, WIDE: 0.4}  # what an hour counts that is at quite another time of day

Source: TypeAlias = Literal["told", "seen", "guessed"]


def recall_both(
    memories: Memories | ReadMemories, query: str, now: Clock, *, since: int | None, source: Source | None = None
) -> list[Recalled]:
    """The top intentions, then the top tasks, best first (PAPER §4.1: three and five).

    `source` is what a robot's memories come from, where a record does not say otherwise; a person's have none.
    """
    return [
        *_top(memories.intentions, "intention", query, now, Numbers.RECALL_INTENTIONS, since, source),
        *_top(memories.tasks, "task", query, now, Numbers.RECALL_TASKS, since, source),
    ]


def recall_hours(view: RobotView, query: str) -> list[Recalled]:
    """What the paper's robot recalls: of what was told on earlier days and of today, merged (PAPER §4.1)."""
    told = recall_both(view.history, query, view.clock, since=None, source="told")
    return _best([*told, *_today(view, query)])


def _today(view: RobotView, query: str) -> list[Recalled]:
    return recall_both(view.guesses, query, view.clock, since=view.clock.day * 24, source="guessed")


def _best(recalled: Iterable[Recalled]) -> list[Recalled]:
    """Merge recalls of several stores: again three intentions and five tasks, best and then newest first."""
    ranked = sorted(recalled, key=_rank)
    intentions = [memory for memory in ranked if memory.kind == "intention"]
    tasks = [memory for memory in ranked if memory.kind == "task"]
    return intentions[: Numbers.RECALL_INTENTIONS] + tasks[: Numbers.RECALL_TASKS]


def recall_weeks(view: RobotView, query: str) -> list[Recalled]:
    """What the robot recalls who lives with somebody for weeks: at least half of it told, the rest guessed today.

    What was told fades by the day and counts more at a like hour of a like day. It is ranked exactly, since every
    intention and every task of these days is scored. DEVIATES: by the paper's decay of 0.95 an hour, yesterday counts
    0.29 and nothing older is ever recalled; the paper describes that decay for one day.
    """
    now, today = view.clock, _today(view, query)
    kept: list[Recalled] = []
    streams: dict[CandidateKind, Readable] = {"intention": view.history.intentions, "task": view.history.tasks}
    for kind, stream in streams.items():
        most = Numbers.RECALL_WEEKS[kind]
        own = [memory for memory in today if memory.kind == kind]
        told = _told(stream, kind, query, now, most)
        kept += sorted([*told[: most - min(len(own), most // 2)], *own[: most // 2]], key=_rank)
    return kept


def _told(stream: Readable, kind: CandidateKind, query: str, now: Clock, most: int) -> list[Recalled]:
    if not now.day:
        return []
    texts, hours, [relevances] = stream.relevances([query], now.day * 24 - 1, (now.day - DAYS) * 24)
    recency = weights(now, hours)
    scores = relevances * np.array(recency)
    best: dict[str, int] = {}  # where each text scores highest, the newest of equals; most are said again and again
    least = 0.0
    for place in np.lexsort((np.arange(len(scores)), scores))[::-1].tolist():
        if len(best) >= most and scores[place] < least:
            break
        if best.setdefault(texts[place], place) == place:
            least = scores[place]
    told = [
        Recalled(
            kind=kind,
            text=text,
            hour=hours[place],
            relevance=float(relevances[place]),
            recency=recency[place],
            score=float(scores[place]),
            source="told",
        )
        for text, place in best.items()
    ]
    return sorted(told, key=_rank)[:most]


def weight(now: Clock, hour: int, width: float = NARROW) -> float:
    """How much a told hour (a global index) counts at this hour of this day, in (0, 1]."""
    return weights(now, [hour], width)[0]


def weights(now: Clock, hours: Sequence[int], width: float = NARROW) -> list[float]:
    """The `weight` of each of many told hours: weeks of them share few days, and few times of day."""
    fade = {day: _faded(now, day) for day in {hour // 24 for hour in hours}}
    alike = [_alike(now, hour_of_day, width) for hour_of_day in range(24)]
    return [fade[hour // 24] * alike[hour % 24] for hour in hours]


def _faded(now: Clock, day: int) -> float:
    """What is left of a told day, in (0, 1]."""
    fade = FADING ** (now.day - day)
    return fade if day_type(now.day) == day_type(day) else fade * OTHER_KIND


def _alike(now: Clock, hour_of_day: int, width: float) -> float:
    """How much a time of day says about now, in (0, 1]."""
    any_hour = _AT_ANY_HOUR[width]
    return any_hour + (1 - any_hour) * math.exp(-(((hour_of_day - now.hour) / width) ** 2) / 2)


def _rank(memory: Recalled) -> tuple[float, int, str]:
    return (-memory.score, -memory.hour, memory.text)


def as_variables(recalled: Iterable[Recalled], now: Clock) -> dict[str, list[dict[str, Any]]]:
    """The variables `recalled_intentions` and `recalled_tasks` of `coopera.core.asks`, best first as they are given."""
    memories = list(recalled)
    return {
        f"recalled_{kind}s": [as_memory(m.text, m.hour, now, m.source) for m in memories if m.kind == kind]
        for kind in ("intention", "task")
    }


def as_memory(text: str, hour: int, now: Clock, source: Source | None = None) -> dict[str, Any]:
    """One memory as prompts read it; `hour` is a global hour index, and `source` is a robot's."""
    day, hour_of_day = divmod(hour, 24)
    label = hour_label(hour_of_day)
    when = label if day == now.day else f"day {day + 1}, {label}"
    return {"when": when, "hours_ago": now.now - hour, "text": text, **({"source": source} if source else {})}


def _top(
    stream: MemoryStream | Readable,
    kind: CandidateKind,
    query: str,
    now: Clock,
    k: int,
    since: int | None,
    source: Source | None,
) -> list[Recalled]:
    return [
        Recalled(
            kind=kind,
            text=r.text,
            hour=r.hour,
            relevance=r.relevance,
            recency=r.recency,
            score=r.score,
            source=r.metadata.get("source", source),
        )
        for r in stream.recall(query, now.now, k, since=since)
    ]
