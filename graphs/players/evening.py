"""What a real person is asked in the evening: the day's candidates, those that say the same once, and not too many."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.clock import Clock
from coopera.core.hour import CandidateKind, HumanHour, RobotHour, TaskCandidate
from coopera.core.household import FreeMotion, Outcome, PickPlace, plain
from coopera.core.interview import Card, Entry
from coopera.core.randomness import rng_at
from coopera.graphs.players.real_person import Verdict

MOST = 60
"""Questions of an evening, if nothing else is said."""
ALIKE = 0.9
"""Cosine from which two candidates of one hour, of the same kind and with the same things, say nearly the same."""
SPARED = "Not asked: there were more questions than an evening has."


class Lived(NamedTuple):
    """An hour that the evening speaks of."""

    clock: Clock
    human: HumanHour
    robot: RobotHour


class Candidate(NamedTuple):
    """One thing that the robot imagined in an hour."""

    kind: CandidateKind
    text: str
    under: str
    things: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Asked:
    """What is asked of an evening.

    Attributes:
        cards: An hour each; what they ask counts through `items`.
        items: What is asked, in words.
        groups: For each hour the places of its candidates that say the same, the one that is asked first.
        drawn: For each hour the numbers of its groups that are asked, in order.
        of: How many candidates there are in all.
    """

    cards: list[Card]
    items: list[str]
    groups: list[list[list[int]]]
    drawn: list[list[int]]
    of: int

    def handed_out(self, said: Sequence[Verdict]) -> list[list[Verdict]]:
        """The answers to all candidates, hour by hour: what was asked, what says the same, and what was spared."""
        answers, found = iter(said), []
        for card, groups, drawn in zip(self.cards, self.groups, self.drawn, strict=True):
            verdicts = [Verdict(None, SPARED, asked=False)] * sum(map(len, groups))
            for number, entry in zip(drawn, card.entries, strict=True):
                answer = next(answers)
                for place in groups[number]:
                    verdicts[place] = answer._replace(answered_as=self.items[entry.item])
                verdicts[groups[number][0]] = answer
            found.append(verdicts)
        return found


def evening_of(hours: Sequence[Lived], embeddings: Embeddings, *, most: int, address: tuple[int, str, int]) -> Asked:
    """Choose what is asked of a day.

    DEVIATES: the paper's people answer for every candidate. A real person would have hundreds of questions. So what
    says nearly the same is asked once; of more than `most` questions each hour has as many as the others, drawn at
    random.

    Args:
        hours: The day.
        embeddings: Says what is alike.
        most: Questions at most.
        address: What the draw derives from: seed, person and day.
    """
    candidates = [_candidates(hour.robot) for hour in hours]
    groups = [_alike(of_hour, embeddings) for of_hour in candidates]
    drawn: list[list[int]] = []
    for hour, size, quota in zip(hours, map(len, groups), quotas([len(one) for one in groups], most), strict=True):
        rng = rng_at(*address, hour.clock.hour, "asked")
        drawn.append(sorted(rng.permutation(size)[:quota].tolist()))
    cards: list[Card] = []
    items: list[str] = []
    for hour, of_hour, grouped, numbers in zip(hours, candidates, groups, drawn, strict=True):
        entries = []
        for number in numbers:
            first, *others = (of_hour[place] for place in grouped[number])
            also = [other.text for other in dict.fromkeys(others) if other.text != first.text]
            entries.append(Entry(item=len(items), kind=first.kind, under=first.under, also=list(dict.fromkeys(also))))
            items.append(first.text)
        cards.append(_card(hour, entries))
    return Asked(cards, items, groups, drawn, sum(map(len, candidates)))


def quotas(sizes: Sequence[int], most: int) -> list[int]:
    """How many each may have of `most`, as equal as their sizes let it be; earlier ones have what cannot be shared."""
    given = [0] * len(sizes)
    left = most
    while left > 0 and (hungry := [n for n, size in enumerate(sizes) if given[n] < size]):
        for n in hungry[:left]:
            given[n] += 1
        left -= len(hungry[:left])
    return given


def _candidates(robot: RobotHour) -> list[Candidate]:
    return [
        *(Candidate("intention", one.text, "", ()) for one in robot.intentions),
        *(Candidate("task", one.act.describe(), one.intention, _things(one)) for one in robot.tasks),
    ]


def _things(task: TaskCandidate) -> tuple[str, ...]:
    """What a task is done with, by class: tasks with other things are never the same."""
    if isinstance(task.act, PickPlace):
        return plain(task.act.object), plain(task.act.receptacle)
    if isinstance(task.act, FreeMotion):
        return plain(task.act.target), plain(task.act.in_hand)
    return (plain(task.act.object),)


def _alike(candidates: Sequence[Candidate], embeddings: Embeddings) -> list[list[int]]:
    """The places of candidates that say nearly the same, each list in order, the lists by their first."""
    if not candidates:
        return []
    texts = list(dict.fromkeys(one.text for one in candidates))
    vectors = np.asarray(embeddings.embed_documents(texts), dtype=float)
    vectors /= np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12)
    near = vectors @ vectors.T
    at = {text: place for place, text in enumerate(texts)}
    groups: list[list[int]] = []
    for place, one in enumerate(candidates):
        for group in groups:
            first = candidates[group[0]]
            same = (first.kind, first.things) == (one.kind, one.things)
            if same and (first.text == one.text or near[at[first.text], at[one.text]] >= ALIKE):
                group.append(place)
                break
        else:
            groups.append([place])
    return groups


def _card(hour: Lived, entries: list[Entry]) -> Card:
    return Card(
        hour=hour.clock.hour,
        time=hour.clock.label,
        intention=hour.human.intention.text,
        tasks=[task.act.describe() for task in hour.human.tasks],
        robot=[_done(outcome) for outcome in hour.robot.outcomes],
        entries=entries,
    )


def _done(outcome: Outcome) -> str:
    said = outcome.act.describe()
    return said if outcome.ok else f"{said} (it could not: {outcome.reason})"
