"""A study as LangGraph's own server and Studio run it: chosen by plain data, with services opened from that.

`langgraph.json` names `study`. What a run works with (homes, memories, models) cannot be sent to a server, so the
graph's context is a `Choice` of ids and numbers; each has a default, and a first run needs nothing at all. The run
directory is the same as with `coopera run`, and the study graph with its days, hours, person and robot runs inside.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from langgraph.checkpoint.base import BaseCheckpointSaver
from langgraph.errors import GraphInterrupt
from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime
from pydantic import Field
from typing_extensions import TypedDict

from coopera.config.schema import MAX_HOURS, Config, Models
from coopera.core.household import Collab
from coopera.core.people import Frozen
from coopera.graphs import build_study_graph
from coopera.graphs.inside import with_inside
from coopera.report.page import write_report
from coopera.studies.study import new_run, old_run, plan_days


class Choice(Frozen):
    """What a study is made of, by name; as it stands here, two hours of one person with the models that ship."""

    person: str = Field("amara", description="Id of a person (coopera humans list).")
    home: str = Field("maple", description="Id of a home (coopera scenes list).")
    model: str = Field("offline", description="The language model of every role, such as openai:MODEL.")
    base_url: str | None = Field(None, description="Address of an OpenAI-compatible server.")
    method: str = Field("ours", description="The robot's method (coopera list methods).")
    collab: Collab = Field(2, description="Type of collaboration, 1 or 2.")
    days: int = Field(1, ge=1, le=366, description="Days of the person's life.")
    hours: int = Field(2, ge=1, le=MAX_HOURS, description="Hours of each day, the first at 9 am.")
    seed: int = Field(0, ge=0, description="Every random draw derives from it.")
    pictures: Literal["sampled", "none"] = Field("none", description="Whether the first task of each hour is drawn.")
    played_by: Literal["simulated", "me"] = Field(
        "simulated", description="Who plays the person; with me, each question interrupts the run until it is answered."
    )

    def config(self, out: Path | None) -> Config:
        """The configuration of such a run, in a folder or the next free one."""
        return Config(
            setting=1,
            humans=[self.person],
            scenes=[self.home],
            models=Models(human=self.model, robot=self.model, judge=self.model),
            base_url=self.base_url,
            method=self.method,
            collab=self.collab,
            days=self.days,
            hours=self.hours,
            seed=self.seed,
            pictures=self.pictures,
            played_by=self.played_by,
            out=out,
        )


class ServedInput(TypedDict, total=False):
    """What starts a served study; it may be empty."""

    out: str  # the run directory; without it the next free runs/run-NNN


class ServedState(ServedInput, total=False):
    """State of a served study."""

    run: str  # by begin: the run directory
    summary: dict[str, Any]  # by study: the content of summary.json


def build_served_study(
    checkpointer: BaseCheckpointSaver[Any] | None = None,
) -> CompiledStateGraph[ServedState, Choice, ServedInput, ServedState]:
    """Compile the study for a server, which brings its own checkpointer; from Python give one to be interrupted."""
    graph = StateGraph(ServedState, context_schema=Choice, input_schema=ServedInput)
    graph.add_node(begin)
    graph.add_node("study", live)
    graph.add_edge(START, "begin")
    graph.add_edge("begin", "study")
    graph.add_edge("study", END)
    served = graph.compile(checkpointer=checkpointer, name="coopera")
    return with_inside(served, {"study": build_study_graph()})


def begin(state: ServedInput, runtime: Runtime[Choice]) -> dict[str, Any]:
    """Begin a run directory with what was chosen. Reads `out`; writes `run`.

    Raises:
        ConfigError: If there is no such person, home, model or method, or the folder cannot be written.
    """
    out = state.get("out", "").strip()
    with new_run((runtime.context or Choice()).config(Path(out) if out else None)) as (run, _):
        return {"run": str(run.root.resolve())}


def live(state: ServedState, runtime: Runtime[Choice]) -> dict[str, Any]:
    """Live the run's days; where a real person is asked, the run stops, and goes on with the answer.

    Reads `run`; writes `summary`.
    """
    with old_run(Path(state["run"])) as (run, services):
        try:
            build_study_graph().invoke({"schedule": plan_days(run.config)}, context=services)
        except GraphInterrupt as err:
            waits = err
        else:
            summary = run.finish()
            write_report(run)
            return {"summary": summary}
    raise waits


study = build_served_study()
