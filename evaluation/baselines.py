"""Robots outside our graph: a habit table, and a model finetuned on the person's accounts.

Both propose one intention and its tasks, accept all of them, and learn from the evenings alone.
"""

from __future__ import annotations

import warnings
from collections import Counter
from typing import Any, NamedTuple

from coopera.core.clock import Clock, hour_label
from coopera.core.hour import DayAccount, IntentionCandidate, Observation, Proposal, TaskCandidate
from coopera.core.household import Act, FreeMotion, HandOver
from coopera.core.people import PersonId
from coopera.graphs.robots.robot_view import RobotView


class Occasion(NamedTuple):
    """An hour of an account: the robot's observation, and the person's tasks after the first."""

    person: PersonId
    clock: Clock
    sight: str
    intention: str
    acts: list[Act]


class Habit:
    """A frequency prior: what this person did most often at this hour before, and its tasks as on the latest such day.

    Ties go to the newest. Where the person has done nothing yet at this hour, nothing is proposed.
    """

    def __init__(self) -> None:
        """Know nothing."""
        self._past: list[Occasion] = []

    def help(self, view: RobotView) -> Proposal:
        """Propose the habit of this hour."""
        past = [one for one in self._past if (one.person, one.clock.hour) == (view.person, view.clock.hour)]
        if not past:
            return Proposal(fallbacks=["nothing is known of this person at this hour"])
        times = Counter(one.intention for one in past)
        chosen = max(past, key=lambda one: (times[one.intention], one.clock.now))
        return _propose(chosen, times[chosen.intention] / len(past))

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, Any]:
        """Remember the day."""
        self._past += occasions_of(account)
        return {"occasions": len(self._past)}


class Finetuned:
    """The robot's brain itself, finetuned each evening to output one intention and its tasks from what it sees.

    PAPER §4.3 finetunes a language model. The offline model has no weights to finetune, so a multinomial logistic
    regression takes its place. It learns the same map from the same evenings: from the words of the percept and the
    hour to one intention of the accounts. The tasks are those of the most similar hour with this intention. It can only
    repeat an intention of the accounts, and it prefers frequent ones. A robot model of Hugging Face is finetuned
    itself (`coopera.evaluation.finetuned`).
    """

    def __init__(self) -> None:
        """Know nothing."""
        self._past: list[Occasion] = []
        self._model: Any = None

    def help(self, view: RobotView) -> Proposal:
        """Propose what was learned for such a sight at such an hour; before the first evening, nothing."""
        if not self._past:
            return Proposal(fallbacks=["nothing has been told yet"])
        text = _shown(view.person, view.clock, sight_of(view.observation))
        if self._model is None:  # one intention is all that was ever told
            return _propose(self._past[-1], 1.0)
        chances = dict(zip(self._model.classes_, self._model.predict_proba([text])[0], strict=True))
        best = max(sorted(chances), key=lambda name: round(float(chances[name]), 9))
        words = set(text.split())
        similar = max(
            (one for one in self._past if one.intention == best),
            key=lambda one: (len(words & set(_shown(one.person, one.clock, one.sight).split())), one.clock.now),
        )
        return _propose(similar, round(float(chances[best]), 9))

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, Any]:
        """Train anew on all evenings so far."""
        from sklearn.feature_extraction.text import TfidfVectorizer  # noqa: PLC0415 - heavy
        from sklearn.linear_model import LogisticRegression  # noqa: PLC0415
        from sklearn.pipeline import make_pipeline  # noqa: PLC0415

        self._past += occasions_of(account)
        labels = [one.intention for one in self._past]
        if len(set(labels)) > 1:
            texts = [_shown(one.person, one.clock, one.sight) for one in self._past]
            vectors = TfidfVectorizer(lowercase=True, token_pattern=r"\S+", sublinear_tf=True)
            self._model = make_pipeline(vectors, LogisticRegression(C=10.0, max_iter=500))
            with warnings.catch_warnings():  # few occasions of many intentions are no surprise here
                warnings.simplefilter("ignore", UserWarning)
                self._model.fit(texts, labels)
        return {"occasions": len(self._past), "intentions": len(set(labels))}


def occasions_of(account: DayAccount) -> list[Occasion]:
    """The hours of an account."""
    return [
        Occasion(
            person=account.person,
            clock=Clock(day=account.day, hour=hour.hour),
            sight=sight_of(hour.robot.observation),
            intention=hour.intention,
            acts=list(hour.tasks[1:]),
        )
        for hour in account.hours
    ]


def sight_of(seen: Observation) -> str:
    """What was seen, in words."""
    percept = seen.percept.caption() if seen.percept else ""
    return f"{seen.first_task or ''} {percept}".strip()


def _shown(person: PersonId, clock: Clock, sight: str) -> str:
    """The input as text; the hour, the part of the day and the person are words of their own."""
    part = f"part{clock.hour // 3}"
    return f"{sight} who:{person} {part} {hour_label(clock.hour).replace(' ', '')}"


def _propose(chosen: Occasion, probability: float) -> Proposal:
    intention = IntentionCandidate(text=chosen.intention, probability=probability, accepted=True)
    tasks = [
        TaskCandidate(intention=chosen.intention, thought="as before", act=act, probability=probability, accepted=True)
        for act in map(offer, chosen.acts)
    ]
    return Proposal(intentions=[intention], tasks=tasks)


def offer(act: Act) -> Act:
    """What a robot does for a person's act: the same, or bringing what it takes."""
    return HandOver(object=act.in_hand) if isinstance(act, FreeMotion) else act
