"""One hour in the home: the person lives it, the robot watches the first task and helps, and it is scored.

human -> demonstrate -> robot -> finish -> score -> record; without a robot, human -> finish -> record; while the person
is away, human -> record. The hour is the
unit of work: interrupted, it is done again as a whole and gives the same result, so its graphs keep no checkpoints.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Annotated, Any, NotRequired, Protocol, cast

from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime
from langgraph.types import Command
from typing_extensions import TypedDict

from coopera.core.clock import Clock
from coopera.core.errors import HourError, ModelOutputError
from coopera.core.hour import DayPlan, HourRecord, HumanHour, Intention, Observation, RobotHour
from coopera.core.household import Act, AgentId, Outcome
from coopera.core.lazy import made_once
from coopera.core.people import Belief, PersonId
from coopera.core.protocols import Home
from coopera.core.randomness import Address
from coopera.core.success import Success
from coopera.graphs.events import say
from coopera.graphs.human import build_human_graph
from coopera.graphs.inside import with_inside
from coopera.graphs.recorded import remember_guess
from coopera.graphs.robot import (
    OracleInput,
    OwnRobotContext,
    RobotContext,
    RobotInput,
    RobotState,
    build_own_robot_graph,
    build_robot_graph,
    robot_hour,
)
from coopera.graphs.robots.identity import identify, sight
from coopera.graphs.robots.robot_view import HomeView, RobotView, robots_door
from coopera.graphs.robots.sight import agreeing
from coopera.graphs.robots.traits import guesses, revise
from coopera.graphs.services import Services
from coopera.simulation.state.snapshots import digest


class HourInput(TypedDict):
    """What starts an hour."""

    plan: DayPlan
    position: int
    belief: Belief
    beliefs: NotRequired[dict[PersonId, Belief]]


class HourState(HourInput, total=False):
    """Working state of the hour; the person's truth lives here and is never handed to the robot's graph."""

    human: HumanHour  # by human
    observation: Observation  # by demonstrate
    robot: RobotHour  # by robot, completed by score
    outcomes: Annotated[list[Outcome], operator.add]  # by demonstrate and finish: what the person did
    success: Success  # by score
    failure: str  # by whichever node failed
    world: dict[str, Any]  # by record: the snapshot


_robot = made_once()(build_robot_graph)
_oracle = made_once()(lambda: build_robot_graph(OracleInput))
_own_robot = made_once()(build_own_robot_graph)

_ALONE = {"human": "finish", "finish": "record"}
"""What comes next where there is no robot."""


class Node(Protocol):
    """A node of the hour."""

    def __call__(self, state: HourState, *, runtime: Runtime[Services]) -> dict[str, Any]:
        """Return a partial update of the state."""
        ...


class Step(Protocol):
    """A node that says what comes next, too."""

    def __call__(self, state: HourState, *, runtime: Runtime[Services]) -> Command[str]:
        """Return a partial update of the state, and the next node."""
        ...


def build_hour_graph() -> CompiledStateGraph[HourState, Services, HourInput, HourState]:
    """Compile the hour; a reply that cannot be read ends it early, as failed, and it is recorded all the same."""
    graph = StateGraph(HourState, context_schema=Services, input_schema=HourInput)
    nodes: dict[str, Node] = {
        "human": live,
        "demonstrate": demonstrate,
        "robot": help_person,
        "finish": finish,
        "score": score,
    }
    graph.add_edge(START, "human")
    for (name, node), after in zip(nodes.items(), [*list(nodes)[1:], "record"], strict=True):
        alone = _ALONE.get(name, after)
        graph.add_node(name, _going_on(node, after, alone), destinations=tuple(sorted({after, alone, "record"})))
    graph.add_node("record", record)
    graph.add_edge("record", END)
    hours = graph.compile(checkpointer=False, name="hour")
    return with_inside(hours, {"human": build_human_graph(), "robot": _robot()})


def live(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Have the person decide what to do. Writes `human`."""
    return {"human": runtime.context.life.decide(runtime.context, state["plan"], _clock(state))}


def demonstrate(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Have the person do the first task while the robot watches. Writes `observation`; adds to `outcomes`."""
    services, first = runtime.context, state["human"].tasks[0]
    seen, outcome = services.life.show(services, state["plan"], _clock(state), first)
    return {"observation": seen, "outcomes": [outcome]}


def help_person(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Have the robot help. Reads `observation` and the beliefs; writes `robot`."""
    services, plan, clock = runtime.context, state["plan"], _clock(state)
    guessed = _with_whom(state, services)
    person = guessed or plan.person
    services.memories("guesses", plan.episode, person).forget_from(clock.now)
    belief = state["belief"] if person == plan.person else state.get("beliefs", {}).get(person, Belief())
    if services.hourly_traits and services.method.traits:
        belief = _revised(services, plan, clock, person, belief)
    view = robot_view(services, plan, clock, state["observation"], belief, person)
    helped = _helped(services, plan, view, state["human"].intention)
    believed = belief if services.hourly_traits else None
    return {"robot": helped.model_copy(update={"with_whom": guessed, "belief": believed})}


def finish(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Have the person do what is left, except what the robot has done. Adds to `outcomes`."""
    services, plan = runtime.context, state["plan"]
    home = services.home(plan.scene)
    helped = state["robot"].outcomes if "robot" in state else []
    done = {_effect(home, one.agent, one.act) for one in helped if one.ok}
    shown = 1 if "observation" in state else 0
    left = [task for task in state["human"].tasks[shown:] if _effect(home, services.human_agent, task.act) not in done]
    return {"outcomes": services.life.finish(services, plan, _clock(state), left)}


def score(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Judge the robot's tasks against the person's remaining ones. Completes `robot`; writes `success`.

    What somebody would have to wait for is asked in the evening (`coopera.graphs.day.feedback`).
    """
    services, plan, human, robot = runtime.context, state["plan"], state["human"], state["robot"]
    at = scored_at(plan, _clock(state).hour)
    home, remaining = services.home(plan.scene), human.tasks[1:]
    tasks, success = services.score(home, at, human.intention, remaining, robot.tasks, robot.outcomes)
    return {"robot": robot.model_copy(update={"tasks": tasks}), "success": success}


def record(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Remember the hour and write its trace: the last act of an hour. Writes `world`."""
    services, plan, clock = runtime.context, state["plan"], _clock(state)
    human, robot = state.get("human"), state.get("robot")
    services.life.end(services, plan, clock, human)
    if robot:
        remember_guess(services, plan, clock, robot)
    home = services.home(plan.scene)
    world = home.snapshot()
    success = state.get("success")
    services.recorder.write_hour(
        HourRecord(
            day=plan.day,
            episode=plan.episode,
            episode_day=plan.episode_day,
            hour=clock.hour,
            person=plan.person,
            scene=plan.scene,
            human=human,
            robot=robot,
            world={
                "outcomes": [o.model_dump() for o in state.get("outcomes", [])],
                "watched": "observation" in state,
                "poses": world,
                "sha256": digest(world),
            },
            success=success,
            status="failed" if "failure" in state else "ok",
            reason=state.get("failure", ""),
            calls=services.ask.take_calls(),
        ),
        after=home.frames_due(),  # an hour that stands has all its pictures
    )
    say(plan.day, clock.hour, success.model_dump() if success else None)
    return {"world": world}


def scored_at(plan: DayPlan, hour: int) -> Address:
    """The address of an hour's measures, whenever they are taken."""
    return Address(plan.person, plan.episode_day, hour, "score")


def robot_view(
    services: Services, plan: DayPlan, clock: Clock, seen: Observation, belief: Belief, person: PersonId
) -> RobotView:
    """What the robot may know of an hour with a person, or with the one that it takes them for."""
    return RobotView(
        clock=clock,
        observation=agreeing(seen),
        pictures=tuple(services.recorder.root / frame for frame in seen.frames),
        person=person,
        belief=belief,
        collab=plan.collab,
        home=HomeView.of(services.home(plan.scene), services.robot_agent),
        history=services.memories("history", plan.episode, person).to_read(),
        guesses=services.memories("guesses", plan.episode, person).to_read(),
        ask=robots_door(services.ask),
        looks=services.ask.sees("robot"),
    )


def _helped(services: Services, plan: DayPlan, view: RobotView, truth: Intention) -> RobotHour:
    """Run the graph of the method's robot; the truth reaches the method that declares it, and no other."""
    home, method, who = services.home(plan.scene), services.method, services.robot_agent
    film = _filming(services, home, view)
    if services.own:
        ours = OwnRobotContext(view, home, method, services.own.robot, agent=who, film=film)
        done = _own_robot().invoke(RobotInput(), context=ours)
    elif method.intentions == "given":
        told = OracleInput(true_intention=truth.text)
        done = _oracle().invoke(told, context=RobotContext(view, home, method, services.learner, agent=who, film=film))
    else:
        context = RobotContext(view, home, method, services.learner, agent=who, film=film)
        done = _robot().invoke(RobotInput(), context=context)
    return robot_hour(cast(RobotState, done), view.observation)


def _filming(services: Services, home: Home, view: RobotView) -> Callable[[int], None] | None:
    """What keeps pictures of the robot's acts beside those of the first task; the robot is never shown them."""
    if not view.pictures or not services.help_frames:
        return None

    def film(number: int) -> None:
        home.frames(services.help_frames, view.pictures[0].parent, f"help-{number}", wait=False)

    return film


def _with_whom(state: HourState, services: Services) -> PersonId | None:
    """Guess the person from what was seen today; None where the robot is told, as on the first day with somebody."""
    plan, clock = state["plan"], _clock(state)
    if services.identity_known:
        return None
    dawn = plan.episode_day * 24
    known = {}
    for person in sorted(services.people):
        memories = services.memories("history", plan.episode, person)
        if memories.intentions.recall("the day", max(dawn - 1, 0), 1):
            known[person] = memories
    if plan.person not in known:
        return None
    before = [
        sight(Clock(day=plan.episode_day, hour=hour.hour), hour.robot.observation)
        for hour in services.recorder.read_day(plan.day)
        if hour.robot is not None and hour.hour < clock.hour
    ]
    likely = identify([*before, sight(clock, state["observation"])], known)
    return max(likely, key=lambda person: likely[person])


def _revised(services: Services, plan: DayPlan, clock: Clock, person: PersonId, before: Belief) -> Belief:
    """The belief about the person in the light of today's guesses; one that cannot be read leaves it as it was."""
    helped = [
        (hour.hour, hour.robot)
        for hour in services.recorder.read_day(plan.day)
        if hour.robot and hour.hour < clock.hour and (hour.robot.with_whom or plan.person) == person
    ]
    past = guesses(helped, plan.episode_day * 24)
    if not past:
        return before
    at = Address(person, clock.day, clock.hour, "infer_traits")
    try:
        return revise(services.ask, at, clock, past, before, evening=False)[0]
    except ModelOutputError:
        return before


def _effect(home: Home, agent: AgentId, act: Act) -> tuple[str, ...]:
    if act.kind == "pick_place":
        return (act.relation, home.class_of(act.object), home.class_of(act.receptacle))
    return (agent, act.describe())


def _clock(state: HourInput) -> Clock:
    return state["plan"].clock(state["position"])


def _going_on(node: Node, after: str, alone: str) -> Step:
    """The node, then `after` or, without a robot, `alone`; the record where it failed, or where nobody is at home.

    For an edge with a condition of its own LangGraph reads all of the state once more.
    """

    def run(state: HourState, *, runtime: Runtime[Services]) -> Command[str]:
        try:
            update = node(state, runtime=runtime)
        except HourError as err:
            return Command(update={"failure": str(err)}, goto="record")
        human: HumanHour = update.get("human") or state["human"]
        at_home = after if runtime.context.method.robot else alone
        return Command(update=update, goto="record" if human.intention.away else at_home)

    return run
