from __future__ import annotations

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
)
from coopera.core.household import SceneId
from coopera.core.people import Belief, PersonId
from coopera.report.learned import by_activity, by_hour, calibration, intention_pairs, task_pairs
from coopera.rundir.summary import fallbacks


def lived(
    hour: int, did: str, guesses: dict[str, tuple[float, bool]], *, fell_back: list[str] | None = None
) -> HourRecord:
    """An hour with the robot's guesses: probability, and whether it was accepted."""
    return HourRecord(
        day=0,
        episode=0,
        episode_day=0,
        hour=hour,
        person=PersonId("mara"),
        scene=SceneId("toy"),
        human=HumanHour(
            recalled=[],
            intention=Intention(text=did),
            found=Found(fixed={}, movable={}, motions=[]),
            tasks=[],
            reflections=[],
        ),
        robot=RobotHour(
            observation=Observation(),
            intentions=[IntentionCandidate(text=t, probability=p, accepted=a) for t, (p, a) in guesses.items()],
            tasks=[],
            fallbacks=fell_back or [],
        ),
        world={},
        success=None,
        status="ok",
    )


HOURS = [
    lived(9, "Cook", {"Cook": (0.9, True), "Read": (0.7, True)}, fell_back=['no tasks for "Read": unreadable']),
    lived(10, "Cook", {"Read": (0.6, True), "Tidy": (0.1, False)}, fell_back=['no tasks for "Tidy": unreadable']),
    lived(11, "Sing", {"Cook": (0.2, False)}, fell_back=["no intention was accepted: the most probable one went on"]),
]
EVENING = Evening(
    day=0,
    episode=0,
    episode_day=0,
    person=PersonId("mara"),
    scene=SceneId("toy"),
    feedback=[
        FeedbackItem(hour=hour.hour, kind="intention", text=c.text, accepted=bool(c.accepted), helpful=yes)
        for hour in HOURS
        if hour.robot and hour.human
        for c in hour.robot.intentions
        for yes in [None if c.text == "Tidy" else c.text == hour.human.intention.text]
    ],
    belief=Belief(),
)


def test_verdicts_are_compared_with_what_was_right_and_unreadable_answers_left_out() -> None:
    pairs = intention_pairs(HOURS, {0: EVENING})
    assert pairs == [(0.9, True), (0.7, False), (0.6, False), (0.2, False)]
    assert [(one.count, one.said, one.right) for one in calibration(pairs)] == [
        (0, None, None),
        (1, 0.2, 0.0),
        (0, None, None),
        (2, 0.6499999999999999, 0.0),
        (1, 0.9, 1.0),
    ]
    assert sum(one.count for one in calibration([(0.0, False), (1.0, True)])) == 2
    assert task_pairs(HOURS) == []


def test_an_activity_is_shown_with_what_it_was_mixed_up_with() -> None:
    cook, sing = by_activity(HOURS, {0: EVENING})
    assert (cook.of, cook.hours, cook.imagined, cook.accepted, cook.mistaken) == ("Cook", 2, 1, 1, ("Read", 2))
    assert (sing.of, sing.hours, sing.imagined, sing.accepted, sing.mistaken) == ("Sing", 1, 0, 0, None)


def test_the_hours_of_the_day_are_shown_in_order_with_what_was_mixed_up_in_them() -> None:
    early, late = HOURS[0], HOURS[1].model_copy(update={"hour": 9, "day": 1})
    evenings = {0: EVENING, 1: EVENING.model_copy(update={"day": 1})}
    nine, eleven = by_hour([HOURS[2], late, early], evenings)
    assert (nine.of, nine.hours, nine.imagined, nine.accepted) == ("9 am", 2, 1, 1)
    assert nine.mistaken == ("Read", 2)
    assert (eleven.of, eleven.hours, eleven.mistaken) == ("11 am", 1, None)


def test_fallbacks_are_counted_by_kind() -> None:
    assert fallbacks(HOURS) == {"no intention was accepted": 1, "no tasks for": 2}
