"""The robot's verdicts on its candidates: how probable each is, and which of them go on.

The paper keeps what is more probable than not. That serves the F1 over the robot's own candidates. A person's needs are
served otherwise: with F the F1 that can be reached, an offer pays as soon as its probability is above F/2, since it
adds its probability to the hits and one to the offers (the plug-in rule for F1). With F at about 0.7, that is 0.35.
An intention only costs thought, so it goes on earlier.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol, runtime_checkable

from coopera.core.hour import CandidateKind, Example
from coopera.graphs.robots.learning import Learner
from coopera.graphs.robots.method import Method

HALF = 0.5
NEED: dict[CandidateKind, float] = {"intention": 0.15, "task": 0.35}
UNKNOWN = 0.5
"""What every untrained classifier says."""


@runtime_checkable
class GivesChances(Protocol):
    """A classifier whose P(yes) may be a chance that nothing shifts; for any other, 0.5 is the place to decide."""

    @property
    def gives_chances(self) -> bool:
        """Whether it is one now."""
        ...


class Verdicts(NamedTuple):
    """For each candidate, how probable it is to be right, and whether it goes on."""

    probabilities: list[float]
    accepted: list[bool]


def judge(method: Method, learner: Learner, kind: CandidateKind, asked: Sequence[Example]) -> Verdicts:
    """Judge the candidates of an hour.

    Until a classifier has learned anything, a method with `evidence` goes by its prior: the likeliest intention, with
    all of its tasks. One without accepts all, as the paper's does.
    """
    if method.verdicts == "first":
        return _sure([kind == "task" or place == 0 for place in range(len(asked))])
    if method.verdicts != "classifiers":
        return _sure([method.verdicts == "accept"] * len(asked))
    classifier = learner.classifiers[kind]
    said = classifier.probabilities(asked) if asked else []
    if not method.evidence or any(p != UNKNOWN for p in said):
        chances = isinstance(classifier, GivesChances) and classifier.gives_chances
        bar = NEED[kind] if chances and method.accepts == "need" else HALF
        return Verdicts(said, [p >= bar for p in said])
    prior = [example.evidence.get("prior", UNKNOWN) for example in asked]
    best = prior.index(max(prior)) if prior else 0
    return Verdicts(prior, [kind == "task" or place == best for place in range(len(asked))])


def _sure(accepted: list[bool]) -> Verdicts:
    return Verdicts([float(yes) for yes in accepted], accepted)
