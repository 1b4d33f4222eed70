"""What has happened in the run so far, as the person may see it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coopera.core.clock import hour_label
from coopera.core.errors import CooperaError
from coopera.core.hour import HourRecord
from coopera.core.household import Outcome
from coopera.core.interview import Question
from coopera.rundir.directory import RunDir
from coopera.rundir.trace_files import human_outcomes

FRAME = re.compile(r"frames/day-\d{2,}/hour-\d{2}/[a-z]+(-\d{1,3}){1,2}\.webp")
_SHOWN = 4  # pictures of an hour


class Hour(NamedTuple):
    """An hour that has been lived.

    Attributes:
        time: In words.
        intention: What the person wanted.
        tasks: What they did, each with the reason why it could not be done, if so.
        robot: The same of the robot.
        repairs: What was mended of their tasks.
        frames: Pictures of the person, as paths in the run.
        help: Pictures of the robot as it helps, likewise.
        failed: Why the hour could not be lived; empty if it was.
    """

    time: str
    intention: str
    tasks: list[tuple[str, str]]
    robot: list[tuple[str, str]]
    repairs: list[str]
    frames: list[str]
    help: list[str]
    failed: str


class Past(NamedTuple):
    """The day so far, and how the home was left."""

    hours: list[Hour]
    poses: dict[str, Any] | None


def past_of(root: Path, question: Question) -> Past:
    """The hours of the day of a question that are on file, in order."""
    try:
        run = RunDir.open(root)
        days = run.days()
        records = run.read_day(days[-1]) if days else []
    except CooperaError:
        return Past([], None)
    today = [one for one in records if one.episode_day == question.day and one.person == question.person]
    last = records[-1] if records and records[-1].scene == question.scene else None
    return Past([_hour(one, run) for one in today], last.world.get("poses") if last else None)


def _hour(record: HourRecord, run: RunDir) -> Hour:
    human, robot = record.human, record.robot
    frames = robot.observation.frames if robot else []
    chosen = [one for one in frames if "/human-" in one] or frames
    return Hour(
        time=hour_label(record.hour),
        intention=human.intention.text if human else "",
        tasks=[_tried(one) for one in human_outcomes(record)],
        robot=[_tried(one) for one in robot.outcomes] if robot else [],
        repairs=human.repairs if human else [],
        frames=_some(chosen),
        help=_some(_help(record, run)),
        failed=record.reason if record.status == "failed" else "",
    )


def _help(record: HourRecord, run: RunDir) -> list[str]:
    """Pictures of the robot's help, where the run has any."""
    folder = run.root / "frames" / f"day-{record.day:02d}" / f"hour-{record.hour:02d}"
    return sorted(path.relative_to(run.root).as_posix() for path in folder.glob("help-*.webp"))


def _some(frames: Sequence[str]) -> list[str]:
    """A few of some pictures, from first to last."""
    step = max(1, -(-len(frames) // _SHOWN))
    return [one for one in frames[::step] if FRAME.fullmatch(one)]


def _tried(outcome: Outcome) -> tuple[str, str]:
    return outcome.act.describe(), "" if outcome.ok else outcome.reason
