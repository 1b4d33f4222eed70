"""Whether a run is whole, and what of it can be made again from its trace."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from coopera.config.files import write_atomic
from coopera.core.errors import CooperaError
from coopera.core.naming import sha256
from coopera.memory.rebuild import rewrite
from coopera.people.shipped import write_persona
from coopera.report.page import write_report
from coopera.rundir import claim, seals
from coopera.rundir.directory import RunDir
from coopera.simulation import load_scene
from coopera.studies.assemble import open_embeddings
from coopera.studies.catalogues import find_person
from coopera.studies.findings import TRUTH, Finding, findings
from coopera.studies.own_files import home_files
from coopera.studies.remade import film_again, learn_again
from coopera.studies.remembered import by_the_trace, memory_folder
from coopera.studies.standing import CHECKPOINTS, give_up, give_up_if_wrong, steps_done
from coopera.studies.study import plan_days


def examine(path: Path, *, repair: bool = False) -> list[Finding]:
    """Look a run through, and on request make again what follows from its trace; what is right is not touched.

    Args:
        path: The run directory.
        repair: Whether to put right what can be.

    Raises:
        ConfigError: If the folder holds no run, or its configuration cannot be read.
        RunError: If another process is writing the run, or run.json cannot be read.
    """
    run = RunDir.open(path)
    with _held(run):
        found = findings(run)
        return _repaired(run, found) if repair and found else found


def _repaired(run: RunDir, found: Sequence[Finding]) -> list[Finding]:
    """Put right what can be, and return what was found with what became of it."""
    notes = {**_restore_given(run, found), **_seal_again(run, found)}
    left = findings(run, index=False)
    if any(one.part in TRUTH for one in left):
        why = "it is made again once the trace, and what the run was given, are whole"
        notes = dict.fromkeys((one.file for one in (*found, *left) if one.part not in TRUTH), why) | notes
    else:
        left += [one for one in found if one.part == "memory" and one not in left]
        notes |= _make_again(run, left)
        found, left = [*found, *left], findings(run, index=False)
    still = {one.file for one in left}
    every = {one.file: one for one in (*left, *found)}
    return [one._replace(mended=file not in still, note=notes.get(file, "")) for file, one in every.items()]


@contextmanager
def _held(run: RunDir) -> Iterator[None]:
    """Keep others from writing the run meanwhile; a folder that nobody may write needs no care."""
    claim.refuse_second_writer(run.root, run.info)
    try:
        lock = claim.lock(run.root)
    except OSError:
        yield
        return
    with lock:
        yield


def _restore_given(run: RunDir, found: Iterable[Finding]) -> dict[str, str]:
    """Put back people and homes whose sources still say the same; say of each that could not be why."""
    notes = {}
    for one in found:
        if one.part in ("people", "homes"):
            try:
                given = _person(run, Path(one.file).stem) if one.part == "people" else _homes(run)
            except CooperaError as err:
                notes[one.file] = str(err)
                continue
            if one.file in given and sha256(given[one.file]) == seals.sealed_sha(run.root, one.file):
                write_atomic(run.root / one.file, given[one.file])
            else:
                notes[one.file] = "where it came from is another one now, or no seal tells; restore it"
    return notes


def _person(run: RunDir, person: str) -> dict[str, str]:
    with tempfile.TemporaryDirectory(prefix="coopera-") as folder:
        path = write_persona(find_person(run.config, person), Path(folder))
        return {f"people/{path.name}": path.read_text(encoding="utf-8")}


def _homes(run: RunDir) -> dict[str, str]:
    own = [path for id, path in run.config.files.scenes.items() if id in (run.config.scenes or [])]
    return {f"scenes/{name}": text for path in own for name, text in home_files(load_scene(path)).items()}


def _seal_again(run: RunDir, found: Iterable[Finding]) -> dict[str, str]:
    """Write lost seals again where that gives what the seal after them names."""
    notes = {}
    for one in found:
        if one.part != "seal" or one.file == seals.REMADE:
            continue
        path = run.root / one.file
        try:
            if path.name == seals.END:
                seals.seal_end(run.root)
                continue
            start = path.parent == run.root
            seal = seals.seal_of_start(run.root, run.info) if start else run.seal_of_day(int(path.parent.name[4:]))
        except (CooperaError, OSError, ValueError) as err:
            notes[one.file] = str(err)
            continue
        if seals.sealed_sha(run.root, one.file) in (None, sha256(seals.seal_text(seal))):
            seals.write_seal(path, seal)
        else:
            notes[one.file] = "what it named is not as it was, either; restore it"
    return notes


def _make_again(run: RunDir, left: Sequence[Finding]) -> dict[str, str]:
    """Make again whatever follows from the trace and is wrong; say of each part that could not be why."""
    plans = plan_days(run.config)
    wrong: dict[str, list[str]] = {}
    for one in left:
        wrong.setdefault(one.part, []).append(one.file)
    notes: dict[str, str] = {}

    def attempt(part: str, work: Callable[[list[str]], object]) -> None:
        if files := wrong.get(part):
            try:
                said = work(files)
                notes.update(said if isinstance(said, dict) else {})
            except (CooperaError, OSError) as err:
                notes.update(dict.fromkeys(files, str(err)))

    with open_embeddings(run.config) as embeddings:

        def remember(files: list[str]) -> dict[str, str]:
            kept = rewrite(memory_folder(run), by_the_trace(run, plans), embeddings)
            if run.state != "finished":  # what a step had remembered is gone, so it is not to go on in its midst
                give_up(run.root / CHECKPOINTS)
            return dict.fromkeys(files, f"what was there is kept in {kept.name}") if kept else {}

        def learn(files: list[str]) -> dict[str, str]:
            return _accounted(run, files, learn_again(run, plans, files, embeddings))

        attempt("memory", remember)
        attempt("adapters", learn)
    attempt("checkpoints", lambda _: give_up_if_wrong(run.root / CHECKPOINTS, plans, steps_done(run, plans)))
    attempt("pictures", lambda files: _accounted(run, files, film_again(run, files)))
    attempt("figures", lambda _: run.rewrite_figures())
    attempt("report", lambda _: write_report(run))
    return notes


def _accounted(run: RunDir, wrong: Sequence[str], made: Sequence[str]) -> dict[str, str]:
    """Say which files were not made, and which came out with other bytes than those sealed."""
    odd = [name for name in made if seals.file_sha(run.root / name) != seals.sealed_sha(run.root, name)]
    if odd:
        seals.note_remade(run.root, odd)
    notes = dict.fromkeys(set(wrong) - set(made), "nothing in the trace makes it")
    other = "made again here, with other bytes than before (another processor or library computes a little differently)"
    return notes | dict.fromkeys(odd, other)
