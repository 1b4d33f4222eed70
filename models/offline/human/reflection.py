"""Second thoughts on tasks (PAPER §3.2, Reflexion): do they fit the person and the day, and can they be done here?

Each check is a real one; a task that fails it gets a "no" with the reason and is replaced or mended.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

import numpy as np

from coopera.core.affordances import affordances
from coopera.core.household import FreeMotion, PickPlace, plain
from coopera.core.replies import (
    FreeMotionDraft,
    FreeMotionReflectionReply,
    FreeMotionReview,
    PickPlaceDraft,
    PickPlaceReflectionReply,
    PickPlaceReview,
)
from coopera.models.offline.household.knowledge import Activity
from coopera.models.offline.household.placing import (
    Placement,
    by_name,
    feasible_places,
    fill_up,
    free_motion,
    makeshift_places,
    placement,
    spots,
    usable,
)
from coopera.models.offline.household.reading import Memory, Piece, Surroundings, class_of, clip, memories
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.choosing import Reasons, known, person_placements, reasons, touchable
from coopera.models.offline.human.person import PrivateLife

KIN = 0.45  # cosine from which a thing that the household file does not name still fits an activity
HARDLY_EVER = 0.015  # weight under which a thing is not this person's
MONOTONE = 3  # one motion may be made this often in an hour, if the activity has others
MOST = 8  # tasks that a reply may hold

A = TypeVar("A", PickPlace, FreeMotion)
D = TypeVar("D", PickPlaceDraft, FreeMotionDraft)


@dataclass(slots=True)
class _Item(Generic[A]):
    """A task under review."""

    id: str
    thought: str
    act: A
    problems: list[str] = field(default_factory=list)


def profile_type1(
    sense: CommonSense, life: PrivateLife | None, variables: Mapping[str, Any], rng: np.random.Generator
) -> PickPlaceReflectionReply:
    """Answer human/reflect_profile_type1: is each placement part of what this person does for the intention?"""
    person = known(life)
    fixed, movable = Surroundings(variables["fixed"]), Surroundings(variables["movable"])
    activity = person.at_home(sense.recognise(variables["intention"]).activity, fixed)
    items = _placements(variables["tasks"])
    fitting = {activity.places[i] for i in feasible_places(activity, fixed, movable)}
    spare = person_placements(
        sense, person, activity, {**variables, "n_tasks": MOST}, fixed=fixed, movable=movable, rng=rng
    )
    _find_repeats(items)
    for item in items:
        if item.act.object not in movable.by_name or item.act.receptacle not in fixed.by_name:
            item.problems.append("not everything it needs is at hand")
        elif len(fitting) >= len(items) and _classes(item.act) not in fitting:
            item.problems.append("this is not how I go about it")
    _replace(items, spare)
    before = memories(variables["recalled_tasks"], int(variables["hour"]))
    problems = [item.problems for item in items]
    return _placing_reply(variables, items, problems, _why(person, activity, variables, before))


def profile_type2(
    sense: CommonSense, life: PrivateLife | None, variables: Mapping[str, Any], _rng: np.random.Generator
) -> FreeMotionReflectionReply:
    """Answer human/reflect_profile_type2: do things, spots, motions and their order fit this person's way?"""
    person = known(life)
    activity = person.own(sense.recognise(variables["intention"]).activity)
    fixed, items = Surroundings(variables["fixed"]), _motions(variables["tasks"])
    options = spots(sense, activity, fixed)
    weights = dict(zip(activity.thing_names, person.thing_weights(activity), strict=True))
    favourites = _usable_first(activity, sorted(weights, key=lambda thing: (-weights[thing], thing)), options)
    for item in items:
        thing = item.act.in_hand
        if thing in weights and weights[thing] < HARDLY_EVER:
            item.problems.append(f"I hardly ever use the {thing}")
            _other_thing(items, item, activity, favourites)
        elif thing not in weights and sense.nearest(thing, activity.thing_names)[1] < KIN:
            item.problems.append(f"the {thing} is of no use for this")
            _other_thing(items, item, activity, favourites)
        elif thing in [other.act.in_hand for other in items[: items.index(item)]]:
            item.problems.append(f"I have the {thing} in hand already")
            _other_thing(items, item, activity, favourites)
        if options and fixed.by_name.get(item.act.target) not in [p for some in options.values() for p in some]:
            item.problems.append(f"the {plain(item.act.target)} is not the place for it")
            _move(item, by_name(next(iter(options.values())), activity.id))
    _vary_motions(items, activity, favourites)
    for item in items:
        _to_a_fitting_place(item, options)
    problems = _in_order(items, activity)
    before = memories(variables["recalled_tasks"], int(variables["hour"]))
    return _moving_reply(variables, items, problems, _why(person, activity, variables, before))


def scene_type1(
    sense: CommonSense, life: PrivateLife | None, variables: Mapping[str, Any], _rng: np.random.Generator
) -> PickPlaceReflectionReply:
    """Answer human/reflect_scene_type1: do the objects exist, is the count right, are the findings obeyed?"""
    person = known(life)
    count = int(variables["n_tasks"])
    fixed, movable = Surroundings(variables["fixed"]), Surroundings(variables["movable"])
    activity = person.at_home(sense.recognise(variables["intention"]).activity, fixed)
    items = _placements(variables["tasks"])
    for item in items:
        thing = _mend(sense, item, item.act.object, item.act.object_id, movable)
        spot = _mend(sense, item, item.act.receptacle, item.act.receptacle_id, fixed)
        if thing is not None and spot is not None:
            as_meant = (item.act.object, item.act.receptacle) == (thing.name, spot.name)
            act = Placement(thing, spot, 0).act()
            item.act = act.model_copy(update={"relation": item.act.relation}) if as_meant else act
    _find_repeats(items)
    _heed(items, variables["findings"])
    mended = [item for item in items if item.problems and all(MENDED in said for said in item.problems)]
    wanting = len(mended) < sum(bool(item.problems) for item in items) or len(items) < count
    spare = _usual_placements(sense, activity, fixed, touchable(person, variables["movable"])) if wanting else []
    _replace([item for item in items if item not in mended], spare, beside=items)
    problems = [item.problems for item in items]
    del items[count:]
    for place in spare:
        if len(items) < count and place.act().describe() not in [item.act.describe() for item in items]:
            items.append(_Item("", f"One more: I {place.act().describe()}.", place.act()))
    return _placing_reply(variables, items, problems, _why(person, activity, variables, []))


def scene_type2(
    sense: CommonSense, life: PrivateLife | None, variables: Mapping[str, Any], _rng: np.random.Generator
) -> FreeMotionReflectionReply:
    """Answer human/reflect_scene_type2: do the targets exist, is the count right, are the findings obeyed?"""
    person = known(life)
    activity = person.own(sense.recognise(variables["intention"]).activity)
    count = int(variables["n_tasks"])
    fixed, items = Surroundings(variables["fixed"]), _motions(variables["tasks"])
    for item in items:
        spot = _mend(sense, item, item.act.target, item.act.target_id, fixed)
        if spot is not None:
            _move(item, spot)
    _find_repeats(items)
    _heed(items, variables["findings"])
    options = spots(sense, activity, fixed)
    things = _usable_first(activity, activity.thing_names, options)
    for item in items:
        if any(MENDED not in said for said in item.problems):
            _other_thing(items, item, activity, things)
    for item in items:
        _to_a_fitting_place(item, options)
    problems = [item.problems for item in items]
    del items[count:]
    for thing in things:
        if len(items) < count and options and thing not in [item.act.in_hand for item in items]:
            more = _Item(
                "", "", free_motion(by_name(next(iter(options.values())), thing), thing, activity.things[thing])
            )
            _to_a_fitting_place(more, options)
            more.thought = f"One more: I {more.act.describe()}."
            items.append(more)
    return _moving_reply(variables, items, problems, _why(person, activity, variables, []))


MENDED = "(mended)"


def _placements(tasks: Sequence[Mapping[str, Any]]) -> list[_Item[PickPlace]]:
    return [_Item(str(t["id"]), str(t["thought"]), PickPlace.model_validate(t["act"])) for t in tasks]


def _motions(tasks: Sequence[Mapping[str, Any]]) -> list[_Item[FreeMotion]]:
    return [_Item(str(t["id"]), str(t["thought"]), FreeMotion.model_validate(t["act"])) for t in tasks]


def _find_repeats(items: Sequence[_Item[A]]) -> None:
    seen: set[str] = set()
    for item in items:
        text = item.act.describe()
        if text in seen:
            item.problems.append("it repeats a task before it")
        seen.add(text)


def _heed(items: Sequence[_Item[A]], findings: Sequence[Any]) -> None:
    """Add what was found about each task by its id; a finding without any id is about the tasks whose words it has."""
    ids = [item.id for item in items]
    for finding in map(str, findings):
        named = [i for i in ids if re.search(rf"(?<![\d.]){re.escape(i)}(?!\d)", finding)]
        for item in items:
            about = item.id in named if named else item.act.describe() in finding
            if about and not item.problems:
                item.problems.append(finding)


def _mend(sense: CommonSense, item: _Item[A], name: str, number: int, objects: Surroundings) -> Piece | None:
    """Return the object meant: the named one, or the nearest in meaning that exists; None in an empty home."""
    piece = objects.by_name.get(name)
    if piece is not None:
        if piece.id != number:
            item.problems.append(f"{name} has the id {piece.id} {MENDED}")
        return piece
    if not objects.pieces:
        item.problems.append(f"there is no {name}, nor anything instead")
        return None
    nearest = objects.pieces[sense.nearest(plain(name), [plain(p.name) for p in objects.pieces])[0]]
    item.problems.append(f"there is no {name}; {nearest.name} comes nearest {MENDED}")
    return nearest


def _usual_placements(
    sense: CommonSense, activity: Activity, fixed: Surroundings, movable: Surroundings
) -> list[Placement]:
    """Return what anybody would place for the activity in this home: enough to replace all that a reply may hold."""
    usual: list[Placement] = []
    for index in feasible_places(activity, fixed, movable):
        usual.append(placement(activity, index, fixed, movable, [p.thing.name for p in usual], by_name))
    return fill_up(usual, makeshift_places(sense, activity, fixed, movable), len(usual) + MOST)


def _replace(
    items: Sequence[_Item[PickPlace]],
    spare: Sequence[Placement],
    beside: Sequence[_Item[PickPlace]] | None = None,
) -> None:
    """Give each task with a problem another placement, of another thing if there is one; without any it stays."""
    everything = items if beside is None else beside
    for item in items:
        taken = {other.act.describe() for other in everything}
        things = {other.act.object for other in everything}
        free = [place for place in spare if place.act().describe() not in taken]
        fresh = next((place for place in free if place.thing.name not in things), free[0] if free else None)
        if item.problems and fresh is not None:
            item.act = fresh.act()
            item.thought = f"Better: I {item.act.describe()}."


def _other_thing(
    items: Sequence[_Item[FreeMotion]], item: _Item[FreeMotion], activity: Activity, things: Sequence[str]
) -> None:
    """Take the best thing that no task has in hand yet, with its usual motion."""
    taken = {other.act.in_hand for other in items}
    fresh = next((thing for thing in things if thing not in taken), None)
    if fresh is not None:
        item.act = item.act.model_copy(update={"in_hand": fresh, "motion": activity.things[fresh]})
        item.thought = f"Better: I {item.act.describe()}."


def _usable_first(activity: Activity, things: Sequence[str], options: Mapping[str, Sequence[Piece]]) -> list[str]:
    return sorted(things, key=lambda thing: not usable(activity, thing, options))


def _vary_motions(items: Sequence[_Item[FreeMotion]], activity: Activity, things: Sequence[str]) -> None:
    """Where one motion would be made over and over, take a thing with which one does something else."""
    for item in items:
        made = [other.act.motion for other in items]
        taken = {other.act.in_hand for other in items}
        others = [thing for thing in things if activity.things[thing] not in made and thing not in taken]
        if made.count(item.act.motion) > MONOTONE and others:
            item.problems.append(f"too often the same: {item.act.motion}")
            _other_thing(items, item, activity, others)


def _to_a_fitting_place(item: _Item[FreeMotion], options: Mapping[str, Sequence[Piece]]) -> None:
    """Go where the motion can be made, if the activity has such a place here."""
    suits, motion = affordances().suits, item.act.motion
    fitting = next((pieces for cls, pieces in options.items() if suits(motion, cls)), None)
    if fitting is not None and not suits(motion, class_of(item.act.target)):
        item.problems.append(f"nobody would {motion} at the {plain(item.act.target)}")
        _move(item, by_name(fitting, motion))


def _move(item: _Item[FreeMotion], spot: Piece) -> None:
    item.act = item.act.model_copy(update={"target": spot.name, "target_id": spot.id})


def _in_order(items: list[_Item[FreeMotion]], activity: Activity) -> list[list[str]]:
    """Put the tasks in the order in which their things come into play; return the problems in the old order."""
    place = {thing: i for i, thing in enumerate(activity.thing_names)}
    latest = -1
    for item in items:
        turn = place.get(item.act.in_hand, latest)
        if turn < latest:
            item.problems.append(f"the {item.act.in_hand} is needed earlier")
        latest = max(latest, turn)
    problems = [item.problems for item in items]
    items.sort(key=lambda item: place.get(item.act.in_hand, len(place)))
    return problems


def _classes(act: PickPlace) -> tuple[str, str]:
    return re.sub(r"_\d+$", "", act.object), re.sub(r"_\d+$", "", act.receptacle)


Why = Callable[[Sequence[PickPlace | FreeMotion], str], Reasons]


def _why(person: PrivateLife, activity: Activity, variables: Mapping[str, Any], before: Sequence[Memory]) -> Why:
    return lambda done, thing: reasons(person, activity, variables, before, done, thing)


def _placing_reply(
    variables: Mapping[str, Any], items: Sequence[_Item[PickPlace]], problems: Sequence[Sequence[str]], why: Why
) -> PickPlaceReflectionReply:
    acts = [item.act for item in items]
    drafts = [
        PickPlaceDraft(thought=clip(item.thought, 300), act=item.act, **why(acts[:i], plain(item.act.object)))
        for i, item in enumerate(items)
    ]
    given = [item.act for item in _placements(variables["tasks"])]
    said = _reviewed(given, drafts, problems)
    return PickPlaceReflectionReply(
        reviews=[PickPlaceReview(reason=reason, yes=yes, task=task) for reason, yes, task in said],
        add=drafts[len(given) :],
    )


def _moving_reply(
    variables: Mapping[str, Any], items: Sequence[_Item[FreeMotion]], problems: Sequence[Sequence[str]], why: Why
) -> FreeMotionReflectionReply:
    acts = [item.act for item in items]
    drafts = [
        FreeMotionDraft(thought=clip(item.thought, 300), act=item.act, **why(acts[:i], item.act.in_hand))
        for i, item in enumerate(items)
    ]
    given = [item.act for item in _motions(variables["tasks"])]
    said = _reviewed(given, drafts, problems)
    return FreeMotionReflectionReply(
        reviews=[FreeMotionReview(reason=reason, yes=yes, task=task) for reason, yes, task in said],
        add=drafts[len(given) :],
    )


def _reviewed(
    given: Sequence[PickPlace | FreeMotion], drafts: Sequence[D], problems: Sequence[Sequence[str]]
) -> Iterator[tuple[str, bool, D | None]]:
    """For each given task the reason, the verdict, and the draft in its place; None if it stays, or if it goes.

    A task for which there is nothing better stays in spite of its problems: it is given back as it was.
    """
    for n, (act, wrong) in enumerate(zip(given, problems, strict=True)):
        draft = drafts[n] if n < len(drafts) else None
        if draft is None:
            yield "There are tasks enough without it.", False, None
        elif wrong or draft.act != act:
            yield clip("; ".join(wrong) or "Another task comes before it.", 200), False, draft
        else:
            yield "It fits as it is.", True, None
