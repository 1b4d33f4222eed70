"""Which moments of a recording tell it: its deed, its end, and then whatever is least like those that are chosen.

DEVIATES: the paper samples frames at equal times. In eight of them a person walks up twice and then does six times the
same; four or five that differ tell as much, and pictures are what a run spends its time on.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.shapes.rotations import Array, about_z
from coopera.simulation.sight.pose_matching import HANDS, PARTS, skeleton
from coopera.simulation.sight.recording import Moment, Recording
from coopera.simulation.sight.timing import TICKS

_CANDIDATES = 40
"""Of about so many moments the poses are compared: working out more takes longer than a picture."""
_HAND = 2.0
"""A hand's way counts so many times that of another joint."""
_GONE = 0.3
"""What a metre of floor counts, in metres of every joint."""
_CHANGED = 0.35
"""What it counts that another thing is held, has been moved, is worn or is open (half of it, squared, each way)."""
_BEFORE = 4
"""Of a motion's pictures one in so many may show what was before it: one, at least."""
_TELLS = 0.015
"""A motion of which so much is not yet shown (a distance of poses, in metres) has the next picture."""
_BETWEEN = 3.0
"""How much it counts to differ from the pictures just before and after, where that to differ from all counts 1."""
_END = 1.0
"""The last so many seconds are the end."""


class _Look(NamedTuple):
    """How a moment looks: numbers whose distance is that of the poses, and what is held, moved, worn and open."""

    pose: Array
    things: frozenset[str]


def telling_ticks(recording: Recording, robots: Mapping[AgentId, RobotBody], count: int) -> list[int]:
    """Choose moments of a recording that differ most from each other (farthest-point sampling), in order of time.

    The deed comes first, then the end: whatever late moment is least like the deed, since motions repeat. The others
    differ from all and, even more, from those before and after them: the phases of a motion take turns. One moment of
    each walk may be among them; of a motion, few show what was before it.

    Args:
        recording: With at least one shot.
        robots: The robots' bodies.
        count: How many moments, at least 1.

    Returns:
        Distinct ticks, rising; fewer than `count` only where the recording has no more.
    """
    if count >= recording.ticks:
        return list(range(recording.ticks))
    if count == 1:
        return [_deed(recording)]
    ticks = _candidates(recording, count)
    looks = [_look(recording, robots, tick) for tick in ticks]
    things = sorted(set().union(*(look.things for look in looks)))
    rows = [(*look.pose, *(_CHANGED * (name in look.things) for name in things)) for look in looks]
    places = np.array(rows)
    deed = ticks.index(_deed(recording))
    before = np.array(ticks) < _begun(recording)
    elsewhere = before & (np.array(ticks) < _arrived(recording))
    spare = max(1, count // _BEFORE)
    chosen, left = [deed], np.linalg.norm(places - places[deed], axis=1)
    for number in range(1, count):
        among = left
        if number == 1:
            late = np.array(ticks) >= recording.ticks - _late(recording)
            among = np.where(late, left, -1.0)
        among = among.copy()
        lively = left[~before].max(initial=0.0) >= _TELLS
        if before[chosen].sum() >= (spare if lively else max(spare, count // 2)):
            among[before] = -1.0
        elif lively and spare == 1:
            among[elsewhere] = -1.0
        among[chosen] = -2.0
        if number > 1:
            among = among + _BETWEEN * _from_neighbours(places, chosen) * (among >= 0)
        best = int(np.argmax(np.round(among, 6)))
        chosen.append(best)
        left = np.minimum(left, np.linalg.norm(places - places[best], axis=1))
    return sorted(ticks[i] for i in chosen)


def _from_neighbours(places: Array, chosen: list[int]) -> Array:
    """How far each moment is from the nearer of the chosen ones just before and just after it; shape (n,)."""
    order = sorted(chosen)
    after = np.searchsorted(order, np.arange(len(places)))
    sides = [order[0], *order, order[-1]]
    gaps = [np.linalg.norm(places - places[[sides[i + step] for i in after]], axis=1) for step in (0, 1)]
    found: Array = np.minimum(*gaps)
    return found


def _late(recording: Recording) -> float:
    """How many of the last ticks are the end: of a motion, which repeats itself, the last quarter."""
    last = recording.shots[-1]
    return _END * TICKS if last.begun is None else max(_END * TICKS, (last.ticks - last.begun) / 4)


def _begun(recording: Recording) -> int:
    """The tick from which on a motion is made; 0 for an act without one, which is told by all of its ticks."""
    last = recording.shots[-1]
    return 0 if last.begun is None else recording.ticks - last.ticks + last.begun


def _arrived(recording: Recording) -> int:
    """The tick at which who acts has come to the place of the last shot, with what they have in hand."""
    last = recording.shots[-1]
    return recording.ticks - last.ticks + last.came


def _deed(recording: Recording) -> int:
    """The tick at which the act is best seen."""
    before = sum(shot.ticks for shot in recording.shots[:-1])
    return before + recording.shots[-1].deed


def _candidates(recording: Recording, count: int) -> list[int]:
    """Ticks to choose from, rising: evenly spread, one of each walk, each deed, and the last."""
    step = max(1, min(recording.ticks // _CANDIDATES, recording.ticks // (3 * count)))
    found, start = set(), 0
    for shot in recording.shots:
        moves = set(range(start + shot.came, start + shot.ticks, step))
        comes = shot.came // 2 if shot.begun is None else shot.came  # far from a motion's place few would see them
        found |= {start + comes, start + shot.deed, start + shot.ticks - 1} | moves
        start += shot.ticks
    if len(found) <= count:
        found = set(range(recording.ticks))
    return sorted(found)


def _look(recording: Recording, robots: Mapping[AgentId, RobotBody], tick: int) -> _Look:
    index, within = recording.find(tick)
    moment = recording.shots[index].at(within)
    poses = [_features(moment, agent, robots.get(agent)) for agent in _moving(recording)]
    things = {f"{agent} holds {held.name}" for agent, held in moment.held.items()}
    things |= {f"{name} at {where.position} in {where.inside}" for name, where in moment.moved.items()}
    things |= {f"{agent} wears {name}" for agent, names in moment.worn.items() for name in names}
    things |= {f"{name} is open" for name in moment.opened}
    return _Look(np.concatenate(poses), frozenset(things))


def _moving(recording: Recording) -> list[AgentId]:
    """Whose pose counts: who acts, and the person who is handed something."""
    return list(dict.fromkeys((recording.actor, recording.person)))


def _features(moment: Moment, agent: AgentId, body: RobotBody | None) -> Array:
    """The body's place and its joints, such that the distance of two is that of the joints on average, in metres."""
    placed = moment.bodies[agent]
    joints, weights = _joints(placed, body)
    joints = joints @ about_z(placed.yaw).T * np.sqrt(weights / weights.sum())[:, None]
    return np.concatenate((joints.ravel(), (_GONE * placed.x, _GONE * placed.y)))


def _joints(placed: Placed, body: RobotBody | None) -> tuple[Array, Array]:
    """Joints about the body's place, shape (n, 3), and what each counts."""
    if body is not None:
        points = body.arm(placed.pose)[[0, -1]]
        return points, np.array((1.0, _HAND))
    weights = np.ones(len(PARTS))
    weights[HANDS] = _HAND
    return skeleton(placed.pose), weights
