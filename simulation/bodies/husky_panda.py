"""A Panda arm on a Husky base: the second body, from the robots that ship with pybullet.

The arm's joints, axes and limits are those of the Panda's description. DEVIATES: the Husky is drawn at 0.55 of its
size, since the homes' doors and the navigation radius of 0.30 m are made for indoor robots. We add a lifting column
under the arm, since the arm alone cannot reach both the floor and the top of a fridge. We add a mast with the camera.
"""

from __future__ import annotations

import math

import numpy as np

from coopera.simulation.bodies.arm import Chain, Joint
from coopera.simulation.bodies.robot import Head, MobileManipulator

_QUARTER = math.pi / 2
_MOUNT = (0.04, 0.42)  # forward and height of the arm's foot, the column being down

_CHAIN = Chain(
    joints=(
        Joint("arm_lift", (_MOUNT[0], 0.0, _MOUNT[1]), "z", 0.0, 0.35, slides=True),
        Joint("panda_joint1", (0.0, 0.0, 0.333), "z", -2.9671, 2.9671),
        Joint("panda_joint2", (0.0, 0.0, 0.0), "z", -1.8326, 1.8326, roll=-_QUARTER),
        Joint("panda_joint3", (0.0, -0.316, 0.0), "z", -2.9671, 2.9671, roll=_QUARTER),
        Joint("panda_joint4", (0.0825, 0.0, 0.0), "z", -3.1416, 0.0, roll=_QUARTER),
        Joint("panda_joint5", (-0.0825, 0.384, 0.0), "z", -2.9671, 2.9671, roll=-_QUARTER),
        Joint("panda_joint6", (0.0, 0.0, 0.0), "z", -0.0873, 3.8223, roll=_QUARTER),
        Joint("panda_joint7", (0.088, 0.0, 0.0), "z", -2.9671, 2.9671, roll=_QUARTER),
    ),
    tip=(0.0, 0.0, 0.212),
    pan=(1, _MOUNT[0]),
    lift=-0.75,
)

BODY = MobileManipulator(
    name="husky_panda",
    chain=_CHAIN,
    shoulder=2,
    head=Head((-0.19, 0.0, 1.16), (0.0, 0.0, 0.03), (0.06, 0.0, 0.0), lifted=False),
    fingers=("left_finger", "right_finger"),
    reaching=np.array((0.1, 0.0, -0.5, 0.0, -2.2, 0.0, 1.9, 0.785, 0.0, 0.4, 0.04, 0.04)),
    tucked=np.array((0.0, 1.7, -1.5, 0.0, -2.9, 0.0, 1.7, 0.785, 0.0, 0.25, 0.02, 0.02)),
    carrying=np.array((0.0, 1.1, -0.9, 0.0, -2.6, 0.0, 2.0, 0.785, 0.0, 0.25, 0.03, 0.03)),
    farthest=0.95,
)
