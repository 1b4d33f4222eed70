"""Success of the robot's help: F1 over the task superset, by predicates and by a judge (PAPER §4.3).

A candidate is *correct* if it helps with one of the person's remaining tasks (those after the first, which the
robot has watched). The classifier's verdict is the prediction: accepted and correct is a true positive.

Worked example: six candidates, four accepted, three of these correct, one correct one rejected:
tp 3, fp 1, fn 1, tn 1; precision 3/4, recall 3/4, F1 = 6/8 = 0.75.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from langchain_core.embeddings import Embeddings
from numpy.typing import NDArray

from coopera.core.errors import ModelOutputError
from coopera.core.hour import Intention, Success, Task, TaskCandidate
from coopera.core.household import Act, FreeMotion, HandOver, Outcome, PickPlace, plain
from coopera.core.protocols import Ask, Home
from coopera.core.randomness import Address
from coopera.core.replies import VerdictsReply
from coopera.evaluation.counts import count
from coopera.evaluation.measures import help_given

Floats = NDArray[np.float64]

SIMILAR = 0.6  # PAPER App. C.3: the threshold of type 2


@dataclass(frozen=True, slots=True)
class Measure:
    """Scores an hour by both measures; implements `coopera.graphs.services.Score`."""

    ask: Ask
    embeddings: Embeddings
    _vectors: dict[str, Floats] = field(init=False, default_factory=dict, repr=False, compare=False)

    def __call__(
        self,
        home: Home,
        at: Address,
        intention: Intention,
        remaining: Sequence[Task],
        candidates: Sequence[TaskCandidate],
        outcomes: Sequence[Outcome] = (),
    ) -> tuple[list[TaskCandidate], Success]:
        """Set `correct` (by predicate) on the candidates, count by predicate and by judge, and measure the help."""
        accepted = [bool(c.accepted) for c in candidates]
        correct = [self.matches(home, c, remaining) for c in candidates]
        judged = self._judge(at, intention, remaining, candidates)
        scored = [c.model_copy(update={"correct": yes}) for c, yes in zip(candidates, correct, strict=True)]
        useful = [[self.helps(home, done.act, task.act) for task in remaining] for done in outcomes]
        return scored, Success(
            predicate=count(accepted, correct),
            judge=count(accepted, judged),
            help=help_given(outcomes, useful, remaining=len(remaining)),
        )

    def matches(self, home: Home, candidate: TaskCandidate, remaining: Sequence[Task]) -> bool:
        """The predicate: does this candidate help with one of the remaining tasks?"""
        return any(self.helps(home, candidate.act, task.act) for task in remaining)

    def helps(self, home: Home, act: Act, wanted: Act) -> bool:
        """Whether an act of the robot helps with an act that the person has before them.

        PAPER App. C.3: in type 1 the classes of object and receptacle are the same, whichever instances; in type 2
        the offered thing is similar (cosine of at least 0.6) to the one that the person will hold.
        """
        if isinstance(act, PickPlace) and isinstance(wanted, PickPlace):
            return _classes(home, act) == _classes(home, wanted)
        if isinstance(act, HandOver) and isinstance(wanted, FreeMotion):
            return self._similarity(act.object, wanted.in_hand) >= SIMILAR
        return False

    def _similarity(self, one: str, other: str) -> float:
        if plain(one).lower() == plain(other).lower():
            return 1.0
        return float(self._vector(plain(one)) @ self._vector(plain(other)))

    def _vector(self, text: str) -> Floats:
        """A text's vector in float64; the names of a home's things come again every hour."""
        if text not in self._vectors:
            self._vectors[text] = np.asarray(self.embeddings.embed_query(text), dtype=np.float64)
        return self._vectors[text]

    def _judge(
        self, at: Address, intention: Intention, remaining: Sequence[Task], candidates: Sequence[TaskCandidate]
    ) -> list[bool | None]:
        if not candidates:
            return []
        try:
            reply = self.ask(
                "judge/tasks",
                VerdictsReply,
                at=at,
                variables={
                    "time": f"{at.hour}:00",
                    "intention": intention.text,
                    "tasks": [{"id": t.id, "thought": t.thought, "text": t.act.describe()} for t in remaining],
                    "offers": [{"thought": c.thought, "text": c.act.describe()} for c in candidates],
                },
            )
        except ModelOutputError:
            return [None] * len(candidates)
        verdicts: list[bool | None] = [v.yes for v in reply.verdicts]
        return verdicts if len(verdicts) == len(candidates) else [None] * len(candidates)


def _classes(home: Home, act: PickPlace) -> tuple[str, str]:
    return home.class_of(act.object), home.class_of(act.receptacle)
