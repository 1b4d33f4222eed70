from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.hour import (
    Evening,
    FeedbackItem,
    Found,
    HourRecord,
    HumanHour,
    Intention,
    IntentionCandidate,
    Observation,
    RobotHour,
    Task,
    TaskCandidate,
)
from coopera.core.household import Act, FreeMotion, HandOver, Outcome, PickPlace, SceneId
from coopera.core.people import Belief, PersonId
from coopera.evaluation.robot.error_budget import FALSE, LOST, Budget, budgets, by_day, hour_budget, pool


def helps(act: Act, wanted: Act) -> bool:
    """The predicate without similarity: the very same thing."""
    if isinstance(act, HandOver) and isinstance(wanted, FreeMotion):
        return act.object == wanted.in_hand
    return act == wanted


def person(*things: str, does: str = "Have tea") -> HumanHour:
    acts = [FreeMotion(target_id=1, target="sofa_1", in_hand=thing, motion="use") for thing in things]
    tasks = [Task(id=f"9.{n}", thought="", act=act) for n, act in enumerate(acts, 1)]
    found = Found(fixed={}, movable={}, motions=[])
    return HumanHour(recalled=[], intention=Intention(text=does), found=found, tasks=tasks, reflections=[])


def offer(thing: str, accepted: bool = True, of: str = "Have tea") -> TaskCandidate:
    return TaskCandidate(intention=of, thought="", act=HandOver(object=thing), accepted=accepted)


def robot(intentions: dict[str, bool], *offers: TaskCandidate, failed: tuple[str, ...] = ()) -> RobotHour:
    """A robot with intentions (by text: whether it accepted them) and offers; those of `failed` things fail."""
    acts = [one.act for one in offers if one.accepted]
    return RobotHour(
        observation=Observation(),
        intentions=[IntentionCandidate(text=text, accepted=accepted) for text, accepted in intentions.items()],
        tasks=list(offers),
        outcomes=[Outcome(agent="robot", act=act, ok=act.object not in failed, metres=1) for act in acts],
    )


def lost(budget: Budget) -> dict[str, int]:
    return {name: count for name, count in budget.lost.items() if count}


def false(budget: Budget) -> dict[str, int]:
    return {name: count for name, count in budget.false.items() if count}


RIGHT = {"Have tea": True, "Read": False}


def test_a_task_is_lost_at_the_last_step_that_it_reached() -> None:
    """Of six remaining tasks the pot was helped; three more were proposed, and two no intention's tasks had."""
    human = person("mug", "pot", "sugar", "milk", "spoon", "honey", "lemon")
    did = robot(
        {"Have tea": True, "Read": True},
        offer("pot"),
        offer("sugar", accepted=False),
        offer("milk", accepted=False, of="Read"),
        offer("spoon"),
        failed=("spoon",),
    )
    found = hour_budget(human, did, RIGHT, helps)
    assert (found.remaining, found.helped, found.missed, found.failed) == (6, 1, 5, 1)
    assert lost(found) == {"task_rejected": 2, "not_done": 1, "not_among_tasks": 2}


@pytest.mark.parametrize(
    ("intentions", "right", "where"),
    [
        ({"Read": True}, RIGHT, "not_imagined"),
        ({"Have tea": False, "Read": True}, RIGHT, "intention_rejected"),
        ({"Have tea": True, "Read": True}, RIGHT, "not_among_tasks"),
        ({"Have a cuppa": True, "Read": True}, {"Have a cuppa": True, "Read": False}, "not_among_tasks"),
        ({"Read": True}, {"Read": None}, "unknown"),
        ({"Read": True}, {}, "unknown"),
        ({}, {}, "not_among_tasks"),
    ],
)
def test_what_was_not_proposed_was_lost_where_the_right_intention_was(
    intentions: dict[str, bool], right: dict[str, bool | None], where: str
) -> None:
    assert lost(hour_budget(person("mug", "pot"), robot(intentions), right, helps)) == {where: 1}


def test_a_method_that_imagines_no_intentions_loses_no_task_on_them() -> None:
    did = robot({"drink from a cup near the sofa": True}, offer("hat", of="drink from a cup near the sofa"))
    found = hour_budget(person("mug", "pot"), did, {"drink from a cup near the sofa": False}, helps, imagines=False)
    assert (lost(found), false(found)) == ({"not_among_tasks": 1}, {"wrong_thing": 1})


def test_an_accepted_task_that_never_came_to_be_done_was_too_late() -> None:
    did = robot({"Have tea": True}, offer("pot")).model_copy(update={"outcomes": []})
    assert lost(hour_budget(person("mug", "pot"), did, RIGHT, helps)) == {"not_done": 1}


def test_false_help_says_why_it_was_of_no_use() -> None:
    """The mug is in hand; the hat is the wrong thing for tea; the novel was for reading; nobody said of "Paint"."""
    did = robot(
        {"Have tea": True, "Read": True, "Paint": True},
        *(offer("mug"), offer("hat"), offer("novel", of="Read"), offer("brush", of="Paint"), offer("pot")),
        failed=("pot",),
    )
    found = hour_budget(person("mug", "pot"), did, {**RIGHT, "Paint": None}, helps)
    assert false(found) == {"in_hand": 1, "wrong_thing": 1, "wrong_intention": 1, "unsaid": 1}
    assert found.accepted == found.failed + found.useless == 5


def test_what_the_person_had_put_there_already_is_told_apart_from_what_they_hold() -> None:
    act = PickPlace(object_id=1, object="mug_1", receptacle_id=2, receptacle="sink_1")
    other = act.model_copy(update={"object": "pan_1"})
    tasks = [Task(id=f"9.{n}", thought="", act=one) for n, one in enumerate((act, other), 1)]
    human = person().model_copy(update={"tasks": tasks})
    did = robot({"Have tea": True}, TaskCandidate(intention="Have tea", thought="", act=act, accepted=True))
    assert false(hour_budget(human, did, RIGHT, helps)) == {"already_done": 1}


THINGS = ["mug", "pot", "hat", "pen", "cup"]
OFFERS = st.builds(offer, st.sampled_from(THINGS), st.booleans(), st.sampled_from(["Have tea", "Read", "Paint"]))


@given(
    st.lists(st.sampled_from(THINGS), max_size=5),
    st.dictionaries(st.sampled_from(["Have tea", "Read", "Paint"]), st.booleans()),
    st.dictionaries(st.sampled_from(["Have tea", "Read", "Paint"]), st.sampled_from([True, False, None])),
    st.lists(OFFERS, max_size=6, unique_by=lambda one: one.act.object),
    st.sets(st.sampled_from(THINGS)),
    st.booleans(),
)
def test_the_causes_add_up_to_what_was_missed_and_to_what_was_of_no_use(
    things: list[str],
    intentions: dict[str, bool],
    right: dict[str, bool | None],
    offers: list[TaskCandidate],
    failed: set[str],
    imagines: bool,
) -> None:
    human, did = person(*things), robot(intentions, *offers, failed=tuple(failed))
    found = hour_budget(human, did, right, helps, imagines=imagines)
    assert list(found.lost) == list(LOST)
    assert list(found.false) == list(FALSE)
    assert sum(found.lost.values()) == found.missed == found.remaining - found.helped
    wanted = [task.act for task in human.tasks[1:]]
    useful = sum(one.ok and any(helps(one.act, act) for act in wanted) for one in did.outcomes)
    assert found.accepted == len(did.outcomes) == found.failed + found.useless + useful


def record(hour: int, day: int = 0, **over: Any) -> HourRecord:
    given: dict[str, Any] = {
        **{"day": day, "episode": 0, "episode_day": day, "hour": hour, "person": PersonId("mara")},
        **{"scene": SceneId("toy"), "human": person("mug", "pot"), "robot": robot({"Have a cuppa": True})},
        **{"world": {}, "success": None, "status": "ok"},
    }
    return HourRecord(**given | over)


def evening(day: int, *, helpful: bool | None, slip: bool = False) -> Evening:
    item = FeedbackItem(
        hour=9, kind="intention", text="Have a cuppa", accepted=True, helpful=helpful, slip=slip
    )  # of hour 9 alone
    return Evening(
        day=day,
        episode=0,
        episode_day=day,
        person=PersonId("mara"),
        scene=SceneId("toy"),
        feedback=[item],
        belief=Belief(),
    )


def test_the_evening_says_which_intention_was_right_and_a_slip_is_undone() -> None:
    for said, slip, where in (
        (True, False, "not_among_tasks"),
        (False, False, "not_imagined"),
        (False, True, "not_among_tasks"),
        (None, False, "unknown"),
    ):
        [day] = budgets([record(9)], [evening(0, helpful=said, slip=slip)], lambda _: helps)
        assert lost(day.budget) == {where: 1}


def test_a_day_without_its_evening_has_no_verdicts_but_what_the_person_would_call_it() -> None:
    right = record(10, robot=robot({"Have tea": True}))
    [day] = budgets([record(9), right], [], lambda _: helps)
    assert lost(day.budget) == {"unknown": 1, "not_among_tasks": 1}


def test_hours_that_failed_without_a_robot_or_away_are_left_out() -> None:
    away = person("mug", "pot").model_copy(update={"intention": Intention(text="Shop", away=True)})
    left_out = [record(10, status="failed"), record(11, robot=None), record(12, human=away)]
    [day] = budgets([record(9), *left_out], [], lambda _: helps)
    assert (day.budget.hours, day.budget.remaining) == (1, 1)


def test_days_are_pooled_by_the_day_of_the_episode() -> None:
    days = budgets([record(9), record(10), record(9, day=1)], [evening(0, helpful=True)], lambda _: helps)
    found = by_day([*days, *days])
    assert {day: budget.missed for day, budget in found.items()} == {0: 4, 1: 2}
    assert pool(found.values()).missed == 6
    assert pool([]).missed == 0
