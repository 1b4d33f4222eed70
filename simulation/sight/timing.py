"""How long things take: the ticks of a recording, walks, and what is done where one stands."""

from __future__ import annotations

from coopera.simulation.acts.plans import Give, Handle, Open, Play

TICKS = 30
"""Ticks per second."""
PERSON_SPEED, ROBOT_SPEED = 1.1, 0.8
"""Metres per second."""
SHOWN = 1.3
"""Seconds of a walk that a shot shows before the act."""
MOTION = 8.0
"""Seconds of a motion that are shown, at least; always two of its periods."""
TURN, REACH, HOLD, BACK, SETTLE = 8, 22, 8, 16, 26
"""Ticks until one has turned to a thing, reached it, has it (or has put it down), and stands again; or sits."""


def seconds_at_place(step: Handle | Open | Play | Give) -> float:
    """How long a step takes where it is done, without the way there."""
    if isinstance(step, Play):
        ticks = SETTLE + round(max(MOTION, 2 * step.motion.keys.period) * TICKS)
    else:
        ticks = TURN + REACH + (2 if isinstance(step, Give) else 1) * HOLD + BACK
    return ticks / TICKS
