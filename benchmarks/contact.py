"""Do hand, tool and surface meet? What is drawn of a motion in a home, checked in numbers for those that need it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from coopera.core.affordances import affordances
from coopera.simulation import World
from coopera.simulation.acts.workplace import thing_of, working, worktop_before
from coopera.simulation.bodies.humanoid import MOUTH, Frames, forward
from coopera.simulation.homes.catalogue import blocks, parts_of
from coopera.simulation.homes.magic_box import Point3, shape_of
from coopera.simulation.motions.aids import aids, now
from coopera.simulation.motions.holding import Grip, held_at
from coopera.simulation.motions.library import Motion
from coopera.simulation.motions.poses import Setting, pose_at, working_height
from coopera.simulation.motions.vessels import grasp, lip
from coopera.simulation.shapes.rotations import Array, about_z, matrix

MOMENTS = 16
FLOOR, CLOTH, KEYS, TIP, OVER, SHOE, WALL = 0.03, 0.02, 0.04, 0.04, 0.07, 0.17, 0.07
"""How near what must meet has to come, in metres; the last is how thick a bathtub's walls are."""


class Seen(NamedTuple):
    """One moment: the body, and each thing with its class, size, place and turn, all in the body frame."""

    frames: Frames
    things: list[tuple[str, Point3, Array, Array]]
    grip: Grip


def moments(world: World, motion: Motion) -> tuple[Setting, list[Seen]]:
    """What is drawn of the motion that the person of a home is making, at some moments of its period."""
    person = world.state.person()
    setting, grip = working(world.layout, world.state, person, motion)
    found = []
    for seconds in np.linspace(0.0, motion.keys.period, MOMENTS, endpoint=False):
        pose = pose_at(motion, float(seconds), setting)
        things, how = [], grip
        if person.thing is not None:
            thing = thing_of(world.layout, world.state, person.thing)
            how = now(motion, setting, grip, float(seconds))
            known = world.state.box.get(person.thing)
            looks = thing.cls if known is None else shape_of(known.text).cls
            things.append((looks, thing.size, *held_at(pose, thing.size, how)))
            for aid in aids(motion, setting, grip, float(seconds), thing.cls):
                shape = shape_of(aid.thing)
                things.append((shape.cls, shape.size, *held_at(pose, shape.size, aid.grip)))
        found.append(Seen(forward(pose), things, how))
    return setting, found


def gap(point: Array, cls: str, size: Point3, place: Array, turn: Array) -> float:
    """How far a point is from what is drawn of a thing (metres)."""
    local = turn.T @ (point - place)
    away = []
    for part in parts_of(cls, size, (0.5, 0.5, 0.5)):
        long = part.length / 2 + (part.radius if part.kind == "capsule" else 0.0)
        round_ = (part.radius, part.radius, part.radius if part.kind == "sphere" else long)
        half = np.array(part.half if part.kind == "box" else round_)
        inner = np.abs(matrix(part.orientation).T @ (local - np.array(part.position)))
        away.append(float(np.linalg.norm(np.maximum(inner - half, 0.0))))
    return min(away)


def _brush(world: World, seen: list[Seen], setting: Setting) -> Iterator[str]:
    """The end of a long tool is on the floor, and in no furniture."""
    person = world.state.person()
    for one in seen:
        _, size, place, turn = one.things[0]
        if size[0] < 1.0:
            return
        end = place - turn[:, 0] * (size[0] / 2 - 0.04)
        lowest = float(end[2]) - 0.5 * size[2] * abs(float(turn[2, 2])) - 0.04 * abs(float(turn[2, 0]))
        if abs(lowest + 0.5 * size[2] * float(turn[2, 2])) > FLOOR + size[2]:
            yield f"the brush is {lowest:+.2f} m off the floor"
            return
        at = about_z(person.yaw) @ end + np.array((*person.place, 0.0))
        for thing in world.layout.fixed:
            if blocks(thing) and thing.bounds.distance(float(at[0]), float(at[1])) <= 0.0:
                yield f"the brush is in the {thing.name}"
                return


def _cloth(world: World, seen: list[Seen], setting: Setting) -> Iterator[str]:
    """What wipes lies on the surface."""
    if setting.worktop is None:
        return
    height = working_height(setting)
    for one in seen:
        flat = [float(place[2]) for _, size, place, _ in one.things if size[2] < 0.1]
        if flat and min(abs(z - height) for z in flat) > CLOTH:
            yield f"the cloth is {min(flat) - height:+.2f} m off the surface"
            return


def _keys(world: World, seen: list[Seen], setting: Setting) -> Iterator[str]:
    """Both hands are at the keys of what is typed on."""
    laid = [one for one in seen[0].things if one[0] in ("laptop", "keyboard")]
    if not laid or seen[0].grip.laid is None:
        return
    for side in ("right_hand", "left_hand"):
        away = max(gap(one.frames.place[side], *one.things[0]) for one in seen)
        if away > KEYS:
            yield f"the {side} is up to {away:.2f} m off the keys"


def _fork(world: World, seen: list[Seen], setting: Setting) -> Iterator[str]:
    """The fork goes from the plate to the mouth, and the plate stays where it is."""
    forks = [[thing for thing in one.things if thing[0] in ("fork", "spoon")] for one in seen]
    plates = [[thing for thing in one.things if thing[0] in ("plate", "bowl")] for one in seen]
    if not all(forks) or not all(plates):
        return
    tips = [thing[0][2] - thing[0][3][:, 0] * thing[0][1][0] / 2 for thing in forks]
    mouth = min(
        float(np.linalg.norm(tip - one.frames.point("head", *MOUTH))) for tip, one in zip(tips, seen, strict=True)
    )
    plate = min(gap(tip, *thing[0]) for tip, thing in zip(tips, plates, strict=True))
    if mouth > 2 * TIP:
        yield f"the fork stays {mouth:.2f} m from the mouth"
    if plate > TIP:
        yield f"the fork stays {plate:.2f} m from the plate"
    if np.ptp([thing[0][2] for thing in plates], axis=0).max() > 1e-9:
        yield "the plate moves"


def _bath(world: World, seen: list[Seen], setting: Setting) -> Iterator[str]:
    """The body is within the walls of the tub, and no higher than sitting in it."""
    person = world.state.person()
    tub = world.layout.object(person.at or "")
    if tub is None or tub.cls != "bathtub":
        return
    half = np.array(tub.size[:2]) / 2 - WALL / 2
    for one in seen:
        for part in ("pelvis", "right_elbow", "left_elbow", "right_hand", "left_hand", "right_ankle", "left_ankle"):
            at = about_z(person.yaw) @ one.frames.place[part] + np.array((*person.place, 0.0))
            local = about_z(tub.yaw)[:2, :2].T @ (at[:2] - np.array(tub.xy))
            if (np.abs(local) > half).any():
                yield f"the {part} is {float((np.abs(local) - half).max()):.2f} m in the wall of the tub"
                return
        if float(one.frames.place["pelvis"][2]) > tub.position[2] + 0.6 * tub.size[2]:
            yield "the body is above the tub"
            return


def _pours(world: World, seen: list[Seen], setting: Setting) -> Iterator[str]:
    """What is tipped has its lip over a vessel that stands before one."""
    person, motion = world.state.person(), seen[0].grip
    if not motion.tips or person.thing is None:
        return
    size = thing_of(world.layout, world.state, person.thing).size
    best = max(seen, key=lambda one: one.grip.tip)
    _, _, place, turn = best.things[0]
    edge = best.frames.place["right_hand"] + lip(size)
    wanted = best.frames.place["left_hand"]
    if best.grip.tip < 0.9:
        yield "it is not tipped"
    if math.dist(edge[:2], wanted[:2]) > OVER + 0.05:
        yield f"the lip is {math.dist(edge[:2], wanted[:2]):.2f} m beside the hand that holds the cup"
    if float(np.linalg.norm(place - best.frames.place["right_hand"])) > max(size) + 0.05 or not grasp(size).any():
        yield "the vessel is out of the hand"
    cups = [
        thing
        for thing in world.state.carried_by(world.layout, person.at or "")
        if affordances().is_one_of(thing.cls, ("mug", "glass", "cup")) and thing.name != person.thing
    ]
    near = []
    for cup in cups:
        x, y, _ = world.state.thing(cup).position
        near.append(math.dist((about_z(person.yaw) @ edge + np.array((*person.place, 0.0)))[:2], (x, y)))
    if near and 0.2 > min(near) > OVER:
        yield f"the lip is {min(near):.2f} m beside the cup"


def _shoes(world: World, seen: list[Seen], setting: Setting) -> Iterator[str]:
    """Both hands come to a foot."""
    if world.state.person().posture != "sit":
        return
    for side in ("right", "left"):
        away = min(
            float(np.linalg.norm(one.frames.place[f"{side}_hand"] - one.frames.place[f"{foot}_ankle"]))
            for one in seen
            for foot in ("right", "left")
        )
        if away > SHOE:
            yield f"the {side} hand stays {away:.2f} m from the feet"


def _table(world: World, seen: list[Seen], setting: Setting) -> Iterator[str]:
    """What is put on the table lies on it, and on nothing beside it."""
    person = world.state.person()
    before = worktop_before(world.layout, person)
    laid = [one for one in seen if one.grip.laid is not None]
    if seen[0].grip.hold == "right" and not laid:
        yield "nothing is put down"
    for one in laid:
        if abs(float(one.things[0][2][2]) - working_height(setting)) > CLOTH:
            yield "what is put down is off the surface"
            return
    if before is not None and laid and float(laid[0].things[0][2][0]) < before.edge - 0.02:
        yield "what is put down is before the edge"


CHECKS: dict[str, Callable[[World, list[Seen], Setting], Iterator[str]]] = {
    "sweep the floor": _brush,
    "mop the floor": _brush,
    "wipe the surface": _cloth,
    "type on a keyboard": _keys,
    "eat a meal": _fork,
    "lie in the bath": _bath,
    "pour a drink": _pours,
    "tie the shoes": _shoes,
    "set the table": _table,
}


def contacts(world: World, motion: Motion) -> Iterator[str]:
    """What does not meet that should, of the motion that the person of a home is making."""
    check = CHECKS.get(motion.caption)
    if check is not None:
        setting, seen = moments(world, motion)
        yield from check(world, seen, setting)
