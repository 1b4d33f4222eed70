"""The kitchen to act in, which nothing may leave in a state that cannot be."""

from __future__ import annotations

import pytest

from coopera.simulation import World
from coopera.simulation.state.truth import problems
from tests.simulation.kitchen import HOME


@pytest.fixture
def home():
    with World(HOME) as world:
        yield world
        assert list(problems(world.layout, world.state)) == []
