"""One hour in the home: the person lives it, the robot watches the first task and helps, and it is scored.

human -> demonstrate -> robot -> finish -> score -> record; without a robot, human -> finish -> record. The hour is the
unit of work: interrupted, it is done again as a whole and gives the same result, so its graphs keep no checkpoints.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import replace
from typing import Annotated, Any, NotRequired, Protocol, cast

from langgraph.graph import END, START, StateGraph
from langgraph.graph.state import CompiledStateGraph
from langgraph.runtime import Runtime
from typing_extensions import TypedDict

from coopera.core.clock import Clock
from coopera.core.errors import ModelOutputError
from coopera.core.hour import DayPlan, HourRecord, HumanHour, Observation, RobotHour, Success
from coopera.core.household import Outcome
from coopera.core.people import Belief, PersonId
from coopera.core.protocols import Home
from coopera.core.randomness import Address
from coopera.graphs.earlier_life import Shown
from coopera.graphs.human import HumanInput, HumanState, build_human_graph, human_hour
from coopera.graphs.identity import identify, sight
from coopera.graphs.robot import (
    OracleInput,
    RobotInput,
    RobotState,
    build_own_robot_graph,
    build_robot_graph,
    robot_hour,
)
from coopera.graphs.services import HumanContext, RobotContext, Services
from coopera.graphs.traits import guesses, revise
from coopera.simulation.acts.state import digest


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


_ALONE = {"human": "finish", "finish": "record"}
"""What comes next where there is no robot."""


class Node(Protocol):
    """A node of the hour."""

    def __call__(self, state: HourState, *, runtime: Runtime[Services]) -> dict[str, Any]:
        """Return a partial update of the state."""
        ...


def build_hour_graph() -> CompiledStateGraph[HourState, Services, HourInput, HourState]:
    """Compile the hour; a reply that cannot be read ends it early, as failed, and it is recorded all the same."""
    human, robot, own = build_human_graph(), build_robot_graph(), build_own_robot_graph()
    oracle = build_robot_graph(OracleInput)

    def live(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
        if runtime.context.lived:
            again = runtime.context.lived.hour(state["plan"], _clock(state).hour)
            return {"human": again.human} if again.human else {"failure": again.reason}
        ctx = human_context(runtime.context, state["plan"])
        ctx.memories.forget_from(_clock(state).now)
        ctx = replace(ctx, logged=runtime.context.logged(state["plan"], _clock(state)))
        given = HumanInput(clock=_clock(state), hours=state["plan"].hours)
        return {"human": human_hour(cast(HumanState, human.invoke(given, context=ctx)))}

    def help_person(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
        plan, guessed = state["plan"], _with_whom(state, runtime.context)
        ctx = robot_context(runtime.context, plan, guessed)
        ctx.guesses.forget_from(_clock(state).now)
        belief = state["belief"] if ctx.person == plan.person else state.get("beliefs", {}).get(ctx.person, Belief())
        if runtime.context.hourly_traits and ctx.method.traits:
            belief = _revised(runtime.context, plan, _clock(state), ctx.person, belief)
        given = RobotInput(clock=_clock(state), observation=state["observation"], belief=belief)
        helper = robot if ctx.own is None else own
        if ctx.method.intentions == "given":
            helper, given = oracle, OracleInput(**given, true_intention=state["human"].intention.text)
        helped = robot_hour(cast(RobotState, helper.invoke(given, context=ctx)))
        believed = belief if runtime.context.hourly_traits else None
        return {"robot": helped.model_copy(update={"with_whom": guessed, "belief": believed})}

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
        graph.add_node(name, _failing(node))
        alone = _ALONE.get(name, after)
        graph.add_conditional_edges(name, _goes_on_to(after, alone), sorted({after, alone, "record"}))
    graph.add_node("record", record)
    graph.add_edge("record", END)
    return graph.compile(checkpointer=False, name="hour")


def demonstrate(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Have the person do the first task while the robot watches. Writes `observation`.

    The robot gets sampled frames, in type 1 the task's text too (PAPER §3.1), and, where its model cannot look at
    beliefs, what a perception module reports.
    """
    services, plan, clock = runtime.context, state["plan"], _clock(state)
    home, first = services.home(plan.scene), state["human"].tasks[0]
    keeps = services.lived if not services.frames else None
    if keeps and (shown := keeps.shown(plan, clock.hour)):
        home.restore(shown.world)
        return {"observation": shown.observation, "outcomes": [shown.outcome]}
    outcome = home.perform(services.human_agent, first.act, record=True, watcher=services.robot_agent)
    frames = []
    if services.frames:
        folder = services.recorder.frames_folder(plan.day, clock.hour)
        frames = [services.relative(path) for path in home.frames(services.frames, folder)]
    if services.video:
        home.film(services.recorder.video_file(plan.day, clock.hour))
    blind = not services.ask.sees("robot")
    percept = home.percept(services.rng(Address(plan.person, clock.day, clock.hour, "percept"))) if blind else None
    text = first.act.describe() if plan.collab == 1 else None
    observation = Observation(frames=frames, percept=percept, first_task=text)
    if keeps:
        keeps.keep(plan, clock.hour, Shown(observation=observation, outcome=outcome, world=home.snapshot()))
    return {"observation": observation, "outcomes": [outcome]}


def finish(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Have the person do what is left, except what the robot has done. Adds to `outcomes`.

    In a day that was lived before, what came of the person's acts is known.
    """
    home, who = runtime.context.home(state["plan"].scene), runtime.context.human_agent
    helped = state["robot"].outcomes if "robot" in state else []
    done = {_effect(home, outcome) for outcome in helped if outcome.ok}
    shown = 1 if "observation" in state else 0
    remaining = [Outcome(agent=who, act=task.act, ok=True) for task in state["human"].tasks]
    if runtime.context.lived:
        again = runtime.context.lived.hour(state["plan"], _clock(state).hour)
        remaining = [Outcome.model_validate(one) for one in again.world["outcomes"]]
    mine = [one for one in remaining[shown:] if _effect(home, one) not in done]
    return {"outcomes": mine if runtime.context.lived else [home.perform(who, one.act) for one in mine]}


def score(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Judge the robot's tasks against the person's remaining ones. Completes `robot`; writes `success`."""
    services, plan, human, robot = runtime.context, state["plan"], state["human"], state["robot"]
    at = Address(plan.person, _clock(state).day, _clock(state).hour, "score")
    home, remaining = services.home(plan.scene), human.tasks[1:]
    tasks, success = services.score(home, at, human.intention, remaining, robot.tasks, robot.outcomes)
    return {"robot": robot.model_copy(update={"tasks": tasks}), "success": success}


def record(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
    """Remember the hour and write its trace: the last act of an hour. Writes `world`."""
    services, plan, clock = runtime.context, state["plan"], _clock(state)
    human, robot = state.get("human"), state.get("robot")
    if human and not services.lived:
        texts = [task.act.describe() for task in human.tasks]
        services.memories("human", plan.episode, plan.person).add(human.intention.text, texts, clock.now)
    if robot:
        _remember_guess(services, plan, clock, robot)
    if services.lived:
        services.home(plan.scene).restore(services.lived.hour(plan, clock.hour).world["poses"])
    world = services.home(plan.scene).snapshot()
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
        )
    )
    runtime.stream_writer(
        {"day": plan.day, "hour": clock.hour, "node": "record", "success": success.model_dump() if success else None}
    )
    return {"world": world}


def human_context(services: Services, plan: DayPlan) -> HumanContext:
    """The person's services for a day."""
    return HumanContext(
        ask=services.ask,
        persona=services.people[plan.person],
        collab=plan.collab,
        home=services.home(plan.scene),
        memories=services.memories("human", plan.episode, plan.person),
        embeddings=services.embeddings,
        model=services.person,
        sizes=services.sizes,
        interview=services.interview,
    )


def robot_context(services: Services, plan: DayPlan, guessed: PersonId | None = None) -> RobotContext:
    """The robot's services for a day: what it may know of the person, or of the one that it takes them for."""
    person = guessed or plan.person
    return RobotContext(
        ask=services.ask,
        person=person,
        collab=plan.collab,
        method=services.method,
        home=services.home(plan.scene),
        history=services.memories("history", plan.episode, person),
        guesses=services.memories("guesses", plan.episode, person),
        learner=services.learner,
        own=services.own.robot if services.own else None,
        images=services.recorder.root,
        agent=services.robot_agent,
    )


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


def _remember_guess(services: Services, plan: DayPlan, clock: Clock, robot: RobotHour) -> None:
    for guess in guesses([(clock.hour, robot)], plan.episode_day * 24):
        services.memories("guesses", plan.episode, robot.with_whom or plan.person).add(
            guess.intention, guess.tasks, guess.now
        )


def _effect(home: Home, outcome: Outcome) -> tuple[str, ...]:
    act = outcome.act
    if act.kind == "pick_place":
        return ("on", home.class_of(act.object), home.class_of(act.receptacle))
    return (outcome.agent, act.describe())


def _clock(state: HourInput) -> Clock:
    return state["plan"].clock(state["position"])


def _failing(node: Node) -> Node:
    def run(state: HourState, runtime: Runtime[Services]) -> dict[str, Any]:
        try:
            return node(state, runtime=runtime)
        except ModelOutputError as err:
            return {"failure": str(err)}

    return run


def _goes_on_to(after: str, alone: str) -> Callable[[HourState, Runtime[Services]], str]:
    def route(state: HourState, runtime: Runtime[Services]) -> str:
        if "failure" in state:
            return "record"
        return after if runtime.context.method.robot else alone

    return route
