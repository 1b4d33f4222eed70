"""Putting a real person's own words into tasks: which objects of the home they name, or come nearest to naming."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from coopera.core.affordances import affordances
from coopera.core.errors import ModelCallError
from coopera.core.household import plain
from coopera.core.replies import FreeMotionDraft, FreeMotionReply, PickPlaceDraft, PickPlaceReply
from coopera.models.offline.household.knowledge import key
from coopera.models.offline.household.placing import Placement, free_motion, spots
from coopera.models.offline.household.reading import Piece, Surroundings, clip
from coopera.models.offline.household.sense import CommonSense

_TARGET = re.compile(
    r"\b(?P<where>on|onto|in|into|at|to|under|by|next to|beside)\s+(?:the\s+|my\s+|a\s+)?(?P<place>[^,]+)$"
)
_WITH = re.compile(r"\bwith\s+(?:the\s+|my\s+|a\s+|an\s+|some\s+)?(?P<thing>\w+(?:\s\w+)?)")


def placements(sense: CommonSense, variables: Mapping[str, Any]) -> PickPlaceReply:
    """Make a pick-and-place of each step: the thing that it names, and the place after "on", "in" or the like.

    "On" and "in" are taken at their word, where the place holds things within it.

    Raises:
        ModelCallError: If the home has no movable or no fixed object.
    """
    fixed, movable = Surroundings(variables["fixed"]), Surroundings(variables["movable"])
    if not fixed.pieces or not movable.pieces:
        raise ModelCallError("human/tasks_type1: the home has no movable or no fixed object to make a task of")
    drafts = []
    for step in map(str, variables["steps"]):
        where = _TARGET.search(step)
        place = _named(sense, where["place"] if where else step, fixed.pieces)
        thing = _named(sense, step[: where.start()] if where else step, movable.pieces)
        act = Placement(thing, place, 0).act()
        if where and where["where"] in ("on", "onto"):
            act = act.model_copy(update={"relation": "on"})
        elif where and where["where"] in ("in", "into") and affordances().contains(place.cls):
            act = act.model_copy(update={"relation": "inside"})
        drafts.append(PickPlaceDraft(thought=clip(f"I {step}.", 300), act=act))
    return PickPlaceReply(tasks=drafts)


def motions(sense: CommonSense, variables: Mapping[str, Any]) -> FreeMotionReply:
    """Make a free motion of each step: its words are the motion; place and thing are those it names, or usual ones.

    Raises:
        ModelCallError: If the home has no fixed object.
    """
    activity = sense.recognise(variables["intention"]).activity
    fixed = Surroundings(variables["fixed"])
    if not fixed.pieces:
        raise ModelCallError("human/tasks_type2: the home has no fixed object to make a task of")
    usual = next(iter(spots(sense, activity, fixed).values()))[0]
    known = [thing for other in sense.household.activities for thing in other.thing_names]
    drafts = []
    for step in map(str, variables["steps"]):
        spot = _mentioned(step, fixed.pieces) or usual
        held = _WITH.search(step)
        names = sorted(set(sense.mentioned(step, known)), key=lambda thing: (-len(thing), thing))
        thing = names[0] if names else held["thing"] if held else _likely(sense, step, activity.thing_names)
        act = free_motion(spot, thing, clip(_movement(step, plain(spot.name), thing), 200))
        drafts.append(FreeMotionDraft(thought=clip(f"I {step}.", 300), act=act))
    return FreeMotionReply(tasks=drafts)


def _named(sense: CommonSense, words: str, pieces: Sequence[Piece]) -> Piece:
    """Return the object whose name stands in the words, or else the one nearest in meaning."""
    named = _mentioned(words, pieces)
    return named or pieces[sense.nearest(words or "thing", [plain(piece.name) for piece in pieces])[0]]


def _mentioned(words: str, pieces: Sequence[Piece]) -> Piece | None:
    """Return the object whose name stands in the words; of several the longest name, then the first."""
    said = f" {key(words)} "
    found = [piece for piece in pieces if f" {key(plain(piece.name))} " in said]
    return min(found, key=lambda piece: (-len(plain(piece.name)), piece.name), default=None)


def _movement(step: str, place: str, thing: str) -> str:
    """Return a step without the place and the thing that its task names anyway."""
    the = r"(?:the\s+|my\s+|a\s+|an\s+|some\s+)?"
    at = rf"(?:at|on|in|by|near)\s+{the}{re.escape(place)}"
    held = rf"with\s+{the}{re.escape(thing)}(?:\s+in\s+(?:my\s+)?hand)?"
    tail = rf"\s+(?:{at}|{held})\b"
    return re.sub(tail, "", step, flags=re.IGNORECASE).strip(" .,") or step


def _likely(sense: CommonSense, step: str, things: Sequence[str]) -> str:
    return things[sense.nearest(step, things)[0]]
