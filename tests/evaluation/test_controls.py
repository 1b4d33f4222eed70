"""Controls and ceilings: what they are given, what they then do, and where they are refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from coopera.config.schema import Config, Models
from coopera.core.errors import ConfigError
from coopera.core.hour import DayPlan, HourRecord, Observation, Proposal
from coopera.core.household import ROBOT, Percept, SceneId
from coopera.core.people import BigFive, PersonId
from coopera.evaluation import METHODS
from coopera.evaluation.controls.ceiling import knower
from coopera.graphs import build_study_graph
from coopera.graphs.robots.robot_view import HomeView
from coopera.models.offline.household.knowledge import shipped
from coopera.models.offline.household.reading import Surroundings, class_of
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.person import PrivateLife
from coopera.rundir.earlier_life import LivedDays
from coopera.studies.catalogues import resolve
from tests.fakes import MARA, ScriptedAsk, type2_answers
from tests.graphs.conftest import MakeServices, make_services
from tests.graphs.test_told import robot
from tests.models.offline.questions import FIXED, MOVABLE, WORDS

__all__ = ["make_services"]
NOOR = MARA.model_copy(update={"id": PersonId("noor"), "profile": "I write poems.", "big_five": BigFive(openness=2)})


def helped(make: MakeServices, thing: str | None, profile: str = MARA.profile) -> Proposal:
    seen = Observation(percept=Percept(room="kitchen", near=[], motion="", in_hand=thing))
    said = knower({MARA.id: profile}, {MARA.id: MARA}, shipped(), WORDS).help(robot(make, seen=seen).view)
    assert isinstance(said, Proposal)
    return said


def test_a_ceiling_goes_by_the_person_and_by_what_it_sees_and_offers_nothing_that_is_in_hand(
    make_services: MakeServices,
) -> None:
    retired = "I am 75 years old and retired. I drink a lot of coffee."  # so nothing fixed is on
    eating = helped(make_services, "cereal box", profile=retired)
    brewing = helped(make_services, "coffee beans", profile=retired)
    assert eating.intentions != brewing.intentions
    for said, held in ((eating, "cereal box"), (brewing, "coffee beans")):
        things = [task.act.object for task in said.tasks if task.accepted]  # type: ignore[union-attr]
        assert things
        assert held not in things
        assert all(0 <= (task.probability or 0) <= 1 for task in said.tasks)
    assert helped(make_services, "cereal box", profile=retired) == eating
    assert helped(make_services, None, profile="I write poems.") != helped(make_services, None)


def test_a_ceiling_knows_where_this_person_wants_their_things(make_services: MakeServices) -> None:
    ctx = robot(make_services, collab=1)
    ctx.home.fixed, ctx.home.movable = FIXED, MOVABLE  # type: ignore[attr-defined]
    view = replace(ctx.view, home=HomeView.of(ctx.home, ROBOT))
    offered = []
    for profile in (
        "I am 75 years old and retired. I drink a lot of coffee.",
        "I am 80 years old and retired. I read.",
    ):
        life = PrivateLife(CommonSense(shipped(), WORDS), profile, MARA.big_five)
        said = knower({MARA.id: profile}, {MARA.id: MARA}, shipped(), WORDS).help(view)
        wished = {place for one in shipped().activities for place in life.at_home(one, Surroundings(FIXED)).places}
        acts = [task.act for task in said.tasks]  # type: ignore[union-attr]
        offered.append({(class_of(act.object), class_of(act.receptacle)) for act in acts})  # type: ignore[union-attr]
        assert offered[-1]
        assert offered[-1] <= wished
    assert any(not pairs <= shipped().usual_places for pairs in offered)


def test_a_ceiling_is_declared_to_be_told_the_truth_and_nothing_else_is_but_the_oracle() -> None:
    assert {name for name, method in METHODS.items() if method.told_the_truth} == {"ceiling", "oracle"}


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"models": Models(human="openai:some-model")}, "the person here is openai:some-model"),
        ({"played_by": "me"}, "the person here is played by me"),
    ],
)
def test_a_ceiling_is_refused_where_nobody_knows_the_true_person(
    tmp_path: Path, given: dict[str, Any], why: str
) -> None:
    with pytest.raises(ConfigError, match=f"method: ceiling knows the true person, .*{why}"):
        resolve(Config(method="ceiling", out=tmp_path / "run", **given))


def test_a_swapped_robot_is_refused_without_a_life_of_two_people(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="swapped is told of another person's days, so it needs an earlier_life"):
        resolve(Config(method="swapped", out=tmp_path / "run"))


def test_a_swapped_robot_is_told_of_the_stranger_and_asked_about_by_the_stranger(
    make_services: MakeServices, tmp_path: Path
) -> None:
    plan = DayPlan(day=0, episode_day=0, person=MARA.id, scene=SceneId("toy"), hours=[9, 10], collab=2)
    own = make_services(folder=tmp_path / "own")
    build_study_graph().invoke({"schedule": [plan]}, context=own)
    [first, _] = [hour.human for hour in own.recorder.read_day(0) if hour.human]
    other = first.model_copy(update={"intention": first.intention.model_copy(update={"text": "Read quietly"})})

    def stranger(plan: DayPlan, hour: int) -> Any:
        return other if hour == 9 else None

    ask = ScriptedAsk(type2_answers())
    services = make_services(folder=tmp_path / "swapped", method="swapped", ask=ask, stranger=stranger)
    build_study_graph().invoke({"schedule": [plan]}, context=services)
    told = services.memories("history", 0, MARA.id).intentions.records()
    assert [(record.hour, record.text) for record in told] == [(9, "Read quietly")]
    assert {v["intention"] for v in ask.variables_of("human/feedback_intentions")} == {"Read quietly"}
    kept = services.recorder.read_day(0)
    assert [hour.human.intention.text for hour in kept if hour.human] == ["Cook a meal"] * 2  # the life is Mara's own
    assert {item.hour for item in services.recorder.evenings[0].feedback} == {9}  # type: ignore[attr-defined]


def test_a_stranger_is_read_from_the_life_of_another_and_does_nothing_where_they_did_nothing(
    make_services: MakeServices, tmp_path: Path
) -> None:
    plans = [
        DayPlan(day=day, episode=day, episode_day=0, person=who.id, scene=SceneId("toy"), hours=[9], collab=2)
        for day, who in enumerate((MARA, NOOR))
    ]
    services = replace(make_services(folder=tmp_path, method="none"), people={MARA.id: MARA, NOOR.id: NOOR})
    build_study_graph().invoke({"schedule": plans}, context=services)
    noors = services.recorder.read_day(1)[0]
    services.recorder.write_hour(_wanting(noors, "Write a poem"))
    lived = LivedDays(tmp_path, {0: 1, 1: 0})
    found = lived.stranger(plans[0], 9)
    assert found is not None
    assert found.intention.text == "Write a poem"
    assert lived.stranger(plans[0], 10) is None


def _wanting(hour: HourRecord, text: str) -> HourRecord:
    assert hour.human is not None
    wanted = hour.human.intention.model_copy(update={"text": text})
    return hour.model_copy(update={"human": hour.human.model_copy(update={"intention": wanted})})
