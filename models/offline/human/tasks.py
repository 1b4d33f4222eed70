"""The person's tasks for an intention, and what the person thinks of them on second thought."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from coopera.core.affordances import affordances
from coopera.core.errors import ModelCallError
from coopera.core.household import plain
from coopera.core.people import Frozen
from coopera.core.replies import FreeMotionDraft, FreeMotionReply, PickPlaceDraft, PickPlaceReply
from coopera.models.offline.household.placing import free_motion, spots, usable
from coopera.models.offline.household.reading import Piece, Surroundings, clip, memories, weighted_order
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human import own_steps, reflection
from coopera.models.offline.human.choosing import DONE, favourite_spot, known, person_placements, reasons
from coopera.models.offline.human.person import PrivateLife
from coopera.models.offline.human.reflection import MOST

AGAIN = 1.6  # weight of a thing that was already used today, against one that was not
IN_TURN = ("First", "Then", "Next", "After that", "Finally")

Answer = Callable[[CommonSense, PrivateLife | None, Mapping[str, Any], np.random.Generator], Frozen]


def pick_and_place(
    sense: CommonSense, life: PrivateLife | None, variables: Mapping[str, Any], rng: np.random.Generator
) -> PickPlaceReply:
    """Answer human/tasks_type1: the person's usual placements among those that the home allows, in sensible order."""
    if variables["steps"]:
        return own_steps.placements(sense, variables)
    person = known(life)
    fixed, movable = Surroundings(variables["fixed"]), Surroundings(variables["movable"])
    activity = person.at_home(sense.recognise(variables["intention"]).activity, fixed)
    before = memories(variables["recalled_tasks"], int(variables["hour"]))
    chosen = person_placements(sense, person, activity, variables, fixed, movable, rng)
    if not chosen:
        raise ModelCallError("human/tasks_type1: the home has no movable or no fixed object to make a task of")
    drafts: list[PickPlaceDraft] = []
    for turn, place in enumerate(chosen):
        thing = plain(place.thing.name)
        drafts.append(
            PickPlaceDraft(
                thought=clip(f"{IN_TURN[min(turn, 4)]}, I want {place.words()}.", 300),
                act=place.act(),
                **reasons(person, activity, variables, before, [draft.act for draft in drafts], thing),
            )
        )
    return PickPlaceReply(tasks=drafts)


def free_motions(
    sense: CommonSense, life: PrivateLife | None, variables: Mapping[str, Any], rng: np.random.Generator
) -> FreeMotionReply:
    """Answer human/tasks_type2: motions at the person's favourite spots with favourite things in hand.

    The motions are those that the household file gives for the activity; those among the examples that the
    prompt offers need not be taken.
    """
    if variables["steps"]:
        return own_steps.motions(sense, variables)
    person = known(life)
    activity = person.own(sense.recognise(variables["intention"]).activity)
    before = memories(variables["recalled_tasks"], int(variables["hour"]))
    options = spots(sense, activity, Surroundings(variables["fixed"]))
    if not options:
        raise ModelCallError("human/tasks_type2: the home has no fixed object to make a task of")
    names = activity.thing_names
    used = sense.mentioned(" ".join(memory.text for memory in before), names)
    done = sense.mentioned(" ".join(variables["so_far"]), names)
    again = [DONE if name in done else AGAIN if name in used else 1.0 for name in names]
    weights = person.thing_weights(activity) * again
    count = int(variables["n_tasks"])
    drawn = weighted_order(weights, rng)
    doable = [i for i in drawn if usable(activity, names[i], options)]
    chosen = [*doable, *(i for i in drawn if i not in doable)]
    chosen = (chosen * count)[: min(count, MOST)] if len(chosen) < count else chosen[:count]
    drafts: list[FreeMotionDraft] = []
    main: Piece | None = None
    for turn, index in enumerate(sorted(chosen)):
        thing = names[index]
        motion = person.motion(activity, thing, options, rng)
        fitting = {cls: pieces for cls, pieces in options.items() if affordances().suits(motion, cls)} or options
        spot = favourite_spot(person, activity, fitting, main, rng)
        main = main or spot
        drafts.append(
            FreeMotionDraft(
                thought=clip(f"{IN_TURN[min(turn, 4)]}, I {motion} at the {plain(spot.name)} with the {thing}.", 300),
                act=free_motion(spot, thing, motion),
                **reasons(person, activity, variables, before, [draft.act for draft in drafts], thing),
            )
        )
    return FreeMotionReply(tasks=drafts)


ANSWERS: dict[str, Answer] = {
    "human/tasks_type1": pick_and_place,
    "human/tasks_type2": free_motions,
    "human/reflect_profile_type1": reflection.profile_type1,
    "human/reflect_profile_type2": reflection.profile_type2,
    "human/reflect_scene_type1": reflection.scene_type1,
    "human/reflect_scene_type2": reflection.scene_type2,
}
