"""The run directory: the truth about a run, in files of open formats that are replaced as a whole or not at all."""

from __future__ import annotations

import logging
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

from coopera.config.files import canonical_json, reason, write_atomic, write_output
from coopera.config.prices import Prices, read_prices
from coopera.config.schema import Config, load_config
from coopera.core.errors import ConfigError, CooperaError, RunError
from coopera.core.hour import Evening, HourRecord
from coopera.core.people import Persona
from coopera.evaluation.measuring import told_in_the_evening
from coopera.models.settings import Budget, Spent
from coopera.people.shipped import read_persona, write_persona
from coopera.rundir import claim, retention, seals
from coopera.rundir.about import SCHEMA, about, now, read_about
from coopera.rundir.behind import Behind
from coopera.rundir.crash import how_it_ended
from coopera.rundir.stopping import Stop
from coopera.rundir.summary import metrics_csv, metrics_lines, summarise
from coopera.rundir.trace import Trace
from coopera.rundir.trace_files import as_read, write_record

_LOG = logging.getLogger(__name__)


class RunDir(Trace):
    """One run's folder; implements `coopera.core.protocols.Recorder`.

    Who writes holds a lock on the file `lock` and is named in run.json. Used as a context manager it records how the
    work ended: `finished` after `finish`, else `stopped` or `failed`, each of which may be resumed.

    Attributes:
        root: The folder.
        config: The resolved configuration, as in config.yaml.
    """

    def __init__(
        self, root: Path, config: Config, info: dict[str, Any], lock: IO[str] | None, stop: Stop | None = None
    ) -> None:
        """Use `create`, `resume` or `open`."""
        super().__init__(root)
        self.config = config
        self.info = info
        self._lock = lock
        self._rows: dict[tuple[int, int], str] = {}
        self._stop = Stop(stop)
        self._made: list[Path] = []
        self._behind = Behind[HourRecord | Evening]()

    @classmethod
    def create(
        cls,
        config: Config,
        *,
        people: Sequence[Persona],
        prompts: Mapping[str, str],
        models: Mapping[str, str],
        knowledge: Mapping[str, str] | None = None,
        stop: Stop | None = None,
        resumable: bool = True,
    ) -> Self:
        """Start a new run in `config.out`; nothing stays behind if that fails.

        Args:
            config: Resolved by `coopera.studies.catalogues.resolve`.
            people: Those who take part; kept in the run, so that it stays readable without the data folder.
            prompts: SHA of each prompt by name.
            models: Identity of the model behind each role.
            knowledge: SHA of each household file besides the person's shipped one, by what names it.
            stop: What else stops this run, besides the signals that it listens to itself.
            resumable: Whether it keeps its memory and checkpoints on file.

        Raises:
            ConfigError: If the folder cannot be written, is not empty or holds another run.
        """
        if config.out is None:
            raise ConfigError("out: a folder for the run must be given.")
        prices = read_prices(config.budget.prices) if config.budget.prices else None
        root, made = config.out, claim.make_folder(config.out)
        info = about(prompts, models) | {"knowledge": dict(knowledge or {}), "resumable": resumable}
        info |= {"prices": prices.model_dump(by_alias=True)} if prices else {}
        lock = None
        try:
            lock = claim.lock(root)
            write_atomic(root / "config.yaml", config.to_yaml())
            for persona in people:
                write_persona(persona, root / "people")
            seals.seal_start(root, info)
            write_atomic(root / "run.json", canonical_json(info))
        except (OSError, CooperaError) as err:
            if lock:
                lock.close()
            claim.clear(root, made)
            what = reason(err) if isinstance(err, OSError) else str(err)
            raise ConfigError(f"out: {root} cannot be written ({what}).") from err
        run = cls(root, config, info, lock, stop)
        run._made = made
        return run

    @classmethod
    def open(cls, path: Path) -> Self:
        """Open a run for reading.

        Raises:
            ConfigError: If the folder holds no run.
            RunError: If its files are damaged or newer than this version understands.
        """
        if not (path / "run.json").is_file():
            raise ConfigError(f"{path}: this folder holds no run (there is no run.json in it).")
        info = read_about(path / "run.json")
        return cls(path, load_config(path / "config.yaml"), info, None)

    @classmethod
    def resume(cls, path: Path, budget: Budget | None = None) -> Self:
        """Open a run that has not finished for writing; a budget replaces what it had.

        Raises:
            ConfigError: If the folder holds no run.
            RunError: If the run is finished, another process is still writing it, it kept nothing to go on from, or a
                file that it sealed is missing or altered.
        """
        run = cls.open(path)
        if run.state == "finished":
            raise RunError(f"{path}: this run is finished, so there is nothing to resume.")
        if run.info["schema"] < SCHEMA:
            raise RunError(
                f"{path / 'run.json'}: schema {run.info['schema']} was written by an older coopera, and this one reads "
                f"such a run but cannot go on with it; use the version that began it."
            )
        if not run.resumable:
            raise RunError(f"{path}: this run kept nothing to go on from, as those of a benchmark; start it anew.")
        claim.refuse_second_writer(path, run.info)
        run._lock = claim.lock(path)
        try:
            run._take_up(budget)
        except BaseException:
            run._lock.close()
            raise
        return run

    def _take_up(self, budget: Budget | None) -> None:
        """Go on as the one who writes, if all that was finished is as it was."""
        seals.refuse_broken(self.root)
        claim.sweep(self.root)
        self._rows = self._rows_of_all()
        if budget is not None:
            self.config = self.config.model_copy(update={"budget": budget})
            write_atomic(self.root / "config.yaml", self.config.to_yaml())
        self.info |= {**claim.writer(), "state": "running", "reason": "", "ended": None}
        self._write_info()

    def keep_homes(self, files: Mapping[str, str]) -> None:
        """Write the files of homes that no catalogue has, by name, into the folder `scenes`, as people are kept."""
        for name, text in files.items():
            write_output(self.root / "scenes" / name, text)
        seals.seal_start(self.root, self.info)

    def discard(self) -> None:
        """Take back a run that was only just created, so that its folder is as it was before."""
        if self._lock is not None:
            claim.empty(self.root, self._made)
            self._lock.close()
            self._lock = None

    @property
    def state(self) -> str:
        """How the run stands: running, stopped, failed or finished.

        Where it says that it runs and its writer is gone, it has stopped: killed, or without room to say how it ended.
        """
        state = str(self.info["state"])
        return "stopped" if state == "running" and claim.is_gone(self.info) else state

    @property
    def resumable(self) -> bool:
        """Whether its memory and checkpoints are on file; if not, a run that was stopped is done anew."""
        return bool(self.info.get("resumable", True))

    @property
    def prices(self) -> Prices | None:
        """What its models cost, as it was told when it began."""
        return Prices.model_validate(self.info["prices"]) if "prices" in self.info else None

    def __enter__(self) -> Self:
        """Return the run; from now on Ctrl-C and `kill` stop it at its next step."""
        self._stop.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Record how the work ended and let go of the run."""
        self._stop.__exit__(kind, error, trace)
        self._behind.close()
        if self._lock is None:
            return
        if self.state == "running":
            with suppress(OSError):  # a full disk, say: that this process has ended tells as much
                self._end(*how_it_ended(error))
        self._lock.close()
        self._lock = None

    def check(self) -> None:
        """Go on, unless a stop was asked for; whatever takes long calls this now and then.

        Raises:
            StoppedError: If Ctrl-C was pressed or the process was told to end.
        """
        self._stop.check()

    @contextmanager
    def stopped_by_failure(self) -> Iterator[None]:
        """Stop the run's work in other threads where this one fails."""
        try:
            yield
        except BaseException:
            self._stop.ask()
            raise

    # Recorder

    def frames_folder(self, day: int, hour: int) -> Path:
        """An empty folder frames/day-DD/hour-HH."""
        self._stop.check()
        folder = self.root / "frames" / f"day-{day:02d}" / f"hour-{hour:02d}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        return folder

    def video_file(self, day: int, hour: int) -> Path:
        """The file video/day-DD/hour-HH.mp4."""
        self._stop.check()
        return self.root / "video" / f"day-{day:02d}" / f"hour-{hour:02d}.mp4"

    def write_hour(self, record: HourRecord, after: Callable[[], None] | None = None) -> None:
        """Write trace/day-DD/hour-HH.json, the hour before it first; with `after`, once that has returned.

        The work may go on meanwhile, and reads the hour by its day.
        """
        self._stop.check()

        def write() -> None:
            write_record(self.hour_file(record.day, record.hour), record)
            self._rows[record.day, record.hour] = metrics_lines(record)

        self._behind.write(record, write, after)

    @contextmanager
    def settling(self) -> Iterator[None]:
        """Have all hours on file at the end, and after a failure as many as can be."""
        try:
            yield
            self._behind.settle()
        except BaseException:
            with suppress(Exception):
                self._behind.settle()
            raise

    def read_day(self, day: int) -> list[HourRecord]:
        """The hours of a day, in order, also those that wait to be written; what went wrong with one is raised."""
        self._stop.check()
        hours = [record for record in self._behind.waiting() if isinstance(record, HourRecord)]
        waiting = {record.hour: as_read(record) for record in hours if record.day == day}
        written = {record.hour: record for record in super().read_day(day)}
        return [record for _, record in sorted((written | waiting).items())]

    def write_evening(self, evening: Evening) -> None:
        """Write trace/day-DD/evening.json after the day's hours, bring metrics.csv up to date, and seal the day.

        While hours wait to be written, the work may go on.
        """
        self._stop.check()

        def write() -> None:
            write_record(self.evening_file(evening.day), evening)
            for record in told_in_the_evening(super(RunDir, self).read_day(evening.day), [evening]):
                self._rows[record.day, record.hour] = metrics_lines(record)
            self._write_metrics()
            self._seal(evening.day)

        self._behind.write(evening, write)

    def seal_days(self) -> None:
        """Seal what is finished and is not sealed yet: the run was killed in between, or begun by an older version."""
        if not seals.is_sealed(self.root):
            _LOG.warning("%s: was begun by a version that sealed nothing; what stands is sealed now", self.root)
            seals.seal_start(self.root, self.info)
        for day in self.days():
            if self.evening_file(day).is_file() and not seals.day_seal(self.root, day).is_file():
                self._seal(day)
            elif seal := seals.read_seal(seals.day_seal(self.root, day)):
                retention.remove(self.root, seal.removed)

    def seal_of_day(self, day: int) -> seals.Seal:
        """The seal of a finished day."""
        seal, evening = seals.seal_of_day(self.root, day), self.read_evening(day)
        assert evening is not None
        past, before = self.read_evening(day - 1), seals.read_seal(seals.day_seal(self.root, day - 1))
        gone = retention.superseded(self.config.keep_adapters, evening, past, before, seal)
        return seal.model_copy(update={"removed": gone})

    def _seal(self, day: int) -> None:
        """Seal a finished day, and only then remove what it makes superfluous."""
        seal = self.seal_of_day(day)
        seals.write_seal(seals.day_seal(self.root, day), seal)
        retention.remove(self.root, seal.removed)

    def adapters_folder(self, day: int) -> Path:
        """The folder adapters/day-DD, made if need be."""
        folder = self.root / "adapters" / f"day-{day:02d}"
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    # Reading

    def people(self) -> dict[str, Persona]:
        """Those who took part, by id, as they were when the run began."""
        return {path.stem: read_persona(path) for path in sorted((self.root / "people").glob("*.yaml"))}

    def summary(self) -> dict[str, Any]:
        """The figures so far, computed from the trace, which is the content of summary.json."""
        return summarise(self.config, self.hours(), self.evenings(), self.prices)

    def spent(self) -> Spent:
        """What models were paid for so far: as noted at the end, or, after a kill, at least what the trace shows."""
        records: list[HourRecord | Evening] = [*self.hours(), *self.evenings()]
        paid = [call for record in records for call in record.calls if not call.cached]
        tokens = sum(call.tokens_in + call.tokens_out for call in paid)
        money = self.prices.bill(paid)["spent"] if self.prices else 0.0
        return self._noted().at_least(Spent(calls=len(paid), tokens=tokens, money=money))

    def note_spent(self, spent: Spent) -> None:
        """Keep what was spent in run.json; what was noted at the end, with an evening that was killed, is no less."""
        self.info["spent"] = self._noted().at_least(spent).model_dump()
        with suppress(OSError):  # what ended the work is to be told, not this
            self._write_info()

    def _noted(self) -> Spent:
        return Spent.model_validate(self.info.get("spent", {}))

    # The end

    def finish(self) -> dict[str, Any]:
        """Write metrics.csv and summary.json, record that the run is finished, and return the summary."""
        self._behind.settle()
        summary = self.write_figures()
        self.info["spent"] = self.spent().model_dump()
        self._end("finished", "")
        return summary

    def write_figures(self) -> dict[str, Any]:
        """Write metrics.csv and summary.json from the trace, seal them, and return the summary."""
        summary = self.summary()
        self._rows = self._rows_of_all()
        self._write_metrics()
        write_atomic(self.root / "summary.json", canonical_json(summary))
        seals.seal_end(self.root)
        return summary

    def metrics_so_far(self) -> str:
        """metrics.csv as the last evening left it."""
        rows, days = self._rows_of_all(), {evening.day for evening in self.evenings()}
        return metrics_csv(rows[key] for key in sorted(rows) if key[0] in days)

    def rewrite_figures(self) -> None:
        """Write what a run has of figures: at its end all of them, and before that metrics.csv."""
        if self.state == "finished":
            self.write_figures()
        else:
            write_atomic(self.root / "metrics.csv", self.metrics_so_far())

    def _end(self, state: str, why: str) -> None:
        self.info |= {"state": state, "reason": why, "ended": now()}
        self._write_info()

    def _write_info(self) -> None:
        write_atomic(self.root / "run.json", canonical_json(self.info))

    def _rows_of_all(self) -> dict[tuple[int, int], str]:
        return {(r.day, r.hour): metrics_lines(r) for r in told_in_the_evening(self.hours(), self.evenings())}

    def _write_metrics(self) -> None:
        write_atomic(self.root / "metrics.csv", metrics_csv(self._rows[key] for key in sorted(self._rows)))
