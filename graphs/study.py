"""A study: days in the order that the setting prescribes, one supervisor over the day graph."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

from langchain_core.runnables import RunnableConfig
from langgraph.checkpoint.base import BaseCheckpointSaver
from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime
from langgraph.types import Command, StateSnapshot
from typing_extensions import TypedDict

from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, FeedbackItem, ModelCall
from coopera.core.household import SceneId
from coopera.core.interview import Answer, Question
from coopera.core.people import Belief, BigFive, PersonId
from coopera.graphs.day import build_day_graph
from coopera.graphs.services import Services

STATE_TYPES: tuple[type, ...] = (BigFive, Clock, DayPlan, FeedbackItem, ModelCall, Belief)
"""The classes that stand in checkpoints; a checkpointer's serialiser must be given them."""


class StudyInput(TypedDict):
    """What starts a study."""

    schedule: list[DayPlan]


class StudyState(StudyInput, total=False):
    """State of a study; the keys of `DayInput` are the day graph's to read and write."""

    ahead: int  # by next_day: how many days have been started
    plan: DayPlan  # by next_day
    worlds: dict[SceneId, dict[str, Any]]
    beliefs: dict[PersonId, Belief]
    learned: list[int]


def build_study_graph(
    checkpointer: BaseCheckpointSaver[Any] | None = None,
) -> CompiledStateGraph[StudyState, Services, StudyInput, StudyState]:
    """Compile the study; invoke it with `{"schedule": [...]}`, or with None to go on from its checkpoint.

    Give the checkpointer `STATE_TYPES`, and leave `durability` at "async": "sync" breaks the uncheckpointed graphs
    within the hour (a fault of LangGraph 1.2.22), and nothing is lost, since a lost hour is done again.
    """
    graph = StateGraph(StudyState, context_schema=Services, input_schema=StudyInput)
    graph.add_node(next_day)
    graph.add_node("day", build_day_graph())
    graph.add_conditional_edges(START, has_days, {"next_day": "next_day", "done": END})
    graph.add_edge("next_day", "day")
    graph.add_conditional_edges("day", has_days, {"next_day": "next_day", "done": END})
    return graph.compile(checkpointer=checkpointer, name="study")


class Waiting(NamedTuple):
    """A question that interrupted a study, and the id by which its answer is handed in."""

    id: str
    question: Question

    def answered(self, answer: Answer) -> Command[Any]:
        """What to invoke the study with, to go on from the question."""
        return Command(resume={self.id: answer})


def waiting(
    graph: CompiledStateGraph[StudyState, Services, StudyInput, StudyState], thread: RunnableConfig
) -> Waiting | None:
    """The question that a study waits with, or None.

    Answers must be handed in by id: one that is not stays behind in the checkpoint, and LangGraph 1.2.22 would take it
    for the answer to the next question when the study goes on in another process.
    """
    state = graph.get_state(thread, subgraphs=True)
    while state.tasks and isinstance(inner := state.tasks[0].state, StateSnapshot) and inner.tasks:
        state = inner
    found = [one for task in state.tasks for one in task.interrupts]
    return Waiting(found[0].id, Question.model_validate(found[0].value)) if found else None


def next_day(state: StudyState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Take the next plan; a new episode starts with a robot that knows nobody and homes as they were built."""
    ahead = state.get("ahead", 0)
    plan = state["schedule"][ahead]
    update: dict[str, Any] = {"ahead": ahead + 1, "plan": plan}
    if ahead == 0 or state["schedule"][ahead - 1].episode != plan.episode:
        update |= {"worlds": {}, "beliefs": {}, "learned": []}
    return update


def has_days(state: StudyState) -> Literal["next_day", "done"]:
    """Go on until the schedule is lived."""
    return "next_day" if state.get("ahead", 0) < len(state["schedule"]) else "done"
