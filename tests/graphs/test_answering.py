"""How reliably a person answers in the evening, and what of it the robot hears."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coopera.core.hour import DayPlan, Evening, FeedbackItem
from coopera.core.household import SceneId
from coopera.graphs import Services, build_day_graph, first_day
from coopera.graphs.players.answering import UNANSWERED, Answering
from coopera.graphs.robots.learning import account_of, labelled
from tests.fakes import MARA
from tests.graphs.conftest import MakeServices

MANY = 4000
PLAN = DayPlan(day=0, episode_day=0, person=MARA.id, scene=SceneId("toy"), hours=[9, 10, 11, 12])


def meant(count: int = MANY, **changed: Any) -> list[FeedbackItem]:
    one = FeedbackItem(hour=9, kind="task", text="", accepted=True, helpful=True, reason="I used it.", grade=4)
    return [one.model_copy(update={"text": f"thing {n}", **changed}) for n in range(count)]


def given(answering: Answering, items: list[FeedbackItem], seed: int = 0) -> list[FeedbackItem]:
    return answering.given(items, np.random.default_rng(seed))


def evening_of(services: Services) -> Evening:
    build_day_graph().invoke(first_day(PLAN), context=services)
    evening: Evening = services.recorder.evenings[0]  # type: ignore[attr-defined]
    return evening


def test_who_answers_everything_and_never_slips_says_what_they_mean() -> None:
    assert given(Answering(), meant(50)) == meant(50)


def test_who_answers_nothing_leaves_all_open() -> None:
    said = given(Answering(rate=0.0), meant(50))
    assert {(item.helpful, item.reason, item.grade, item.slip) for item in said} == {(None, UNANSWERED, None, False)}
    assert [item.text for item in said] == [item.text for item in meant(50)]


def test_who_answers_half_leaves_about_half_open_and_means_the_rest() -> None:
    said = given(Answering(rate=0.5), meant())
    answered = [item for item in said if item.helpful is not None]
    assert 0.45 < len(answered) / MANY < 0.55
    assert {(item.helpful, item.reason, item.grade, item.slip) for item in answered} == {(True, "I used it.", 4, False)}


def test_a_slip_is_the_opposite_of_what_was_meant_and_no_reason_tells_it_from_the_others() -> None:
    said = given(Answering(noise=0.5), meant())
    slips = [item for item in said if item.slip]
    assert 0.45 < len(slips) / MANY < 0.55
    assert {(item.helpful, item.grade) for item in slips} == {(False, 2)}
    assert {(item.helpful, item.grade) for item in said if not item.slip} == {(True, 4)}
    assert {item.reason for item in said} == {""}


def test_an_answer_that_could_not_be_read_stays_as_it_is() -> None:
    unread = meant(50, helpful=None, reason="the reply has no verdicts", grade=None)
    assert given(Answering(rate=0.5, noise=0.5), unread) == unread


def test_what_is_left_open_does_not_hang_on_how_often_people_slip() -> None:
    exact, noisy = (given(Answering(rate=0.5, noise=noise), meant()) for noise in (0.0, 0.5))
    assert [item.helpful is None for item in exact] == [item.helpful is None for item in noisy]


def test_the_evening_is_that_of_a_person_who_means_it_unless_a_setting_says_otherwise(
    make_services: MakeServices, tmp_path: Path
) -> None:
    usual = evening_of(make_services(folder=tmp_path / "usual"))
    said = evening_of(make_services(folder=tmp_path / "said", answering=Answering(rate=1.0, noise=0.0)))
    assert usual == said
    assert usual.feedback
    assert all(item.helpful is not None and not item.slip for item in usual.feedback)


def test_an_evening_that_is_done_again_gets_the_same_answers_and_another_seed_gets_others(
    make_services: MakeServices, tmp_path: Path
) -> None:
    def answers(name: str, seed: int) -> list[FeedbackItem]:
        services = make_services(folder=tmp_path / name, answering=Answering(rate=0.5, noise=0.5))
        return evening_of(replace(services, seed=seed)).feedback

    assert answers("once", 0) == answers("again", 0)
    assert answers("once", 0) != answers("other", 1)


def test_a_robot_is_told_what_was_said_and_never_that_it_was_a_slip(make_services: MakeServices) -> None:
    services = make_services(answering=Answering(rate=0.7, noise=0.5))
    evening = evening_of(services)
    assert any(item.slip for item in evening.feedback)
    account = account_of(PLAN, services.recorder.read_day(0), evening.feedback, evening.belief)
    told = [item for hour in account.hours for item in hour.feedback]
    assert [item.helpful for item in told] == [item.helpful for item in evening.feedback]
    assert {(item.slip, item.reason) for item in told} <= {(False, ""), (False, UNANSWERED)}
    kept = [path.read_text() for path in services.recorder.adapters_folder(0).rglob("examples.jsonl")]
    assert kept
    assert not any("slip" in one for one in kept)


def test_no_label_is_made_of_a_question_that_was_left_open(make_services: MakeServices) -> None:
    services = make_services(answering=Answering(rate=0.0))
    evening = evening_of(services)
    examples = labelled(account_of(PLAN, services.recorder.read_day(0), evening.feedback, evening.belief))
    assert examples["task"] == []
    assert {(one.candidate, one.label) for one in examples["intention"]} == {("Cook a meal", True)}


@pytest.mark.parametrize(("grade", "slipped"), [(1, 5), (2, 4), (3, 3), (5, 1)])
def test_a_graded_slip_is_the_grade_at_the_other_end(grade: int, slipped: int) -> None:
    said = given(Answering(noise=0.5), meant(50, grade=grade, helpful=grade >= 3))
    assert {item.grade for item in said if item.slip} == {slipped}
