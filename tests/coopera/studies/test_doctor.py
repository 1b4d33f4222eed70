"""A run that lost or altered a file is told so, and whatever follows from its trace is made again as it was."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from coopera import Config, resume_study, run_study
from coopera.core.errors import RunError, StoppedError
from coopera.graphs.robots.learning import KEPT, KEPT_PLAIN, unpack_kept
from coopera.memory import MemoryStream
from coopera.memory.rebuild import texts
from coopera.rundir import seals
from coopera.studies import findings as checks
from coopera.studies.doctor import examine
from tests.coopera.conftest import Said
from tests.fakes import LetterEmbeddings

Harm = Callable[[Path], object]
ADAPTER = "adapters/day-00/intention/kernel.npz"
FRAME = "frames/day-01/hour-09/robot-0.webp"


def config(out: Path, **more: object) -> Config:
    given = {"days": 2, "hours": 1, "frames": 1, "frame_size": (32, 32), **more}
    return Config(out=out, **given)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory, letters: Path) -> Path:
    out = tmp_path_factory.mktemp("doctor") / "whole"
    run_study(config(out, data_dir=letters))
    return out


@pytest.fixture(autouse=True)
def index_is_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    """To look into a memory's index takes a process of its own, and seconds; one test does it."""
    monkeypatch.setattr(checks, "index_damage", lambda folder: "")


def copied(run: Path, name: str) -> Path:
    return Path(shutil.copytree(run, run.parent / name.replace("/", "-")))


def content(run: Path) -> dict[str, bytes]:
    """All that a run's results rest on; its memory by what it remembers."""
    files = [path for path in run.rglob("*") if path.is_file()]
    own = [path for path in files if not path.relative_to(run).parts[0].startswith(("memory", "checkpoints", "lock"))]
    found = {path.relative_to(run).as_posix(): path.read_bytes() for path in own}
    return found | {"memory": json.dumps(texts(run / "memory")).encode()}


def cut(name: str) -> Harm:
    return lambda run: (run / name).write_bytes((run / name).read_bytes()[: (run / name).stat().st_size // 2])


def lose(name: str) -> Harm:
    return lambda run: shutil.rmtree(run / name) if (run / name).is_dir() else (run / name).unlink()


def scribble(name: str) -> Harm:
    return lambda run: (run / name).write_text("nothing of the kind")


MENDED = [
    ("lost-adapter", lose(ADAPTER), ADAPTER),
    ("cut-adapter", cut(ADAPTER), ADAPTER),
    ("lost-examples", lose("adapters/day-00/task/examples.jsonl"), "adapters/day-00/task/examples.jsonl"),
    ("lost-adapters", lose("adapters"), ADAPTER),
    ("lost-memory", lose("memory"), "memory"),
    ("cut-memory", cut("memory/chroma.sqlite3"), "memory"),
    ("cut-checkpoints", cut("checkpoints.sqlite"), "checkpoints.sqlite"),
    ("scribbled-metrics", scribble("metrics.csv"), "metrics.csv"),
    ("lost-summary", lose("summary.json"), "summary.json"),
    ("cut-report", cut("report.html"), "report.html"),
    ("lost-frame", lose(FRAME), FRAME),
    ("scribbled-frame", scribble(FRAME), FRAME),
    ("lost-person", lose("people/amara.yaml"), "people/amara.yaml"),
    ("scribbled-person", scribble("people/amara.yaml"), "people/amara.yaml"),
    ("lost-seal", lose("trace/day-00/seal.json"), "trace/day-00/seal.json"),
    ("scribbled-seal", scribble("trace/day-00/seal.json"), "trace/day-00/seal.json"),
    ("lost-first-seal", lose("seal.json"), "seal.json"),
    ("lost-last-seal", lose("trace/day-01/seal.json"), "trace/day-01/seal.json"),
]


def test_a_whole_run_is_whole_and_nothing_of_it_is_touched(whole: Path) -> None:
    before = content(whole)
    assert examine(whole) == examine(whole, repair=True) == []
    assert content(whole) == before


@pytest.mark.parametrize(("name", "harm", "file"), MENDED, ids=[name for name, *_ in MENDED])
def test_what_follows_from_the_trace_is_made_again_as_it_was(whole: Path, name: str, harm: Harm, file: str) -> None:
    run = copied(whole, name)
    harm(run)
    assert file in [one.file for one in examine(run)]
    assert all(one.mended for one in examine(run, repair=True))
    assert examine(run) == []
    assert content(run) == content(whole)


TRUTH = ["trace/day-00/hour-09.json", "trace/day-00/evening.json", "trace/day-01/hour-09.json", "config.yaml"]


@pytest.mark.parametrize("file", TRUTH)
def test_what_nothing_else_holds_is_named_and_the_rest_is_left_as_it_is(whole: Path, file: str) -> None:
    run = copied(whole, f"altered-{file}")
    text = (run / file).read_text()
    (run / file).write_text(text.replace("amara", "bruno"))
    (run / "metrics.csv").unlink()
    [truth] = [one for one in examine(run, repair=True) if one.file == file]
    assert not truth.mended
    assert not (run / "metrics.csv").exists()


def test_a_damaged_index_is_found_and_the_memory_rebuilt_from_the_trace(
    whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()
    run = copied(whole, "index")
    for file in run.glob("memory/*/length.bin"):
        file.write_bytes(b"")
    for file in run.glob("memory/*/header.bin"):
        file.write_bytes(b"short")
    [found] = examine(run, repair=True)
    assert (found.file, found.mended) == ("memory", True)
    assert "is kept in memory.damaged" in found.note
    assert content(run)["memory"] == content(whole)["memory"]


def test_examples_kept_that_an_earlier_version_did_not_pack_are_made_again_as_it_had_them(whole: Path) -> None:
    run = copied(whole, "earlier")
    folder, seal = run / "adapters/day-01/task", run / "trace/day-01/seal.json"
    unpack_kept(folder)
    (folder / KEPT).unlink()
    told = json.loads(seal.read_text())
    told["files"].pop(f"adapters/day-01/task/{KEPT}")
    told["files"][f"adapters/day-01/task/{KEPT_PLAIN}"] = seals.file_sha(folder / KEPT_PLAIN)
    seal.write_text(json.dumps(told))
    (run / "seal-end.json").unlink()
    before = content(run)
    (folder / KEPT_PLAIN).unlink()
    assert all(one.mended for one in examine(run, repair=True))
    assert {**content(run), "seal-end.json": b""} == {**before, "seal-end.json": b""}


def test_files_that_come_out_otherwise_are_accounted_for(whole: Path) -> None:
    """As if the adapters of a run from another machine were trained again here."""
    run = copied(whole, "elsewhere")
    seal = json.loads((run / "trace/day-01/seal.json").read_text())
    last = "adapters/day-01/intention/kernel.npz"
    seal["files"][last] = "0" * 64
    (run / "trace/day-01/seal.json").write_text(json.dumps(seal))
    (run / last).unlink()
    (run / "seal-end.json").unlink()
    found = {one.file: one for one in examine(run, repair=True)}
    assert found[last].mended
    assert "with other bytes than before" in found[last].note
    assert examine(run) == []
    assert last in json.loads((run / seals.REMADE).read_text())["files"]
    (run / last).write_bytes(b"")
    assert [one.file for one in examine(run)] == [last]


REFUSED = [
    ("people/amara.yaml", scribble, "look for the same one among those installed"),
    ("people/amara.yaml", lose, "people/amara.yaml: this file is missing"),
    ("trace/day-00/hour-09.json", scribble, "restore it, since nothing else holds it, or delete that day's seal.json"),
    ("trace/day-00/hour-09.json", lose, "this file is missing, by trace/day-00/seal.json"),
    ("trace/day-00/evening.json", lose, "this file is missing, by trace/day-00/seal.json"),
    (ADAPTER, scribble, "--repair` trains it again"),
    ("trace/day-00/seal.json", scribble, "restore it, or let"),
]


@pytest.fixture(scope="module")
def stopped(whole: Path, letters: Path) -> Path:
    out = whole.parent / "stopped"

    def stop(event: dict[str, object]) -> None:
        if (event["node"], event["day"]) == ("record", 1):
            raise StoppedError("The run was interrupted.")

    with pytest.raises(StoppedError):
        run_study(config(out, pictures="none", data_dir=letters), on_event=stop)
    return out


@pytest.mark.parametrize(("file", "harm", "said"), REFUSED, ids=[f"{h.__name__}-{f}" for f, h, _ in REFUSED])
def test_a_run_is_not_gone_on_with_where_a_sealed_file_is_lost_or_altered(
    stopped: Path, file: str, harm: Callable[[str], Harm], said: str
) -> None:
    run = copied(stopped, f"{harm.__name__}-{file}")
    harm(file)(run)
    with pytest.raises(RunError, match=said):
        resume_study(run)
    assert json.loads((run / "run.json").read_text())["state"] == "stopped"


def test_a_stopped_run_that_was_mended_goes_on_as_if_nothing_had_been(stopped: Path) -> None:
    run, other = copied(stopped, "mended"), copied(stopped, "untouched")
    for harm in (lose("adapters"), lose("memory"), cut("checkpoints.sqlite"), lose("metrics.csv")):
        harm(run)
    assert all(one.mended for one in examine(run, repair=True))
    assert not {path.name for path in run.iterdir()} & {"summary.json", "seal-end.json"}
    resume_study(run)
    resume_study(other)
    adapters = [path.relative_to(run).as_posix() for path in (run / "adapters").rglob("*.npz")]
    assert len(adapters) == 4
    assert [(run / name).read_bytes() for name in adapters] == [(other / name).read_bytes() for name in adapters]
    assert (run / "metrics.csv").read_bytes() == (other / "metrics.csv").read_bytes()
    assert content(run)["memory"] == content(other)["memory"]


def test_a_memory_that_was_lost_is_rebuilt_when_the_run_goes_on(
    stopped: Path, caplog: pytest.LogCaptureFixture
) -> None:
    run, other = copied(stopped, "memoryless"), copied(stopped, "remembering")
    shutil.rmtree(run / "memory")
    for one in (run, other):
        resume_study(one)
    assert content(run)["memory"] == content(other)["memory"]
    assert (run / "metrics.csv").read_bytes() == (other / "metrics.csv").read_bytes()
    assert "the memory was rebuilt from the trace" in caplog.text


@pytest.mark.parametrize("made", ["", "writer.lock", "chroma.sqlite3"])
def test_a_memory_that_a_process_died_making_goes_on_with_nothing_set_aside(stopped: Path, made: str) -> None:
    run, other = copied(stopped, f"made-{made}"), copied(stopped, f"whole-{made}")
    shutil.rmtree(run / "memory")
    (run / "memory").mkdir()
    if made:
        (run / "memory" / made).touch()
    for one in (run, other):
        resume_study(one)
    assert content(run)["memory"] == content(other)["memory"]
    assert {path.name for path in run.iterdir()} == {path.name for path in other.iterdir()}


@pytest.mark.parametrize(("until", "found"), [(24, []), (0, ["memory"])], ids=["a day broken off", "an older copy"])
def test_a_memory_that_is_behind_the_trace_is_given_what_it_lacks_when_the_run_goes_on(
    stopped: Path, caplog: pytest.LogCaptureFixture, until: int, found: list[str]
) -> None:
    """A killed process leaves the hours of its last day in the trace alone; what is lost besides is a fault."""
    run, other = copied(stopped, f"behind-{until}"), copied(stopped, f"not-behind-{until}")
    for stream in open_streams(run):
        with stream:
            stream.forget_from(until)
    assert [one.file for one in examine(run)] == found
    for one in (run, other):
        resume_study(one)
    assert content(run)["memory"] == content(other)["memory"]
    assert (run / "metrics.csv").read_bytes() == (other / "metrics.csv").read_bytes()
    assert {path.name for path in run.iterdir()} == {path.name for path in other.iterdir()}
    assert not caplog.text


def test_a_memory_that_says_something_else_than_the_trace_is_rebuilt_when_the_run_goes_on(
    stopped: Path, caplog: pytest.LogCaptureFixture
) -> None:
    run, other = copied(stopped, "else"), copied(stopped, "not-else")
    for stream in open_streams(run):
        with stream:
            stream.forget_from(0)
            stream.add(["something else"], 9)
    assert [one.file for one in examine(run)] == ["memory"]
    for one in (run, other):
        resume_study(one)
    assert content(run)["memory"] == content(other)["memory"]
    assert "the memory was rebuilt from the trace" in caplog.text


def open_streams(run: Path) -> Iterator[MemoryStream]:
    """Every stream of a run, one after the other."""
    for name in texts(run / "memory"):
        yield MemoryStream.open(run / "memory", name, LetterEmbeddings(), create=False)


def test_a_run_of_a_version_without_seals_goes_on_and_is_sealed(
    stopped: Path, caplog: pytest.LogCaptureFixture
) -> None:
    run = copied(stopped, "old")
    for path in run.rglob("seal*.json"):
        path.unlink()
    assert examine(run) == []
    resume_study(run)
    assert "begun by a version that sealed nothing" in caplog.text
    assert {path.relative_to(run).as_posix() for path in seals.seals(run)} == {
        "seal.json",
        "trace/day-00/seal.json",
        "trace/day-01/seal.json",
        "seal-end.json",
    }
    assert examine(run) == []


def test_a_run_that_keeps_the_newest_adapters_alone_goes_on_as_one_that_keeps_all(whole: Path, letters: Path) -> None:
    kept = {}
    for kind in ("all", "last"):
        out = whole.parent / f"keeps-{kind}"

        def stop(event: dict[str, object]) -> None:
            if (event["node"], event["day"]) == ("record", 2):
                raise StoppedError("The run was interrupted.")

        with pytest.raises(StoppedError):
            run_study(config(out, days=3, pictures="none", keep_adapters=kind, data_dir=letters), on_event=stop)
        resume_study(out)
        kept[kind] = {path.relative_to(out): path.read_bytes() for path in (out / "adapters").rglob("*.*")}
        assert examine(out) == []
    records = ("examples.jsonl", "told.json")
    last = {path: data for path, data in kept["all"].items() if "day-02" in path.parts or path.name in records}
    assert kept["last"] == last
    removed = seals.read_seal(seals.day_seal(whole.parent / "keeps-last", 1))
    assert removed is not None
    assert "adapters/day-00/task/kernel.npz" in removed.removed


def test_seals_are_the_same_for_the_same_files(whole: Path) -> None:
    run = copied(whole, "again")
    before = {path: path.read_bytes() for path in seals.seals(run)}
    for path in before:
        path.unlink()
    checks.RunDir.open(run).seal_days()
    seals.seal_end(run)
    assert {path: path.read_bytes() for path in before} == before


def test_the_command_says_what_is_wrong_line_by_line(whole: Path, coopera: Callable[..., Said]) -> None:
    run = copied(whole, "told")
    assert coopera("doctor", run) == Said(0, f"{run}: whole.\n", "")
    (run / "metrics.csv").unlink()
    (run / FRAME).unlink()
    said = coopera("doctor", run)
    assert (said.code, len(said.out.splitlines())) == (1, 2)
    assert "metrics.csv: missing, though seal-end.json names it" in said.out
    said = coopera("doctor", run, "--repair", "--json")
    assert (said.code, said.json["whole"], {one["mended"] for one in said.json["findings"]}) == (0, True, {True})


def test_trace_and_report_say_in_a_line_that_something_is_not_as_it_was(
    whole: Path, coopera: Callable[..., Said]
) -> None:
    run = copied(whole, "looked-at")
    assert coopera("trace", run, "--json").err == ""
    (run / "trace/day-00/evening.json").unlink()
    (run / FRAME).unlink()
    for command in ("trace", "report"):
        said = coopera(command, run)
        assert said.code == 0
        assert said.err == (
            f"coopera: {run}: trace/day-00/evening.json is missing, and so is 1 more; `coopera doctor {run}` tells "
            f"more.\n"
        )
