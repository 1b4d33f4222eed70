"""A person's free-form task: what it is done with is fetched, the body takes its place at the furniture, and moves."""

from __future__ import annotations

import math

import numpy as np

from coopera.core.affordances import affordances
from coopera.core.household import AgentId, FreeMotion, plain
from coopera.simulation.acts import effects
from coopera.simulation.acts.equipment import Workplace, bring_tool, gather, take_in_hand, undress
from coopera.simulation.acts.fitting import check_in_hand, check_place, check_tools, in_hand_is
from coopera.simulation.acts.meaning import motion_meant
from coopera.simulation.acts.plans import (
    Dress,
    Ground,
    Placed,
    Plan,
    Play,
    UnableError,
    Watch,
    all_clear_of,
    clear_of,
    stand_up,
    taken_by_others,
)
from coopera.simulation.acts.resting import SEAT_NEAR, bed_for, fits, seat_for, used_by_others
from coopera.simulation.acts.walking import walk_to_deed
from coopera.simulation.acts.workplace import at_work
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.homes.catalogue import Rest, blocks, surfaces
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.motions.library import Motion
from coopera.simulation.motions.poses import pose_at
from coopera.simulation.shapes.rotations import Array, wrapped
from coopera.simulation.state.agents import named
from coopera.simulation.state.home_state import HomeState, PersonState
from coopera.simulation.ways.navigation import Stand, clearance, obstacle_boxes

_SWEPT = np.array([(x, y) for x in (0.45, 0.65, 0.85, 1.05) for y in (-0.45, -0.15, 0.15, 0.45)])
"""What a broom comes over, in the frame of who sweeps (metres)."""
_TRIED, _CLEAR = 150, 0.03
"""At so many places one looks for a heading with free floor for a broom: this much round it (metres)."""
ROOM_REACH = 1.5
"""Farthest from the furniture at which one does what takes free floor (metres)."""
_WORKTOP = (0.45, 1.3)
_LOW_TABLE = 0.36
_KEYS = 0.61  # a piano's keyboard, as a share of its height
_MOMENTS = (0.0, 0.25, 0.5, 0.75)
_STANDS, _ANY = 12, 1000
"""From how many places at a piece of furniture one chooses, and from how many where those are taken."""


def free_motion(ground: Ground, state: HomeState, agent: AgentId, act: FreeMotion, watch: Watch | None = None) -> Plan:
    """Plan a free-form task: fetch what it takes, go to the furniture, take one's place there, and do the motion.

    What is named by the name of a thing of the home is that thing, and is fetched; any other words mean a thing from
    the magic box. The motion changes what `coopera.core.affordances` says.

    Raises:
        UnableError: With the reason why it cannot be done; where it does not fit, with what would.
    """
    target = ground.fixed(act.target, act.target_id)
    meant = motion_meant(ground, state, act, target)
    motion, done = ground.motions[meant.caption], affordances().of(meant.caption)
    check_place(ground, motion, target)
    check_in_hand(ground, state, act)
    check_tools(ground, state, act, meant.caption)
    plan = Plan(stand_still(ground, state, agent), meant=meant)
    if done.undresses:
        undress(ground, plan, agent, watch)
    body, used_furniture = _placed(ground, plan, agent, target, motion)
    pose = _pose(ground, body, motion)
    hands = _hands(body, pose)
    at = Workplace(target, body, hands)
    if done.gathers is not None:
        gather(ground, plan, agent, done.gathers, at, act.in_hand, watch)
    tool = bring_tool(ground, plan, agent, act, done, at, watch)
    take_in_hand(ground, plan, agent, act.in_hand, watch)
    held = plan.state.agents[agent].thing
    if tool is None and held is not None and in_hand_is(ground, plan.state, held, done.tools):
        tool = plan.state.find(ground.scene, held)
    walk_to_deed(ground, plan, agent, _deeds(ground, body, motion) if watch else [], body.spot, watch, held)
    now = plan.state.person(agent)
    place = now.spot if body.place == body.spot else body.place
    kept = {"spot": now.spot, "place": place, "motion": motion.caption, "thing": held, "worn": now.worn}
    body = body.model_copy(update=kept)
    plan.steps.append(Play(agent, body, motion))
    plan.in_hand = held
    plan.state = effects.after(ground, plan.state.put(agent, body), agent, done, target, tool)
    dressed = plan.state.person(agent)
    if dressed.worn != body.worn:
        plan.steps.append(Dress(agent, dressed.worn, dressed.thing))
    things = [target] if used_furniture is target else [target, used_furniture]
    plan.at = [thing.name for thing in sorted(things, key=lambda thing: round(thing.bounds.distance(*hands), 3))]
    return plan


def stand_still(ground: Ground, state: HomeState, agent: AgentId) -> HomeState:
    """The home as a person leaves off, still where they are: what they had switched on for it goes off."""
    person = state.person(agent)
    off = stand_up(ground, state, agent, person.spot)
    return off.put(agent, person.model_copy(update={"switched": ()}))


def stay(ground: Ground, state: HomeState, agent: AgentId, watch: Watch) -> Plan:
    """Plan that a person goes on with what they are doing, and a robot comes to see it."""
    plan, person = Plan(state), state.person(agent)
    motion = ground.motions[person.motion]
    watch(plan, _deeds(ground, person, motion), person.spot)
    plan.steps.append(Play(agent, person, motion))
    plan.at, plan.in_hand = [person.at] if person.at is not None else [], person.thing
    return plan


def _pose(ground: Ground, person: PersonState, motion: Motion, share: float = 0.0) -> Array:
    """The pose in which a person begins a motion, or is after a share of its period, with nothing in hand."""
    return pose_at(motion, share * motion.keys.period, at_work(ground.scene, person, motion)[0])


def _deeds(ground: Ground, person: PersonState, motion: Motion) -> list[Placed]:
    """The person at some moments of a motion: at one of them a hand may be where nobody sees it."""
    return [Placed(*person.place, person.yaw, _pose(ground, person, motion, share)) for share in _MOMENTS]


def _hands(person: PersonState, pose: Array) -> Point:
    """Where the hands are on the floor plan: what lies under them is what the person is at."""
    frames = forward(pose)
    middle = (frames.place["right_hand"] + frames.place["left_hand"]) / 2
    cos, sin = math.cos(person.yaw), math.sin(person.yaw)
    x, y = float(middle[0]), float(middle[1])
    return person.place[0] + x * cos - y * sin, person.place[1] + x * sin + y * cos


def _placed(
    ground: Ground, plan: Plan, agent: AgentId, target: SceneObject, motion: Motion
) -> tuple[PersonState, SceneObject]:
    """Choose where the body goes, and the furniture that it uses for that.

    Raises:
        UnableError: If the seat or the bed is taken, or there is no place near enough.
    """
    used = used_by_others(plan.state, agent)
    if motion.posture == "sit" and target.cls != "rug":
        found = seat_for(ground, target, used)
        if found is None and not affordances().of(motion.caption).seated:
            return _upright(ground, plan, agent, target, motion), target
        if found is None:
            raise UnableError(f"somebody sits at the {plain(target.name)} already")
        chair, rest = found
        near = chair is not target and target.bounds.distance(rest.x, rest.y) <= SEAT_NEAR
        spot = _stand(ground, plan, agent, chair, (rest.x, rest.y))
        return _resting(rest, spot, target, _worktop(target) if near else None, "sit"), chair
    if motion.posture == "lie" and target.cls != "rug":
        lying = bed_for(target, used)
        if lying is None:
            raise UnableError(f"somebody is on the {plain(target.name)} already")
        bed, rest = lying
        spot = _stand(ground, plan, agent, bed, None)
        return _resting(rest, spot, target, None, "lie"), bed
    if motion.posture != "stand":
        x, y, yaw = _open_floor(ground, plan, agent, target, motion)
        posture = "lie" if motion.posture == "lie" else "floor"
        return PersonState(spot=(x, y), place=(x, y), yaw=yaw, posture=posture, at=target.name), target
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


def _worktop(target: SceneObject, *, stands: bool = False) -> float | None:
    """The height at which hands work at a piece of furniture; who stands also bends down to a low table."""
    if target.cls == "piano":
        return target.position[2] + _KEYS * target.size[2]
    if target.position[2] >= _WORKTOP[0]:  # a machine on a counter is worked at on that counter
        return target.position[2] + 0.1
    for surface in surfaces(target):
        height = target.position[2] + surface.z
        if (_LOW_TABLE if stands else _WORKTOP[0]) <= height <= _WORKTOP[1]:
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
    worktop = _worktop(target, stands=True)
    if worktop is not None and worktop < motion.keys.above:
        worktop = None
    sweeps = motion.keys.hold == "floor"
    if not sweeps and target.cls in affordances().stood_on and fits(target.xy, used_by_others(plan.state, agent)):
        stand = _stand(ground, plan, agent, target, target.xy)
        yaw = target.facing + (math.pi if target.cls == "treadmill" else 0.0)
        height = target.position[2] + min([*(surface.z for surface in surfaces(target)[:1]), 0.2])
        spot = (stand.x, stand.y)
        place = target.xy if blocks(target) else spot
        support = height if blocks(target) else 0.0
        return PersonState(spot=spot, place=place, yaw=wrapped(yaw), support=support, at=target.name)
    if sweeps or affordances().of(motion.caption).roomy:
        x, y, yaw = _open_floor(ground, plan, agent, target, motion)
        return PersonState(spot=(x, y), place=(x, y), yaw=yaw, worktop=worktop, at=target.name)
    stand = _stand(ground, plan, agent, target, None)
    spot = (stand.x, stand.y)
    return PersonState(spot=spot, place=spot, yaw=stand.yaw, worktop=worktop, at=target.name)


def _open_floor(
    ground: Ground, plan: Plan, agent: AgentId, target: SceneObject, motion: Motion
) -> tuple[float, float, float]:
    """A place near the target with much free floor around it, and the heading with most room ahead and behind.

    Who sweeps has free floor where the broom goes, as far as there is such a place.
    """
    scene = ground.scene
    boxes = obstacle_boxes((thing for thing in scene.fixed if blocks(thing)), scene.walls())
    cells = ground.navigator.cells_in(target.room)
    if not len(cells):
        raise UnableError(f"{named(agent)} finds no place to stand near the {plain(target.name)}")
    gap = clearance(cells[:, 0], cells[:, 1], obstacle_boxes([target], []))
    room = np.minimum(ground.navigator.clearance_in(target.room), 0.9)
    score = room - 0.25 * np.maximum(gap - 0.5, 0.0)
    taken = taken_by_others(plan.state, agent)
    on_it = (gap <= 0.0) & (not blocks(target))
    fits_there = all_clear_of(cells, taken) & (on_it if on_it.any() else gap <= ROOM_REACH)
    if not fits_there.any():
        raise UnableError(f"{named(agent)} finds no free floor at the {plain(target.name)}")
    if motion.keys.hold == "floor":
        fits_there = all_clear_of(cells, taken) & (gap <= ROOM_REACH)
        score = score - 0.25 * gap
        order = np.flatnonzero(fits_there)[np.argsort(-score[fits_there].round(3), kind="stable")]
        return _to_sweep(cells[order][:: max(len(order) // _TRIED, 1)], boxes)
    best = int(np.where(fits_there, score, -np.inf).argmax())
    x, y = float(cells[best, 0]), float(cells[best, 1])
    headings = np.arange(16) * math.pi / 8
    along = np.array((-0.9, -0.5, 0.5, 0.8))
    ahead, aside = np.outer(np.cos(headings), along), np.outer(np.sin(headings), along)
    strip = clearance(x + ahead, y + aside, boxes).min(axis=1).round(3)
    return x, y, float(headings[int(strip.argmax())])


def _to_sweep(cells: Array, boxes: Array) -> tuple[float, float, float]:
    """The first of some places at which a broom meets nothing in some direction, and the clearest direction there."""
    headings = np.arange(16) * math.pi / 8
    ahead, aside = _SWEPT.T
    x = cells[:, 0, None, None] + np.outer(np.cos(headings), ahead) - np.outer(np.sin(headings), aside)
    y = cells[:, 1, None, None] + np.outer(np.sin(headings), ahead) + np.outer(np.cos(headings), aside)
    gaps = clearance(x.ravel(), y.ravel(), boxes).reshape(x.shape).min(axis=2).round(3)
    best = int(np.minimum(gaps.max(axis=1), _CLEAR).argmax())
    return float(cells[best, 0]), float(cells[best, 1]), float(headings[int(gaps[best].argmax())])
