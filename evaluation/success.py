"""Success of the robot's help: F1 over the task superset, by predicates and by a judge (PAPER §4.3).

A candidate is *correct* if it helps with one of the person's remaining tasks (those after the first, which the
robot has watched). The classifier's verdict is the prediction: accepted and correct is a true positive.

Worked example: six candidates, four accepted, three of these correct, one correct one rejected:
tp 3, fp 1, fn 1, tn 1; precision 3/4, recall 3/4, F1 = 6/8 = 0.75.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from langchain_core.embeddings import Embeddings

from core.errors import ModelOutputError
from core.hour import Counts, Intention, Success, Task, TaskCandidate
from core.household import FreeMotion, HandOver, PickPlace, plain
from core.protocols import Ask, Home
from core.randomness import Address
from core.replies import VerdictsReply

SIMILAR = 0.6  # PAPER App. C.3: the threshold of type 2


def count(accepted: Sequence[bool], correct: Sequence[bool | None]) -> Counts:
    """Count verdicts against truth; `None` is unscored and enters nothing else.

    F1 is None where it has no meaning: nothing scored, or nothing accepted while nothing was correct.
    Precision is None where nothing was accepted, recall where nothing was correct.
    """
    pairs = [(a, c) for a, c in zip(accepted, correct, strict=True) if c is not None]
    tp = sum(a and c for a, c in pairs)
    fp = sum(a and not c for a, c in pairs)
    fn = sum(c and not a for a, c in pairs)
    return _rates(tp, fp, fn, len(pairs) - tp - fp - fn, len(correct) - len(pairs))


def pool(counts: Iterable[Counts]) -> Counts:
    """Add up hours and take the rates of the sum, so that an hour weighs by its candidates."""
    every = list(counts)
    tp, fp, fn, tn, unscored = (sum(getattr(c, f) for c in every) for f in ("tp", "fp", "fn", "tn", "unscored"))
    return _rates(tp, fp, fn, tn, unscored)


@dataclass(frozen=True, slots=True)
class Measure:
    """Scores an hour by both measures; implements `graphs.services.Score`."""

    ask: Ask
    embeddings: Embeddings

    def __call__(
        self,
        home: Home,
        at: Address,
        intention: Intention,
        remaining: Sequence[Task],
        candidates: Sequence[TaskCandidate],
    ) -> tuple[list[TaskCandidate], Success]:
        """Set `correct` (by predicate) on the candidates and count by predicate and by judge."""
        accepted = [bool(c.accepted) for c in candidates]
        correct = [self.matches(home, c, remaining) for c in candidates]
        judged = self._judge(at, intention, remaining, candidates)
        scored = [c.model_copy(update={"correct": yes}) for c, yes in zip(candidates, correct, strict=True)]
        return scored, Success(predicate=count(accepted, correct), judge=count(accepted, judged))

    def matches(self, home: Home, candidate: TaskCandidate, remaining: Sequence[Task]) -> bool:
        """The predicate: does this candidate help with one of the remaining tasks?

        PAPER App. C.3: in type 1 the classes of object and receptacle are those of a remaining task, whichever
        instances; in type 2 the offered thing is similar (cosine of at least 0.6) to one held in a remaining task.
        """
        act = candidate.act
        if isinstance(act, PickPlace):
            wanted = [t.act for t in remaining if isinstance(t.act, PickPlace)]
            return _classes(home, act) in [_classes(home, other) for other in wanted]
        if isinstance(act, HandOver):
            held = [t.act.in_hand for t in remaining if isinstance(t.act, FreeMotion)]
            return any(self._similarity(act.object, thing) >= SIMILAR for thing in held)
        return False

    def _similarity(self, one: str, other: str) -> float:
        if plain(one).lower() == plain(other).lower():
            return 1.0
        a, b = (np.asarray(self.embeddings.embed_query(plain(text)), dtype=np.float64) for text in (one, other))
        return float(a @ b)

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


def _rates(tp: int, fp: int, fn: int, tn: int, unscored: int) -> Counts:
    def ratio(part: int, whole: int) -> float | None:
        return part / whole if whole else None

    return Counts(
        tp=tp,
        fp=fp,
        fn=fn,
        tn=tn,
        unscored=unscored,
        f1=ratio(2 * tp, 2 * tp + fp + fn),
        precision=ratio(tp, tp + fp),
        recall=ratio(tp, tp + fn),
    )
