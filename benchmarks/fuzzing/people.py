"""Readers of people, their logs, diaries and conversations, for `benchmarks.fuzz`."""

from __future__ import annotations

from pathlib import Path

from benchmarks.fuzzing import mutations as change
from benchmarks.fuzzing.kit import ROOT, Reader, in_yaml, of_file
from coopera.evaluation.people.time_use import read_time_use
from coopera.people.changes import open_changes
from coopera.people.import_chat import read_rows
from coopera.people.import_diary import read_published
from coopera.people.log_file import looks_like_log, read_log
from coopera.people.shipped import read_persona
from tests.coopera.people.survey import activities


def _persona(path: Path) -> object:
    return read_persona(path)


def _log(path: Path) -> object:
    return looks_like_log(path), read_log(path)


def _diaries(path: Path) -> object:
    return read_published(path)


def _conversations(path: Path) -> object:
    return read_rows(path)


def _changes(path: Path) -> object:
    changes = open_changes(str(path), 0)
    return [changes("amara", day) for day in (0, 15, 40)]  # type: ignore[arg-type]


def _time_use(path: Path) -> object:
    return read_time_use(path)


_LOG = b"day,hour,intention,tasks,continues,away\n0,9,Bake bread,get flour; heat the oven,no,no\n0,10,Rest,,yes,\n"


_DIARY = b"day,start,end,activity,tasks,away\n0,07:30,08:15,Eat,make tea,\n0,09:00,12:30,Work,,yes\n0,23:00,25:30,TV,,"


_SAID = (
    b'{"day": 0, "hour": 9, "intention": "Bake", "tasks": ["get flour"], "away": false}\n'
    b'{"day": 0, "hour": 10, "intention": "Rest"}\n'
)


_CHAT = (
    b'user 1 personas,user 2 personas,Best Generated Conversation\n"I bake.\nI have cats.",I run.,'
    b'"User 1: Hi!\nUser 2: Hello."\nI sail.,I swim.,Hi.\n'
)


_HOMER = (
    b'{"A/train/000": {"schedule": [["breakfast", 485, 528], ["leave_home", 540, 550], ["reading", 700, 760]]}, '
    b'"A/train/001": {"schedule": [["breakfast", 480, 500]]}}'
)


_CHANGES = in_yaml(
    {
        "moods": True,
        "changes": [
            {
                "kind": "illness",
                "text": "I have the flu",
                "day": 12,
                "until": 17,
                "more": {"nap": 3.0},
                "never": ["cardio"],
            },
            {
                "kind": "job",
                "text": "A new job",
                "day": 30,
                "work": {"at": "outside", "days": [0, 1], "start": 8, "end": 15},
            },
            {"kind": "drift", "text": "I read more", "day": 20, "ramp": 30, "more": {"read": 3.0}, "person": "amara"},
        ],
    }
)


_TIME_USE = (ROOT / "evaluation/people/time_use_atus_2022_23.csv").read_bytes()

READERS: dict[str, Reader] = {
    "persona": Reader(
        of_file("amara.yaml", [(ROOT / "coopera/personas/amara.yaml").read_bytes()], _persona), change.in_yaml
    ),
    "changes": Reader(of_file("changes.yaml", [_CHANGES], _changes), change.in_yaml),
    "log": Reader(of_file("log.csv", [_LOG, _DIARY], _log), change.in_cells),
    "log-lines": Reader(of_file("log.jsonl", [_SAID], _log), change.in_lines),
    "diary-homer": Reader(of_file("homer.json", [_HOMER], _diaries), change.in_json),
    "diary-atus": Reader(of_file("atusact.dat", [activities().encode()], _diaries), change.in_cells),
    "conversations": Reader(of_file("chat.csv", [_CHAT], _conversations), change.in_cells),
    "time-use": Reader(of_file("use.csv", [_TIME_USE], _time_use), change.in_cells),
}
