"""A study as LangGraph's server runs it: chosen by plain data, drawn with its insides, interrupted by questions."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from langgraph.checkpoint.memory import InMemorySaver
from langgraph.types import Command
from pydantic import ValidationError

from coopera.core.errors import ConfigError
from coopera.core.interview import Question
from coopera.graphs import STATE_TYPES, build_day_graph
from coopera.rundir.directory import RunDir
from coopera.studies.served import Choice, build_served_study
from coopera.studies.standing import serializer

ROOT = Path(__file__).parents[3]
THREAD: Any = {"configurable": {"thread_id": "served"}}
SERVED = build_served_study()


def test_langgraph_json_names_the_graph_and_the_classes_of_its_checkpoints() -> None:
    told = json.loads((ROOT / "langgraph.json").read_text(encoding="utf-8"))
    module, name = told["graphs"]["study"]["path"].split(":")
    assert (module, name) == (build_served_study.__module__, "study")
    allowed = told["checkpointer"]["serde"]["allowed_msgpack_modules"]
    assert sorted(allowed) == sorted([one.__module__, one.__name__] for one in STATE_TYPES)


def test_a_server_is_told_the_schemas_of_the_study_and_of_all_that_runs_inside() -> None:
    choice = SERVED.get_context_jsonschema()
    assert choice is not None
    assert all("default" in field for field in choice["properties"].values())
    inside = dict(SERVED.get_subgraphs(recurse=True))
    assert list(inside) == ["study", "study|day", "study|day|hour", "study|day|hour|human", "study|day|hour|robot"]
    for graph in inside.values():
        for schema in (graph.get_input_jsonschema(), graph.get_output_jsonschema(), graph.get_context_jsonschema()):
            assert json.dumps(schema)


def test_a_day_is_drawn_with_the_person_and_the_robot_in_it() -> None:
    drawn = build_day_graph().get_graph(xray=True).nodes
    assert {"hour:human:propose", "hour:robot:imagine_intentions", "hour:score", "feedback"} <= set(drawn)
    assert "hour:human:propose" not in build_day_graph().get_graph().nodes


def test_a_choice_that_cannot_be_is_refused_before_a_folder_is_made(tmp_path: Path) -> None:
    with pytest.raises(ValidationError, match="colour"):
        SERVED.invoke({"out": str(tmp_path / "run")}, context={"colour": "red"})  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match="there is no person 'nobody'"):
        SERVED.invoke({"out": str(tmp_path / "run")}, context=Choice(person="nobody"))
    assert not (tmp_path / "run").exists()


def test_a_served_person_is_asked_by_interrupts_and_again_where_an_answer_cannot_be_read(tmp_path: Path) -> None:
    graph = build_served_study(InMemorySaver(serde=serializer()))
    choice = Choice(played_by="me", hours=1)
    done = graph.invoke({"out": str(tmp_path / "run")}, THREAD, context=choice)
    asked: list[tuple[str, str]] = []
    while "__interrupt__" in done:
        assert RunDir.open(tmp_path / "run").state == "stopped"
        question = Question.model_validate(done["__interrupt__"][0].value)
        asked.append((question.kind, question.problem))
        answers: dict[str, Any] = {
            "intention": "Read a novel",
            "tasks": ["1 | sit and read | novel" if question.problem else "999 | sit | novel"],
            "feedback": ["yes"] * len(question.items),
        }
        done = graph.invoke(Command(resume=answers[question.kind]), THREAD, context=choice)
    wrong = asked.pop(2)
    assert asked == [("intention", ""), ("tasks", ""), ("feedback", "")]
    assert wrong[0] == "tasks"
    assert "no fixed object number 999" in wrong[1]
    run = RunDir.open(tmp_path / "run")
    assert run.state == "finished"
    assert done["summary"] == run.summary()
    assert [hour.human.intention.text for hour in run.hours() if hour.human] == ["Read a novel"]
