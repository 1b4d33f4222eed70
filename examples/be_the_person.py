"""Be the person: the day graph stops at each question with LangGraph's `interrupt`, and goes on with your answer.

.venv/bin/python examples/be_the_person.py

An answer that cannot be read is asked for again. Tasks and the evening's answers are given line by line, with an empty
line at the end.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

from langgraph.checkpoint.memory import InMemorySaver
from langgraph.types import Command

from coopera import Config
from coopera.core.interview import Answer, Question
from coopera.graphs import build_day_graph, first_day
from coopera.graphs.players.stated import Interviewed
from coopera.studies.standing import serializer
from coopera.studies.study import new_run, plan_days


def answer(question: Question) -> Answer:
    """Show a question and read the answer."""
    print(f"\n{question.time}: {question.kind}? {question.problem}")
    print("\n".join([*question.items, *list(question.places)[:8]]))
    if question.kind == "intention":
        return input("> ")
    return list(iter(lambda: input("> "), ""))


def main() -> None:
    """Live one hour and its evening."""
    graph = build_day_graph(InMemorySaver(serde=serializer()))
    thread = {"configurable": {"thread_id": "my day"}}
    with tempfile.TemporaryDirectory() as folder:
        config = Config(days=1, hours=1, pictures="none", out=Path(folder) / "run")
        with new_run(config) as (run, services):
            services = replace(services, player=Interviewed())
            done = graph.invoke(first_day(plan_days(run.config)[0]), thread, context=services)
            while "__interrupt__" in done:
                asked = done["__interrupt__"][0]
                try:
                    said = answer(Question.model_validate(asked.value))
                except EOFError:
                    print("Nobody answers; with a checkpointer on file the graph would wait.")
                    return
                done = graph.invoke(Command(resume={asked.id: said}), thread, context=services)
            for hour in run.hours():
                print(hour.human and [task.act.describe() for task in hour.human.tasks])


if __name__ == "__main__":
    main()
