"""People in a home are drawn as who they are and dressed for what they do, and nothing but pictures tells."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from coopera.core.household import HUMAN, AgentId
from coopera.core.people import BigFive, Looks, Persona, PersonId
from coopera.simulation.people.appearance import appearance_of
from coopera.simulation.state.agents import PersonAgent, RobotAgent
from coopera.simulation.world import World
from tests.simulation.flat import flat, move

ANA = Persona(
    id=PersonId("ana"), name="Ana", profile="I am a woman.", big_five=BigFive(), appearance=Looks(hair_colour="red")
)
BEN = Persona(id=PersonId("ben"), name="Ben", profile="I am a man.", big_five=BigFive())
ALL = ["human-0.webp", "human-1.webp"]


@pytest.fixture(scope="module")
def home() -> Iterator[World]:
    with World(flat(), frame_size=(64, 48), renderer="tiny") as world:
        yield world


def filmed(home: World, motion: str, folder: Path) -> np.ndarray:
    home.restore({})
    outcome = home.perform(HUMAN, move("bed_1", "book", motion), record=True)
    assert outcome.ok, outcome.reason
    home.frames(2, folder)
    return np.stack([np.asarray(Image.open(folder / name)) for name in ALL])


def test_somebody_else_lives_there_and_only_the_pictures_change(home: World, tmp_path: Path) -> None:
    told = []
    pictures = []
    for person in (ANA, BEN, ANA):
        home.inhabit(HUMAN, person)
        pictures.append(filmed(home, "do squats", tmp_path / str(len(told))))
        told.append((home.percept(np.random.default_rng(1)), home.snapshot()))
    assert told[0] == told[1] == told[2]
    assert not np.array_equal(pictures[0], pictures[1])
    assert np.array_equal(pictures[0], pictures[2])


@pytest.mark.parametrize(
    ("motion", "outfit"), [("do squats", "sport"), ("lie down", "sleep"), ("stand and read", "day")]
)
def test_the_outfit_is_that_of_the_motion_once_it_has_begun(home: World, motion: str, outfit: str) -> None:
    home.restore({})
    assert home.perform(HUMAN, move("bed_1", "book", motion), record=True).ok
    shot = home.recording.shots[-1]
    assert shot.at(0).outfits.get(HUMAN, "day") == "day", "on the way they are dressed for the day"
    assert shot.at(shot.deed).outfits[HUMAN] == outfit


def test_several_people_have_looks_of_their_own() -> None:
    looks = appearance_of("", "eve")
    agents = [PersonAgent(AgentId("ana")), PersonAgent(AgentId("eve"), looks), RobotAgent()]
    world = World(flat(), agents=agents)
    assert world.looks == {"eve": looks}
