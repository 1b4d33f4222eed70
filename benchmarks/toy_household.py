"""A toy of the whole loop, in texts: people with hidden habits, a robot with candidates, an evening's feedback.

It exists to compare classifiers and uses nothing of the rest of coopera. A person is a draw of likings (from Big-Five
loadings and chance), of usual hours and of favourite things. The robot knows the usual hours and things of people in
general. It sees the room and a motion class, right in 85 % of hours. It makes the `Example`s as our robot does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import yaml
from langchain_core.embeddings import Embeddings

from coopera.core.hour import Example
from coopera.core.people import TRAITS, BigFive, PersonId
from coopera.core.randomness import rng_at
from coopera.memory.embeddings import as_array

HOURS = range(9, 22)
SIGHT = 0.85
"""Share of hours in which the motion is recognised."""


class Activity(NamedTuple):
    """What people do: wordings, when in general (peaks), where, how it looks, with what."""

    wordings: tuple[str, ...]
    peaks: tuple[int, ...]
    room: str
    motion: str
    things: tuple[str, ...]
    loading: str = ""


@cache
def activities() -> tuple[Activity, ...]:
    """Return everything that people in the toy do."""
    text = Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8")
    return tuple(
        Activity(
            tuple(entry["wordings"]),
            tuple(entry["peaks"]),
            entry["room"],
            entry["motion"],
            tuple(entry["things"]),
            entry.get("loading", ""),
        )
        for entry in yaml.safe_load(text)
    )


@dataclass(frozen=True, slots=True)
class Person:
    """The hidden truth: log likings, own peak hour, and own weights over each activity's things."""

    id: PersonId
    big_five: BigFive
    liking: npt.NDArray[np.float64]
    own_hour: npt.NDArray[np.float64]
    things: npt.NDArray[np.float64]


class Lived(NamedTuple):
    """An hour as it was: the activity, its wording, and the things in hand."""

    day: int
    hour: int
    activity: int
    text: str
    things: frozenset[str]


def draw_person(seed: int, number: int) -> Person:
    """Draw a person; equal arguments give the same one."""
    rng = rng_at(seed, "person", number)
    scores = np.clip(rng.normal(3.2, 0.9, 5), 1, 5)
    traits = dict(zip(TRAITS, (round(float(score), 2) for score in scores), strict=True))
    liking = rng.normal(0, 1.1, len(activities()))
    for index, activity in enumerate(activities()):
        if activity.loading:
            sign = 1.0 if activity.loading.endswith("+") else -1.0
            liking[index] += 0.6 * sign * (traits[activity.loading[:-1]] - 3)
    own_hour = np.array([rng.choice(activity.peaks) + rng.integers(-2, 3) for activity in activities()], float)
    things = rng.dirichlet(np.full(8, 0.5), len(activities()))
    return Person(PersonId(f"p{number}"), BigFive(**traits), liking, own_hour, things)


def live_day(person: Person, seed: int, day: int) -> list[Lived]:
    """Let a person live a day: liking, own hour and general peaks, no repetition, temperature 0.7."""
    done: set[int] = set()
    hours = []
    for hour in HOURS:
        rng = rng_at(seed, person.id, day, hour, "human")
        score = person.liking - (hour - person.own_hour) ** 2 / 8 + common_sense(hour)
        score[list(done)] -= 3.0
        weights = np.exp((score - score.max()) / 0.7)
        chosen = int(rng.choice(len(activities()), p=weights / weights.sum()))
        done.add(chosen)
        activity = activities()[chosen]
        picks = rng.choice(8, size=5, p=0.9 * person.things[chosen] + 0.1 / 8)
        things = frozenset(activity.things[pick] for pick in picks)
        hours.append(Lived(day, hour, chosen, str(rng.choice(activity.wordings)), things))
    return hours


def common_sense(hour: int) -> npt.NDArray[np.float64]:
    """Log prior of each activity at an hour, as everyone knows it; shape (activities,)."""
    return np.array([-min((hour - peak) ** 2 for peak in activity.peaks) / 12 for activity in activities()])


@dataclass(slots=True)
class Robot:
    """What a robot knows of one person, and how it imagines: by hour, motion and room, never by truth."""

    person: Person
    seed: int
    embeddings: Embeddings
    past: list[Lived] = field(default_factory=list)
    profile: str = ""
    big_five: BigFive | None = None

    def imagine_intentions(self, lived: Lived) -> list[tuple[int, Example]]:
        """Return 5 (activity, unlabelled example) pairs for an hour."""
        rng = rng_at(self.seed, self.person.id, lived.day, lived.hour, "robot")
        truth = activities()[lived.activity]
        motions = sorted({activity.motion for activity in activities()})
        motion = truth.motion if rng.random() < SIGHT else str(rng.choice(motions))
        fits = np.array([2.5 * (a.motion == motion) + 1.0 * (a.room == truth.room) for a in activities()])
        score = common_sense(lived.hour) + fits + rng.gumbel(0, 0.7, len(activities()))
        recalled = self._recall(f"In the {truth.room}, the person seems to {motion}", lived)
        best = [int(index) for index in np.argsort(-score, kind="stable")[:5]]
        texts = [str(rng.choice(activities()[index].wordings)) for index in best]
        return [
            (index, self._example(lived, text, recalled, rank))
            for rank, (index, text) in enumerate(zip(best, texts, strict=True))
        ]

    def hear_intention(self, lived: Lived) -> Example:
        """Return the true intention of an hour, told in the evening, as one more positive example."""
        return self._example(lived, lived.text, [], None).model_copy(update={"label": True})

    def imagine_tasks(self, lived: Lived, activity: int, guess: Example) -> list[Example]:
        """Return 5 unlabelled task candidates for an intention candidate: things that go with it, by common sense."""
        rng = rng_at(self.seed, self.person.id, lived.day, lived.hour, "tasks", activity)
        things = activities()[activity].things
        picks = rng.choice(len(things), size=5, replace=False)
        return [
            guess.model_copy(update={"candidate": f"bring the {things[pick]}", "intention": guess.candidate})
            for pick in picks
        ]

    def _example(self, lived: Lived, text: str, recalled: Sequence[Lived], rank: int | None) -> Example:
        return Example(
            person=self.person.id,
            day=lived.day,
            hour=lived.hour,
            candidate=text,
            profile=self.profile,
            big_five=self.big_five,
            intentions=[past.text for past in recalled[:3]],
            tasks=[f"use the {thing}" for past in recalled[:2] for thing in sorted(past.things)][:5],
            rank=rank,
        )

    def _recall(self, caption: str, lived: Lived) -> list[Lived]:
        """Earlier days' hours, best by recency x relevance to what is seen."""
        if not self.past:
            return []
        vectors = as_array(self.embeddings, [caption, *(past.text for past in self.past)])
        age = np.array([24 * (lived.day - past.day) + lived.hour - past.hour for past in self.past])
        score = 0.95**age * (vectors[1:] @ vectors[0])
        return [self.past[index] for index in np.argsort(-score, kind="stable")[:3]]

    def learn_person(self, day: Sequence[Lived]) -> None:
        """Remember the true day and infer who this is: the commonest activities, and Big Five with errors."""
        self.past = [*self.past, *day]
        counts = np.bincount([past.activity for past in self.past], minlength=len(activities()))
        top = np.argsort(-counts, kind="stable")[:6]
        words = [activities()[index].wordings[0] for index in top]
        self.profile = (
            f"This person likes to {words[0]} and to {words[1]}. They often {words[2]} or {words[3]}. "
            f"Now and then they {words[4]} and {words[5]}."
        )
        rng = rng_at(self.seed, self.person.id, day[0].day, "traits")
        seen = {
            trait: float(np.clip(getattr(self.person.big_five, trait) + rng.normal(0, 0.6), 1, 5)) for trait in TRAITS
        }
        self.big_five = BigFive(**seen)
