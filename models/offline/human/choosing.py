"""How a person chooses: which things go where, where to move, and the reasons given for it. Person's side only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from typing_extensions import TypedDict

from coopera.core.errors import ModelCallError
from coopera.core.household import FreeMotion, PickPlace, plain
from coopera.models.offline.household.knowledge import Activity
from coopera.models.offline.household.offers import wants
from coopera.models.offline.household.placing import Placement, feasible_places, fill_up, makeshift_places, placement
from coopera.models.offline.household.reading import Memory, Piece, Surroundings, class_of, clip, weighted_order
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.person import PrivateLife

STAY = 0.5  # chance to stay at the main spot for the next task
DONE = 0.02  # weight of what was done in the hour that is gone on from: other steps come now
AWAY = 0.15  # weight of a spot in another room than the main one


class Reasons(TypedDict):
    """The reasons of a task, as fields of a draft."""

    reason_human: str
    reason_intentions: str
    reason_tasks: str


def person_placements(
    sense: CommonSense,
    person: PrivateLife,
    activity: Activity,
    variables: Mapping[str, Any],
    fixed: Surroundings,
    movable: Surroundings,
    rng: np.random.Generator,
) -> list[Placement]:
    """Return n distinct placements (fewer only where the home has no more), in the order in which they are done."""

    def pick(pieces: Sequence[Piece], what: str) -> Piece:
        name = person.favourite([piece.name for piece in pieces], what)
        return next(piece for piece in pieces if piece.name == name)

    count, weights = int(variables["n_tasks"]), person.place_weights(activity)
    done = {(want.thing, want.spot) for want in wants(variables.get("so_far", ()))}
    feasible = feasible_places(activity, fixed, movable)
    again = [DONE if tuple(map(plain, activity.places[i])) in done else 1.0 for i in feasible]
    order = weighted_order([float(weights[i]) * once for i, once in zip(feasible, again, strict=True)], rng)
    chosen: list[Placement] = []
    for index in (feasible[i] for i in order[:count]):
        chosen.append(placement(activity, index, fixed, movable, [c.thing.name for c in chosen], pick))
    if len(chosen) < count:
        within_reach = touchable(person, variables["movable"])
        chosen = fill_up(chosen, makeshift_places(sense, activity, fixed, within_reach), count)
    return sorted(chosen, key=lambda place: place.order)


def touchable(person: PrivateLife, movable: Mapping[str, Sequence[Any]]) -> Surroundings:
    """The home's objects without those that facts rule out, such as the wine; all, where it has no others."""
    ruled_out = person.facts.never_things
    return Surroundings({name: movable[name] for name in movable if plain(class_of(name)) not in ruled_out} or movable)


def favourite_spot(
    person: PrivateLife,
    activity: Activity,
    options: Mapping[str, Sequence[Piece]],
    main: Piece | None,
    rng: np.random.Generator,
) -> Piece:
    """Choose where to move: the person's favourite spots, mostly in the room where the activity began."""
    if main is not None and rng.random() < STAY and main in options.get(main.cls, ()):
        return main
    by_class = dict(zip(activity.fixed, person.spot_weights(activity), strict=True))
    pieces = [piece for some in options.values() for piece in some]
    weights = np.array([float(by_class.get(piece.cls, 1.0)) / len(options[piece.cls]) for piece in pieces])
    if main is not None:
        weights *= [1.0 if piece.room == main.room else AWAY for piece in pieces]
    chosen = pieces[int(rng.choice(len(pieces), p=weights / weights.sum()))]
    same = [piece for piece in options[chosen.cls] if piece.room == chosen.room]
    name = person.favourite([piece.name for piece in same], activity.id)
    return next(piece for piece in same if piece.name == name)


def reasons(
    person: PrivateLife,
    activity: Activity,
    variables: Mapping[str, Any],
    before: Sequence[Memory],
    done: Sequence[PickPlace | FreeMotion],
    thing: str,
) -> Reasons:
    """Return the three reasons of a task: the person, the intention, and the tasks before it."""
    human = person.own_words(activity) or f"It is a habit: the {thing} is what I usually reach for."
    earlier = [memory for memory in before if f" {thing} " in f" {memory.text} "]
    if earlier:
        tasks = f"I already had the {thing} today, when I wanted to {earlier[0].text}."
    elif done:
        tasks = f"It goes on from the task before: {done[-1].describe()}."
    elif before:
        tasks = f"Earlier I did this: {before[0].text}. Now something else begins."
    else:
        tasks = "It is the first thing to do."
    intentions = f'It is part of "{variables["intention"]}".'
    return Reasons(
        reason_human=clip(human, 400), reason_intentions=clip(intentions, 400), reason_tasks=clip(tasks, 400)
    )


def known(life: PrivateLife | None) -> PrivateLife:
    """Return the life, or say that the prompt named no person.

    Raises:
        ModelCallError: If there is none.
    """
    if life is None:
        raise ModelCallError("the prompt's variables do not say who the person is")
    return life
