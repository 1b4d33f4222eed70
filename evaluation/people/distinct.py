"""Are people distinct? N-way classification of who lived a day (PAPER §4.2, Distinct Simulated Humans)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from coopera.core.people import PersonId
from coopera.core.randomness import rng_at
from coopera.evaluation.people.figures import Figure, over_people, unmeasured
from coopera.evaluation.people.learners import Learner
from coopera.evaluation.people.lives import HeldOut, LivedDay, Lives, hold_out

KINDS: dict[str, Callable[[LivedDay], list[str]]] = {
    "intentions": lambda day: day.intentions,
    "tasks": lambda day: day.all_tasks,
}


class Recognised(NamedTuple):
    """How many of one person's days were put down to that person."""

    right: int
    days: int


def distinctness(lives: Lives, learner: Learner, *, seed: int = 0) -> list[Figure]:
    """Accuracy of telling from a day's intentions, and from its tasks, who of N people lived it.

    Days are held out by home. The control shuffles who lived which day and must be at chance, 1/N. The interval
    resamples people.
    """
    held_out = hold_out(lives.days)
    if len(lives.people) < 2:
        return unmeasured("distinct", *KINDS, why="it takes at least two people to tell apart")
    if not held_out.folds:
        return unmeasured("distinct", *KINDS, why="it takes a second home, or a second day, to test on")
    shuffled = shuffle_people(lives.days, seed)
    figures = []
    for kind, texts in KINDS.items():
        right = identified(lives.days, held_out, texts, learner, kind)
        by_chance = identified(shuffled, held_out, texts, learner, kind)
        if not right:
            figures += unmeasured("distinct", kind, why="no tested day is of a person who also lived another one")
            continue
        figures.append(
            over_people(
                "distinct",
                kind,
                right,
                accuracy,
                chance=by_chance,
                seed=seed,
                n=sum(unit.days for unit in right.values()),
                unit="days",
                control_is="people shuffled",
                note=f"{len(lives.people)}-way, chance {1 / len(lives.people):.3f}, unseen {held_out.unseen}",
            )
        )
    return figures


def identified(
    days: Sequence[LivedDay],
    held_out: HeldOut,
    texts: Callable[[LivedDay], list[str]],
    learner: Learner,
    kind: str,
) -> dict[PersonId, Recognised]:
    """How many tested days were put down to the right person, by person.

    A day of somebody of whom no other day may be learned from cannot be recognised and is left out.
    """
    names = sorted({day.person for day in days})
    number = {name: at for at, name in enumerate(names)}
    found: dict[PersonId, Recognised] = {}
    for fold in held_out.folds:
        train = [at for at in fold.train if texts(days[at])]
        known = {days[at].person for at in train}
        test = [at for at in fold.test if days[at].person in known and texts(days[at])]
        if not test or len(known) < 2:
            continue
        labels = [number[days[at].person] for at in train]
        answers = learner.people([texts(days[at]) for at in train], labels, [texts(days[at]) for at in test], kind=kind)
        for at, answer in zip(test, answers, strict=True):
            before = found.get(days[at].person, Recognised(0, 0))
            found[days[at].person] = Recognised(before.right + (names[answer] == days[at].person), before.days + 1)
    return found


def shuffle_people(days: Sequence[LivedDay], seed: int) -> list[LivedDay]:
    """The same days, each put down to somebody at random; everybody keeps their number of days."""
    order = rng_at(seed, "people", "shuffled").permutation(len(days))
    return [day.model_copy(update={"person": days[at].person}) for day, at in zip(days, order, strict=True)]


def accuracy(units: Sequence[Recognised]) -> float:
    """Share of the days of all units that were put down to the right person."""
    return sum(unit.right for unit in units) / sum(unit.days for unit in units)
