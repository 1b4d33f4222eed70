"""A rating on file: its plan, and each rater's answers, written whole with each answer."""

from __future__ import annotations

import hmac
import json
import secrets
import threading
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_json
from coopera.core.hour import HourRecord
from coopera.core.people import Frozen
from coopera.evaluation.rating.planning import Rated, RaterId, RatingPlan, Sizes, Unit, plan_rating, shown_to
from coopera.rundir.directory import RunDir

PLAN = "plan.json"
_MODE = 0o700  # the plan holds the raters' tokens, and which run is whose


class Said(Frozen):
    """One answer: yes, no, or None for a skipped one, and when, in UTC."""

    yes: bool | None
    at: str


class Given(Frozen):
    """All that a rater has said, by item."""

    answers: dict[str, Said] = {}


class Rating:
    """A rating in its folder."""

    def __init__(self, folder: Path, plan: RatingPlan) -> None:
        self.folder, self.plan = folder, plan
        self._lock = threading.Lock()
        self._shown = {rater: shown_to(plan, rater) for rater in plan.order}
        self._given = {rater: self._read(rater) for rater in plan.order}

    @classmethod
    def begin(cls, folder: Path, runs: Sequence[Path], sizes: Sizes, seed: int) -> Rating:
        """Plan a rating of runs and write it.

        Raises:
            ConfigError: If the folder is not new, or the runs cannot be rated.
        """
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise ConfigError(f"out: {folder} is not empty; a new rating needs a folder of its own.")
        if len({path.resolve() for path in runs}) != len(runs):
            raise ConfigError("runs: a run stands twice, and each may stand once.")
        opened = [RunDir.open(path) for path in runs]
        rated = [
            (
                Rated(
                    folder=str(run.root.resolve()),
                    method=run.config.method,
                    setting=run.config.setting,
                    person=", ".join(run.config.humans or []),
                ),
                run.hours(),
            )
            for run in opened
        ]
        plan = plan_rating(rated, sizes, seed, [secrets.token_urlsafe(18) for _ in range(sizes.raters)])
        try:
            folder.mkdir(parents=True, exist_ok=True)
            folder.chmod(_MODE)
            write_atomic(folder / PLAN, canonical_json(plan.model_dump(mode="json")))
        except OSError as err:
            raise ConfigError(f"out: {folder} cannot be written ({reason(err)}).") from err
        return cls(folder, plan)

    @classmethod
    def open(cls, folder: Path) -> Rating:
        """Go on with a rating.

        Raises:
            ConfigError: If the folder holds none, or one of its files cannot be used.
        """
        if not (folder / PLAN).is_file():
            raise ConfigError(f"{folder}: there is no rating here; coopera rate begin RUN… --out {folder} makes one.")
        try:
            return cls(folder, RatingPlan.model_validate(read_json(folder / PLAN)))
        except ValidationError as err:
            raise ConfigError(f"{folder / PLAN}: this is no plan of a rating.") from err

    def rater(self, token: str) -> RaterId | None:
        """Whose token it is; None is nobody's."""
        found = None
        for rater, own in self.plan.tokens.items():
            if hmac.compare_digest(own.encode(), token.encode()):
                found = rater
        return found

    def units(self, rater: RaterId) -> list[Unit]:
        """What a rater is shown, in their order."""
        return self._shown[rater]

    def given(self, rater: RaterId) -> dict[str, bool | None]:
        """What a rater has said so far, by item."""
        with self._lock:
            return {item: said.yes for item, said in self._given[rater].answers.items()}

    def answers(self) -> dict[RaterId, dict[str, bool | None]]:
        """What all raters have said so far."""
        return {rater: self.given(rater) for rater in self.plan.order}

    def progress(self, rater: RaterId) -> tuple[int, int]:
        """How many items a rater has answered, and of how many."""
        return len(self.given(rater)), sum(len(unit.items) for unit in self._shown[rater])

    def say(self, rater: RaterId, item: str, yes: bool | None, *, undo: bool = False) -> None:
        """Keep an answer, or take it back.

        Raises:
            ConfigError: If the item is not one of this rater's.
        """
        if item not in {one.id for unit in self._shown[rater] for one in unit.items}:
            raise ConfigError("This is not one of your tasks.")
        with self._lock:
            answers = dict(self._given[rater].answers)
            if undo:
                answers.pop(item, None)
            else:
                answers[item] = Said(yes=yes, at=datetime.now(UTC).isoformat(timespec="seconds"))
            given = Given(answers=answers)
            write_atomic(self._file(rater), canonical_json(given.model_dump(mode="json")))
            self._given[rater] = given

    def records(self) -> dict[tuple[int, int, int], HourRecord]:
        """The rated hours, by run (its place), day and hour.

        Raises:
            ConfigError: If a run is not there any more.
        """
        found: dict[tuple[int, int, int], HourRecord] = {}
        for place, rated in enumerate(self.plan.runs):
            for record in RunDir.open(Path(rated.folder)).hours():
                found[place, record.day, record.hour] = record
        return found

    def picture(self, rater: RaterId, unit: str, number: int) -> Path | None:
        """A picture of one of a rater's units; None if there is none."""
        for one in self._shown[rater]:
            if one.id == unit and 0 <= number < len(one.frames):
                root = Path(self.plan.runs[one.run].folder).resolve()
                path = (root / one.frames[number]).resolve()
                return path if path.is_relative_to(root) and path.is_file() else None
        return None

    def _file(self, rater: RaterId) -> Path:
        return self.folder / "answers" / f"{rater}.json"

    def _read(self, rater: RaterId) -> Given:
        path = self._file(rater)
        if not path.is_file():
            return Given()
        try:
            data: Any = json.loads(path.read_text(encoding="utf-8"))
            return Given.model_validate(data)
        except (ValueError, OSError) as err:
            raise ConfigError(f"{path}: these are no answers of a rater.") from err
