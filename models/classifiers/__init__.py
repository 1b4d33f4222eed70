"""The yes/no classifiers of the robot's candidates (PAPER §3.3).

The person's feedback trains them each evening.

>>> from coopera.memory.embeddings import bundled
>>> judge = make_classifier("kernel", kind="intention", embeddings=bundled())
"""

from __future__ import annotations

from coopera.models.classifiers.registry import (
    ClassifierSpec,
    Wanted,
    find_classifier,
    known_classifiers,
    make_classifier,
    register_classifier,
)
from coopera.models.classifiers.text import Inputs

__all__ = [
    "ClassifierSpec",
    "Inputs",
    "Wanted",
    "find_classifier",
    "known_classifiers",
    "make_classifier",
    "register_classifier",
]
