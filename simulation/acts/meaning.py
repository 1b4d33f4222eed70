"""Which motion a person's words mean at a piece of furniture: a clip that fits there, or else a neutral one.

A caption means itself. Other words are compared in meaning with every caption, alone and together with thing and place.
"""

from __future__ import annotations

import re
from itertools import zip_longest

from coopera.core.affordances import affordances
from coopera.core.household import Act, AgentId, FreeMotion, HandOver, PickPlace, plain
from coopera.simulation.acts.fitting import (
    bears,
    check_hands_over,
    check_in_hand,
    check_moves,
    check_place,
    check_receptacle,
    check_tools,
    in_hand_is,
)
from coopera.simulation.acts.plans import Ground, UnableError
from coopera.simulation.acts.resting import seat_for
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.motions.library import FALLBACK, Meant, Posture
from coopera.simulation.state.home_state import HomeState

LEAST = 0.35
"""From this cosine on words mean a motion; of nonsense MiniLM's nearest caption has at most 0.33 (measured)."""
_SURE, _LESS = 0.6, 0.25
"""Words that mean one motion this surely, and those that fit the furniture so much less, are at the wrong place."""
_COUNTS = 0.1
"""What it counts that a motion is done with the thing in hand, needs another, or has not the posture that is said."""
_SAID: dict[Posture, str] = {
    "sit": "sit sits sitting seated",
    "lie": "lie lies lying laid",
    "stand": "stand stands standing",
}
_POSTURES = {word: posture for posture, words in _SAID.items() for word in words.split()}
_SEATED = "sit and rest"
_NAMED = 4


def misfit(ground: Ground, state: HomeState, agent: AgentId, act: Act) -> str:
    """What stands against an act whatever the moment, as a sentence; empty where it can be tried."""
    try:
        if isinstance(act, PickPlace):
            thing = ground.movable(state, act.object, act.object_id)
            receptacle = ground.receptacle(state, act.receptacle, act.receptacle_id)
            check_receptacle(ground, thing, receptacle, act.relation if receptacle.fixed else "inside")
        elif isinstance(act, HandOver):
            check_hands_over(ground, state, agent, act.object)
        else:
            check_moves(ground, agent)
            target = ground.fixed(act.target, act.target_id)
            meant = motion_meant(ground, state, act, target)
            check_place(ground, ground.motions[meant.caption], target)
            check_in_hand(ground, state, act)
            check_tools(ground, state, act, meant.caption)
    except UnableError as unable:
        return unable.sentence
    return ""


def motion_meant(ground: Ground, state: HomeState, act: FreeMotion, target: SceneObject) -> Meant:
    """The motion that is made for an act's words.

    Of the motions that fit the furniture, and for which there are tools, it is the one that comes nearest: by the mean
    of its cosines with the words alone and with `asked`, and by whether it is done with the thing in hand and in the
    posture that is said. Where it does not come near enough to the words, the motion is neutral: sitting where there is
    a seat, or else standing.

    Raises:
        UnableError: If the words surely mean a motion that cannot be made there, or the body has no neutral one.
    """
    alone = ground.motions.ranked(act.motion, ground.rank)
    if alone[0].likeness == 1.0 and " ".join(act.motion.lower().split()) in ground.motions:
        return alone[0]
    asked = f"{act.motion} with {plain(act.in_hand)} at {plain(target.name)}"
    words = {meant.caption: meant.likeness for meant in alone}
    whole = words if ground.rank is None else dict(ground.rank(asked))
    near = {caption: (words[caption] + whole.get(caption, 0.0)) / 2 for caption in words}
    said = _posture(act.motion)
    ranked = sorted(words, key=lambda caption: -(near[caption] + _fitness(ground, state, act, caption, said)))
    best = next((caption for caption in ranked if _can(ground, state, act, target, caption)), None)
    surest, least = alone[0], LEAST if ground.rank is not None else 1e-9
    if best is not None and words[best] >= max(least, surest.likeness - _LESS if surest.likeness >= _SURE else 0.0):
        return Meant(best, near[best], asked)
    if surest.likeness >= _SURE:
        return Meant(surest.caption, near[surest.caption], asked)
    return _neutral(ground, act, target, asked, alone)


def _neutral(ground: Ground, act: FreeMotion, target: SceneObject, asked: str, alone: list[Meant]) -> Meant:
    stands = FALLBACK if FALLBACK in ground.motions else None
    sits = _SEATED in ground.motions and seat_for(ground, target, []) is not None
    suits = sits and affordances().suits(_SEATED, target.cls) and bears(ground, ground.motions[_SEATED], target)
    caption = _SEATED if suits and _posture(act.motion) != "stand" else stands
    if caption is None:
        near = "; ".join(meant.caption for meant in alone[:_NAMED])
        raise UnableError(f"nobody here knows how to {act.motion!r}; known motions are: {near} and others")
    likeness = next(meant.likeness for meant in alone if meant.caption == caption)
    return Meant(caption, likeness, asked, neutral=True)


def _can(ground: Ground, state: HomeState, act: FreeMotion, target: SceneObject, caption: str) -> bool:
    """Whether a motion can be made at the furniture, with what it needs."""
    try:
        check_place(ground, ground.motions[caption], target)
        check_tools(ground, state, act, caption)
    except UnableError:
        return False
    return True


def _fitness(ground: Ground, state: HomeState, act: FreeMotion, caption: str, said: Posture | None) -> float:
    """What the thing in hand, and a posture that is said, say for or against a motion."""
    used = affordances().of(caption)
    other = said is not None and ground.motions[caption].posture != said
    done_with = (*used.needs, *used.lies)
    if done_with and in_hand_is(ground, state, act.in_hand, done_with):
        return _COUNTS * (1 - other)
    return -_COUNTS * (bool(used.needs) + other)


def _posture(text: str) -> Posture | None:
    """The first posture that words name; who does sit-ups does not sit."""
    words = re.findall(r"[\w-]+", text.lower())
    named = (word for word, after in zip_longest(words, words[1:]) if word != "sit" or after not in ("up", "ups"))
    return next((_POSTURES[word] for word in named if word in _POSTURES), None)
