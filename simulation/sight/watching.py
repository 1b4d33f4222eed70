"""A robot as an onlooker: where it goes to see a person, and the pictures of a recording."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Ground, Placed, Plan, Turn, UnableError, taken_by_others
from coopera.simulation.acts.walking import walk
from coopera.simulation.drawing.context import Renderer
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.people.appearance import Appearance
from coopera.simulation.sight.cameras import Eyes, Focus, around, robot_camera, view_camera, watching_place
from coopera.simulation.sight.recording import Moment, Recording, still
from coopera.simulation.sight.stage import Camera, Image, Stage


class Watcher:
    """Owns the stages of a home, one for rays and one for pictures; made at the first recording."""

    def __init__(
        self, ground: Ground, renderer: Renderer = "auto", looks: Mapping[AgentId, Appearance] | None = None
    ) -> None:
        """Start pybullet and build the home in it, for rays; what it looks like waits for the first picture."""
        self.ground, self._looks = ground, looks
        self.stage = Stage(ground.scene, ground.people, ground.robots, renderer=None)
        self._renderer = renderer
        self._drawn: Stage | None = None

    def close(self) -> None:
        """Give pybullet back."""
        self.stage.close()
        if self._drawn is not None:
            self._drawn.close()

    @property
    def drawn(self) -> Stage:
        """The stage that pictures are taken of."""
        if self._drawn is None:
            ground = self.ground
            self._drawn = Stage(ground.scene, ground.people, ground.robots, self._renderer, self._looks)
        return self._drawn

    def watch(self, plan: Plan, robot: AgentId, who: AgentId, deed: Placed, spot: Point) -> None:
        """Add to a plan: a robot drives to where it will see an act of a person, out of their way.

        Args:
            plan: The plan so far; the robot's drive is added.
            robot: Who is to see it.
            who: The person.
            deed: The person in the middle of the act.
            spot: The floor from which they do it.
        """
        person = plan.state.person(who)
        route = self.ground.navigator.route(person.spot, spot)
        bodies = {agent: still(self.ground, plan.state, agent) for agent in plan.state.agents if agent != who}
        elsewhere = bodies[robot]._replace(x=-100.0, y=-100.0)  # it must not see itself in the way
        self.stage.show(plan.state, Moment({**bodies, who: deed, robot: elsewhere}, {}, {}))
        place = watching_place(
            self.stage,
            self.ground.navigator,
            Eyes(self.ground.robots[robot], plan.state.agents[robot].spot),
            self._focus(who, deed),
            [*(route.points or []), spot, (deed.x, deed.y)],
            taken_by_others(plan.state, robot),
        )
        if place is not None and math.dist(place, plan.state.agents[robot].spot) > 0.3:
            metres, steps, state = plan.metres, list(plan.steps), plan.state
            try:
                walk(self.ground, plan, robot, place)
            except UnableError:  # it cannot get there: it watches from where it is
                plan.steps, plan.state = steps, state
            if math.dist(person.spot, spot) < 0.05 and plan.state.agents[who].spot != person.spot:
                plan.steps, plan.state = steps, state  # who is at the place already is not sent away
            plan.metres = metres
        x, y = plan.state.agents[robot].spot
        yaw = math.atan2(deed.y - y, deed.x - x)
        plan.steps.append(Turn(robot, yaw))
        plan.state = plan.state.with_agent(robot, yaw=yaw)

    def film(self, recording: Recording, count: int, size: tuple[int, int]) -> dict[str, list[Image]]:
        """Render uniformly sampled moments: pictures by view, "robot" and "human", in order of time."""
        views: dict[int, Camera] = {}
        pictures: dict[str, list[Image]] = {"robot": [], "human": []}
        for tick in np.linspace(0, recording.ticks - 1, count).round().astype(int):
            index, within = recording.find(int(tick))
            shot = recording.shots[index]
            if index not in views:
                views[index] = self._view(recording, shot.at(shot.deed))
            moment = shot.at(within)
            self.drawn.show(recording.state, moment)
            pictures["robot"].append(self.drawn.picture(self._eyes(recording, moment), size)[0])
            pictures["human"].append(self.drawn.picture(views[index], size)[0])
        return pictures

    def video(self, recording: Recording, size: tuple[int, int], every: int) -> Iterator[Image]:
        """Yield each n-th tick with both views side by side, the robot's on the left."""
        views: dict[int, Camera] = {}
        for tick in range(0, recording.ticks, every):
            index, within = recording.find(tick)
            shot = recording.shots[index]
            if index not in views:
                views[index] = self._view(recording, shot.at(shot.deed))
            moment = shot.at(within)
            self.drawn.show(recording.state, moment)
            eyes = (self._eyes(recording, moment), views[index])
            yield np.concatenate([self.drawn.picture(camera, size)[0] for camera in eyes], axis=1)

    def _eyes(self, recording: Recording, moment: Moment) -> Camera:
        return robot_camera(self.ground.robots[recording.robot], moment.bodies[recording.robot])

    def _view(self, recording: Recording, moment: Moment) -> Camera:
        self.drawn.show(recording.state, moment)
        focus = self._focus(recording.person, moment.bodies[recording.person])
        return view_camera(self.drawn, self.ground.scene, focus)

    def _focus(self, who: AgentId, person: Placed) -> Focus:
        """A person, and the furniture whose rectangle they are in: its hull would stop all rays to them."""
        scene = self.ground.scene
        return Focus(who, person, around(scene, person), scene.room_at(person.x, person.y).name)


@dataclass(frozen=True, slots=True)
class Onlooker:
    """One robot that watches one person: a `Watch`."""

    watcher: Watcher
    robot: AgentId
    person: AgentId

    def __call__(self, plan: Plan, deed: Placed, spot: Point) -> None:
        """Add to a plan the robot's drive to where it sees the person's act."""
        self.watcher.watch(plan, self.robot, self.person, deed, spot)
