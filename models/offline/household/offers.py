"""The things in task candidates and in tasks, read from their words or their data. Shared common sense."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from coopera.core.household import plain
from coopera.models.offline.household.reading import said

_BRING = re.compile(r"\bbring (?:the |a |an |some )?(?P<thing>.+?)\.?$", re.IGNORECASE)
_PUT = re.compile(
    r"\bput (?:the |a |an )?(?P<thing>.+?) (?:on|in|into|onto) (?:the |a |an )?(?P<spot>.+?)\.?$", re.IGNORECASE
)
_IN_HAND = re.compile(r" at the (?P<spot>.+?) with the (?P<thing>.+?) in hand\.?$", re.IGNORECASE)


class Want(NamedTuple):
    """A thing, the furniture it goes to or is used at, the motion made with it, and all that was said, as words."""

    thing: str
    spot: str | None
    text: str
    motion: str = ""


def wants(items: Sequence[Any]) -> list[Want]:
    """Read tasks or task candidates, from their act where it is given and else from their words."""
    return [_want(item) for item in items]


def _want(item: Any) -> Want:
    text = said(item)
    act = item.get("act") if isinstance(item, Mapping) else None
    if isinstance(act, Mapping):
        thing = act.get("in_hand") or act.get("object")
        spot = act.get("receptacle") or act.get("target")
        if thing:
            return Want(plain(str(thing)), plain(str(spot)) if spot else None, text, str(act.get("motion", "")))
    for pattern in (_IN_HAND, _PUT, _BRING):
        if found := pattern.search(text):
            groups = found.groupdict()
            motion = text[: found.start()].strip() if pattern is _IN_HAND else ""
            return Want(plain(groups["thing"]), plain(groups["spot"]) if groups.get("spot") else None, text, motion)
    return Want(text, None, text)
