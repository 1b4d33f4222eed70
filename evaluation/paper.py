"""The paper's published figures, beside which ours are shown."""

from __future__ import annotations

LAST_DAY: dict[str, dict[str, float]] = {
    "ours": {"1": 0.505, "2": 0.465, "3": 0.439, "4": 0.344},
    "no_traits": {"1": 0.481, "2": 0.443, "3": 0.239, "4": 0.206},
    "no_context": {"1": 0.452, "2": 0.414, "3": 0.408, "4": 0.299},
    "other_backbone": {"1": 0.487, "2": 0.424, "3": 0.362, "4": 0.310},
}
"""PAPER §4.5: predicate success on the last day, mean of both collaboration types, by method and setting.

The baselines' figures stand in the paper's plots only, without numbers.
"""

GENERALISATION: dict[str, tuple[float, float]] = {"scene": (0.269, 0.465), "human": (0.258, 0.343)}
"""PAPER §4.3: without and with what was learned before."""

L1: dict[str, dict[str, float]] = {
    "predicate": {"1": 0.091, "2": 0.091, "3": 0.085, "4": 0.120},
    "judge": {"1": 0.077, "2": 0.080, "3": 0.077, "4": 0.075},
}
"""PAPER §4.4: mean absolute difference to the success that real people gave, ours, by setting."""

ORDER = (
    ("oracle", "ours", "App. E: ours is second only to oracle"),
    ("ours", "direct_prompting", "App. E: minimal improvement"),
    ("ours", "direct_finetuning", "App. E: slightly better than prompting, still struggles"),
    ("direct_finetuning", "direct_prompting", "App. E"),
    ("ours", "random", "App. E: degrades over time"),
    ("ours", "intention_agnostic", "App. E: moderate improvement, lags behind"),
    ("ours", "human_context_agnostic", "App. E: superficial time-task correlations"),
    ("ours", "no_traits", "Table 5"),
    ("ours", "no_context", "Table 5"),
    ("ours", "other_backbone", "Table 5"),
)
"""What the paper says of the order of methods: (the better, the worse, where)."""
