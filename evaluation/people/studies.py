"""Material for the two user studies (PAPER §4.2, User Studies): questions for people, their key, and the scoring.

1. Multiple choice: a person's profile, and three days of which one is that person's.
2. Matching: descriptions of traits, and days, one of each person.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from coopera.core.clock import hour_label
from coopera.core.errors import ConfigError
from coopera.core.people import TRAITS, Frozen, Persona
from coopera.core.randomness import rng_at
from coopera.evaluation.people.figures import FULL, PAPER, Figure
from coopera.evaluation.people.lives import LivedDay, Lives
from coopera.evaluation.statistics import mean_over_people

OPTIONS = 3  # PAPER §4.2: one correct, two distractors
PEOPLE = 10  # PAPER §4.2
_NOTCH = ("very low", "low", "middling", "high", "very high")


class HourShown(Frozen):
    """An hour as participants read it."""

    time: str
    intention: str
    tasks: list[str]


class DayShown(Frozen):
    """A day as participants read it, without a person's or a home's name; `letter` is how they answer."""

    letter: str
    hours: list[HourShown]


class Choice(Frozen):
    """One multiple-choice question: whose profile, and the days to choose from."""

    id: str
    profile: str
    traits: str
    options: list[DayShown]


class Trait(Frozen):
    """One description to be matched with a day."""

    id: str
    traits: str
    profile: str


class Study(Frozen):
    """What participants are given; the answers are not in it."""

    id: str
    choices: list[Choice]
    descriptions: list[Trait]
    days: list[DayShown]


class Key(Frozen):
    """The right letter of each question; `study` tells whose key it is."""

    study: str
    choices: dict[str, str]
    matches: dict[str, str]
    people: dict[str, str]
    """Question -> person, for whoever evaluates."""


class Answers(Frozen):
    """What one participant answered: question -> letter; unanswered ones are missing."""

    study: str
    participant: str
    answers: dict[str, str]


class Made(NamedTuple):
    """A study and its key."""

    study: Study
    key: Key


def make_study(lives: Lives, *, seed: int = 0) -> Made | None:
    """Draw both studies: up to ten people, one question each, and one day each to be matched.

    The three days of a question are of one home and, where there are such, of one number, so that neither gives the
    person away. Letters are drawn anew for each question. None where no three people lived in one home.
    """
    rng = rng_at(seed, "studies")
    people = lives.people
    chosen = [people[at] for at in sorted(rng.choice(len(people), min(PEOPLE, len(people)), replace=False))]
    choices: list[Choice] = []
    keys, who = {}, {}
    for person in chosen:
        options = _options(lives, person, rng)
        if not options:
            continue
        name = f"C{len(choices) + 1}"
        order = rng.permutation(len(options))
        shown = [_show(options[at], "ABC"[place]) for place, at in enumerate(order)]
        persona = lives.personas[person]
        choices.append(Choice(id=name, profile=persona.profile, traits=describe_traits(persona), options=shown))
        keys[name], who[name] = "ABC"[list(order).index(0)], str(person)
    if not choices:
        return None
    days = [_draw(lives.of(person), rng) for person in chosen]
    order, rows = rng.permutation(len(chosen)), rng.permutation(len(chosen))
    letters = {chosen[at]: chr(ord("A") + place) for place, at in enumerate(order)}
    descriptions, matches = [], {}
    for row, at in enumerate(rows, 1):
        persona = lives.personas[chosen[at]]
        descriptions.append(Trait(id=f"M{row}", traits=describe_traits(persona), profile=persona.profile))
        matches[f"M{row}"], who[f"M{row}"] = letters[chosen[at]], str(chosen[at])
    shown_days = [_show(days[at], chr(ord("A") + place)) for place, at in enumerate(order)]
    text = "".join(one.model_dump_json() for one in (*choices, *descriptions, *shown_days))
    name = hashlib.sha256(text.encode()).hexdigest()[:12]
    study = Study(id=name, choices=choices, descriptions=descriptions, days=shown_days)
    return Made(study, Key(study=name, choices=keys, matches=matches, people=who))


def score_answers(key: Key, answers: Sequence[Answers], *, seed: int = 0) -> list[Figure]:
    """Accuracy of both studies: mean over participants of the share of their answers that are right.

    What a participant left out counts neither way. The interval resamples participants.

    Raises:
        ConfigError: If answers belong to another study, name an unknown question, or a participant comes twice.
    """
    seen: set[str] = set()
    for one in answers:
        _check(key, one)
        if one.participant in seen:
            raise ConfigError(f"participant {one.participant!r} has answered twice; keep one of the two.")
        seen.add(one.participant)
    figures = []
    for measure, right, chance in (
        ("multiple choice", key.choices, 1 / OPTIONS),
        ("matching", key.matches, 1 / max(len(key.matches), 1)),
    ):
        shares = [share for one in answers if (share := _share(right, one.answers)) is not None]
        figure = Figure(
            check="seen by people",
            measure=measure,
            n=len(shares),
            unit="participants",
            paper=PAPER["seen by people", measure, FULL],
            note=f"chance {chance:.3f}" if shares else "nobody has answered",
        )
        if shares:
            found = mean_over_people(shares)
            figure = figure.model_copy(update={"value": found.mean, "low": found.low, "high": found.high})
        figures.append(figure)
    return figures


def describe_traits(persona: Persona) -> str:
    """The Big Five in words with their scores, such as "openness high (4.2)"."""
    found = [(trait, getattr(persona.big_five, trait)) for trait in TRAITS]
    return ", ".join(f"{trait} {_NOTCH[min(int((score - 1) / 0.8), 4)]} ({score:.1f})" for trait, score in found)


def _options(lives: Lives, person: str, rng: np.random.Generator) -> list[LivedDay]:
    """A day of the person first, then days of two others of the same home; empty if there are not two others."""
    mine = [day for day in lives.days if day.person == person]
    for at in rng.permutation(len(mine)):
        right = mine[at]
        others: dict[str, list[LivedDay]] = {}
        for day in lives.days:
            if day.person != person and day.scene == right.scene and day.number == right.number:
                others.setdefault(day.person, []).append(day)
        if len(others) >= OPTIONS - 1:
            names = sorted(others)
            drawn = rng.choice(len(names), OPTIONS - 1, replace=False)
            return [right, *(_draw(others[names[place]], rng) for place in drawn)]
    return []


def _draw(days: Sequence[LivedDay], rng: np.random.Generator) -> LivedDay:
    return days[int(rng.integers(len(days)))]


def _show(day: LivedDay, letter: str) -> DayShown:
    hours = [
        HourShown(time=hour_label(hour), intention=intention, tasks=tasks)
        for hour, intention, tasks in zip(day.hours, day.intentions, day.tasks, strict=True)
    ]
    return DayShown(letter=letter, hours=hours)


def _check(key: Key, one: Answers) -> None:
    if one.study != key.study:
        raise ConfigError(f"participant {one.participant!r} answered study {one.study}, but the key is of {key.study}.")
    unknown = sorted(set(one.answers) - set(key.choices) - set(key.matches))
    if unknown:
        raise ConfigError(f"participant {one.participant!r}: there is no question {unknown[0]!r} in this study.")


def _share(right: Mapping[str, str], answers: Mapping[str, str]) -> float | None:
    given = [name for name in right if answers.get(name)]
    return sum(answers[name] == right[name] for name in given) / len(given) if given else None
