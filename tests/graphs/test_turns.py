"""A turn in a person's life: what was told before it counts less, and nothing fades while nothing changes."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera.core.errors import CooperaError, RunError
from coopera.core.hour import DayAccount, Example, HourAccount, Observation, RobotHour
from coopera.core.household import Act, HandOver
from coopera.core.people import Belief, PersonId
from coopera.core.randomness import rng_at
from coopera.graphs.robots.learning import KINDS, Learner
from coopera.graphs.robots.told import told_hours
from coopera.graphs.robots.turns import Uses, still_counts
from tests.fakes import MARA, FolderRecorder, TableClassifier
from tests.graphs.conftest import MakeServices
from tests.graphs.test_told import COOKING, READING, robot

MORNING, EVENING = ("pot", "pan", "spoon", "bowl"), ("novel", "lamp", "blanket", "mug")
HOURS = range(9, 22)


def life(days: range, early: tuple[str, ...], late: tuple[str, ...], *, seed: int = 0) -> Uses:
    """Two of four things in each hour, of one kind until 3 pm and of the other from then on."""
    rng = rng_at(seed, "life")
    return tuple(
        (day * 24 + hour, tuple(sorted(map(str, rng.choice(early if hour < 15 else late, 2, replace=False)))))
        for day in days
        for hour in HOURS
    )


def test_nothing_fades_while_nothing_changes() -> None:
    assert min(still_counts(life(range(20), MORNING, EVENING)).values()) > 0.85


def test_what_was_told_before_a_turn_soon_counts_little_and_what_is_told_since_counts_in_full() -> None:
    counts = still_counts((*life(range(8), MORNING, EVENING), *life(range(8, 15), EVENING, MORNING, seed=1)))
    assert max(counts[day] for day in range(8)) < 0.3
    assert min(counts[day] for day in range(9, 15)) > 0.85


def test_a_weekend_unlike_the_working_week_is_no_turn_once_one_is_known() -> None:
    week = [life(range(start, start + 5), MORNING, EVENING, seed=start) for start in (0, 7, 14)]
    free = [life(range(start, start + 2), EVENING, MORNING, seed=start) for start in (5, 12, 19)]
    counts = still_counts((*week[0], *free[0], *week[1], *free[1], *week[2], *free[2]))
    assert min(counts.values()) > 0.5


def test_nothing_told_counts_nothing() -> None:
    assert still_counts(()) == {}
    assert still_counts(((33, ()),)) == {}


def test_told_hours_from_before_a_turn_speak_less_for_now(make_services: MakeServices) -> None:
    told = {day * 24 + hour: ("Read", READING) if day < 8 else ("Cook", COOKING) for day in range(11) for hour in HOURS}
    view = robot(make_services, day=11, told=told).view
    as_ever, noticed = told_hours(view), told_hours(view, turns=True)
    assert noticed[0].near < 0.3 * as_ever[0].near
    assert noticed[0].wide < 0.3 * as_ever[0].wide
    assert noticed[-1].near == pytest.approx(as_ever[-1].near, rel=0.1)


class Weigher(TableClassifier):
    """Keeps how much each example counted when it was last trained."""

    counts: dict[int, float]

    def train(self, examples: list[Example], *, seed: int) -> dict[str, float]:  # type: ignore[override]
        self.counts = {example.day: example.counts for example in examples}
        return super().train(examples, seed=seed)

    def load(self, folder: Path) -> None:
        if not (folder / "table.txt").read_text():
            raise CooperaError(f"{folder}: damaged")
        super().load(folder)


def account(day: int, things: tuple[str, ...]) -> DayAccount:
    acts: list[Act] = [HandOver(object=thing) for thing in things]
    robot_hour = RobotHour(recalled=[], intentions=[], tasks=[], outcomes=[], observation=Observation())
    lived = [HourAccount(hour=hour, intention="be busy", tasks=acts, robot=robot_hour) for hour in HOURS]
    return DayAccount(person=PersonId(MARA.id), day=day, hours=lived, belief=Belief())


def test_examples_from_before_a_turn_count_less_and_another_process_finds_the_same(tmp_path: Path) -> None:
    def lived(turns: bool) -> Learner:
        one = Learner(dict.fromkeys(KINDS, Weigher), FolderRecorder(tmp_path / str(turns)), 7, turns=turns)
        for day in range(15):
            one.learn(day, list(range(day)), account(day, MORNING if day < 8 else EVENING))
        return one

    noticed, as_ever = (lived(turns).classifiers["intention"] for turns in (True, False))
    assert noticed.counts[0] < 0.3 < 0.9 < noticed.counts[14]  # type: ignore[attr-defined]
    assert set(as_ever.counts.values()) == {1.0}  # type: ignore[attr-defined]
    (tmp_path / "True/adapters/day-14/intention/table.txt").write_text("")
    again = Learner(dict.fromkeys(KINDS, Weigher), FolderRecorder(tmp_path / "True"), 7, turns=True)
    again.be_at(list(range(15)))
    assert again.classifiers["intention"].counts == noticed.counts  # type: ignore[attr-defined]
    (tmp_path / "True/adapters/day-03/told.json").write_text("[]")
    (tmp_path / "True/adapters/day-14/intention/table.txt").write_text("")
    with pytest.raises(RunError, match=r"told\.json: what was told on this day cannot be read"):
        Learner(dict.fromkeys(KINDS, Weigher), FolderRecorder(tmp_path / "True"), 7, turns=True).be_at(list(range(15)))
