from __future__ import annotations

import pytest

from coopera.core.errors import ConfigError
from coopera.simulation.acts.predicates import performed
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, move, put


@pytest.fixture(scope="module")
def world():
    with World(flat()) as world:
        world.perform("robot", bring("toothbrush"))
        world.perform("human", move("sofa_1", "toothbrush", "sit and rest"))
        world.perform("robot", put("mug_1", "dining_table_1"))
        yield world


@pytest.mark.parametrize(
    ("predicate", "holds"),
    [
        ("on(mug, dining table)", True),
        ("on(mug, dining_table)", True),
        ("on(mug, kitchen counter)", False),
        ("on(unicorn, dining table)", False),
        ("holding(human, toothbrush)", True),
        ("holding(person, mug)", False),
        ("holding(robot, toothbrush)", False),
        ("near(human, sofa)", True),
        ("near(robot, sofa)", False),
        ("near(robot, dining table)", True),
        ("at(human, living room)", True),
        ("at(robot, living room)", False),
        ("performed(sit and rest)", True),
        ("performed(dance)", False),
        ("  at( robot , kitchen ) ", True),
    ],
)
def test_a_written_predicate_says_what_is_true_of_the_home(world, predicate, holds) -> None:
    assert world.holds(predicate) is holds


@pytest.mark.parametrize("text", ["", "on(mug)", "on mug sofa", "under(mug, sofa)", "holding(cat, mug)", "at(human)"])
def test_what_is_no_predicate_is_refused_with_those_that_are(world, text) -> None:
    with pytest.raises(ConfigError, match="known are on"):
        world.holds(text)


def test_a_motion_counts_as_performed_from_a_similarity_of_six_tenths_on(world) -> None:
    assert performed(world.state, "relax for a while", lambda a, b: 0.6)
    assert not performed(world.state, "relax for a while", lambda a, b: 0.59)
    assert not performed(world.state, "relax for a while")
