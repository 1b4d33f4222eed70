"""A real person in the loop: answers in text or by choice, questions that wait, and feedback."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from langgraph.checkpoint.serde.jsonplus import JsonPlusSerializer
from langgraph.checkpoint.sqlite import SqliteSaver

from coopera.core.hour import DayPlan, LoggedHour
from coopera.core.household import SceneId
from coopera.core.interview import Answer, Question
from coopera.graphs import STATE_TYPES, Services, build_study_graph
from coopera.graphs.players.real_person import Verdict, read_choice, read_intention, read_steps, read_verdicts
from coopera.graphs.players.simulated import Simulated
from coopera.graphs.players.stated import Interviewed, Logged
from coopera.graphs.study import waiting
from tests.fakes import MARA, FakeHome, ScriptedAsk, moving, type2_answers
from tests.graphs.conftest import MakeServices

DAY = DayPlan(day=0, episode_day=0, person=MARA.id, scene=SceneId("toy"), hours=[9, 10])
THREAD: Any = {"configurable": {"thread_id": "study"}}
HOME = FakeHome()


def asked(**given: Any) -> Question:
    about = {"person": MARA.id, "name": "Mara", "day": 0, "hour": 9, "time": "9 am", "weekday": "Monday", "collab": 2}
    return Question.model_validate({"kind": "tasks", **about, **given})


def answer(question: Question) -> Answer:
    """A person who reads, by choice and in words, and finds the first thing right."""
    if question.kind == "intention":
        return f"Read at {question.time}"
    if question.kind == "tasks":
        return ["1 | sit and read | novel", "stir my tea"]
    return ["yes, just right", *["no"] * (len(question.items) - 1)]


def live(
    services: Services, folder: Path, person: Callable[[Question], Answer] = answer, stop_after: int = 99
) -> list[Question]:
    """Run the study, or go on with it, until it ends or `stop_after` questions are answered."""
    folder.mkdir(parents=True, exist_ok=True)
    connection = sqlite3.connect(folder / "checkpoints.sqlite", check_same_thread=False)
    saver = SqliteSaver(connection, serde=JsonPlusSerializer(allowed_msgpack_modules=list(STATE_TYPES)))
    graph = build_study_graph(saver)
    given: Any = None if graph.get_state(THREAD).values else {"schedule": [DAY]}
    questions: list[Question] = []
    if waiting(graph, THREAD) is None:
        graph.invoke(given, THREAD, context=services)
    while (asking := waiting(graph, THREAD)) is not None and len(questions) < stop_after:
        questions.append(asking.question)
        graph.invoke(asking.answered(person(asking.question)), THREAD, context=services)
    connection.close()
    return questions


def services_in_the_loop(
    make_services: MakeServices, folder: Path, *, graded: bool = False, **options: Any
) -> Services:
    answers = type2_answers()
    answers["human/tasks_type2"] = lambda v: {"tasks": [moving("stove_1", "spoon", step, 3) for step in v["steps"]]}
    return make_services(ask=ScriptedAsk(answers), folder=folder, player=Interviewed(graded), **options)


def test_the_person_is_asked_for_intention_tasks_and_in_the_evening_for_feedback(
    make_services: MakeServices, tmp_path: Path
) -> None:
    services = services_in_the_loop(make_services, tmp_path)
    questions = live(services, tmp_path)
    assert [(q.kind, q.hour) for q in questions] == [
        ("intention", 9),
        ("tasks", 9),
        ("intention", 10),
        ("tasks", 10),
        ("feedback", 10),
    ]
    assert questions[2].today == ["9 am: Read at 9 am"]
    assert questions[1].places.keys() == HOME.fixed.keys()
    hours = services.recorder.read_day(0)
    assert [h.human.intention.text for h in hours if h.human] == ["Read at 9 am", "Read at 10 am"]
    first = hours[0].human
    assert first is not None
    chosen = next(iter(questions[1].places))
    assert [t.act.model_dump(include={"target", "motion", "in_hand"}) for t in first.tasks] == [
        {"target": chosen, "motion": "sit and read", "in_hand": "novel"},
        {"target": "stove_1", "motion": "stir my tea", "in_hand": "spoon"},
    ]
    feedback = services.recorder.evenings[0].feedback  # type: ignore[attr-defined]
    assert [card.hour for card in questions[4].cards] == [9, 10]
    assert [item.helpful for item in feedback] == [True] + [False] * (questions[4].of - 1)
    assert feedback[0].reason == "just right"


def test_no_language_model_speaks_for_a_person_who_is_there(make_services: MakeServices, tmp_path: Path) -> None:
    services = services_in_the_loop(make_services, tmp_path)
    live(services, tmp_path)
    prompts = {prompt for prompt, _, _ in services.ask.asked if prompt.startswith("human/")}  # type: ignore[attr-defined]
    assert prompts == {"human/tasks_type2"}  # for the step in the person's own words alone


@pytest.mark.parametrize("stop_after", [0, 1, 3, 4])
def test_a_run_that_waited_ends_as_one_that_did_not(
    make_services: MakeServices, tmp_path: Path, stop_after: int
) -> None:
    whole = services_in_the_loop(make_services, tmp_path / "whole")
    live(whole, tmp_path / "whole")
    live(services_in_the_loop(make_services, tmp_path / "waited"), tmp_path / "waited", stop_after=stop_after)
    again = services_in_the_loop(make_services, tmp_path / "waited")
    rest = live(again, tmp_path / "waited")
    assert len(rest) == 5 - stop_after
    files = [
        {path.name: path.read_bytes() for path in (tmp_path / name / "trace").rglob("*.json")}
        for name in ("whole", "waited")
    ]
    assert files[0] == files[1]
    assert again.recorder.evenings == whole.recorder.evenings  # type: ignore[attr-defined]


def test_an_answer_that_cannot_be_read_is_asked_for_again_with_what_is_wrong(
    make_services: MakeServices, tmp_path: Path
) -> None:
    bad: list[Answer] = [["9 | sit | novel"], []]
    problems: list[str] = []

    def clumsy(question: Question) -> Answer:
        problems.append(question.problem)
        return bad.pop(0) if question.kind == "tasks" and bad else answer(question)

    live(services_in_the_loop(make_services, tmp_path), tmp_path, clumsy)
    wrong = ["There is no fixed object number 9; the list has 3.", "Please give 1 to 8 steps."]
    assert problems[:5] == ["", "", *wrong, ""]


def test_graded_feedback_is_kept_as_grades_and_helps_from_three_up(make_services: MakeServices, tmp_path: Path) -> None:
    services = services_in_the_loop(make_services, tmp_path, graded=True)

    def grading(question: Question) -> Answer:
        if question.kind != "feedback":
            return answer(question)
        assert question.graded
        return [str(1 + n % 5) for n in range(len(question.items))]

    live(services, tmp_path, grading)
    feedback = services.recorder.evenings[0].feedback  # type: ignore[attr-defined]
    assert [(item.grade, item.helpful) for item in feedback[:5]] == [(n, n >= 3) for n in (1, 2, 3, 4, 5)]


def test_a_simulated_person_grades_too(make_services: MakeServices) -> None:
    answers = type2_answers()
    answers["human/grade_intentions"] = lambda v: {"grades": [{"grade": 4, "reason": "near"}] * len(v["guesses"])}
    answers["human/grade_tasks"] = lambda v: {"grades": [{"grade": 2}] * len(v["offers"])}
    services = make_services(ask=ScriptedAsk(answers), player=Simulated(graded=True))
    build_study_graph().invoke({"schedule": [DAY]}, context=services)
    feedback = services.recorder.evenings[0].feedback  # type: ignore[attr-defined]
    assert {(item.kind, item.grade, item.helpful) for item in feedback} == {("intention", 4, True), ("task", 2, False)}


def test_of_a_logged_hour_the_model_only_decomposes(make_services: MakeServices) -> None:
    log = {
        9: LoggedHour(day=0, hour=9, intention="Read", tasks=["sofa_1 | sit and read | novel"]),
        10: LoggedHour(day=0, hour=10, intention="Cook"),
    }
    ask = ScriptedAsk(type2_answers())
    services = make_services(ask=ask, method="none", player=Logged(lambda plan, clock: log[clock.hour]))
    build_study_graph().invoke({"schedule": [DAY]}, context=services)
    first, second = (hour.human for hour in services.recorder.read_day(0))
    assert first is not None
    assert second is not None
    assert (first.intention.text, [t.act.describe() for t in first.tasks]) == (
        "Read",
        ["sit and read at the sofa with the novel in hand"],
    )
    assert (second.intention.text, len(second.tasks), len(second.reflections)) == ("Cook", 5, 2)
    assert "human/intention" not in {prompt for prompt, _, _ in ask.asked}


def test_what_a_diary_says_of_an_hour_stands_in_the_trace_and_an_open_hour_is_the_models(
    make_services: MakeServices,
) -> None:
    log = {9: LoggedHour(day=0, hour=9, intention="Travel", continues=True, away=True)}
    ask = ScriptedAsk(type2_answers())
    services = make_services(ask=ask, method="none", player=Logged(lambda plan, clock: log.get(clock.hour)))
    build_study_graph().invoke({"schedule": [DAY]}, context=services)
    first, second = (hour.human for hour in services.recorder.read_day(0))
    assert first is not None
    assert second is not None
    assert (first.intention.text, first.intention.continues, first.intention.away) == ("Travel", True, True)
    assert (second.intention.continues, second.intention.away) == (False, False)
    assert [at.hour for prompt, at, _ in ask.asked if prompt == "human/intention"] == [10]


@pytest.mark.parametrize(
    ("step", "collab", "said"),
    [
        ("2 | sofa", 1, "put the mug on the sofa"),
        ("mug_1|1", 1, "put the mug on the desk"),
        ("3 | 2 | ladle", 2, "sit and read at the stove with the ladle in hand"),
        ("sofa_1 | hum a tune | hat", 2, "hum a tune at the sofa with the hat in hand"),
    ],
)
def test_a_choice_is_read_by_number_or_by_name(step: str, collab: Any, said: str) -> None:
    draft = read_choice(step, collab, HOME.objects("fixed"), HOME.objects("movable"), HOME.motions)
    assert draft.act.describe() == said


@pytest.mark.parametrize("step", ["1", "1 | 2 | 3 | 4", " | 1 | mug", "oven | stir | spoon", "1 | 9 | spoon", "0|1|x"])
def test_a_choice_of_what_there_is_not_is_refused(step: str) -> None:
    with pytest.raises(ValueError, match="."):
        read_choice(step, 2, HOME.objects("fixed"), HOME.objects("movable"), HOME.motions)


def test_verdicts_are_read_with_their_reasons() -> None:
    question = asked(kind="feedback", items=["a", "b", "c"])
    assert read_verdicts("Yes!\nno because it was late\nn", question) == [
        Verdict(True, "!"),
        Verdict(False, "it was late"),
        Verdict(False, ""),
    ]


@given(st.text() | st.lists(st.text(), max_size=10))
def test_any_answer_is_read_or_refused_in_words(said: Any) -> None:
    question = asked(places={"sofa_1": "study"}, motions=["sit"], items=["a", "b"])
    for read in (read_intention, lambda a: read_steps(a, question), lambda a: read_verdicts(a, question)):
        with suppress(ValueError):
            assert read(said)
