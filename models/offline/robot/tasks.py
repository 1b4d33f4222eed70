"""The robot's tasks for an intention it accepted: what the activity usually needs, and what this person used before."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from coopera.core.errors import ModelCallError
from coopera.core.household import HandOver, PickPlace, plain
from coopera.core.people import Frozen
from coopera.core.replies import HandOverDraft, HandOverReply, PickPlaceDraft, PickPlaceReply
from coopera.models.offline.household.knowledge import Activity
from coopera.models.offline.household.offers import Want, wants
from coopera.models.offline.household.placing import (
    Placement,
    by_name,
    feasible_places,
    fill_up,
    makeshift_places,
    placement,
)
from coopera.models.offline.household.reading import Memory, Surroundings, clip, memories
from coopera.models.offline.household.sense import CommonSense

USED_BEFORE = 1.5  # logits for a thing or a placement that a recalled task of this person shows
HALF_USED = 0.5  # the same for a placement of which only the thing was used
TOLD = 5.0  # logits for what was used in all hours of like intentions that the person told of
SOME = 0.1  # the share of these hours from which a thing or a place is known that the household file lacks
LIKE = 0.6  # cosine from which two intentions are alike where the household file does not know them
DOUBT = 0.5  # scale of the noise among equally plausible things at the usual temperature
USUAL_TEMPERATURE = 0.7

Answer = Callable[[CommonSense, Mapping[str, Any], np.random.Generator, float], Frozen]


def pick_and_place(
    sense: CommonSense, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float
) -> PickPlaceReply:
    """Answer robot/tasks_type1: the most plausible placements that the home allows, without the one already done."""
    count, fixed, movable = (
        int(variables["n_tasks"]),
        Surroundings(variables["fixed"]),
        Surroundings(variables["movable"]),
    )
    recalled = memories(variables["recalled_tasks"], int(variables["hour"]))
    told = {(thing, spot): often for (thing, spot, _), often in _told(variables).items() if spot}
    activity = _as_told(sense, variables, recalled)
    used = wants([memory.text for memory in recalled])
    done = variables["first_task"] or ""
    places = [i for i in feasible_places(activity, fixed, movable) if not _is(activity.places[i], done)]
    logits = []
    for thing, spot in (activity.places[i] for i in places):
        exact = any((want.thing, want.spot) == (plain(thing), plain(spot)) for want in used)
        half = any(want.thing == plain(thing) for want in used)
        often = told.get((plain(thing), plain(spot)), 0.0)
        logits.append((USED_BEFORE if exact else HALF_USED if half else 0.0) + TOLD * often)
    chosen: list[Placement] = []
    for index in (places[i] for i in _ranked(logits, rng, temperature)[:count]):
        chosen.append(placement(activity, index, fixed, movable, [c.thing.name for c in chosen], by_name))
    if len(chosen) < count:
        spare = makeshift_places(sense, activity, fixed, movable)
        chosen = fill_up(chosen, [place for place in spare if not _is_act(place.act(), done)], count)
    if not chosen:
        raise ModelCallError("robot/tasks_type1: the home has no movable or no fixed object to make a task of")
    return PickPlaceReply(
        tasks=[
            PickPlaceDraft(
                thought=clip(f"The person will want {p.words()}.", 300),
                act=p.act(),
                **_reasons(variables, recalled, plain(p.thing.name)),
            )
            for p in chosen
        ]
    )


def hand_overs(
    sense: CommonSense, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float
) -> HandOverReply:
    """Answer robot/tasks_type2: the things that the activity most plausibly needs, from a box that has everything."""
    recalled, count = memories(variables["recalled_tasks"], int(variables["hour"])), int(variables["n_tasks"])
    activity = _as_told(sense, variables, recalled)
    names = [name for name in activity.thing_names if plain(name) != plain(variables["in_hand"] or "")]
    used = sense.mentioned(" ".join(memory.text for memory in recalled), names)
    told: Counter[str] = Counter()
    for (thing, _, _), often in _told(variables).items():
        told[thing] += often  # type: ignore[assignment]
    logits = [(USED_BEFORE if name in used else 0.0) + TOLD * told[plain(name)] for name in names]
    order = _ranked(logits, rng, temperature)
    things = [names[i] for i in order[:count]]
    return HandOverReply(
        tasks=[
            HandOverDraft(
                thought=clip(f"To {activity.things[thing]}, the person will want the {thing}.", 300),
                act=HandOver(object=thing),
                **_reasons(variables, recalled, thing),
            )
            for thing in things
        ]
    )


def _as_told(sense: CommonSense, variables: Mapping[str, Any], recalled: Sequence[Memory]) -> Activity:
    """The activity that an intention speaks of, with what this person was told to use or to place for like ones.

    Without that a robot whose common sense differs from the person's could never offer what it was told. A task is of a
    like intention if one remembered of the same hour is recognised as the same activity or, where either is not known
    to the household file, if the two intentions are alike in meaning.
    """
    intention = str(variables["intention"])
    found = sense.recognise(intention)

    def like(other: str) -> bool:
        theirs = sense.recognise(other)
        if found.sure and theirs.sure:
            return theirs.activity is found.activity
        return sense.similarity(other, intention) >= LIKE

    past = memories(variables["recalled_intentions"], int(variables["hour"]))
    hours = {memory.hours_ago for memory in past if like(memory.text)}
    told = [want for want in wants([m.text for m in recalled if m.hours_ago in hours]) if want.spot]
    told += [
        Want(thing, spot, "", motion) for (thing, spot, motion), often in _told(variables).items() if often >= SOME
    ]
    things = {want.thing: want.motion for want in told if want.motion and want.thing not in found.activity.things}
    places = dict.fromkeys((_class(want.thing), _class(str(want.spot))) for want in told if not want.motion)
    return Activity.model_construct(
        **{
            **dict(found.activity),
            "things": {**found.activity.things, **things},
            "places": tuple(dict.fromkeys([*found.activity.places, *places])),
        }
    )


def _told(variables: Mapping[str, Any]) -> dict[tuple[str, str | None, str], float]:
    """What was told to be used for like intentions, as thing, spot and motion, with its share of these hours."""
    total = sum(float(hour["weight"]) for hour in variables["told"]) or 1.0
    found: dict[tuple[str, str | None, str], float] = {}
    for hour in variables["told"]:
        for want in wants(hour["tasks"]):
            key = (want.thing, want.spot, want.motion)
            found[key] = found.get(key, 0.0) + float(hour["weight"]) / total
    return found


def _class(words: str) -> str:
    return words.replace(" ", "_")


def _ranked(logits: Sequence[float], rng: np.random.Generator, temperature: float) -> list[int]:
    """Order by plausibility; among equals chance decides, more so at a higher temperature."""
    noise = DOUBT * temperature / USUAL_TEMPERATURE * rng.gumbel(size=len(logits))
    return [int(i) for i in np.argsort(-(np.asarray(logits) + noise), kind="stable")]


def _is(pair: tuple[str, str], done: str) -> bool:
    want = wants([done])[0]
    return (want.thing, want.spot) == (plain(pair[0]), plain(pair[1]))


def _is_act(act: PickPlace, done: str) -> bool:
    return _is((act.object, act.receptacle), done)


def _reasons(variables: Mapping[str, Any], recalled: Sequence[Memory], thing: str) -> dict[str, str]:
    shown = next((memory for memory in recalled if f" {thing} " in f" {memory.text} "), None)
    traits = variables["big_five"]
    human = "Nothing is known of this person yet." if not traits else "It is a usual need; the traits do not decide it."
    return {
        "reason_human": human,
        "reason_intentions": clip(f'It belongs to "{variables["intention"]}".', 400),
        "reason_tasks": clip(
            f"It was used before: {shown.text}." if shown else "No remembered task has it; it is usual for this.", 400
        ),
    }


ANSWERS: dict[str, Answer] = {
    "robot/tasks_type1": pick_and_place,
    "robot/tasks_type2": hand_overs,
}
