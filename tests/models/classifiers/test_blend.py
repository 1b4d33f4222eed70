"""P(yes) from scores and counts: it starts from the prior, and moves as far as feedback bears the rest out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coopera.core.errors import CooperaError
from coopera.core.hour import Example
from coopera.core.people import PersonId
from coopera.models.classifiers.blend import Blend, blend, read_blend
from coopera.models.classifiers.kernel import KernelClassifier
from coopera.models.classifiers.text import Inputs
from tests.fakes import LetterEmbeddings

MARA = PersonId("mara")


def shown(n: int, *, day: int = 0, label: bool | None = None, **evidence: float) -> Example:
    known = {"prior": 0.5, **evidence}
    return Example(person=MARA, day=day, hour=9 + n % 12, candidate=f"thing {n}", rank=0, evidence=known, label=label)


def chances(fitted: Blend, *examples: Example, score: float = 0.0) -> list[float]:
    return [float(p) for p in fitted.probabilities(np.full(len(examples), score), examples)]


def test_a_single_evening_leaves_the_prior_where_it_was() -> None:
    fitted = blend(np.ones(40), [shown(n, prior=0.3) for n in range(40)], np.ones(40, bool))
    assert chances(fitted, shown(1, prior=0.1), shown(2, prior=0.8)) == pytest.approx([0.1, 0.8])


def test_a_score_is_heard_from_the_third_day_on() -> None:
    """By then it has foretold days from more than one other."""
    for days, heard in ((2, False), (3, True)):
        examples = [shown(n, day=n % days) for n in range(90)]
        labels = np.arange(90) // days % 2 == 0
        low, high = (chances(blend(labels * 2.0 - 1, examples, labels), shown(0), score=score)[0] for score in (-1, 1))
        assert (high - low > 0.3) is heard
        assert (high == low) is not heard


def test_it_believes_in_counts_that_feedback_bears_out_and_not_in_those_that_say_nothing() -> None:
    rng = np.random.default_rng(0)
    told, hour = rng.uniform(0.05, 0.95, 400), rng.uniform(0.05, 0.95, 400)
    labels = rng.random(400) < told
    pairs = enumerate(zip(told, hour, strict=True))
    examples = [shown(n, day=n % 5, told=float(t), hour=float(h)) for n, (t, h) in pairs]
    fitted = blend(np.zeros(400), examples, labels)
    low, high = chances(fitted, shown(0, told=0.1, hour=0.5), shown(0, told=0.9, hour=0.5))
    assert low < 0.25
    assert high > 0.75
    one, other = chances(fitted, shown(0, told=0.5, hour=0.1), shown(0, told=0.5, hour=0.9))
    assert abs(one - other) < 0.15


def test_a_hopeless_first_day_says_little_against_what_is_told_on_the_next() -> None:
    """On the first day nothing is told, and common sense is mostly wrong; then the robot is told something."""
    untold = [shown(n, prior=0.35, support=0.0) for n in range(120)]
    next_day = [shown(n, day=1, prior=0.7, support=2.0) for n in range(40)]
    labels = np.array([n % 10 == 0 for n in range(120)] + [n % 10 < 7 for n in range(40)])
    fitted = blend(np.zeros(160), [*untold, *next_day], labels)
    alone, told = chances(fitted, shown(0, prior=0.35, support=0.0), shown(0, prior=0.7, support=2.0))
    assert alone < 0.2
    assert told > 0.5


def test_its_probabilities_are_shares() -> None:
    rng = np.random.default_rng(1)
    prior = rng.uniform(0.05, 0.95, 600)
    labels = rng.random(600) < prior**2  # the prior is too sure of itself
    examples = [shown(n, day=n % 5, prior=float(p)) for n, p in enumerate(prior)]
    fitted = blend(np.zeros(600), examples, labels)
    said = np.array(chances(fitted, *examples))
    for low in (0.0, 0.25, 0.5):
        part = (said >= low) & (said < low + 0.25)
        assert abs(said[part].mean() - labels[part].mean()) < 0.1


def test_what_is_from_before_a_turn_counts_little() -> None:
    def told_no_more(before: float) -> float:
        old = [shown(n, day=0, told=0.9).model_copy(update={"counts": before}) for n in range(40)]
        new = [shown(n, day=1, told=0.9) for n in range(40)]
        return chances(blend(np.zeros(80), [*old, *new], np.arange(80) < 40), shown(0, told=0.9))[0]

    assert told_no_more(1.0) == pytest.approx(0.5, abs=0.01)
    assert told_no_more(0.05) < 0.25


def taught(n: int = 60) -> list[Example]:
    return [shown(i, day=i // 12, told=0.8 if i % 3 else 0.1, label=bool(i % 3)) for i in range(n)]


def test_the_kernel_judges_by_the_counts_where_there_are_any_and_is_the_same_after_reading_it_back(
    tmp_path: Path,
) -> None:
    kernel = KernelClassifier(kind="task", embeddings=LetterEmbeddings(), inputs=Inputs())
    kernel.train(taught(), seed=0)
    asked = [shown(99, told=0.8), shown(99, told=0.1)]
    yes, no = kernel.probabilities(asked)
    assert yes > 0.5 > no
    kernel.save(tmp_path)
    again = KernelClassifier(kind="task", embeddings=LetterEmbeddings(), inputs=Inputs())
    again.load(tmp_path)
    assert again.probabilities(asked) == [yes, no]


def test_a_method_without_order_lets_its_classifiers_see_no_counts() -> None:
    kernel = KernelClassifier(kind="task", embeddings=LetterEmbeddings(), inputs=Inputs(rank=False))
    kernel.train(taught(), seed=0)
    one, other = kernel.probabilities([shown(99, told=0.8), shown(99, told=0.1)])
    assert one == other
    assert not kernel.gives_chances


def test_the_kernel_says_whether_its_probabilities_are_chances() -> None:
    kernel = KernelClassifier(kind="task", embeddings=LetterEmbeddings(), inputs=Inputs())
    assert not kernel.gives_chances
    kernel.train(taught(), seed=0)
    assert kernel.gives_chances
    kernel.train([one.model_copy(update={"evidence": {}}) for one in taught()], seed=0)
    assert not kernel.gives_chances


def test_a_blend_of_another_number_of_features_is_refused() -> None:
    whole = blend(np.zeros(1), [shown(0)], np.array([True]))._asdict()
    assert read_blend(whole) == Blend(**whole)
    with pytest.raises(ValueError, match="one number per feature"):
        read_blend(whole | {"weights": [1.0]})


def test_a_damaged_blend_is_named_with_its_folder(tmp_path: Path) -> None:
    kernel = KernelClassifier(kind="task", embeddings=LetterEmbeddings(), inputs=Inputs())
    kernel.train(taught(), seed=0)
    kernel.save(tmp_path)
    path = tmp_path / "classifier.json"
    path.write_text(path.read_text().replace('"shifts"', '"shifty"'))
    with pytest.raises(CooperaError, match=r"classifier\.json is damaged"):
        kernel.load(tmp_path)
