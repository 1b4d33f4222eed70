"""The Fetch: a mobile manipulator with a lifting torso and a seven-joint arm.

PAPER §Scenes: the robot of Habitat 3.0. Joint origins, axes and limits follow Fetch Robotics' public description; the
shapes (bodies/fetch.urdf) are ours. The torso takes part in every reach: it is the chain's first joint.
"""

from __future__ import annotations

import math

import numpy as np

from coopera.simulation.bodies.arm import Chain, Joint
from coopera.simulation.bodies.robot import Head, MobileManipulator

_CHAIN = Chain(
    joints=(
        Joint("torso_lift", (-0.086875, 0.0, 0.37743), "z", 0.0, 0.38615, slides=True),
        Joint("shoulder_pan", (0.119525, 0.0, 0.34858), "z", -1.6056, 1.6056),
        Joint("shoulder_lift", (0.117, 0.0, 0.06), "y", -1.221, 1.518),
        Joint("upperarm_roll", (0.219, 0.0, 0.0), "x", -math.pi, math.pi),
        Joint("elbow_flex", (0.133, 0.0, 0.0), "y", -2.251, 2.251),
        Joint("forearm_roll", (0.197, 0.0, 0.0), "x", -math.pi, math.pi),
        Joint("wrist_flex", (0.1245, 0.0, 0.0), "y", -2.16, 2.16),
        Joint("wrist_roll", (0.1385, 0.0, 0.0), "x", -math.pi, math.pi),
    ),
    tip=(0.16645, 0.0, 0.0),
    pan=(1, 0.03),
    lift=-0.75,
)

BODY = MobileManipulator(
    name="fetch",
    chain=_CHAIN,
    shoulder=2,
    head=Head((-0.03375, 0.0, 0.980431), (0.14253, 0.0, 0.057999), (0.07, 0.0, 0.0225), lifted=True),
    fingers=("left_finger", "right_finger"),
    reaching=np.array((0.15, 0.0, -0.35, 0.0, 1.25, 0.0, 0.75, 0.0, 0.0, 0.4, 0.05, 0.05)),
    tucked=np.array((0.05, 1.32, 1.40, -0.2, 1.72, 0.0, 1.66, 0.0, 0.0, 0.25, 0.04, 0.04)),
    carrying=np.array((0.12, 0.9, 0.85, -1.2, 1.95, -0.5, 1.0, 0.4, 0.0, 0.25, 0.03, 0.03)),
    farthest=1.15,
)
