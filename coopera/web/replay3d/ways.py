"""The walks that recordings leave out: between two shots everybody walks to where the next one begins."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.sight.recording import Moment
from coopera.simulation.sight.walks import Track, walking
from coopera.simulation.ways.navigation import Navigator

_FAST = 2.4
"""Metres per second: twice as fast as people walk, since a day has many walks."""
_NEAR = 0.35
"""Metres that need no walk."""


@dataclass(slots=True)
class Ways:
    """Where everybody was in the last moment, and how they get to the next one."""

    floor: Navigator
    robots: Mapping[AgentId, RobotBody]
    fps: float
    _last: dict[AgentId, Placed] = field(default_factory=dict)

    def to(self, moment: Moment) -> Iterator[Moment]:
        """The moments on the way to a moment, and that moment itself; one after another walks."""
        for agent in moment.bodies:
            for placed in self._walk(agent, moment):
                self._last[agent] = placed
                yield moment._replace(bodies={**moment.bodies, **self._last})
        self._last = dict(moment.bodies)
        yield moment

    def _walk(self, agent: AgentId, moment: Moment) -> Iterator[Placed]:
        there, here = moment.bodies[agent], self._last.get(agent)
        if here is None or math.dist(here[:2], there[:2]) < _NEAR:
            return
        points = self.floor.route((here.x, here.y), (there.x, there.y)).points
        if not points or len(points) < 2:
            return
        track, holds = Track.along(points), agent in moment.held
        steps = math.ceil(track.marks[-1] * self.fps / _FAST)
        robot = self.robots.get(agent)
        for step in range(1, steps):
            gone = track.marks[-1] * step / steps
            yaw = track.heading(gone)
            pose = walking(gone, holds) if robot is None else robot.carrying if holds else robot.tucked
            yield Placed(*track.at(gone), there.yaw if yaw is None else yaw, pose)
