"""The classifiers that there are, as values: what each is called, what it is, and how one is made.

A classifier that ships is one file in `models/classifiers/shipped/`, named as the classifier is ("_" for "-"). It names
a `ClassifierSpec` CLASSIFIER. What is heavy is imported when a classifier is made, so that finding one costs nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from coopera.core.hour import CandidateKind
from coopera.core.registry import Registry
from coopera.models.classifiers.text import Inputs

if TYPE_CHECKING:
    from langchain_core.embeddings import Embeddings

    from coopera.core.protocols import Classifier
    from coopera.models.classifiers.instruction import Instruct


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a new classifier is made for.

    Attributes:
        kind: What it judges: "intention" or "task".
        embeddings: Sentence embeddings; they give a text the same vector every time.
        inputs: What the method lets it see.
        recipe: A recipe file of the user's (`--classifier-config`), if there is one.
        instruct: Says an example as an instruction for a language model: `PromptLibrary().instruct`.
    """

    kind: CandidateKind
    embeddings: Embeddings
    inputs: Inputs
    recipe: Path | None = None
    instruct: Instruct | None = None


@dataclass(frozen=True, slots=True)
class ClassifierSpec:
    """A classifier that can be chosen.

    Attributes:
        name: What `--classifier` calls it.
        about: What it is, in a line.
        make: Returns a new, untrained one.
        check_recipe: Reads a recipe file and raises ConfigError if it is wrong. None where there is no recipe.
    """

    name: str
    about: str
    make: Callable[[Wanted], Classifier]
    check_recipe: Callable[[Path], object] | None = None


_CLASSIFIERS = Registry("classifier", ClassifierSpec, package="coopera.models.classifiers.shipped", dash="-")


def known_classifiers() -> list[str]:
    """Names of all classifiers that can be chosen; nothing of them is imported."""
    return _CLASSIFIERS.known()


def find_classifier(name: str) -> ClassifierSpec:
    """Return a classifier by its name.

    Raises:
        ConfigError: If there is none, or another package offers it and it cannot be loaded.
    """
    return _CLASSIFIERS.find(name)


def register_classifier(spec: ClassifierSpec) -> ClassifierSpec:
    """Make a classifier a choice in this process; packages use an entry point in the group `coopera.classifiers`.

    Raises:
        ConfigError: If another classifier has its name already.
    """
    return _CLASSIFIERS.register(spec)


def make_classifier(
    name: str,
    *,
    kind: CandidateKind,
    embeddings: Embeddings,
    inputs: Inputs | None = None,
    recipe: Path | None = None,
    instruct: Instruct | None = None,
) -> Classifier:
    """Return a new, untrained classifier; `Wanted` says what it is made for. By default it sees everything.

    Raises:
        ConfigError: If there is no classifier of that name, or its recipe is wrong.
    """
    return find_classifier(name).make(Wanted(kind, embeddings, inputs or Inputs(), recipe, instruct))
