"""The methods: ours, and each baseline or ablation as its difference from it. Adding one is adding a line here."""

from __future__ import annotations

from dataclasses import replace

from graphs.method import Method

OURS = Method(name="ours")

METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        OURS,
        replace(OURS, name="random", verdicts="accept", learns=False),  # PAPER §4.3: no classifiers, all accepted
        replace(OURS, name="no_traits", traits=False),  # PAPER §4.5
        replace(OURS, name="no_context", context=False),  # PAPER §4.5
        # nobody helps: a person's life alone, which later runs of any method may take over
        replace(OURS, name="none", traits=False, context=False, verdicts="accept", learns=False, robot=False),
        replace(OURS, name="no_order", order=False),  # classifiers see the paper's fields and nothing else
    )
}
"""All methods by name."""
