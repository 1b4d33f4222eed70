from __future__ import annotations

import gzip
import itertools
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coopera.core.errors import CooperaError, LearningError, RunError
from coopera.core.hour import DayAccount, Example, FeedbackItem, HourAccount, IntentionCandidate, Observation, RobotHour
from coopera.core.people import Belief, PersonId
from coopera.graphs.robots.learning import KEPT, KEPT_PLAIN, KINDS, Learner, Mode, labelled, unpack_kept
from coopera.graphs.robots.rehearsal import keep
from tests.fakes import FolderRecorder, TableClassifier

ANN, BO = PersonId("ann"), PersonId("bo")
GUESSES = ("Cook a meal", "Read quietly", "Tidy the home")


class Diary(TableClassifier):
    """Writes down how often it was trained, so that another order of training is another state."""

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        for example in examples:
            profile = f"{example.person} at {example.day}.{example.hour}: {example.profile}"
            self.table[f"{len(self.table)} {seed} {example.candidate} {profile}"] = bool(example.label)
        return {"trained": float(len(self.table))}

    def load(self, folder: Path) -> None:
        try:
            super().load(folder)
        except (OSError, ValueError) as err:
            raise CooperaError(f"{folder}: damaged: {err}") from err
        if not self.table:
            raise CooperaError(f"{folder}: empty")


class Broken(TableClassifier):
    """Its loss is no number from the second evening on."""

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        if any(e.day for e in examples):
            raise LearningError("its loss became nan")
        return super().train(examples, seed=seed)


class Shown(TableClassifier):
    """Keeps what it was last shown."""

    shown: Sequence[Example] = ()

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        type(self).shown = examples or self.shown  # there are none of tasks
        return {}


def account(day: int, person: PersonId = ANN, *, hours: int = 3, yes: bool | None = None) -> DayAccount:
    """A day on which the first guess was right, or all had one answer."""
    robot = RobotHour(
        observation=Observation(),
        intentions=[IntentionCandidate(text=text, accepted=True) for text in GUESSES],
        tasks=[],
    )
    answers = [None if yes is None else yes for _ in GUESSES]
    lived = [
        HourAccount(
            hour=9 + n,
            intention=GUESSES[0],
            tasks=[],
            robot=robot,
            feedback=[
                FeedbackItem(
                    hour=9 + n,
                    kind="intention",
                    text=text,
                    accepted=True,
                    helpful=text == GUESSES[0] if one is None else one,
                )
                for text, one in zip(GUESSES, answers, strict=True)
            ],
        )
        for n in range(hours)
    ]
    return DayAccount(person=person, day=day, hours=lived, belief=Belief(profile=f"{person} since day {day}."))


def learner(
    folder: Path, make: type[TableClassifier] = Diary, mode: Mode = "warm", *, days: int = 0, people: int = 1
) -> Learner:
    """A learner that has lived some days, with people in turn."""
    one = Learner(dict.fromkeys(KINDS, make), FolderRecorder(folder), 7, mode)
    for day in range(days):
        one.learn(day, list(range(day)), account(day, (ANN, BO)[day % people]))
    return one


def table(one: Learner) -> dict[str, bool]:
    return one.classifiers["intention"].table  # type: ignore[attr-defined, no-any-return]


def test_an_evening_goes_on_from_the_one_before_and_a_fresh_one_starts_anew(tmp_path: Path) -> None:
    assert len(table(learner(tmp_path / "warm", days=3))) == 9 + 18 + 27
    assert len(table(learner(tmp_path / "fresh", mode="fresh", days=3))) == 27


def test_earlier_examples_of_a_person_get_the_newest_profile_and_those_of_others_keep_theirs(tmp_path: Path) -> None:
    last = learner(tmp_path, mode="fresh", days=3, people=2)
    profiles = {line.split("at ")[1].split(".")[0]: line.split(": ")[1] for line in table(last)}
    assert profiles == {"0": "ann since day 2.", "1": "bo since day 1.", "2": "ann since day 2."}


def test_the_thousands_of_examples_of_an_evening_hold_what_they_have_in_common_once(tmp_path: Path) -> None:
    learner(tmp_path, Shown, days=3)
    assert len(Shown.shown) == 27
    assert len({id(example.candidate) for example in Shown.shown}) <= 2 * len(GUESSES)  # kept before, and of today
    assert len({id(example.profile) for example in Shown.shown}) == 1
    assert len({id(example.tasks) for example in Shown.shown}) <= 2


@pytest.mark.parametrize("end", ["\u2028", "\x85", "\x1c", "\r", "\n"])
def test_a_text_with_ends_of_lines_of_any_kind_can_be_learned_from(tmp_path: Path, end: str) -> None:
    told = account(0)
    odd = told.model_copy(
        update={"hours": [one.model_copy(update={"intention": f"Cook{end}a meal"}) for one in told.hours]}
    )
    one = learner(tmp_path, Shown)
    one.learn(0, [], odd)
    one.learn(1, [0], account(1))
    assert f"Cook{end}a meal" in {example.candidate for example in Shown.shown}


def test_an_example_with_the_values_that_it_has_already_is_no_other_one() -> None:
    one = labelled(account(0))["intention"][0]
    assert one.but(profile=one.profile, counts=1.0) is one
    assert one.but(profile="other").profile == "other"
    assert one.but(profile="other", label=one.label).label == one.label


def test_another_process_goes_on_where_this_one_was(tmp_path: Path) -> None:
    here = learner(tmp_path, days=3)
    there = learner(tmp_path)
    there.be_at([0, 1, 2])
    assert table(there) == table(here)
    there.be_at([0])
    assert table(there) == table(learner(tmp_path / "one", days=1))


@pytest.mark.parametrize("mode", ["warm", "fresh"])
@pytest.mark.parametrize("people", [1, 2])
@pytest.mark.parametrize("damaged", [[2], [1, 2], [0, 1, 2]])
def test_a_damaged_classifier_is_noticed_and_trained_again_with_the_same_result(
    tmp_path: Path, mode: Mode, people: int, damaged: list[int], caplog: pytest.LogCaptureFixture
) -> None:
    whole = learner(tmp_path, mode=mode, days=3, people=people)
    saved = tmp_path / "adapters/day-02/intention/table.txt"
    before = saved.read_bytes()
    for day in damaged:
        (tmp_path / f"adapters/day-0{day}/intention/table.txt").write_text("")
    (tmp_path / "adapters/day-01/intention/kept.jsonl.gz").unlink(missing_ok=True)
    again = learner(tmp_path, mode=mode)
    again.be_at([0, 1, 2])
    assert table(again) == table(whole)
    assert saved.read_bytes() == before
    assert "it is trained again" in caplog.text


def test_records_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    learner(tmp_path, days=2)
    for day in (0, 1):
        (tmp_path / f"adapters/day-0{day}/intention/table.txt").write_text("")
    (tmp_path / "adapters/day-00/intention/examples.jsonl").write_text("{")
    with pytest.raises(RunError, match=r"examples\.jsonl: the training examples of this day cannot be read"):
        learner(tmp_path).be_at([0, 1])


def test_where_training_fails_what_was_known_is_kept_and_that_is_said(tmp_path: Path) -> None:
    one = learner(tmp_path, Broken, days=1)
    before = dict(table(one))
    measured = one.learn(1, [0], account(1))
    assert measured["intention"]["failed"] == "its loss became nan"
    assert table(one) == before
    again = learner(tmp_path, Broken)
    again.be_at([0, 1])
    assert table(again) == before


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no full disk to write to")
def test_a_full_disk_ends_the_evening_with_its_reason_and_it_can_be_done_again(tmp_path: Path) -> None:
    one = learner(tmp_path, days=1)
    full = tmp_path / "adapters/day-01/intention/examples.part"
    full.parent.mkdir(parents=True)
    full.symlink_to("/dev/full")
    with pytest.raises(RunError, match=r"examples\.jsonl: the training examples .* cannot be saved: .*No space left"):
        one.learn(1, [0], account(1))
    full.unlink()
    one.learn(1, [0], account(1))
    assert table(one) == table(learner(tmp_path / "other", days=2))


@pytest.mark.parametrize("yes", [True, False])
def test_a_day_of_nothing_but_yes_or_no_and_one_without_hours_are_recorded(tmp_path: Path, yes: bool) -> None:
    one = learner(tmp_path)
    assert one.learn(0, [], account(0, yes=yes))["intention"]["examples"] == 9
    assert one.learn(1, [0], account(1, hours=0))["intention"]["examples"] == 9


DAYS = st.lists(st.tuples(st.sampled_from([ANN, BO]), st.integers(0, 4)), max_size=8)


@settings(max_examples=60, deadline=None)
@given(DAYS, st.integers(2, 12))
def test_what_is_kept_day_by_day_is_what_would_be_kept_of_all_days_at_once(
    days: list[tuple[PersonId, int]], most: int
) -> None:
    batches = [
        [
            Example(person=person, day=day, hour=9, candidate=f"do {n}", label=n == 0 if n < 4 else None)
            for n in range(count)
        ]
        for day, (person, count) in enumerate(days)
    ]
    kept: list[Example] = []
    for batch in batches:
        kept = keep([*kept, *batch], most)
    every = list(itertools.chain(*batches))
    assert kept == keep(every, most)
    assert len(kept) <= most
    counts = {person: sum(e.person == person for e in kept) for person in {e.person for e in every}}
    there = {person: sum(e.person == person for e in every) for person in counts}
    assert all(counts[p] == min(there[p], most // len(counts)) for p in counts)


@pytest.mark.parametrize("most", [2, 4])
def test_as_many_examples_of_a_kind_are_kept_as_the_method_says(tmp_path: Path, most: int) -> None:
    one = learner(tmp_path)
    one.replay = {"intention": most, "task": 1_000}
    for day in range(3):
        one.learn(day, list(range(day)), account(day))
    with gzip.open(tmp_path / "adapters/day-02/intention/kept.jsonl.gz") as lines:
        assert len(list(lines)) == most


def test_the_examples_kept_are_read_as_earlier_versions_wrote_them(tmp_path: Path) -> None:
    one = learner(tmp_path, days=2)
    folders = [tmp_path / f"adapters/day-01/{kind}" for kind in KINDS]
    for folder in folders:
        unpack_kept(folder)
        assert (folder / KEPT_PLAIN).read_bytes() == gzip.decompress((folder / KEPT).read_bytes())
        (folder / KEPT).unlink()
    one.learn(2, [0, 1], account(2))
    assert table(one) == table(learner(tmp_path / "other", days=3))


def test_feedback_on_a_candidate_that_was_never_made_teaches_nothing(tmp_path: Path) -> None:
    lived = account(0)
    stray = [FeedbackItem(hour=9, kind=kind, text="Juggle at the moon", accepted=True, helpful=True) for kind in KINDS]
    hours = [hour.model_copy(update={"feedback": [*hour.feedback, *stray]}) for hour in lived.hours]
    assert labelled(lived.model_copy(update={"hours": hours})) == labelled(lived)
    one = learner(tmp_path)
    one.learn(0, [], lived.model_copy(update={"hours": hours}))
    assert "Juggle at the moon" not in table(one)
