"""Pictures of what a robot did for somebody: frames/day-DD/hour-HH/help-ACT-MOMENT.webp of a run directory."""

from __future__ import annotations

from pathlib import Path


def help_frames(root: Path, day: int, hour: int) -> dict[int, list[str]]:
    """The pictures of the robot's acts in an hour: {number of the act among its outcomes: paths in the run}."""
    found: dict[int, list[tuple[int, str]]] = {}
    for path in (root / "frames" / f"day-{day:02d}" / f"hour-{hour:02d}").glob("help-*-*.webp"):
        act, _, moment = path.stem.removeprefix("help-").partition("-")
        if act.isdecimal() and moment.isdecimal():
            found.setdefault(int(act), []).append((int(moment), path.relative_to(root).as_posix()))
    return {act: [path for _, path in sorted(paths)] for act, paths in sorted(found.items())}
