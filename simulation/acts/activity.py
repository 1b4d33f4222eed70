"""The place of a person's body for a motion at a piece of furniture: the seat, the spot and the heights."""

from __future__ import annotations

import math

import numpy as np

from coopera.core.household import AgentId, FreeMotion, plain
from coopera.simulation.acts.agents import named
from coopera.simulation.acts.navigation import Disc, Stand, clearance, obstacle_boxes
from coopera.simulation.acts.plans import (
    Ground,
    Placed,
    Plan,
    Play,
    UnableError,
    Watch,
    all_clear_of,
    clear_of,
    taken_by_others,
)
from coopera.simulation.acts.skills import emptied
from coopera.simulation.acts.state import HomeState, PersonState
from coopera.simulation.acts.walking import walk_to_deed
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.homes.catalogue import Rest, blocks, lying_place, seat, surfaces
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.motions.library import Motion
from coopera.simulation.motions.poses import Setting, pose_at
from coopera.simulation.shapes.rotations import wrapped

STEPPED_ON = ("treadmill", "shower", "rug")
"""Furniture that the person acts on, not in front of."""
_SEAT_NEAR = 0.9
"""A seat this near to a table or an instrument serves it (metres between their rectangles)."""
_SEAT_FAR = 5.0
"""A seat this near serves what is only looked at or listened to."""
_LOOKS_AT = math.radians(70)
"""A seat serves a table only if one looks at it from there."""
_WORKTOP = (0.45, 1.3)
_KEYS = 0.61  # a piano's keyboard, as a share of its height
_ROOMY = ("exercise", "move around to music", "work near the floor")
_LIE_ON_WIDTH = ("sofa", "bench")
_OFF = 0.1
"""A body this far from the spot where its person would stand is on a piece of furniture (metres)."""
_SITTING, _LYING = 0.5, 0.9
"""Nobody else sits nearer than this to who sits, or lies (metres between the bodies' middles)."""
_STANDS, _ANY = 12, 1000
"""From how many places at a piece of furniture one chooses, and from how many where those are taken."""
_ASIDE = 0.6
"""How far beside the middle of a wide seat another one sits (metres)."""


def free_motion(ground: Ground, state: HomeState, agent: AgentId, act: FreeMotion, watch: Watch | None = None) -> Plan:
    """Plan a free-form task: go to the furniture, take its place there (sit, lie, step on, stand) and do the motion.

    The thing in hand is kept if the person has it; else they take it from the magic box, and what they held from
    there goes back.

    Raises:
        UnableError: With the reason why it cannot be done.
    """
    plan = Plan(state)
    target = ground.fixed(act.target)
    motion = ground.motions.match(act.motion, ground.search)
    person, used = _placed(ground, plan, agent, target, motion)
    pose = pose_at(motion, 0.0, Setting(person.support, person.worktop, person.posture))
    walk_to_deed(ground, plan, agent, Placed(*person.place, person.yaw, pose), person.spot, watch, act.in_hand)
    spot = plan.state.agents[agent].spot
    place = spot if person.place == person.spot else person.place
    plan.state = emptied(plan.state, agent).out_of_box(ground.scene, agent, act.in_hand)
    held = plan.state.agents[agent].thing
    person = person.model_copy(update={"spot": spot, "place": place, "motion": motion.caption, "thing": held})
    plan.steps.append(Play(agent, person, motion))
    plan.state = plan.state.put(agent, person)
    hands = _hands(person, motion)
    things = [target] if used is target else [target, used]
    plan.at = [thing.name for thing in sorted(things, key=lambda thing: round(thing.bounds.distance(*hands), 3))]
    return plan


def stay(ground: Ground, state: HomeState, agent: AgentId, watch: Watch) -> Plan:
    """Plan that a person goes on with what they are doing, and a robot comes to see it."""
    plan, person = Plan(state), state.person(agent)
    motion = ground.motions[person.motion]
    pose = pose_at(motion, 0.0, Setting(person.support, person.worktop, person.posture))
    watch(plan, Placed(*person.place, person.yaw, pose), person.spot)
    plan.steps.append(Play(agent, person, motion))
    plan.at = [person.at] if person.at is not None else []
    return plan


def _hands(person: PersonState, motion: Motion) -> Point:
    """Where the hands are on the floor plan: what lies under them is what the person is at."""
    frames = forward(pose_at(motion, 0.0, Setting(person.support, person.worktop, person.posture)))
    middle = (frames.place["right_hand"] + frames.place["left_hand"]) / 2
    cos, sin = math.cos(person.yaw), math.sin(person.yaw)
    x, y = float(middle[0]), float(middle[1])
    return person.place[0] + x * cos - y * sin, person.place[1] + x * sin + y * cos


def _placed(
    ground: Ground, plan: Plan, agent: AgentId, target: SceneObject, motion: Motion
) -> tuple[PersonState, SceneObject]:
    """Choose where the body goes, and the furniture that it uses for that."""
    used = _used_by_others(plan.state, agent)
    if motion.posture == "sit" and (found := _seat_for(ground, target, used)) is not None:
        chair, rest = found
        worktop = _worktop(target) if chair is not target and _gap(chair, target) <= _SEAT_NEAR else None
        spot = _stand(ground, plan, agent, chair, (rest.x, rest.y))
        return _resting(rest, spot, target, worktop, "sit"), chair
    if motion.posture == "lie" and (found := _bed_for(ground, target, used)) is not None:
        bed, rest = found
        spot = _stand(ground, plan, agent, bed, None)
        return _resting(rest, spot, target, None, "lie"), bed
    if motion.posture in ("floor", "lie"):
        x, y, yaw = _open_floor(ground, plan, agent, target)
        return PersonState(spot=(x, y), place=(x, y), yaw=yaw, posture=motion.posture, at=target.name), target
    return _upright(ground, plan, agent, target, motion), target


def _resting(rest: Rest, spot: Stand, target: SceneObject, worktop: float | None, how: str) -> PersonState:
    return PersonState.model_validate(
        {
            "spot": (spot.x, spot.y),
            "place": (rest.x, rest.y),
            "yaw": rest.heading,
            "support": rest.z,
            "worktop": worktop,
            "posture": how,
            "at": target.name,
        }
    )


def _gap(one: SceneObject, two: SceneObject) -> float:
    a, b = one.bounds, two.bounds
    return math.hypot(max(a.x0 - b.x1, b.x0 - a.x1, 0.0), max(a.y0 - b.y1, b.y0 - a.y1, 0.0))


def _used_by_others(state: HomeState, agent: AgentId) -> list[Disc]:
    """The furniture that other people are on: the places of their bodies, and how near to them nobody else fits."""
    people = [state.person(one) for one in state.ids("person") if one != agent]
    on_it = [person for person in people if math.dist(person.spot, person.place) > _OFF]
    return [Disc(*person.place, _LYING if person.posture == "lie" else _SITTING) for person in on_it]


def _fits(place: Point, used: list[Disc]) -> bool:
    return all(math.dist(place, (disc.x, disc.y)) >= disc.radius for disc in used)


def _seat_on(thing: SceneObject, used: list[Disc]) -> Rest | None:
    """Where one sits on a thing: in its middle, or beside who sits there; None where one does not, or it is taken."""
    middle = seat(thing)
    if middle is None:
        return None
    cos, sin = math.cos(thing.yaw), math.sin(thing.yaw)
    for aside in (0.0, _ASIDE, -_ASIDE):
        rest = middle._replace(x=middle.x + aside * cos, y=middle.y + aside * sin)
        if (aside == 0.0 or thing.size[0] >= 2 * _ASIDE + _SITTING) and _fits((rest.x, rest.y), used):
            return rest
    return None


def _seat_for(ground: Ground, target: SceneObject, used: list[Disc]) -> tuple[SceneObject, Rest] | None:
    """The target itself where one sits on it; else the seat of its room that is near and looks at it best."""
    own = _seat_on(target, used)
    if own is not None:
        return target, own
    far = _SEAT_FAR if target.cls in ("television", "tv_stand", "fireplace", "curtain", "rug") else _SEAT_NEAR
    found: list[tuple[float, str, SceneObject, Rest]] = []
    for thing in ground.scene.fixed:
        rest = _seat_on(thing, used)
        if rest is None or thing.room != target.room or thing.cls in ("toilet", "bathtub"):
            continue
        gap = _gap(thing, target)
        if gap <= far:
            off = abs(wrapped(math.atan2(target.xy[1] - rest.y, target.xy[0] - rest.x) - rest.heading))
            if off <= _LOOKS_AT or far == _SEAT_FAR:
                found.append((round(gap + 0.6 * off, 6), thing.name, thing, rest))
    if not found:
        return None
    _, _, chair, rest = min(found, key=lambda row: row[:2])
    return chair, rest


def _bed_for(ground: Ground, target: SceneObject, used: list[Disc]) -> tuple[SceneObject, Rest] | None:
    """The target where one lies on it (along a sofa, too); else a bed of the same room."""
    beds = [thing for thing in ground.scene.fixed if thing.room == target.room and thing.cls == "bed"]
    sofas = [thing for thing in ground.scene.fixed if thing.room == target.room and thing.cls == "sofa"]
    for thing in (target, *beds, *sofas):
        if any(thing.bounds.distance(disc.x, disc.y) <= 0 for disc in used):
            continue
        rest = lying_place(thing)
        if rest is not None:
            return thing, rest
        sitting = seat(thing)
        if sitting is not None and thing.cls in _LIE_ON_WIDTH and thing.size[0] > 1.5:
            return thing, sitting._replace(heading=thing.yaw)
    return None


def _worktop(target: SceneObject) -> float | None:
    """The height at which hands work at a piece of furniture."""
    if target.cls == "piano":
        return target.position[2] + _KEYS * target.size[2]
    if target.position[2] >= _WORKTOP[0]:  # a machine on a counter is worked at on that counter
        return target.position[2] + 0.1
    for surface in surfaces(target):
        height = target.position[2] + surface.z
        if _WORKTOP[0] <= height <= _WORKTOP[1]:
            return height
    return None


def _stand(ground: Ground, plan: Plan, agent: AgentId, target: SceneObject, near: Point | None) -> Stand:
    """The best place to stand at a piece of furniture, the others permitting; where it is crowded, any place there."""
    taken = taken_by_others(plan.state, agent)
    start = plan.state.agents[agent].spot
    crowded = len(plan.state.ids("person")) > 1
    best: Stand | None = None
    for most in (_STANDS, _ANY) if crowded else (_STANDS,):
        stands = ground.navigator.approach(target, start, most=most)
        if near is not None:
            stands.sort(key=lambda stand: round(math.dist((stand.x, stand.y), near), 3))
        best = best or next(iter(stands), None)
        clear = next((stand for stand in stands if clear_of((stand.x, stand.y), taken)), None)
        if clear is not None:
            return clear
    if best is None:
        raise UnableError(f"{named(agent)} finds no place to stand at the {plain(target.name)}")
    return best


def _upright(ground: Ground, plan: Plan, agent: AgentId, target: SceneObject, motion: Motion) -> PersonState:
    """Standing at the target, on it where one steps on it, or near it with elbow room for large motions."""
    worktop = _worktop(target)
    if target.cls in STEPPED_ON and _fits(target.xy, _used_by_others(plan.state, agent)):
        stand = _stand(ground, plan, agent, target, target.xy)
        yaw = target.facing + (math.pi if target.cls == "treadmill" else 0.0)
        height = target.position[2] + min(surfaces(target)[0].z, 0.2)
        spot = (stand.x, stand.y)
        place = target.xy if blocks(target) else spot
        support = height if blocks(target) else 0.0
        return PersonState(spot=spot, place=place, yaw=wrapped(yaw), support=support, at=target.name)
    if motion.cls in _ROOMY:
        x, y, yaw = _open_floor(ground, plan, agent, target)
        return PersonState(spot=(x, y), place=(x, y), yaw=yaw, worktop=worktop, at=target.name)
    stand = _stand(ground, plan, agent, target, None)
    spot = (stand.x, stand.y)
    return PersonState(spot=spot, place=spot, yaw=stand.yaw, worktop=worktop, at=target.name)


def _open_floor(ground: Ground, plan: Plan, agent: AgentId, target: SceneObject) -> tuple[float, float, float]:
    """A place near the target with much free floor around it, and the heading with most room ahead and behind."""
    scene = ground.scene
    boxes = obstacle_boxes((thing for thing in scene.fixed if blocks(thing)), scene.walls())
    cells = ground.navigator.cells_in(target.room)
    if not len(cells):
        raise UnableError(f"{named(agent)} finds no place to stand near the {plain(target.name)}")
    gap = clearance(cells[:, 0], cells[:, 1], obstacle_boxes([target], []))
    room = np.minimum(ground.navigator.clearance_in(target.room), 0.9)
    score = room - 0.25 * np.maximum(gap - 0.5, 0.0)
    taken = taken_by_others(plan.state, agent)
    best = int(np.where(all_clear_of(cells, taken), score, score - 5.0).argmax())
    x, y = float(cells[best, 0]), float(cells[best, 1])
    headings = np.arange(16) * math.pi / 8
    along = np.array((-0.9, -0.5, 0.5, 0.8))
    ahead, aside = np.outer(np.cos(headings), along), np.outer(np.sin(headings), along)
    strip = clearance(x + ahead, y + aside, boxes).min(axis=1).round(3)
    return x, y, float(headings[int(strip.argmax())])
