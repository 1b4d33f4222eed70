"""How long acts take, and where bodies are meanwhile: what lets two acts happen at the same time."""

from __future__ import annotations

import math
from typing import NamedTuple

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import APART, Dress, Plan, Turn, Walk
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.sight.timing import PERSON_SPEED, ROBOT_SPEED, seconds_at_place
from coopera.simulation.sight.walks import Track

_TICK = 0.1
"""Seconds between two looks at where the bodies are."""


class Stretch(NamedTuple):
    """A part of an act: along a track from a time on, or (a track of one point) standing there."""

    start: float
    track: Track
    speed: float


class Course(NamedTuple):
    """An act in time (seconds from its start): where the body is, and how long it takes in all."""

    stretches: list[Stretch]
    seconds: float

    def at(self, time: float) -> Point:
        """The place of the body after a time; before its start and after its end it stands."""
        now = self.stretches[0]
        for stretch in self.stretches:
            if stretch.start <= time:
                now = stretch
        return now.track.at(max(time - now.start, 0.0) * now.speed)


def course(agent: AgentId, start: Point, plan: Plan, *, drives: bool) -> Course:
    """The course of an agent's act from where it stands; what others do for it (letting it pass) takes no time."""
    stretches, time = [Stretch(0.0, Track.along([start]), 0.0)], 0.0
    speed = ROBOT_SPEED if drives else PERSON_SPEED
    for step in plan.steps:
        if step.agent != agent:
            continue
        if isinstance(step, Walk):
            track = Track.along(step.points)
            stretches.append(Stretch(time, track, speed))
            time += track.marks[-1] / speed
        elif not isinstance(step, Turn | Dress):
            time += seconds_at_place(step)
    return Course(stretches, time)


def waits(yields: Course, goes: Course) -> float:
    """How long a body has to wait on its way until another one is past, in seconds.

    It stops before it would come nearer than `APART` to the other, and goes on when the next step is free. Where the
    other one ends, or it stood too near from the start, nothing is waited for: that is a matter of where one can stand.
    """
    waited, own, now = 0.0, 0.0, 0.0
    while own < yields.seconds and now < goes.seconds:
        here, there = yields.at(own), goes.at(now + _TICK)
        nearer = math.dist(yields.at(own + _TICK), there) < min(APART, math.dist(here, there))
        if nearer:
            waited += _TICK
        else:
            own += _TICK
        now += _TICK
    return round(waited, 6)
