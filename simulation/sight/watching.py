"""A robot as an onlooker: where it goes to see a person, and the pictures of a recording."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from coopera.core.household import Act, AgentId, HandOver, plain
from coopera.simulation.acts.plans import Ground, Placed, Plan, Turn, UnableError, taken_by_others
from coopera.simulation.acts.walking import walk
from coopera.simulation.acts.workplace import thing_of
from coopera.simulation.drawing.context import Renderer
from coopera.simulation.drawing.view import View
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.magic_box import shape_of
from coopera.simulation.motions.holding import held_at
from coopera.simulation.motions.props import Shown
from coopera.simulation.people.appearance import Appearance
from coopera.simulation.shapes.rotations import Array
from coopera.simulation.sight.cameras import Eyes, Focus, around, robot_camera, view_camera, watching_place, within
from coopera.simulation.sight.hiding import at_work, corners_of, framed_of, person_body, robot_body, tops_of
from coopera.simulation.sight.labels import Name, labelled
from coopera.simulation.sight.recording import Filming, Moment, Recording, Shot
from coopera.simulation.sight.sampling import telling_ticks
from coopera.simulation.sight.stage import Camera, Image, Stage
from coopera.simulation.sight.stances import Held, still
from coopera.simulation.sight.video import frame_file, write_frame
from coopera.simulation.state.home_state import HomeState
from coopera.simulation.state.looks import states_in_sight

Viewpoint: TypeAlias = Literal["robot", "human"]
"""The robot's own, or a third person's of who acts."""
_AWAY = -100.0
_NOTHING: Mapping[AgentId, Held] = MappingProxyType({})
_MOMENTS = (0.35, 0.5, 0.6, 0.7, 0.8, 0.93)
"""When, as shares of a shot, the third person looks for the hands besides."""
_NEAR = 0.7
"""Furniture this near to who acts has its name written, where names are asked for (metres)."""


class Take(NamedTuple):
    """A moment, and the cameras through which it is seen: all that a picture is drawn from, besides the home before."""

    moment: Moment
    cameras: Mapping[Viewpoint, Camera]


class Order(NamedTuple):
    """What is wanted of a recording: how many moments, and where pictures of them go, of a size in pixels."""

    moments: int
    size: tuple[int, int]
    folder: Path
    stems: Mapping[Viewpoint, str]
    """What the files of each view are called: STEM-0.webp …."""
    labels: bool = False
    """Whether names are written into them."""

    def files(self, recording: Recording) -> list[Path]:
        """The pictures, view by view, in order of time."""
        shots = range(min(self.moments, recording.ticks))
        return [frame_file(self.folder, stem, i) for stem in self.stems.values() for i in shots]


class Watcher:
    """Owns the stages of a home: for the robots' eyes, for choosing cameras beside the hour, and for pictures."""

    def __init__(
        self, ground: Ground, renderer: Renderer = "auto", looks: Mapping[AgentId, Appearance] | None = None
    ) -> None:
        """Begin without a stage: each has 30 MB, and waits for who needs it."""
        self.ground, self._looks = ground, looks
        self._renderer = renderer
        self._plain: Stage | None = None
        self._drawn: Stage | None = None

    def close(self) -> None:
        """Give pybullet back."""
        for stage in (self._plain, self._drawn):
            if stage is not None:
                stage.close()

    @property
    def stage(self) -> Stage:
        """The stage in which an onlooker's rays are cast; it looks like nothing."""
        if self._plain is None:
            self._plain = Stage(self.ground.scene, self.ground.people, self.ground.robots, renderer=None)
        return self._plain

    @property
    def drawn(self) -> Stage:
        """The stage that pictures are taken of."""
        if self._drawn is None:
            ground = self.ground
            self._drawn = Stage(ground.scene, ground.people, ground.robots, self._renderer, self._looks)
        return self._drawn

    def watch(self, plan: Plan, robot: AgentId, who: AgentId, deeds: Sequence[Placed], spot: Point) -> None:
        """Add to a plan: a robot drives to where it will see an act of a person, out of their way.

        Args:
            plan: The plan so far; the robot's drive is added.
            robot: Who is to see it.
            who: The person.
            deeds: The person at some moments of the act.
            spot: The floor from which they do it.
        """
        person, deed = plan.state.person(who), deeds[0]
        route = self.ground.navigator.route(person.spot, spot)
        bodies = {agent: still(self.ground, plan.state, agent) for agent in plan.state.agents if agent != who}
        elsewhere = bodies[robot]._replace(x=_AWAY, y=_AWAY)  # it must not see itself in the way
        self.stage.show(plan.state, Moment({**bodies, who: deed, robot: elsewhere}, {}, {}))
        place = watching_place(
            self.stage,
            self.ground.navigator,
            Eyes(self.ground.robots[robot], plan.state.agents[robot].spot),
            self._focus(self.stage, {**bodies, who: deed}, who, later=deeds[1:]),
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

    def take(self, recording: Recording, order: Order) -> None:
        """Choose the moments that tell a recording and where they are seen from, draw them and write the pictures.

        Raises:
            SimulationError: If they cannot be written.
        """
        ticks = telling_ticks(recording, self.ground.robots, order.moments)
        for number, (moment, cameras) in enumerate(self._takes(recording, ticks, tuple(order.stems))):
            self.drawn.show(recording.state, moment)
            names = self._names(recording, moment, self.drawn) if order.labels else []
            for view, camera in cameras.items():
                picture = _labelled(self.drawn, names, camera, order.size)
                write_frame(frame_file(order.folder, order.stems[view], number), picture)

    def views(self, recording: Recording, count: int, size: tuple[int, int]) -> dict[str, View]:
        """All that is seen at the moments, and through the cameras, of a recording's pictures: robot-0 … and human-0 ….

        Raises:
            ConfigError: If another renderer than our own draws here.
        """
        stage, ticks = self.drawn, telling_ticks(recording, self.ground.robots, count)
        found: dict[str, View] = {}
        for number, (moment, cameras) in enumerate(self._takes(recording, ticks, ("robot", "human"))):
            stage.show(recording.state, moment)
            found |= {f"{view}-{number}": stage.view(camera, size) for view, camera in cameras.items()}
        return found

    def video(self, recording: Recording, size: tuple[int, int], every: int) -> Iterator[Image]:
        """Yield each n-th tick with both views side by side, the robot's on the left."""
        stage = self.drawn
        for moment, cameras in self._takes(recording, range(0, recording.ticks, every), ("robot", "human")):
            stage.show(recording.state, moment)
            yield np.concatenate([stage.colours(camera, size) for camera in cameras.values()], axis=1)

    def _takes(self, recording: Recording, ticks: Iterable[int], views: Sequence[Viewpoint]) -> Iterator[Take]:
        """Each moment and its cameras: the third person keeps its place during a shot."""
        across: dict[int, Camera] = {}
        for tick in ticks:
            index, within = recording.find(tick)
            shot = recording.shots[index]
            if "human" in views and index not in across:
                across[index] = self._view(recording, shot)
            moment = shot.at(within)
            yield Take(moment, {v: self._eyes(recording, moment) if v == "robot" else across[index] for v in views})

    def _eyes(self, recording: Recording, moment: Moment) -> Camera:
        return robot_camera(self.ground.robots[recording.robot], moment.bodies[recording.robot])

    def _view(self, recording: Recording, shot: Shot) -> Camera:
        """The third-person camera of who acts."""
        who = recording.actor
        moment = shot.at(shot.deed)
        body = moment.bodies[who]
        away = body._replace(x=_AWAY, y=_AWAY) if who in self.ground.robots else body  # rays must not end at its hull
        stage = self.drawn
        stage.show(recording.state, moment._replace(bodies={**moment.bodies, who: away}), for_rays=True)
        moments = [moment, *(shot.at(round(shot.came + share * (shot.ticks - shot.came))) for share in _MOMENTS)]
        focus = self._focus(stage, moment.bodies, who, moment.held, [one.bodies[who] for one in moments[1:]])
        if who not in self.ground.robots:
            corners, tops = map(np.concatenate, zip(*(self._work(recording, one, who) for one in moments), strict=True))
            person = framed_of([one.bodies[who] for one in moments], whole=moment.outfits.get(who) == "sport")
            busy = at_work(focus.body, np.unique(tops.round(2), axis=0))
            focus = focus._replace(body=busy, framed=np.concatenate((person, corners, tops)))
        return view_camera(stage, self.ground.scene, focus)

    def _work(self, recording: Recording, moment: Moment, who: AgentId) -> tuple[Array, Array]:
        """Where what a person works with is drawn at a moment, in the world.

        The corners of what is in hand and those within what else is shown, and the middles of all tops; shapes (n, 3).
        """
        held, placed = moment.held.get(who), moment.bodies[who]
        if held is None:
            return np.zeros((0, 3)), np.zeros((0, 3))
        size = thing_of(self.ground.scene, recording.state, held.name).size
        drawn = Shown(held.grip) if held.drawn is None else held.drawn
        hand = [] if drawn.grip is None else [(*held_at(placed.pose, size, drawn.grip), size)]
        props = [(shape_of(one.thing).size, one.grip) for one in drawn.props]
        others = [(*held_at(placed.pose, wide, grip), wide) for wide, grip in props]
        inner = [(place, turn, (0.5 * wide, 0.5 * deep, high)) for place, turn, (wide, deep, high) in others]
        return corners_of(placed, [*hand, *inner]), tops_of(placed, [*hand, *others])

    def _focus(
        self,
        stage: Stage,
        bodies: Mapping[AgentId, Placed],
        who: AgentId,
        held: Mapping[AgentId, Held] = _NOTHING,
        later: Iterable[Placed] = (),
    ) -> Focus:
        """A body, and the people before it; other robots stop rays themselves."""
        scene, placed = self.ground.scene, bodies[who]
        robot = self.ground.robots.get(who)
        body = person_body(placed, *later) if robot is None else robot_body(robot, placed)
        others = tuple(person_body(bodies[one]) for one in self.ground.people if one != who)
        ignore = dict.fromkeys((*around(scene, placed), *within(scene, body.points)))
        things = tuple(thing.name for thing in held.values() if thing.name in stage.home.bodies)
        return Focus(placed, body, tuple(ignore), scene.room_at(placed.x, placed.y).name, others, things)

    def _names(self, recording: Recording, moment: Moment, drawn: Stage) -> list[Name]:
        """What may be written into a picture: who is there, what they hold or put down, and the furniture near them."""
        scene = self.ground.scene
        handled = dict.fromkeys((*(held.name for held in moment.held.values()), *moment.moved))
        names = [
            Name(drawn.home.bodies[name], plain(self._class_of(recording, name)), small=True)
            for name in handled
            if name in drawn.home.bodies
        ]
        names += [Name(drawn.bodies[one], "person", small=True) for one in self.ground.people]
        names += [Name(drawn.bodies[one], "robot", small=True) for one in self.ground.robots]
        x, y, *_ = moment.bodies[recording.actor]
        near = sorted((thing.bounds.distance(x, y), thing.name, thing.cls) for thing in scene.fixed)
        return names + [Name(drawn.home.bodies[name], plain(cls)) for away, name, cls in near if away < _NEAR]

    def _class_of(self, recording: Recording, name: str) -> str:
        known, thing = recording.state.box.get(name), self.ground.scene.object(name)
        return known.text if known is not None else thing.cls if thing is not None else name


def _labelled(stage: Stage, names: list[Name], camera: Camera, size: tuple[int, int]) -> Image:
    return labelled(*stage.picture(camera, size), names) if names else stage.colours(camera, size)


@dataclass(frozen=True, slots=True)
class Onlooker:
    """One robot that watches one person: a `Watch`."""

    watcher: Watcher
    robot: AgentId
    person: AgentId

    def __call__(self, plan: Plan, deeds: Sequence[Placed], spot: Point) -> None:
        """Add to a plan the robot's drive to where it sees the person's act."""
        self.watcher.watch(plan, self.robot, self.person, deeds, spot)


def onlooker(watcher: Watcher, state: HomeState, agent: AgentId, act: Act, robot: AgentId | None) -> Onlooker:
    """Who watches whom while an agent acts: `robot`, or the one that acts, or the only one.

    Raises:
        SimulationError: If there is no such robot, or not just one to choose from.
    """
    people = state.ids("person")
    acts = agent if agent not in people else None
    watches = state.the("robot", robot or acts)
    if acts is None:
        return Onlooker(watcher, watches, agent)
    named = act.receiver if isinstance(act, HandOver) and act.receiver in people else None
    return Onlooker(watcher, watches, state.the("person", named or next(iter(people), None)))


def recorded(ground: Ground, state: HomeState, plan: Plan, agent: AgentId, watch: Onlooker) -> Recording:
    """Film a planned act from the home before it, and note what a percept may tell of it."""
    before = state.model_copy(update={"box": {**plan.state.box, **state.box}})
    recording = Filming(ground, before, watch.robot, watch.person).film(plan.steps, agent)
    known = before.box.get(plan.in_hand or "")
    recording.near, recording.in_hand = plan.at, plan.in_hand if known is None else known.text
    recording.states = states_in_sight(ground.scene, plan.state)
    return recording
