"""The look of a recorded act: for every tick the place and the pose of both bodies, and the things in their hands.

A recording is a list of shots. A shot is what the robot watches from one place: the end of a walk and then a reach,
a motion or a hand-over. Longer walks are cut, as a film would. Poses are computed only for the ticks asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from coopera.core.household import Agent
from coopera.simulation.acts.navigation import Stand
from coopera.simulation.acts.plans import Give, Handle, Placed, Play, Step, Turn, Walk
from coopera.simulation.acts.skills import to_body
from coopera.simulation.acts.state import HomeState, PersonState, ThingState
from coopera.simulation.bodies.humanoid import SLICES, blend
from coopera.simulation.bodies.humanoid_reach import carrying, reaching, standing
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.motions.library import Hold, Library
from coopera.simulation.motions.poses import Setting, clip, pose_at
from coopera.simulation.shapes.rotations import Array, smooth, wrapped

TICKS = 30
"""Ticks per second."""
_SPEED = {"human": 1.1, "robot": 0.8}  # metres per second
_SHOWN = 1.3
"""Seconds of a walk that a shot shows before the act."""
_MOTION = 8.0
_TURN, _REACH, _HOLD, _BACK, _SETTLE = 8, 22, 8, 16, 26
_ARMS = ("right_shoulder", "right_elbow")


class Held(NamedTuple):
    """What someone holds, by its name or its text, and how."""

    name: str
    hold: Hold = "right"


class Moment(NamedTuple):
    """One tick."""

    person: Placed
    robot: Placed
    in_hand: Held | None
    in_gripper: Held | None
    moved: dict[str, ThingState]


@dataclass(slots=True)
class Shot:
    """Ticks seen from one place of the robot; `at` gives the moment of a tick, `deed` is when the act is best seen."""

    ticks: int
    at: Callable[[int], Moment]
    deed: int


@dataclass(slots=True)
class Recording:
    """A recorded act: the home before it, the shots, and what a percept may tell of it; not which motion is done."""

    state: HomeState
    shots: list[Shot] = field(default_factory=list)
    near: list[str] = field(default_factory=list)
    in_hand: str | None = None

    @property
    def ticks(self) -> int:
        """Length of the recording."""
        return sum(shot.ticks for shot in self.shots)

    def find(self, tick: int) -> tuple[int, int]:
        """The shot that holds a tick, and the tick within it."""
        for index, shot in enumerate(self.shots):
            if tick < shot.ticks:
                return index, tick
            tick -= shot.ticks
        raise IndexError("the recording is shorter than that")


def person_still(library: Library, person: PersonState) -> Placed:
    """The person between two acts."""
    setting = Setting(person.support, person.worktop, person.posture)
    return Placed(*person.place, person.yaw, pose_at(library[person.motion], 0.0, setting))


def robot_still(body: RobotBody, state: HomeState) -> Placed:
    """The robot between two acts."""
    posture = body.tucked if state.robot.thing is None else body.carrying
    return Placed(*state.robot.spot, state.robot.yaw, posture)


class Track(NamedTuple):
    """A walk as a function of the distance gone: corner points and where each lies along the way."""

    points: list[Point]
    marks: list[float]

    @classmethod
    def along(cls, points: list[Point]) -> Track:
        """Measure a walk."""
        marks = [0.0]
        for a, b in zip(points, points[1:], strict=False):
            marks.append(marks[-1] + math.dist(a, b))
        return cls(points, marks)

    def at(self, gone: float) -> Point:
        """The place after a distance."""
        gone = min(max(gone, 0.0), self.marks[-1])
        for i in range(1, len(self.marks)):
            if gone <= self.marks[i] and self.marks[i] > self.marks[i - 1]:
                share = (gone - self.marks[i - 1]) / (self.marks[i] - self.marks[i - 1])
                (ax, ay), (bx, by) = self.points[i - 1], self.points[i]
                return ax + share * (bx - ax), ay + share * (by - ay)
        return self.points[-1]

    def heading(self, gone: float) -> float | None:
        """The direction of the walk, looking a little ahead; None for a walk of no length."""
        total = self.marks[-1]
        if total < 1e-6:
            return None
        back, ahead = self.at(min(gone, total - 0.02) - 0.1), self.at(min(gone, total - 0.02) + 0.2)
        return math.atan2(ahead[1] - back[1], ahead[0] - back[0])


def walking(gone: float, carries: bool) -> Array:
    """The pose after walking a distance: the shipped walk, with the right arm in front if it carries a thing."""
    walk = clip("walk")
    pose = walk.at(gone / walk.travel * walk.seconds).copy()
    if carries:
        arm = carrying()
        for name in _ARMS:
            pose[SLICES[name]] = arm[SLICES[name]]
    return pose


class Filming:
    """Turns the steps of a plan into shots."""

    def __init__(self, library: Library, body: RobotBody, start: HomeState) -> None:
        self.motions = library
        self.body = body
        self.person = person_still(library, start.person)
        self.robot = robot_still(body, start)
        self.hand = Held(start.person.thing) if start.person.thing else None
        self.gripper = Held(start.robot.thing) if start.robot.thing else None
        self.moved: dict[str, ThingState] = {}
        self.recording = Recording(start)
        self._walk: Walk | None = None
        self._actor: Agent = "human"

    def film(self, steps: list[Step], actor: Agent) -> Recording:
        """Film all steps; walks of the one who is not acting happen between the shots."""
        self._actor = actor
        for step in steps:
            if isinstance(step, Walk):
                self._go(step)
            elif isinstance(step, Turn):
                self.robot = self.robot._replace(yaw=step.yaw)
            elif isinstance(step, Handle):
                self._handle(step)
            elif isinstance(step, Play):
                self._play(step)
            else:
                self._give(step)
        return self.recording

    def _go(self, step: Walk) -> None:
        yaw = Track.along(step.points).heading(math.inf)
        if step.agent == "robot":
            self.robot = Placed(*step.points[-1], self.robot.yaw if yaw is None else yaw, self.body.tucked)
        else:
            self.person = Placed(*step.points[-1], self.person.yaw if yaw is None else yaw, standing())
        if step.agent == self._actor:
            self._walk = step
            if step.carries and step.agent == "human":
                self.hand = Held(step.carries)
            elif step.carries:
                self.gripper = Held(step.carries)

    def _approach(self, agent: Agent) -> tuple[int, Callable[[int], Placed]]:
        """The last moments of the walk before an act."""
        walk, self._walk = self._walk, None
        still = self.person if agent == "human" else self.robot
        if walk is None or len(walk.points) < 2:
            return 0, lambda tick: still
        track, speed = Track.along(walk.points), _SPEED[agent] / TICKS
        ticks = min(math.ceil(track.marks[-1] / speed), round(_SHOWN * TICKS))
        carries = walk.carries is not None

        def at(tick: int) -> Placed:
            gone = max(track.marks[-1] - (ticks - tick) * speed, 0.0)
            yaw = track.heading(gone)
            pose = walking(gone, carries) if agent == "human" else self._idle(agent, carries)
            return Placed(*track.at(gone), still.yaw if yaw is None else yaw, pose)

        return ticks, at

    def _handle(self, step: Handle) -> None:
        """Walk up, turn, reach, take or put, and straighten up."""
        agent = step.agent
        walk_ticks, walk_at = self._approach(agent)
        came = walk_at(walk_ticks)
        here = Placed(step.stand.x, step.stand.y, step.stand.yaw, self._idle(agent, step.put is not None))
        after = here._replace(pose=self._idle(agent, step.put is None))
        bent = here._replace(pose=step.posture)
        turned, reached = walk_ticks + _TURN, walk_ticks + _TURN + _REACH
        done = reached + _HOLD
        total = done + _BACK
        hand_before, hand_after = (None, Held(step.name)) if step.put is None else (Held(step.name), None)
        moved_after = self.moved if step.put is None else {**self.moved, step.name: step.put}
        others = self._frozen(agent)
        moved_before = self.moved

        def at(tick: int) -> Moment:
            if tick < walk_ticks:
                body = walk_at(tick)
            elif tick < turned:
                body = _between(came, here, (tick - walk_ticks) / _TURN, agent)
            elif tick < reached:
                body = _between(here, bent, (tick - turned) / _REACH, agent)
            else:
                body = _between(bent, after, (tick - done) / _BACK, agent)
            late = tick >= reached + _HOLD // 2
            return others(body, hand_after if late else hand_before, moved_after if late else moved_before)

        self.recording.shots.append(Shot(total, at, reached + _HOLD // 2 - 1))
        self._finish(agent, after, hand_after, moved_after)

    def _play(self, step: Play) -> None:
        """Walk up, get into the posture, and do the motion."""
        walk_ticks, walk_at = self._approach("human")
        came = walk_at(walk_ticks)
        person, motion = step.person, step.motion
        setting = Setting(person.support, person.worktop, person.posture)
        held = Held(person.thing, motion.keys.hold) if person.thing else None
        carried = Held(person.thing) if person.thing else None
        settled = walk_ticks + _SETTLE
        total = settled + round(max(_MOTION, 2 * motion.keys.period) * TICKS)
        others = self._frozen("human")
        moved = self.moved

        def at(tick: int) -> Moment:
            if tick < walk_ticks:
                return others(walk_at(tick), carried, moved)
            pose = pose_at(motion, max(tick - settled, 0) / TICKS, setting)
            body = Placed(*person.place, person.yaw, pose)
            if tick < settled:
                body = _between(came, body, (tick - walk_ticks) / _SETTLE, "human")
                return others(body, carried, moved)
            return others(body, held, moved)

        self.recording.shots.append(Shot(total, at, settled + (total - settled) // 2))
        self._finish("human", Placed(*person.place, person.yaw, pose_at(motion, 0.0, setting)), held, moved)

    def _give(self, step: Give) -> None:
        """Drive up, hold out the thing, and let the person take it."""
        walk_ticks, walk_at = self._approach("robot")
        came = walk_at(walk_ticks)
        here = Placed(step.stand.x, step.stand.y, step.stand.yaw, self.body.carrying)
        out, empty = here._replace(pose=step.posture), here._replace(pose=self.body.tucked)
        turned, reached = walk_ticks + _TURN, walk_ticks + _TURN + _REACH
        done = reached + 2 * _HOLD
        still, moved = self.person, self.moved
        offer, before = Held(step.thing), self.hand
        taking = _receiving(still, step) if self.recording.state.person.posture == "stand" else still

        def at(tick: int) -> Moment:
            if tick < walk_ticks:
                robot = walk_at(tick)
            elif tick < turned:
                robot = _between(came, here, (tick - walk_ticks) / _TURN, "robot")
            elif tick < reached:
                robot = _between(here, out, (tick - turned) / _REACH, "robot")
            else:
                robot = _between(out, empty, (tick - done) / _BACK, "robot")
            share = (tick - turned) / _REACH if tick < done else 1 - (tick - done) / _BACK
            given = tick >= reached + _HOLD
            person = _between(still, taking, share, "human")
            return Moment(person, robot, offer if given else before, None if given else offer, moved)

        self.recording.shots.append(Shot(done + _BACK, at, reached))
        self.robot, self.hand, self.gripper = empty, offer, None

    def _frozen(self, agent: Agent) -> Callable[[Placed, Held | None, dict[str, ThingState]], Moment]:
        """Moments in which only one agent moves; the robot keeps its head towards the person."""
        person, robot, hand, gripper, turning = self.person, self.robot, self.hand, self.gripper, self.body

        def moment(body: Placed, held: Held | None, moved: dict[str, ThingState]) -> Moment:
            if agent == "human":
                return Moment(body, watching(turning, robot, body), held, gripper, moved)
            return Moment(person, body, hand, held, moved)

        return moment

    def _idle(self, agent: Agent, holds: bool) -> Array:
        if agent == "robot":
            return self.body.carrying if holds else self.body.tucked
        return carrying() if holds else standing()

    def _finish(self, agent: Agent, body: Placed, held: Held | None, moved: dict[str, ThingState]) -> None:
        self.moved = moved
        if agent == "human":
            self.person, self.hand = body, held
        else:
            self.robot, self.gripper = body, held


def _receiving(person: Placed, step: Give) -> Placed:
    """The person turned to the robot, with a hand at the thing."""
    yaw = math.atan2(step.stand.y - person.y, step.stand.x - person.x)
    pose = reaching(to_body(Stand(person.x, person.y, yaw, 0.0, 0.0), step.point))
    return person if pose is None else person._replace(yaw=yaw, pose=pose)


def watching(body: RobotBody, robot: Placed, person: Placed) -> Placed:
    """The robot with its head turned to the person's body."""
    height = min(max(float(person.pose[2]) + 0.15, 0.3), 1.1)
    stand = Stand(robot.x, robot.y, robot.yaw, 0.0, 0.0)
    return robot._replace(pose=body.look_at(robot.pose, to_body(stand, (person.x, person.y, height))))


def _between(first: Placed, second: Placed, share: float, agent: Agent) -> Placed:
    """Ease from one placed body to another."""
    share = smooth(share)
    turn = wrapped(second.yaw - first.yaw)
    if agent == "human":
        pose = blend(first.pose, second.pose, share)
    else:
        pose = first.pose + share * (second.pose - first.pose)
    x, y = (1 - share) * np.array(first[:2]) + share * np.array(second[:2])
    return Placed(float(x), float(y), first.yaw + share * turn, pose)
