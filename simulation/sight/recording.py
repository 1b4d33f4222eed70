"""The look of a recorded act: for every tick the place and the pose of all bodies, and the things in their hands.

A recording is a list of shots. A shot is what a robot watches from one place: the end of a walk and then a reach,
a motion or a hand-over. Longer walks are cut, as a film would. Poses are computed only for the ticks asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, partial
from types import MappingProxyType
from typing import NamedTuple

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Dress, Give, Ground, Handle, Open, Placed, Play, Step, Turn, Walk
from coopera.simulation.acts.workplace import kept_from_sight, reaching_in, surface_at_work, thing_of, working
from coopera.simulation.bodies.humanoid import blend
from coopera.simulation.bodies.humanoid_reach import carrying, standing
from coopera.simulation.motions.aids import aids, now
from coopera.simulation.motions.poses import pose_at
from coopera.simulation.motions.props import shown
from coopera.simulation.people.appearance import Outfit, outfit_for
from coopera.simulation.shapes.rotations import Array
from coopera.simulation.sight.stances import Held, Stances, receiving, stances, watching
from coopera.simulation.sight.timing import (
    BACK,
    HOLD,
    MOTION,
    PERSON_SPEED,
    REACH,
    ROBOT_SPEED,
    SETTLE,
    SHOWN,
    TICKS,
    TURN,
)
from coopera.simulation.sight.walks import Track, between_bodies, mixed, walking
from coopera.simulation.state.home_state import HomeState, PersonState, ThingState


class Moment(NamedTuple):
    """One tick: everybody's body, what those hold who hold something, and the things that were moved by then.

    `worn` is what people have put on, `opened` which furniture is open. `outfits` is how those are dressed who are not
    dressed for the day, `drawn` how pictures show a body that is in fact otherwise, `unseen` which things they leave
    out: nothing else knows of these.
    """

    bodies: Mapping[AgentId, Placed]
    held: Mapping[AgentId, Held]
    moved: Mapping[str, ThingState]
    worn: Mapping[AgentId, tuple[str, ...]] = MappingProxyType({})
    opened: frozenset[str] = frozenset()
    outfits: Mapping[AgentId, Outfit] = MappingProxyType({})
    drawn: Mapping[AgentId, Placed] = MappingProxyType({})
    unseen: frozenset[str] = frozenset()


@dataclass(slots=True)
class Shot:
    """Ticks seen from one place of a robot; `at` gives the moment of a tick, `deed` is when the act is best seen.

    The first `came` ticks are the end of a walk; from `begun` on a motion is made, in a shot of one.
    """

    ticks: int
    at: Callable[[int], Moment]
    deed: int
    came: int = 0
    begun: int | None = None


@dataclass(slots=True)
class Recording:
    """A recorded act: the home before it, the shots, and what a percept may tell of it; not which motion is done.

    `actor` is who acts, by `steps`, `robot` who sees it, `person` who is looked at. `states` is {object: its states in
    words} of what could be seen after the act not to be as at first. `before` is how agents stood, and what they held.
    """

    state: HomeState
    robot: AgentId
    person: AgentId
    actor: AgentId
    shots: list[Shot] = field(default_factory=list)
    near: list[str] = field(default_factory=list)
    in_hand: str | None = None
    states: dict[str, str] = field(default_factory=dict)
    steps: list[Step] = field(default_factory=list)
    before: Stances = Stances({}, {})

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


class Filming:
    """Turns the steps of a plan into shots."""

    def __init__(
        self, ground: Ground, start: HomeState, robot: AgentId, person: AgentId, before: Stances | None = None
    ) -> None:
        """Begin with everybody as they are, which is worked out where it is not known.

        `robot` will see it, and `person` is looked at.
        """
        self.ground, self.robots = ground, ground.robots
        before = before or stances(ground, start)
        self.bodies, self.held = dict(before.bodies), dict(before.held)
        self.moved: Mapping[str, ThingState] = {}
        self.worn = {agent: body.worn for agent, body in start.agents.items() if body.worn}
        self.opened = frozenset(name for name, said in start.conditions.items() if said.get("open"))
        self.recording = Recording(start, robot, person, person, before=before)
        self._outfits = {agent: _outfit(body) for agent, body in start.agents.items() if isinstance(body, PersonState)}
        self._walk: Walk | None = None
        self._actor = person

    def film(self, steps: list[Step], actor: AgentId) -> Recording:
        """Film all steps; walks of those who are not acting happen between the shots."""
        self._actor = self.recording.actor = actor
        self.recording.steps += steps
        for step in steps:
            if isinstance(step, Walk):
                self._go(step)
            elif isinstance(step, Turn):
                self.bodies[step.agent] = self.bodies[step.agent]._replace(yaw=step.yaw)
            elif isinstance(step, Handle):
                self._handle(step)
            elif isinstance(step, Open):
                self._open(step)
            elif isinstance(step, Play):
                self._play(step)
            elif isinstance(step, Dress):
                self._dress(step)
            elif isinstance(step, Give):
                self._give(step)
        return self.recording

    def now(self) -> Moment:
        """Everybody and everything as they are after what was filmed so far."""
        return Moment(dict(self.bodies), dict(self.held), self.moved, dict(self.worn), self.opened, dict(self._outfits))

    def _go(self, step: Walk) -> None:
        yaw = Track.along(step.points).heading(math.inf)
        before = self.bodies[step.agent]
        pose = self._idle(step.agent, holds=False)
        self.bodies[step.agent] = Placed(*step.points[-1], before.yaw if yaw is None else yaw, pose)
        if step.agent == self._actor:
            self._walk = step
            if step.carries:
                self.held[step.agent] = Held(step.carries)

    def _approach(self, agent: AgentId) -> tuple[int, Callable[[int], Placed]]:
        """The last moments of the walk before an act."""
        walk, self._walk = self._walk, None
        there = self.bodies[agent]
        if walk is None or len(walk.points) < 2:
            return 0, lambda tick: there
        drives = agent in self.robots
        track, speed = Track.along(walk.points), (ROBOT_SPEED if drives else PERSON_SPEED) / TICKS
        ticks = min(math.ceil(track.marks[-1] / speed), round(SHOWN * TICKS))
        carries = walk.carries is not None
        driving = self._idle(agent, carries) if drives else None  # to hold no `self` lets a recording go at once

        def at(tick: int) -> Placed:
            gone = max(track.marks[-1] - (ticks - tick) * speed, 0.0)
            yaw = track.heading(gone)
            pose = walking(gone, carries) if driving is None else driving
            return Placed(*track.at(gone), there.yaw if yaw is None else yaw, pose)

        return ticks, at

    def _handle(self, step: Handle) -> None:
        """Walk up, turn, reach, take or put, and straighten up."""
        thing = Held(step.name)
        if step.put is None:
            self._reach(step, None, thing, self.moved, self.opened)
        else:
            self._reach(step, thing, None, {**self.moved, step.name: step.put}, self.opened)

    def _open(self, step: Open) -> None:
        """Walk up, turn, reach, open or close, and straighten up; what is in hand stays there."""
        opened = self.opened | {step.name} if step.opens else self.opened - {step.name}
        thing = self.held.get(step.agent)
        self._reach(step, thing, thing, self.moved, opened)

    def _reach(
        self,
        step: Handle | Open,
        before: Held | None,
        after: Held | None,
        moved: Mapping[str, ThingState],
        opened: frozenset[str],
    ) -> None:
        """Walk up, turn and reach; there the hand, the things and the doors become as said."""
        agent = step.agent
        walk_ticks, walk_at = self._approach(agent)
        came, between = walk_at(walk_ticks), self._blend(agent)
        here = Placed(step.stand.x, step.stand.y, step.stand.yaw, self._idle(agent, before is not None))
        away = here._replace(pose=self._idle(agent, after is not None))
        bent = here._replace(pose=step.posture)
        turned, reached = walk_ticks + TURN, walk_ticks + TURN + REACH
        done = reached + HOLD
        others = self._frozen(agent)
        first, then = (before, self.moved, self.opened), (after, moved, opened)

        def at(tick: int) -> Moment:
            if tick < walk_ticks:
                body = walk_at(tick)
            elif tick < turned:
                body = between(came, here, (tick - walk_ticks) / TURN)
            elif tick < reached:
                body = between(here, bent, (tick - turned) / REACH)
            else:
                body = between(bent, away, (tick - done) / BACK)
            held, places, doors = then if tick >= reached + HOLD // 2 else first
            return others(body, held, places)._replace(opened=doors)

        self.recording.shots.append(Shot(done + BACK, cache(at), reached + HOLD // 2 - 1, walk_ticks))
        self.opened = opened
        self._finish(agent, away, after, moved)

    def _play(self, step: Play) -> None:
        """Walk up, get into the posture, and do the motion."""
        agent = step.agent
        walk_ticks, walk_at = self._approach(agent)
        came, between = walk_at(walk_ticks), self._blend(agent)
        person, motion = step.person, step.motion
        setting, grip = working(self.ground.scene, self.recording.state, person, motion, self.moved)
        cls = thing_of(self.ground.scene, self.recording.state, person.thing).cls if person.thing else ""

        top = surface_at_work(self.ground.scene, self.recording.state, person, motion, self.moved, setting)

        def held(seconds: float) -> Held | None:
            if not person.thing:
                return None
            how, more = now(motion, setting, grip, seconds), aids(motion, setting, grip, seconds, cls)
            return Held(person.thing, how, tuple(more), shown(motion, setting, how, (person.thing, cls), top, seconds))

        carried = Held(person.thing) if person.thing else None
        settled = walk_ticks + SETTLE
        total = settled + round(max(MOTION, 2 * motion.keys.period) * TICKS)
        others = self._frozen(agent)
        moved, outfit = self.moved, _outfit(person)
        scene, state, inside = self.ground.scene, self.recording.state, reaching_in(self.ground.scene, person, motion)
        brought = [state.box[person.thing].text] if person.thing in state.box else []
        doubled = kept_from_sight(scene, state, person, moved, brought)
        also = cache(partial(kept_from_sight, scene, state, person, moved))

        def at(tick: int) -> Moment:
            if tick < walk_ticks:
                return others(walk_at(tick), carried, moved)._replace(unseen=doubled)
            seconds = max(tick - settled, 0) / TICKS
            body = Placed(*person.place, person.yaw, pose_at(motion, seconds, setting))
            if tick < settled:
                comes = between(came, body, (tick - walk_ticks) / SETTLE)
                return others(comes, carried, moved)._replace(unseen=doubled)
            holds = held(seconds)
            used = () if holds is None or holds.drawn is None else (*holds.aids, *holds.drawn.props)
            moment = others(body, holds, moved)
            unseen = doubled | also(tuple(one.thing for one in used))
            moment = moment._replace(outfits={**moment.outfits, agent: outfit}, unseen=unseen)
            if inside is None or person.at is None:
                return moment
            drawn = body._replace(pose=pose_at(inside, seconds, setting))
            return moment._replace(opened=moment.opened | {person.at}, drawn={agent: drawn})

        self.recording.shots.append(Shot(total, cache(at), settled + (total - settled) // 2, walk_ticks, settled))
        self.worn, self._outfits[agent] = {**self.worn, agent: person.worn}, outfit
        self._finish(agent, Placed(*person.place, person.yaw, pose_at(motion, 0.0, setting)), held(0.0), moved)

    def _dress(self, step: Dress) -> None:
        """What is worn and held changes; where a motion did it, that is seen at the motion's end.

        Of what pictures show in place of the thing, such as a garment on the body, nothing changes any more.
        """
        self.worn = {**self.worn, step.agent: step.worn}
        self.held = _with(self.held, step.agent, Held(step.thing) if step.thing else None)
        if not self.recording.shots or step.agent != self._actor:
            return
        last, worn, held = self.recording.shots[-1], self.worn, self.held

        def at(tick: int) -> Moment:
            moment = last.at(tick)
            if tick < last.ticks - BACK:
                return moment
            own = moment.held.get(step.agent)
            stays = own is not None and own.drawn is not None and own.drawn.grip is None
            return moment._replace(worn=worn, held=_with(held, step.agent, own) if stays else held)

        self.recording.shots[-1] = replace(last, at=at)

    def _give(self, step: Give) -> None:
        """Drive up, hold out the thing, and let the person take it; or take from the person what they hold out."""
        walk_ticks, walk_at = self._approach(step.agent)
        came = walk_at(walk_ticks)
        moves, bends = self._blend(step.agent), self._blend(step.receiver)
        here = Placed(step.stand.x, step.stand.y, step.stand.yaw, self._idle(step.agent, holds=not step.back))
        out, after = here._replace(pose=step.posture), here._replace(pose=self._idle(step.agent, holds=step.back))
        turned, reached = walk_ticks + TURN, walk_ticks + TURN + REACH
        done = reached + 2 * HOLD
        waiting, moved = self.bodies[step.receiver], self.moved
        thing, other = Held(step.thing), self.held.get(step.receiver)
        robots = (None, thing) if step.back else (thing, None)
        persons = (thing, None) if step.back else (other, thing)
        stands = self.recording.state.person(step.receiver).posture == "stand"
        taking = receiving(waiting, step) if stands else waiting
        others = self._frozen(step.agent)

        def at(tick: int) -> Moment:
            if tick < walk_ticks:
                robot = walk_at(tick)
            elif tick < turned:
                robot = moves(came, here, (tick - walk_ticks) / TURN)
            elif tick < reached:
                robot = moves(here, out, (tick - turned) / REACH)
            else:
                robot = moves(out, after, (tick - done) / BACK)
            share = (tick - turned) / REACH if tick < done else 1 - (tick - done) / BACK
            given = tick >= reached + HOLD
            person = bends(waiting, taking, share)
            moment = others(robot, robots[given], moved)
            held = _with(moment.held, step.receiver, persons[given])
            return moment._replace(bodies={**moment.bodies, step.receiver: person}, held=held)

        self.recording.shots.append(Shot(done + BACK, cache(at), reached, walk_ticks))
        self._finish(step.agent, after, robots[1], moved)
        self.held = _with(self.held, step.receiver, persons[1])

    def _frozen(self, agent: AgentId) -> Callable[[Placed, Held | None, Mapping[str, ThingState]], Moment]:
        """Moments in which only one agent moves; who watches another one keeps its head towards the person."""
        bodies, all_held, worn, opened = dict(self.bodies), dict(self.held), dict(self.worn), self.opened
        outfits = {one: outfit for one, outfit in self._outfits.items() if one != agent}
        robot, person, robots = self.recording.robot, self.recording.person, self.robots

        def moment(body: Placed, held: Held | None, moved: Mapping[str, ThingState]) -> Moment:
            now = {**bodies, agent: body}
            if agent != robot:
                now[robot] = watching(robots[robot], now[robot], now[person])
            return Moment(now, _with(all_held, agent, held), moved, worn, opened, outfits)

        return moment

    def _idle(self, agent: AgentId, holds: bool) -> Array:
        robot = self.robots.get(agent)
        if robot is not None:
            return robot.carrying if holds else robot.tucked
        return carrying() if holds else standing()

    def _blend(self, agent: AgentId) -> Callable[[Placed, Placed, float], Placed]:
        """How an agent gets from one placed body to another."""
        return partial(between_bodies, mix=mixed if agent in self.robots else blend)

    def _finish(self, agent: AgentId, body: Placed, held: Held | None, moved: Mapping[str, ThingState]) -> None:
        self.moved = moved
        self.bodies[agent] = body
        self.held = _with(self.held, agent, held)


def _outfit(body: PersonState) -> Outfit:
    """How a person is dressed for what they do."""
    return outfit_for(body.motion, body.at)


def _with(held: Mapping[AgentId, Held], agent: AgentId, thing: Held | None) -> dict[AgentId, Held]:
    """What everybody holds, once an agent holds a thing, or nothing."""
    others = {one: what for one, what in held.items() if one != agent}
    return others if thing is None else {**others, agent: thing}
