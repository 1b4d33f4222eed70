"""The trace's files: records as JSON, with a few derived fields that make them easy to read from elsewhere.

Derived fields are written and ignored when read: `robot.frames` (the observation's), `robot.outcomes[].task` (the act
in words), `human.found.objects` (fixed and movable together) and `world.moved` (what changed its place this hour).
"""

from __future__ import annotations

import json
import math
import re
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar, cast

from pydantic import ValidationError

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import RunError
from coopera.core.hour import Evening, HourRecord, RobotHour
from coopera.core.household import Outcome

Record = TypeVar("Record", HourRecord, Evening)
_REMEMBERED = 70
"""Records kept in memory: those of a run of five days of thirteen hours, some ten megabytes."""


def write_record(path: Path, record: HourRecord | Evening) -> None:
    """Write a record as a whole.

    Raises:
        RunError: If the file cannot be written or the record holds a number that is not finite.
    """
    data = record.model_dump()  # not in JSON mode, which would silently turn a NaN into null
    if isinstance(record, HourRecord):
        _derive(data, record)
    try:
        write_atomic(path, canonical_json(data, indent=None))
    except OSError as err:
        raise RunError(f"{path}: the trace cannot be written ({reason(err)}).") from err


def as_read(record: HourRecord) -> HourRecord:
    """An hour that is still to be written as it will be read, to the order of its fields: what is made of it shows."""
    return HourRecord.model_validate(json.loads(canonical_json(record.model_dump(), indent=None)))


def read_record(path: Path, kind: type[Record]) -> Record:
    """Read what `write_record` wrote.

    Raises:
        RunError: If the file cannot be read or is damaged; names the file and the field.
    """
    try:
        at = path.stat()
    except OSError as err:
        raise _unreadable(path, err) from err
    return cast(Record, _read_record(path, kind, (at.st_ino, at.st_mtime_ns, at.st_size)))


@lru_cache(maxsize=_REMEMBERED)
def _read_record(path: Path, kind: type[Record], state: tuple[int, int, int]) -> Record:
    """Read a record once while its file stays as it is: an evening, the summary and the report all ask for it."""
    data = read_json(path)
    if isinstance(data, dict):
        _underive(data)
        _rename(data)
        _complete(data)
    try:
        return _checked(path, kind.model_validate(data))
    except ValidationError as err:
        raise damaged(path, err) from err


def _checked(path: Path, record: Record) -> Record:
    """Refuse what an hour's free part cannot be.

    Raises:
        RunError: Naming the file and the field.
    """
    _check_name(path, record)
    if not isinstance(record, HourRecord):
        return record
    try:
        human_outcomes(record)
    except (ValidationError, TypeError) as err:
        raise RunError(f"{path}: the field world.outcomes is damaged (expected a list of what came of acts).") from err
    if not isinstance(record.world.get("poses", {}), dict):
        raise RunError(f"{path}: the field world.poses is damaged (expected a home's state).")
    return record


def _check_name(path: Path, record: HourRecord | Evening) -> None:
    """Refuse a record under the name of another, where the name says a day and an hour."""
    found = re.fullmatch(r"day-(\d+)/(?:hour-(\d+)|evening)\.json", f"{path.parent.name}/{path.name}")
    if found is None:
        return
    if record.day != int(found[1]):
        raise RunError(f"{path}: the field day is damaged (expected {int(found[1])}).")
    if isinstance(record, HourRecord) and found[2] is not None and record.hour != int(found[2]):
        raise RunError(f"{path}: the field hour is damaged (expected {int(found[2])}).")


def damaged(path: Path, err: ValidationError) -> RunError:
    """Say which field of a file is not what it should be."""
    first = err.errors(include_url=False)[0]
    field = ".".join(str(part) for part in first["loc"])
    what = f"field {field}" if field else "file"
    return RunError(f"{path}: the {what} is damaged ({first['msg'].lower()}).")


def read_json(path: Path) -> Any:
    """Read a JSON file.

    Raises:
        RunError: If the file cannot be read or is no JSON.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8"), parse_float=_finite, parse_constant=_finite)
    except OSError as err:
        raise _unreadable(path, err) from err
    except (ValueError, RecursionError) as err:
        raise RunError(f"{path}: the file is damaged ({err}).") from err


def _finite(text: str) -> float:
    if not math.isfinite(number := float(text)):
        raise ValueError(f"{text} is no number that a trace can hold")
    return number


def _unreadable(path: Path, err: OSError) -> RunError:
    return RunError(f"{path}: the file cannot be read ({reason(err)}).")


def human_outcomes(record: HourRecord) -> list[Outcome]:
    """What came of the person's own acts this hour."""
    return [Outcome.model_validate(one) for one in record.world.get("outcomes", [])]


def intention_verdicts(evening: Evening | None, hour: int) -> dict[str, bool | None]:
    """What the person said in the evening of each intention that the robot imagined in an hour, by text."""
    items = evening.feedback if evening else []
    return {item.text: item.helpful for item in items if item.hour == hour and item.kind == "intention"}


def _rename(data: dict[str, Any]) -> None:
    """Give the fields of a trace of schema 1 their names of today."""
    for part in (data, data.get("robot")):
        if isinstance(part, dict) and "picture" in part:
            part["belief"] = part.pop("picture")


def _complete(data: dict[str, Any]) -> None:
    """Count the accepted acts where a trace of before did not: each is a tp or an fp of the predicate."""
    success = data.get("success")
    given, counts = (success.get("help"), success.get("predicate")) if isinstance(success, dict) else (None, None)
    if isinstance(given, dict) and isinstance(counts, dict) and "accepted" not in given:
        found = [counts.get("tp", 0), counts.get("fp", 0)]
        given["accepted"] = sum(found) if all(isinstance(one, int) for one in found) else None


def _derive(data: dict[str, Any], record: HourRecord) -> None:
    if record.human:
        found = data["human"]["found"]
        found["objects"] = {**found["fixed"], **found["movable"]}
    if record.robot:
        data["robot"]["frames"] = list(record.robot.observation.frames)
        for one, outcome in zip(data["robot"]["outcomes"], record.robot.outcomes, strict=True):
            one["task"] = outcome.act.describe()
    data["world"]["moved"] = _moved(record, record.robot)


def _moved(record: HourRecord, robot: RobotHour | None) -> list[str]:
    """Names of the objects that were put somewhere this hour, in the order in which it was done."""
    outcomes = [*(robot.outcomes if robot else []), *human_outcomes(record)]
    moved = [one.act.object for one in outcomes if one.ok and one.act.kind == "pick_place"]
    return list(dict.fromkeys(moved))


def _underive(data: dict[str, Any]) -> None:
    for part, field in (("robot", "frames"), ("world", "moved")):
        if isinstance(data.get(part), dict):
            data[part].pop(field, None)
    human, robot = data.get("human"), data.get("robot")
    if isinstance(human, dict) and isinstance(human.get("found"), dict):
        human["found"].pop("objects", None)
    if isinstance(robot, dict):
        for one in _listed(robot.get("outcomes")):
            if isinstance(one, dict):
                one.pop("task", None)


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []
