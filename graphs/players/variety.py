"""What keeps a simulated person's days from being alike: the side whose turn it is, the week, and earlier days.

DEVIATES: the paper's prompts have the hour and the day of the week alone, so each morning of a language model's person
begins in much the same way.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from coopera.core.clock import Clock, hour_label
from coopera.core.people import Persona
from coopera.core.randomness import rng_at
from coopera.core.time_use import day_type
from coopera.graphs.players.changes import Change
from coopera.graphs.players.player import HumanContext

_SENTENCE_END = re.compile(r"(?<=[.!?])\s+")
_ABBREVIATED = re.compile(r"(?<![\w.])(?:mr|mrs|ms|dr|st|prof|vs|approx|e\.g|i\.e|[a-z])\.$", re.IGNORECASE)
_MAY_END = re.compile(r"(?<![\w.])(?:etc|jr|sr|inc|a\.m|p\.m)\.$", re.IGNORECASE)  # a sentence as well as not
_SHORT = 4  # words: fewer say no side of a life
_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh")
_OF_FREE_DAYS = re.compile(r"\bweek-?ends?\b", re.IGNORECASE)
_OF_WORKDAYS = re.compile(r"\b(?:week-?days?|work(?:ing)?[ -]?days?|(?:during|in) the week)\b", re.IGNORECASE)
_SAID = 2  # sentences about a day of the week
_EARLIER = 24  # intentions of earlier days: two days' worth, or more where days are alike


def variety(ctx: HumanContext, clock: Clock, turn: int) -> dict[str, Any]:
    """The variables `side`, `rhythm` and `earlier_days`; `turn` counts the person's hours, or their days, from 0."""
    profile = ctx.model.profile(ctx.persona)
    return {
        "side": side(profile, ctx.seed, ctx.persona, turn),
        "rhythm": rhythm(profile, clock, ctx.changes(clock)),
        "earlier_days": earlier_days(ctx, clock) if ctx.living.remembers_days else "",
    }


def side(profile: str, seed: int, persona: Persona, turn: int) -> str:
    """The side of a life whose turn it is: a sentence of the profile, each once in a round, in an order drawn anew."""
    sides = list(dict.fromkeys(_sentences(profile)))
    lap, place = divmod(turn, len(sides))
    order = rng_at(seed, persona.id, lap, "side").permutation(len(sides))
    return sides[int(order[place])]


def rhythm(profile: str, clock: Clock, changes: Sequence[Change]) -> str:
    """What day it is in the week, and what profile and changes say of such a day; nothing is made up."""
    day, place = clock.weekday, clock.day % 7
    said = [one for one in _sentences(profile) if _speaks_of(clock, one)][:_SAID]
    parts = [
        f"{day}, the {_ORDINALS[place]} day of the week" + (", the weekend" if day_type(clock.day) == "weekend" else "")
    ]
    parts += [f'you say: "{sentence}"' for sentence in said]
    parts += [_work(change, place) for change in changes if change.work is not None]
    return "; ".join(parts)


def earlier_days(ctx: HumanContext, clock: Clock) -> str:
    """What was done on earlier days in one line, the newest day first; what was done often stands with its last day."""
    dawn = clock.day * 24
    days: dict[int, list[str]] = {}
    known: set[str] = set()
    for record in sorted(ctx.memories.intentions.records(), key=lambda one: -one.hour):
        if record.hour < dawn and record.text not in known and len(known) < _EARLIER:
            known.add(record.text)
            days.setdefault(clock.day - record.hour // 24, []).append(record.text)
    return "; ".join(f"{_ago(day)}: {', '.join(reversed(texts))}" for day, texts in days.items())


def _sentences(profile: str) -> list[str]:
    """The sentences of a profile; what is too short to be one stands with its neighbour."""
    found: list[str] = []
    for piece in _SENTENCE_END.split(" ".join(profile.split())):
        if found and _goes_on(found[-1], piece):
            found[-1] += f" {piece}"
        else:
            found.append(piece)
    if len(found) > 1 and len(found[-1].split()) < _SHORT:
        found[-2:] = [" ".join(found[-2:])]
    return found


def _goes_on(before: str, piece: str) -> bool:
    unfinished = _ABBREVIATED.search(before) or (_MAY_END.search(before) and piece[:1].islower())
    return bool(unfinished) or len(before.split()) < _SHORT


def _speaks_of(clock: Clock, sentence: str) -> bool:
    kind = _OF_FREE_DAYS if day_type(clock.day) == "weekend" else _OF_WORKDAYS
    return bool(kind.search(sentence) or re.search(rf"\b{clock.weekday}s?\b", sentence))


def _work(change: Change, weekday: int) -> str:
    """The hours of work that came with a change, as they are on a day of the week (Monday is 0)."""
    work = change.work
    if work is None or work.at == "nowhere" or weekday not in work.days:
        return "you do not work on this day"
    where = "at home" if work.at == "home" else "outside the home"
    return f"you work {where} from {hour_label(work.start)} to {hour_label(work.end % 24)}"


def _ago(days: int) -> str:
    return "yesterday" if days == 1 else f"{days} days ago"
