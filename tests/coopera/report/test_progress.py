from __future__ import annotations

import io
from pathlib import Path

from rich.console import Console

from coopera.report.progress import Progress, days_table
from coopera.rundir.directory import RunDir


def lines(events: list[tuple[int, int | None, str, float | None]], *, terminal: bool = False) -> str:
    out = io.StringIO()
    console = Console(file=out, force_terminal=terminal, width=120, highlight=False, color_system=None)
    with Progress(4, console) as progress:
        for day, hour, node, success in events:
            progress.tell({"day": day, "hour": hour, "node": node, "success": success})
    return out.getvalue()


EVENTS = [
    (0, None, "start_day", None),
    (0, 9, "propose", None),
    (0, 9, "record", 0.5),
    (0, 10, "propose", 0.5),
    (0, 10, "record", 0.4),
    (0, None, "learn", 0.4),
    (0, None, "end_day", 0.4),
    (1, 9, "record", None),
]


def test_a_pipe_gets_a_line_at_once_and_one_per_hour() -> None:
    assert lines(EVENTS).splitlines() == [
        "getting ready; 0 of 4 hours are done",
        "day 0, 9 am done (1 of 4 hours); predicate F1 so far 0.500",
        "day 0, 10 am done (2 of 4 hours); predicate F1 so far 0.400",
        "day 1, 9 am done (3 of 4 hours); predicate F1 so far 0.400",
    ]


def test_a_terminal_gets_day_hour_node_and_running_success() -> None:
    text = lines(EVENTS[:5], terminal=True)
    assert "day 0 · 10 am · record · F1 so far 0.400" in text
    assert "2/4" in text


def test_the_days_of_a_run_fit_80_columns_with_need_f1_first(small_run: RunDir) -> None:
    console = Console(record=True, width=80, file=io.StringIO())
    summary = small_run.summary()
    for day in summary["days"]:
        day["person"] = "spc-valid-0001"
    days_table(summary, Path("here"), console)
    text = console.export_text()
    [heads] = [line for line in text.splitlines() if "person" in line and "home" in line]
    assert heads.split() == ["day", "person", "home", "need", "F1", "precision", "recall", "F1", "judge", "people"]
    for day in summary["days"]:
        assert day["need"].keys() == {"precision", "recall", "f1"}
        [line] = [line for line in text.splitlines() if line.split()[:2] == [str(day["day"]), "spc-valid-0001"]]
        shown = [day["need"]["f1"], day["need"]["precision"], day["need"]["recall"], day["predicate"]["f1"]]
        assert line.split()[3:7] == ["–" if value is None else f"{value:.3f}" for value in shown]


def test_a_resumed_run_counts_the_hours_that_were_lived_before() -> None:
    out = io.StringIO()
    with Progress(4, Console(file=out, width=120), done=[(0, 9), (0, 10)]) as progress:
        progress.tell({"day": 0, "hour": 10, "node": "record", "success": 0.5})
        progress.tell({"day": 0, "hour": 11, "node": "record", "success": 0.5})
    assert [line.split("(")[1].split(" hours")[0] for line in out.getvalue().splitlines()[1:]] == ["2 of 4", "3 of 4"]
    assert out.getvalue().startswith("getting ready; 2 of 4 hours are done")


def test_an_hour_that_is_broken_off_is_not_called_done() -> None:
    out = io.StringIO()
    progress = Progress(4, Console(file=out, width=120))
    try:
        with progress:
            progress.tell({"day": 0, "hour": 9, "node": "propose", "success": None})
            raise KeyboardInterrupt
    except KeyboardInterrupt:
        pass
    assert " 9 am done" not in out.getvalue()
