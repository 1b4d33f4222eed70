"""Readers of files of a run, for `benchmarks.fuzz`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from shutil import rmtree

from benchmarks.fuzzing import mutations as change
from benchmarks.fuzzing.kit import ROOT, Reader, Target, of_file
from coopera.evaluation.results import from_csv
from coopera.memory import minilm
from coopera.models.recorded import Past
from coopera.report.page import fill, frames_of, texts
from coopera.report.pictures import embed
from coopera.rundir.directory import RunDir
from coopera.rundir.export import export
from tests.coopera.fake_run import fake_run


def _run(name: str, read: Callable[[Path], object], *more: str) -> Callable[[Path], Target]:
    """A run of one hour, one file of which is changed, or what `read` asks for."""

    def ready(folder: Path) -> Target:
        root = folder / "run"
        fake_run(root, days=1, hours=1, frames=2)
        seeds = [(root / one).read_bytes() for one in (name, *more)]
        return Target(root / name, seeds, lambda: read(root))

    return ready


def _with_encoder(ready: Callable[[Path], Target]) -> Callable[[Path], Target]:
    """The same with the encoder of texts loaded, which is larger than what an input may take."""

    def loaded(folder: Path) -> Target:
        minilm.shared().encode("a text")
        return ready(folder)

    return loaded


def _hour(root: Path) -> object:
    run = RunDir.open(root)
    return run.hours(), run.summary()


def _evening(root: Path) -> object:
    return RunDir.open(root).evenings()


def _export(root: Path) -> object:
    rmtree(root / "out", ignore_errors=True)
    return export(RunDir.open(root), root / "out")


def _report(root: Path) -> object:
    run = RunDir.open(root)
    return fill(texts(run), embed(frames_of(run), 100_000))


def _run_json(root: Path) -> object:
    run = RunDir.open(root)
    return run.state, run.prices, run.resumable, run.spent()


def _recorded(root: Path) -> object:
    return Past(root)


def _results(path: Path) -> object:
    return from_csv(path.read_text(encoding="utf-8", errors="replace"), str(path))


_HOUR, _EVENING = "trace/day-00/hour-09.json", "trace/day-00/evening.json"


_HOURS = b"\n".join((ROOT / "docs/results/offline-seeds/hours.csv").read_bytes().split(b"\n")[:6])

READERS: dict[str, Reader] = {
    "hour": Reader(_run(_HOUR, _hour), change.in_json),
    "evening": Reader(_run(_EVENING, _evening), change.in_json),
    "export": Reader(_run(_HOUR, _export), change.in_json),
    "report": Reader(_with_encoder(_run(_HOUR, _report)), change.in_json),
    "report-evening": Reader(_with_encoder(_run(_EVENING, _report)), change.in_json),
    "run-json": Reader(_run("run.json", _run_json), change.in_json),
    "recorded": Reader(_run(_HOUR, _recorded), change.in_json),
    "results": Reader(of_file("hours.csv", [_HOURS], _results), change.in_cells),
}
