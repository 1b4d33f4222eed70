"""All checks on the simulated people in one go."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from langchain_core.embeddings import Embeddings

from coopera.core.hour import LoggedHour
from coopera.core.people import PersonId
from coopera.evaluation.people.alignment import alignment
from coopera.evaluation.people.distinct import distinctness
from coopera.evaluation.people.figures import Figure, as_variant, unmeasured
from coopera.evaluation.people.learners import Learner
from coopera.evaluation.people.lives import Lives
from coopera.evaluation.people.temporal import temporal_dependence
from coopera.evaluation.people.traits import coherence, diversity


@dataclass(frozen=True, slots=True)
class Checks:
    """What the checks work with.

    Attributes:
        learner: Tells people apart and what comes next.
        embeddings: Compares simulated with recorded days.
        recorded: Logs of real people, by the id of the person who is them in the simulation.
        generic: Id of somebody simulated without a profile; takes part in nothing but the comparison with the recorded.
        seed: Of everything that is drawn.
        tell: Is told what is done next.
    """

    learner: Learner
    embeddings: Embeddings
    recorded: Mapping[PersonId, Sequence[LoggedHour]] = field(default_factory=dict)
    generic: PersonId | None = None
    seed: int = 0
    tell: Callable[[str], None] = lambda what: None


def analyse_people(variants: Mapping[str, Lives], checks: Checks) -> list[Figure]:
    """Carry out every check on each variant of the simulated person, by its name ("full", or an ablation's)."""
    figures: list[Figure] = []
    for variant, everybody in variants.items():
        lives = without(everybody, checks.generic)
        found: list[Figure] = []
        checks.tell(f"{variant}: diversity and coherence")
        found += diversity(lives, seed=checks.seed)
        found += coherence(lives, seed=checks.seed)
        checks.tell(f"{variant}: telling {len(lives.people)} people apart in {len(lives.days)} days")
        found += distinctness(lives, checks.learner, seed=checks.seed)
        checks.tell(f"{variant}: what comes next")
        found += temporal_dependence(lives, checks.learner, seed=checks.seed)
        found += alignment(everybody, checks.recorded, checks.embeddings, generic=checks.generic, seed=checks.seed)
        found += unmeasured("seen by people", "multiple choice", "matching", why="people must answer the form")
        figures += as_variant(found, variant)
    return figures


def without(lives: Lives, person: PersonId | None) -> Lives:
    """Leave somebody out."""
    return Lives(
        [day for day in lives.days if day.person != person],
        lives.personas,
        [belief for belief in lives.beliefs if belief.person != person],
    )
