"""How long the person waits for the robot."""

from __future__ import annotations

from collections.abc import Iterable

from coopera.core.hour import HourRecord


def robot_seconds(hours: Iterable[HourRecord]) -> list[float]:
    """Seconds per hour that the robot's own language-model calls took, replies from the cache left out.

    The person waits for these between showing the first task and being helped. Failed hours are left out.
    """
    return [
        sum(call.seconds for call in hour.calls if call.prompt.startswith("robot/") and not call.cached)
        for hour in hours
        if hour.status == "ok" and hour.robot is not None
    ]
