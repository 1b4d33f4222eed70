"""What is learned is learned from the labels: dealt out at random, nothing is gained."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from langchain_core.embeddings import Embeddings

from benchmarks.learning import Shuffled
from benchmarks.toy_household import Robot, draw_person, live_day
from coopera.core.hour import Example
from coopera.core.protocols import Classifier
from coopera.memory.embeddings import bundled
from coopera.models.classifiers import make_classifier

DAYS, PEOPLE = 4, (2000, 2001, 2002)


@pytest.fixture(scope="module")
def embeddings(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Embeddings]:
    opened = bundled(tmp_path_factory.mktemp("shuffled") / "embeddings.sqlite")
    yield opened
    opened.close()


def lived(number: int, embeddings: Embeddings) -> list[list[Example]]:
    """What a robot imagines on each day, with the person's answers."""
    person = draw_person(0, number)
    robot, days = Robot(person, 0, embeddings), []
    for day in range(DAYS):
        hours = live_day(person, 0, day)
        days.append(
            [
                guess.model_copy(update={"label": activity == hour.activity})
                for hour in hours
                for activity, guess in robot.imagine_intentions(hour)
            ]
        )
        robot.learn_person(hours)
    return days


def f1(judge: Classifier, examples: list[Example]) -> float:
    yes = np.array([p >= 0.5 for p in judge.probabilities(examples)])
    right = np.array([e.label for e in examples])
    return float(2 * (yes & right).sum() / (yes.sum() + right.sum()))


@pytest.mark.slow  # embeds a few hundred sentences
def test_with_labels_dealt_out_at_random_nothing_is_gained(embeddings: Embeddings) -> None:
    gains: dict[str, list[float]] = {"told": [], "shuffled": []}
    for number in PEOPLE:
        *before, last = lived(number, embeddings)
        every = [example for day in before for example in day]
        for name, made in gains.items():
            judge = make_classifier("kernel", kind="intention", embeddings=embeddings)
            start = f1(judge, last)
            learner = judge if name == "told" else Shuffled(judge)
            learner.train(every, seed=0)
            made.append(f1(judge, last) - start)
    assert np.mean(gains["told"]) > 0.1
    assert np.mean(gains["shuffled"]) < 0.05
