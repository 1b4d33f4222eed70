from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, Observation
from coopera.core.household import Percept, SceneId
from coopera.core.people import PersonId
from coopera.graphs import Services, build_study_graph
from coopera.graphs.robots.identity import identify, sight
from coopera.graphs.robots.robot_view import Memories
from coopera.memory import MemoryStream
from tests.fakes import MARA, FakeHome, LetterEmbeddings
from tests.graphs.conftest import MakeServices

BAKER, READER = PersonId("baker"), PersonId("reader")
BO = MARA.model_copy(update={"id": PersonId("bo"), "name": "Bo"})


def told(folder: Path, person: str, task: str, hours: tuple[int, ...]) -> Memories:
    streams = [MemoryStream.open(folder, f"{person}/{kind}", LetterEmbeddings()) for kind in ("intentions", "tasks")]
    memories = Memories(*streams)
    for hour in hours:
        memories.add("Be busy", [task], hour)
    return memories


def test_who_does_such_things_at_such_hours_is_the_likelier_and_a_day_of_it_leaves_little_doubt(tmp_path: Path) -> None:
    hours = (9, 10, 11, 33, 34, 35)
    known = {
        BAKER: told(tmp_path, "baker", "knead dough at the stove", hours),
        READER: told(tmp_path, "reader", "sit on the sofa and study", hours),
    }
    seen = Observation(percept=Percept(room="kitchen", near=["stove_1"], motion="knead dough"))
    sights = [sight(Clock(day=2, hour=hour), seen) for hour in (9, 10, 11)]
    one, all_day = identify(sights[:1], known), identify(sights, known)
    assert 0.5 < one[BAKER] < all_day[BAKER]
    assert sum(all_day.values()) == pytest.approx(1)
    assert identify([], known) == {BAKER: 0.5, READER: 0.5}
    assert identify([sight(Clock(day=2, hour=9), Observation())], known) == {BAKER: 0.5, READER: 0.5}
    for memories in known.values():
        memories.intentions.close()
        memories.tasks.close()


def live(services: Services, people: str) -> list[PersonId | None]:
    """Live a day with each and return whom the robot took them for."""
    by_letter = {"m": MARA.id, "b": BO.id}
    plans = [
        DayPlan(day=day, episode_day=day, person=by_letter[letter], scene=SceneId("toy"), hours=[9, 10])
        for day, letter in enumerate(people)
    ]
    services = replace(services, people={MARA.id: MARA, BO.id: BO}, identity_known=False)
    build_study_graph().invoke({"schedule": plans}, context=services)
    hours = [hour for day in range(len(people)) for hour in services.recorder.read_day(day)]
    return [hour.robot.with_whom for hour in hours if hour.robot]


def test_on_the_first_day_with_somebody_it_is_told_and_later_it_guesses(make_services: MakeServices) -> None:
    taken = live(make_services(), "mbm")
    assert taken[:4] == [None] * 4
    assert set(taken[4:]) <= {MARA.id, BO.id}


def test_it_uses_what_it_knows_of_the_one_it_takes_the_person_for(
    make_services: MakeServices, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = FakeHome()
    monkeypatch.setattr("coopera.graphs.hour.identify", lambda sights, known: dict.fromkeys(known, 0.1) | {BO.id: 0.9})
    services = make_services(home=home)
    assert live(services, "mbm")[4:] == [BO.id, BO.id]
    lines = (services.recorder.adapters_folder(2) / "intention" / "examples.jsonl").read_text()
    assert '"person":"mara"' in lines  # in the evening the person says who they are
    assert '"person":"bo"' not in lines
