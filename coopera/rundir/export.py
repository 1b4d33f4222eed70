"""A run's days as data sets: a Hugging Face `datasets` folder of hours, and episodes in LeRobot's layout.

Both are plain Parquet and JSON with a data set card, written without either library; nothing of ours is needed to read
them.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import ConfigError, RunError
from coopera.core.hour import HourRecord
from coopera.core.household import Outcome
from coopera.core.version import __version__
from coopera.rundir.croissant import Records, whose_days, write_croissant
from coopera.rundir.directory import RunDir

LAYOUT = "v3.0"
"""Of LeRobot's data sets: its file names, and the columns and fields that its reader looks for."""
_HOURS = {
    **dict.fromkeys(("day", "episode", "episode_day", "hour"), "int64"),
    **dict.fromkeys(("person", "scene", "status", "intention", "seen"), "string"),
    **dict.fromkeys(("tasks", "acts", "frames", "robot_intentions", "robot_tasks"), "list of string"),
    **dict.fromkeys(("continues", "away"), "bool_"),
    "robot_probability": "list of float64",
    **dict.fromkeys(("robot_accepted", "robot_correct"), "list of bool_"),
    **dict.fromkeys(("predicate_f1", "judge_f1"), "float64"),
}
_FRAMES = {
    **dict.fromkeys(("index", "episode_index", "frame_index", "task_index", "observation.hour"), "int64"),
    **dict.fromkeys(("timestamp", "action.metres"), "float32"),
    **dict.fromkeys(("observation.intention", "observation.agent", "action"), "string"),
    "next.success": "bool_",
}
_EPISODES = {
    **dict.fromkeys(("episode_index", "length", "dataset_from_index", "dataset_to_index", "day"), "int64"),
    **dict.fromkeys(("data/chunk_index", "data/file_index"), "int64"),
    **dict.fromkeys(("person", "scene"), "string"),
    "tasks": "list of string",
}
_TASKS = {"task_index": "int64", "task": "string"}
"""Columns by the name of their Arrow type: the same whatever a run holds, so that data sets can be put together."""
_ABOUT = {
    "day": "Day of the run, from 0.",
    "episode": "One robot's days with its people, from 0.",
    "episode_day": "Day of the episode, from 0.",
    "hour": "Hour of day, 9 to 23.",
    "person": "Id of the person.",
    "scene": "Id of the home.",
    "status": "ok, or failed: then there are no figures.",
    "intention": "What the person set out to do, in a sentence; none in a failed hour.",
    "seen": "What the robot was told it saw of the first task, where its model sees no pictures.",
    "tasks": "What the person did, in words and in order.",
    "acts": "The same as JSON: pick-and-place or free motion, with ids of furniture and things.",
    "frames": "File names of the pictures of the first task.",
    "robot_intentions": "The intentions that the robot imagined.",
    "robot_tasks": "The tasks that the robot imagined, in words.",
    "continues": "Whether the intention goes on from the hour before.",
    "away": "Whether the person was away from home.",
    "robot_probability": "The classifier's probability of each task.",
    "robot_accepted": "Whether the robot did each task.",
    "robot_correct": "Whether each task would have helped, by the predicate; none where that cannot be told.",
    "predicate_f1": "F1 over the robot's tasks, by the predicate.",
    "judge_f1": "F1 over the robot's tasks, by the judge.",
    "index": "Number of the frame in the data set.",
    "episode_index": "Number of the episode: a day.",
    "frame_index": "Number of the frame in its episode: an act.",
    "task_index": "Number of the task.",
    "observation.hour": "Hour of day of the act.",
    "timestamp": "Time in acts, since an act has no fixed length.",
    "action.metres": "How far the agent went for the act, in metres.",
    "observation.intention": "The person's intention in that hour.",
    "observation.agent": "Who acts: human or robot.",
    "action": "The act as JSON.",
    "next.success": "Whether the act was done.",
    "length": "How many frames the episode has.",
    "dataset_from_index": "Its first frame.",
    "dataset_to_index": "The frame after its last.",
    "data/chunk_index": "In which chunk of files its frames are.",
    "data/file_index": "In which file of that chunk.",
    "task": "The task in words.",
}
_RECORDS = (
    Records("hours", "A row for each hour.", _HOURS, "hours/data/*.parquet", ("day", "hour")),
    Records("frames", "A row for each act, as LeRobot reads it.", _FRAMES, "episodes/data/*/*.parquet", ("index",)),
    Records("episodes", "A row for each day.", _EPISODES, "episodes/meta/episodes/*/*.parquet", ("episode_index",)),
    Records("tasks", "A row for each task.", _TASKS, "episodes/meta/tasks.parquet", ("task_index",)),
)


def export(run: RunDir, out: Path) -> dict[str, Any]:
    """Write `out/hours`, `out/episodes` and the Croissant metadata of both; returns what they hold.

    Raises:
        ConfigError: If pyarrow is not installed, or the folder is not empty.
        RunError: If the run has no hours or the folder cannot be written.
    """
    _parquet()
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise ConfigError(f"out: {out} must be an empty folder or a new one.")
    hours = [_needed(hour) for day in run.days() for hour in run.read_day(day)]
    if not hours:
        raise RunError(f"{run.root}: this run has no hours to export.")
    try:
        rows, frames = _write_hours(run, hours, out / "hours"), _write_episodes(run, hours, out / "episodes")
        write_croissant(run, out, _RECORDS, _ABOUT)
    except OSError as err:
        raise RunError(f"{out}: the data set cannot be written ({reason(err)}).") from err
    except (OverflowError, ValueError) as err:
        raise RunError(f"{run.root}: a number of the trace is too large for a data set ({err}).") from err
    return {"out": str(out), "hours": rows, "episodes": len({hour.day for hour in hours}), "frames": frames}


def _needed(hour: HourRecord) -> HourRecord:
    """What a data set takes of an hour: calls and poses are most of a record, and would fill the memory."""
    return hour.model_copy(update={"calls": [], "world": {"outcomes": hour.world.get("outcomes", [])}})


def _write_hours(run: RunDir, hours: Sequence[HourRecord], folder: Path) -> int:
    rows = [_hour_row(hour) for hour in hours]
    _table(folder / "data" / "train-00000-of-00001.parquet", rows, _HOURS)
    write_atomic(folder / "README.md", _card(run, hours))
    return len(rows)


def _hour_row(hour: HourRecord) -> dict[str, Any]:
    human, robot, success = hour.human, hour.robot, hour.success
    return {
        "day": hour.day,
        "episode": hour.episode,
        "episode_day": hour.episode_day,
        "hour": hour.hour,
        "person": hour.person,
        "scene": hour.scene,
        "status": hour.status,
        "intention": human.intention.text if human else None,
        "continues": human.intention.continues if human else None,
        "away": human.intention.away if human else None,
        "tasks": [task.act.describe() for task in human.tasks] if human else [],
        "acts": [task.act.model_dump_json() for task in human.tasks] if human else [],
        "seen": robot.observation.percept.caption() if robot and robot.observation.percept else None,
        "frames": list(robot.observation.frames) if robot else [],
        "robot_intentions": [c.text for c in robot.intentions] if robot else [],
        "robot_tasks": [c.act.describe() for c in robot.tasks] if robot else [],
        "robot_probability": [c.probability for c in robot.tasks] if robot else [],
        "robot_accepted": [bool(c.accepted) for c in robot.tasks] if robot else [],
        "robot_correct": [c.correct for c in robot.tasks] if robot else [],
        "predicate_f1": success.predicate.f1 if success else None,
        "judge_f1": success.judge.f1 if success and success.judge else None,
    }


def _write_episodes(run: RunDir, hours: Sequence[HourRecord], folder: Path) -> int:
    """A day is an episode, each act in the home a frame, what it was for its task (LeRobot v3.0 file names)."""
    tasks: dict[str, int] = {}
    frames: list[dict[str, Any]] = []
    episodes: list[dict[str, Any]] = []
    days = {day: list(those) for day, those in groupby(hours, key=lambda hour: hour.day)}
    for number, (day, of_day) in enumerate(days.items()):
        begin, said = len(frames), list[str]()
        for hour in of_day:
            intention = hour.human.intention.text if hour.human else ""
            for outcome in _outcomes(hour):
                text = outcome.act.describe()
                said.append(text)
                frames.append(
                    {
                        "index": len(frames),
                        "episode_index": number,
                        "frame_index": len(frames) - begin,
                        "timestamp": float(len(frames) - begin),
                        "task_index": tasks.setdefault(text, len(tasks)),
                        "observation.hour": hour.hour,
                        "observation.intention": intention,
                        "observation.agent": outcome.agent,
                        "action": outcome.act.model_dump_json(),
                        "action.metres": outcome.metres,
                        "next.success": outcome.ok,
                    }
                )
        first = of_day[0]
        episodes.append(
            {
                "episode_index": number,
                "tasks": list(dict.fromkeys(said)),
                "length": len(frames) - begin,
                "data/chunk_index": 0,
                "data/file_index": 0,
                "dataset_from_index": begin,
                "dataset_to_index": len(frames),
                "person": first.person,
                "scene": first.scene,
                "day": day,
            }
        )
    _table(folder / "data" / "chunk-000" / "file-000.parquet", frames, _FRAMES)
    _table(folder / "meta" / "episodes" / "chunk-000" / "file-000.parquet", episodes, _EPISODES)
    rows = [{"task_index": n, "task": text} for text, n in tasks.items()]
    _table(folder / "meta" / "tasks.parquet", rows, _TASKS, index="task")
    write_atomic(folder / "meta" / "info.json", canonical_json(_info(run.config.robot, frames, episodes, tasks)))
    return len(frames)


def _outcomes(hour: HourRecord) -> Iterable[Outcome]:
    """The person's first act, then the robot's, then the person's others, as they came in the home."""
    mine = [Outcome.model_validate(one) for one in hour.world.get("outcomes", [])]
    robot = hour.robot.outcomes if hour.robot else []
    return [*mine[:1], *robot, *mine[1:]]


def _info(robot: str, frames: Sequence[Any], episodes: Sequence[Any], tasks: dict[str, int]) -> dict[str, Any]:
    features = {name: {"dtype": kind.removesuffix("_"), "shape": [1], "names": None} for name, kind in _FRAMES.items()}
    return {
        "codebase_version": LAYOUT,
        "robot_type": robot,
        "fps": 1,  # an act has no fixed length: time counts acts
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "total_episodes": len(episodes),
        "total_frames": len(frames),
        "total_tasks": len(tasks),
        "splits": {"train": f"0:{len(episodes)}"},
        "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
        "video_path": None,
        "features": features,
    }


def _card(run: RunDir, hours: Sequence[HourRecord]) -> str:
    """The data set card, with the front matter that the Hugging Face hub reads."""
    config, people = run.config, run.people()
    sources = sorted({persona.source.split(":")[0] for persona in people.values()})
    models = config.models.model_dump()
    warning = (
        "The people were played by coopera's **offline routine model**, which is not a language model; the texts are "
        "those of a household knowledge file.\n\n"
        if "offline" in models["human"]
        else ""
    )
    return f"""---
language: en
license: apache-2.0
task_categories: [robotics, text-classification]
tags: [human-robot-collaboration, simulated-people, coopera]
size_categories: [{"n<1K" if len(hours) < 1000 else "1K<n<10K" if len(hours) < 10_000 else "10K<n<100K"}]
configs:
- config_name: default
  data_files: data/*.parquet
---

# Simulated days of {len(people)} people, hour by hour

{len(hours)} hours of {len({hour.day for hour in hours})} days in {len({hour.scene for hour in hours})} simulated homes,
made by coopera {__version__}. {whose_days(config)}

{warning}| | |
|---|---|
| people | {", ".join(sorted(people))} (texts from: {", ".join(sources)}) |
| homes | {", ".join(sorted({hour.scene for hour in hours}))} |
| method of the robot | {config.method} |
| models | {", ".join(f"{role}: {spec}" for role, spec in models.items())} |
| collaboration type, setting, seed | {config.collab}, {config.setting}, {config.seed} |
| failed hours | {sum(hour.status == "failed" for hour in hours)} |

One row is one hour: what the person intended and did (`intention`, `tasks`, `acts` as JSON), what the robot saw
(`seen`), imagined (`robot_*`) and how well (`*_f1`, see docs/measures.md of coopera). Lists of one hour go together.

**Uses.** Predicting intentions and tasks, personalisation, evaluating assistants. **Not for** claims about real people:
habits, errors and preferences are a simulation's. Persona texts keep the licence of their source.
"""


def _table(path: Path, rows: Sequence[dict[str, Any]], columns: Mapping[str, str], *, index: str | None = None) -> None:
    """Write rows as Parquet; `index` is the column that pandas takes for the rows' names."""
    pyarrow, parquet = _parquet()

    def kind(name: str) -> Any:
        inner = name.removeprefix("list of ")
        made = getattr(pyarrow, inner)()
        return made if inner == name else pyarrow.list_(made)

    schema = pyarrow.schema([(name, kind(text)) for name, text in columns.items()])
    if index is not None:
        about = {"pandas_type": "unicode", "numpy_type": "object", "metadata": None}
        named = {
            "index_columns": [index],
            "column_indexes": [],
            "columns": [{"name": index, "field_name": index, **about}],
            "pandas_version": "2.0.0",
        }
        schema = schema.with_metadata({"pandas": json.dumps(named)})
    path.parent.mkdir(parents=True, exist_ok=True)
    parquet.write_table(pyarrow.Table.from_pylist(list(rows), schema=schema), path)


def _parquet() -> tuple[Any, Any]:
    try:
        import pyarrow  # noqa: PLC0415 - an optional extra
        from pyarrow import parquet  # noqa: PLC0415
    except ImportError:
        raise ConfigError("export needs the package pyarrow: pip install -c constraints.txt -e '.[parquet]'") from None
    return pyarrow, parquet
