"""How people live: what goes on for hours, what they do away from home, and what is different these days."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from coopera.core.hour import DayPlan, HourRecord
from coopera.core.household import Collab, SceneId
from coopera.core.people import PersonId
from coopera.graphs import Services, build_day_graph, first_day
from coopera.graphs.players.changes import Change
from coopera.graphs.players.living import Living
from tests.fakes import MARA, Answer, FakeHome, ScriptedAsk, placing, reviewed, type2_answers
from tests.graphs.conftest import MakeServices

AWAY_AT_TEN = {"10 am": {"intention": "Go to work", "away": True}}
FLU = Change(kind="illness", text="I have the flu", day=0, until=3, ramp=2, more={"nap": 3.0}, never=("cardio",))


def saying(by_time: dict[str, dict[str, Any]], **more: Answer) -> ScriptedAsk:
    """A person who cooks, but for some hours of the day."""
    answers = type2_answers()

    def intention(variables: dict[str, Any]) -> dict[str, Any]:
        cook = {"intention": f"Cook a meal at {variables['time']}", "wants": ["stove", "theremin"]}
        return by_time.get(variables["time"], cook)

    return ScriptedAsk({**answers, "human/intention": intention, **more})


def live(services: Services, hours: Sequence[int] = (9, 10, 11), collab: Collab = 2) -> list[HourRecord]:
    plan = DayPlan(day=0, episode_day=0, person=MARA.id, scene=SceneId("toy"), hours=list(hours), collab=collab)
    build_day_graph().invoke(first_day(plan), context=services)
    return services.recorder.read_day(0)


@pytest.mark.parametrize("method", ["ours", "none"])
def test_an_hour_away_has_no_tasks_no_robot_and_no_score_and_is_no_failure(
    make_services: MakeServices, method: str
) -> None:
    home = FakeHome()
    services = make_services(ask=saying(AWAY_AT_TEN), home=home, method=method, living=Living(absence=True))
    nine, ten, eleven = live(services)
    assert ten.human is not None
    assert (ten.human.intention.text, ten.human.intention.away) == ("Go to work", True)
    assert (ten.human.tasks, ten.human.reflections, ten.robot, ten.success) == ([], [], None, None)
    assert (ten.status, ten.reason, ten.world["outcomes"], ten.world["watched"]) == ("ok", "", [], False)
    assert ten.world["poses"] == nine.world["poses"]
    assert [call.prompt for call in ten.calls] == ["human/intention"]
    for hour in (nine, eleven):
        assert hour.human is not None
        assert len(hour.human.tasks) == 5
        assert (hour.robot is not None) == (method == "ours")


def test_the_robot_never_hears_of_an_hour_away(make_services: MakeServices) -> None:
    ask = saying(AWAY_AT_TEN)
    services = make_services(ask=ask, living=Living(absence=True))
    live(services)
    history = services.memories("history", 0, MARA.id)
    assert [one.text for one in history.intentions.records()] == ["Cook a meal at 9 am", "Cook a meal at 11 am"]
    assert {one.hour for one in history.tasks.records()} == {9, 11}
    told = [str(variables) for prompt, _, variables in ask.asked if not prompt.startswith("human/")]
    assert told
    assert not any("Go to work" in one for one in told)
    learned = [path.read_text() for path in services.recorder.adapters_folder(0).rglob("examples.jsonl")]
    assert any("Cook a meal at 9 am" in one for one in learned)
    assert not any("Go to work" in one for one in learned)


def test_the_person_remembers_an_hour_away(make_services: MakeServices) -> None:
    ask = saying(AWAY_AT_TEN)
    live(make_services(ask=ask, living=Living(absence=True)))
    [_, _, eleven] = ask.variables_of("human/intention")
    assert [memory["text"] for memory in eleven["today"]] == ["Cook a meal at 9 am", "Go to work"]


def test_nobody_is_asked_in_the_evening_about_an_hour_away(make_services: MakeServices) -> None:
    ask = saying(AWAY_AT_TEN)
    services = make_services(ask=ask, living=Living(absence=True))
    live(services)
    evening = services.recorder.evenings[0]  # type: ignore[attr-defined]
    assert {item.hour for item in evening.feedback} == {9, 11}
    assert [asked["time"] for asked in ask.variables_of("human/feedback_intentions")] == ["9 am", "11 am"]


def test_a_day_that_is_spent_away_ends_with_an_evening_that_has_nothing_to_say(make_services: MakeServices) -> None:
    away = {"intention": "Go to work", "away": True}
    services = make_services(ask=saying(dict.fromkeys(("9 am", "10 am"), away)), living=Living(absence=True))
    assert [hour.status for hour in live(services, (9, 10))] == ["ok", "ok"]
    evening = services.recorder.evenings[0]  # type: ignore[attr-defined]
    assert (evening.feedback, evening.belief.profile) == ([], None)


def test_where_nobody_leaves_the_home_a_reply_that_says_away_is_not_believed(make_services: MakeServices) -> None:
    ask = saying(AWAY_AT_TEN)
    [_, ten, _] = live(make_services(ask=ask))
    assert ten.human is not None
    assert ten.robot is not None
    assert not ten.human.intention.away
    assert len(ten.human.tasks) == 5
    assert {asked["may_leave"] for asked in ask.variables_of("human/intention")} == {False}


def test_where_each_hour_has_its_own_intention_a_reply_that_says_it_goes_on_is_not_believed(
    make_services: MakeServices,
) -> None:
    ask = saying({"10 am": {"intention": "Go on cooking", "continues": True}})
    [_, ten, _] = live(make_services(ask=ask))
    assert ten.human is not None
    assert not ten.human.intention.continues
    assert {asked["may_go_on"] for asked in ask.variables_of("human/intention")} == {False}
    assert [asked["so_far"] for asked in ask.variables_of("human/tasks_type2")] == [[], [], []]


def test_the_first_hour_of_a_day_cannot_go_on(make_services: MakeServices) -> None:
    on = {"intention": "Go on cooking", "continues": True}
    ask = saying({"9 am": on, "10 am": on})
    hours = live(make_services(ask=ask, living=Living(lasting=True)))
    assert [hour.human.intention.continues for hour in hours if hour.human] == [False, True, False]
    assert [asked["may_go_on"] for asked in ask.variables_of("human/intention")] == [False, True, True]


def test_who_goes_on_is_told_the_tasks_of_the_hour_before_and_of_no_other(make_services: MakeServices) -> None:
    ask = saying({"11 am": {"intention": "Go on cooking", "continues": True}})
    [_, ten, _] = live(make_services(ask=ask, living=Living(lasting=True)))
    assert ten.human is not None
    nine, at_ten, eleven = ask.variables_of("human/tasks_type2")
    assert (nine["so_far"], at_ten["so_far"]) == ([], [])
    assert eleven["so_far"] == [task.act.describe() for task in ten.human.tasks]


def test_what_is_different_stands_in_the_trace_and_in_the_persons_own_question(make_services: MakeServices) -> None:
    ask = saying({})
    living = Living(changes=lambda person, day: [FLU] if person == MARA.id else [])
    [nine, *_] = live(make_services(ask=ask, living=living))
    assert nine.human is not None
    [felt] = nine.human.circumstances
    assert (felt.kind, felt.text, felt.strength) == ("illness", "I have the flu", 0.5)
    [asked, *_] = ask.variables_of("human/intention")
    [told] = asked["changes"]
    assert (told["text"], told["strength"], told["more"], told["never"]) == (
        "I have the flu",
        0.5,
        {"nap": 3.0},
        ["cardio"],
    )


@pytest.mark.parametrize("collab", [1, 2])
def test_no_question_to_a_robot_or_a_judge_says_what_is_different_in_the_persons_life_or_what_they_want(
    make_services: MakeServices, collab: Collab
) -> None:
    tasks = [placing("book_1", "desk_1", 4, 1), placing("mug_1", "desk_1", 5, 1), placing("mug_2", "sofa_1", 6, 2)]
    ask = saying({})
    ask.answers = {
        **ask.answers,
        "human/tasks_type1": lambda v: {"tasks": tasks},
        "human/reflect_profile_type1": lambda v: reviewed(),
        "human/reflect_scene_type1": lambda v: reviewed(),
        "robot/tasks_type1": lambda v: {"tasks": tasks[1:2]},
    }
    live(make_services(ask=ask, living=Living(changes=lambda person, day: [FLU])), collab=collab)
    others = [(prompt, variables) for prompt, _, variables in ask.asked if prompt.split("/")[0] != "human"]
    assert {prompt.split("/")[0] for prompt, _ in others} == {"robot", "judge"}
    for prompt, variables in others:
        assert "flu" not in str(variables), prompt
        assert "theremin" not in str(variables), prompt
        assert not {"changes", "may_leave", "may_go_on", "side", "rhythm", "earlier_days"} & set(variables), prompt


def test_a_robot_does_the_same_whatever_is_different_in_the_life_of_a_person_who_does_the_same(
    make_services: MakeServices, tmp_path: Path
) -> None:
    well = live(make_services(ask=saying({}), folder=tmp_path / "well"))
    ill = live(make_services(ask=saying({}), folder=tmp_path / "ill", living=Living(changes=lambda person, day: [FLU])))
    assert [hour.robot for hour in well] == [hour.robot for hour in ill]
    assert all(hour.human and hour.human.circumstances for hour in ill)


def test_a_change_has_no_strength_before_it_grows_with_its_ramp_and_is_over_at_its_end() -> None:
    drift = Change(kind="drift", text="Little by little I read more", day=4, ramp=4, until=10)
    assert [drift.strength(day) for day in (3, 4, 5, 6, 7, 9, 10)] == [0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 0.0]
    at_once = Change(text="I have a dog", day=2)
    assert [at_once.strength(day) for day in (0, 1, 2, 1000)] == [0.0, 0.0, 1.0, 1.0]


def test_a_change_of_a_person_is_for_that_person_in_the_days_of_their_own(make_services: MakeServices) -> None:
    asked: list[tuple[PersonId, int]] = []

    def changes(person: PersonId, day: int) -> list[Change]:
        asked.append((person, day))
        return []

    services = make_services(ask=saying({}), living=Living(changes=changes))
    plan = DayPlan(day=7, episode_day=2, person=MARA.id, scene=SceneId("toy"), hours=[9])
    build_day_graph().invoke(first_day(plan), context=services)
    assert set(asked) == {(MARA.id, 2)}
