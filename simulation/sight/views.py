"""What is to be seen of a home as it now is, as data: a `View` through any camera, or a robot's own."""

from __future__ import annotations

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Ground
from coopera.simulation.drawing.lens import Camera
from coopera.simulation.drawing.view import View
from coopera.simulation.sight.cameras import robot_camera
from coopera.simulation.sight.recording import Filming
from coopera.simulation.sight.stage import Stage
from coopera.simulation.state.home_state import HomeState


def view(stage: Stage, ground: Ground, state: HomeState, through: Camera | AgentId, size: tuple[int, int]) -> View:
    """What a camera, or a robot's head, sees of a home in a state.

    Raises:
        ConfigError: If our own renderer is not to be had.
    """
    moment = Filming(ground, state, AgentId(""), AgentId("")).now()
    if not isinstance(through, Camera):
        through = robot_camera(ground.robots[through], moment.bodies[through])
    stage.show(state, moment)
    return stage.view(through, size)
