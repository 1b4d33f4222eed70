"""Does an hour follow from the hours before? Next-intention prediction (PAPER §4.2, Temporal Dependence)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from coopera.core.people import PersonId
from coopera.core.randomness import rng_at
from coopera.evaluation.people.figures import Figure, over_people, unmeasured
from coopera.evaluation.people.learners import Learner, Step
from coopera.evaluation.people.lives import LivedDay, Lives, hold_out

BEFORE = 3  # PAPER §4.2: "given three earlier intentions"
_MEASURES = ("accuracy", "F1")


class Question(NamedTuple):
    """A step, and whether it is what the person really did next."""

    step: Step
    real: bool


class Tally(NamedTuple):
    """Answers of one person's steps: "this came next" rightly (hits), wrongly (alarms), and not said so."""

    hits: int = 0
    alarms: int = 0
    misses: int = 0
    rejections: int = 0

    def plus(self, real: bool, said: bool) -> Tally:
        """Count one answer more."""
        name = ("hits" if real else "alarms") if said else ("misses" if real else "rejections")
        return self._replace(**{name: getattr(self, name) + 1})


def temporal_dependence(lives: Lives, learner: Learner, *, seed: int = 0) -> list[Figure]:
    """Accuracy and F1 of saying whether an intention is the one that followed three others.

    The control puts the hours of each day in a random order and must be at chance, 0.5. Days are held out by home;
    the interval resamples people.
    """
    held_out = hold_out(lives.days)
    if not held_out.folds:
        return unmeasured("temporal", *_MEASURES, why="it takes a second home, or a second day, to test on")
    answers = _answers(lives.days, learner, seed)
    if not answers:
        return unmeasured("temporal", *_MEASURES, why=f"it takes days of at least {BEFORE + 5} hours")
    by_chance = _answers([_out_of_order(day, seed) for day in lives.days], learner, seed)
    return [
        over_people(
            "temporal",
            measure,
            answers,
            statistic,
            chance=by_chance,
            seed=seed,
            n=sum(map(sum, answers.values())),
            unit="steps",
            control_is="hours shuffled",
            note=f"half of the steps are real, chance 0.5, unseen {held_out.unseen}",
        )
        for measure, statistic in zip(_MEASURES, (accuracy, f1), strict=True)
    ]


def questions(day: LivedDay, seed: int) -> list[Question]:
    """A day's steps: each intention from the fourth on, once as what came next and once in the place of another.

    PAPER §4.2: negatives are "other-time intentions". Ours are of the same day, and every candidate is asked about
    equally often in its own place and in another, so that nothing can be told from the candidate alone. A negative is
    never among the three hours before. Days with fewer than five such hours have none.
    """
    texts = day.intentions
    places = range(BEFORE, len(texts))
    if len(places) < BEFORE + 2:
        return []
    # within the ring of these places, a shift by 1 … n - 4 never lands on the three hours before
    rng = rng_at(seed, "steps", day.person, day.scene, day.seed, day.number)
    shift = int(rng.integers(1, len(places) - BEFORE))
    found = []
    for at in places:
        before = tuple(texts[at - BEFORE : at])
        other = texts[BEFORE + (at - BEFORE + shift) % len(places)]
        found += [Question(Step(before, texts[at]), True), Question(Step(before, other), False)]
    return found


def accuracy(units: Sequence[Tally]) -> float:
    """Share of right answers over all units."""
    return sum(unit.hits + unit.rejections for unit in units) / sum(map(sum, units))


def f1(units: Sequence[Tally]) -> float:
    """F1 of saying "this came next", over all units; nan where nothing is real and nothing was said to be."""
    hits = sum(unit.hits for unit in units)
    faults = sum(unit.alarms + unit.misses for unit in units)
    return 2 * hits / (2 * hits + faults) if hits or faults else float("nan")


def _answers(days: Sequence[LivedDay], learner: Learner, seed: int) -> dict[PersonId, Tally]:
    asked = [questions(day, seed) for day in days]
    answers: dict[PersonId, Tally] = {}
    for fold in hold_out(days).folds:
        train = [question for at in fold.train for question in asked[at]]
        test = [(days[at].person, question) for at in fold.test for question in asked[at]]
        if not train or not test:
            continue
        labels = [int(question.real) for question in train]
        said = learner.steps([question.step for question in train], labels, [question.step for _, question in test])
        for (person, question), label in zip(test, said, strict=True):
            answers[person] = answers.get(person, Tally()).plus(question.real, label == 1)
    return answers


def _out_of_order(day: LivedDay, seed: int) -> LivedDay:
    order = rng_at(seed, "hours", day.person, day.scene, day.seed, day.number).permutation(len(day.intentions))
    return day.model_copy(update={"intentions": [day.intentions[at] for at in order]})
