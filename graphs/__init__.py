"""The LangGraph state machines: the person's hour, the robot's hour, the whole hour, the day, the study.

The services of their nodes, the learning of an evening and robots of one's own are here, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.graphs.day import build_day_graph, first_day
    from coopera.graphs.human import build_human_graph
    from coopera.graphs.players.player import HumanContext
    from coopera.graphs.robot import RobotContext, build_robot_graph
    from coopera.graphs.robots.method import Method
    from coopera.graphs.robots.own_robot import Robot
    from coopera.graphs.robots.robot_view import RobotView
    from coopera.graphs.services import Services
    from coopera.graphs.study import STATE_TYPES, build_study_graph

__all__ = [
    "STATE_TYPES",
    "HumanContext",
    "Method",
    "Robot",
    "RobotContext",
    "RobotView",
    "Services",
    "build_day_graph",
    "build_human_graph",
    "build_robot_graph",
    "build_study_graph",
    "first_day",
]

_HOMES = {
    "STATE_TYPES": "coopera.graphs.study",
    "HumanContext": "coopera.graphs.players.player",
    "Method": "coopera.graphs.robots.method",
    "Robot": "coopera.graphs.robots.own_robot",
    "RobotContext": "coopera.graphs.robot",
    "RobotView": "coopera.graphs.robots.robot_view",
    "Services": "coopera.graphs.services",
    "build_day_graph": "coopera.graphs.day",
    "build_human_graph": "coopera.graphs.human",
    "build_robot_graph": "coopera.graphs.robot",
    "build_study_graph": "coopera.graphs.study",
    "first_day": "coopera.graphs.day",
}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
