"""The methods: the paper's, ours, and each baseline or ablation as a difference from one of them.

Adding one is adding a line here.

Methods of other packages join by an entry point in the group `coopera.methods`; see `coopera.graphs.robots.own_robot`.
"""

from __future__ import annotations

from dataclasses import replace

from coopera.core.registry import Registry
from coopera.evaluation.baselines import Finetuned, Habit
from coopera.evaluation.controls.ceiling import CEILING
from coopera.evaluation.controls.habit import HABIT
from coopera.evaluation.finetuned import FinetunedModel
from coopera.graphs.robots.method import Method
from coopera.graphs.robots.rehearsal import REHEARSED

PAPER = Method(name="paper")
"""The method as the paper has it, so far as it says; what the fields default to."""
OURS = replace(
    PAPER,
    name="ours",
    remembers="days",
    told=True,
    skips_held=True,
    evidence=True,
    accepts="need",
    turns=True,
    replay=(REHEARSED, 2_000),
)
"""The best that we have: it counts what it was told, and remembers for weeks."""

METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        OURS,
        PAPER,
        # PAPER §4.3, baselines: one intention and its tasks from the history in the prompt, nothing validated
        replace(PAPER, name="direct_prompting", n_intentions=1, verdicts="accept", learns=False),
        Method(
            name="direct_finetuning", traits=False, own=Finetuned, tunes=FinetunedModel
        ),  # see coopera.evaluation.baselines and coopera.evaluation.finetuned for what it learns
        replace(PAPER, name="oracle", intentions="given", verdicts="accept", learns=False),
        replace(PAPER, name="random", verdicts="accept", learns=False),  # no classifiers, all accepted
        replace(PAPER, name="intention_agnostic", intentions="skipped"),
        replace(PAPER, name="human_context_agnostic", time_only=True),
        replace(OURS, name="no_traits", traits=False),  # PAPER §4.5
        replace(OURS, name="no_context", context=False),  # PAPER §4.5
        replace(PAPER, name="other_backbone", other_backbone=True),  # PAPER §4.5
        # references that the paper lacks
        replace(OURS, name="first_guess", verdicts="first", learns=False),  # the first guess and its tasks, always
        HABIT,
        replace(OURS, name="swapped", swapped=True),  # told of another person in the evening
        CEILING,
        Method(name="frequency_prior", traits=False, own=Habit),
        replace(PAPER, name="always_no", traits=False, verdicts="reject", learns=False),
        # ours on its very first day, every day: the baseline of generalisation
        replace(OURS, name="untrained", traits=False, context=False, learns=False),
        # nobody helps: a person's life alone, which later runs of any method may take over
        replace(PAPER, name="none", traits=False, context=False, verdicts="accept", learns=False, robot=False),
        replace(PAPER, name="no_order", order=False),  # classifiers see the paper's fields and nothing else
    )
}
"""The methods of this package, and those that `register` added in this process, by name."""


_METHODS = Registry("method", Method, registered=METHODS)


def known_methods() -> list[str]:
    """Names of all methods that can be chosen, those of other packages last; nothing of theirs is loaded."""
    return _METHODS.known()


def find_method(name: str) -> Method:
    """Return a method by name.

    Raises:
        ConfigError: If there is none, or another package offers it and it cannot be loaded or is no `Method`.
    """
    return _METHODS.find(name)


def register(method: Method) -> Method:
    """Make a method a choice in this process, as scripts and notebooks need it; packages use an entry point.

    Raises:
        ConfigError: If another method has its name already.
    """
    return _METHODS.register(method)
