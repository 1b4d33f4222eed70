from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from coopera.memory import MemoryStream
from tests.memory.fakes import Letters

PROGRAM = """
import json, os, sys
import numpy as np
from coopera.memory import MemoryStream
from tests.memory.fakes import Letters

folder, side, seed = sys.argv[1:]
rng = np.random.default_rng(int(seed))
stream = MemoryStream.open(folder, "x", Letters())
hour = max([record.hour for record in stream.latest(1)], default=0)
with open(side, "a") as log:
    def say(*what):
        log.write(json.dumps(what) + "\\n")
        log.flush()
        os.fsync(log.fileno())
    say("opened")
    print("opened", flush=True)
    while True:
        hour += int(rng.integers(0, 3))
        if rng.random() < 0.1:
            hour = max(0, hour - 2)
            say("forgetting", hour)
            stream.forget_from(hour)
        else:
            size = int(rng.choice([1, 1, 6, 50, 400]))
            texts = [f"abcd {seed} {hour} {n}" for n in range(size)]
            say("adding", hour, texts)
            stream.add(texts, hour)
        say("done")
"""


def apply(records: list[tuple[str, int]], step: list[object]) -> list[tuple[str, int]]:
    """What a step that is done makes of the records."""
    kind, hour = step[0], int(step[1])  # type: ignore[call-overload]
    if kind == "forgetting":
        return [record for record in records if record[1] < hour]
    return records + [(text, hour) for text in step[2]]  # type: ignore[attr-defined]


def kill_while_writing(tmp_path: Path, kills: int) -> int:
    """Kill the writer again and again; after each time, all that it was told is done must be there, and no more
    than the one step that was under way. Return the number of records at the end.
    """
    rng = np.random.default_rng(kills)
    folder, expected = tmp_path / "memory", list[tuple[str, int]]()
    for kill in range(kills):
        side = tmp_path / f"side-{kill}.jsonl"
        command = [sys.executable, "-c", PROGRAM, str(folder), str(side), str(kill)]
        pipe = subprocess.PIPE
        with subprocess.Popen(command, cwd=Path(__file__).parents[2], stdout=pipe, stderr=pipe) as writer:
            assert writer.stdout is not None
            writer.stdout.readline()
            with_luck = float(rng.uniform(0.02, 1.5))
            try:
                writer.wait(with_luck)
            except subprocess.TimeoutExpired:
                writer.send_signal(signal.SIGKILL)
            _, errors = writer.communicate()
        assert writer.returncode == -signal.SIGKILL, errors.decode()
        lines = [json.loads(line) for line in side.read_text().splitlines(keepends=True) if line.endswith("\n")]
        steps = [line for line in lines[1:] if line[0] != "done"]
        done = sum(line[0] == "done" for line in lines)
        for step in steps[:done]:
            expected = apply(expected, step)
        with MemoryStream.open(folder, "x", Letters()) as stream:
            found = [(record.text, record.hour) for record in stream.records()]
            possible = [expected, *[apply(expected, step) for step in steps[done:]]]
            assert found in possible
            recalled = stream.recall("abc", 10**6, 7)
            assert [item.text for item in recalled] == [text for text, _ in reversed(found[-7:])]
        expected = found
    return len(expected)


def test_what_add_returned_from_survives_a_kill(tmp_path: Path) -> None:
    kill_while_writing(tmp_path, 3)


@pytest.mark.slow
def test_what_add_returned_from_survives_thirty_kills(tmp_path: Path) -> None:
    assert kill_while_writing(tmp_path, 30) > 1000
