"""Does the home keep its word? `python -m benchmarks.truth [--scenes …] [--robots …] [--commands N] [--seed S]`.

Random commands, many of them odd, to a person and to each robot in one life of each home. After every command the home
is looked at as it can be drawn, whatever the command said of itself: every thing in one place, nothing floats, overlaps
or sticks through what carries it, nobody and nothing is anywhere but where legs and hands brought it, nobody walks
through furniture or through somebody else, and what is done at furniture is done within reach of it. What is refused
has a reason of one sentence, and has changed nothing. A home restored from a snapshot goes on as the one that it was
taken of, and all the commands given to a new home lead to the same state. Exit status 1 where any of it does not hold.
"""

from __future__ import annotations

import argparse
import json
import math
import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from benchmarks.random_commands import Answer, Command, Commander, as_told, carry_out
from coopera.core.affordances import affordances
from coopera.core.household import Act, AgentId, FreeMotion
from coopera.simulation import World, list_scenes, load_scene
from coopera.simulation.acts.handing import HANDING
from coopera.simulation.acts.plans import Give, Handle, Open, Plan, Play, Walk, discs
from coopera.simulation.acts.primitives import Result
from coopera.simulation.bodies.robot import usable_robots
from coopera.simulation.homes.catalogue import blocks, parts_of
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.shapes.kit import Part
from coopera.simulation.shapes.rotations import Array, matrix
from coopera.simulation.sight.watching import Onlooker
from coopera.simulation.state.home_state import HomeState
from coopera.simulation.state.snapshots import digest
from coopera.simulation.state.truth import problems
from coopera.simulation.ways.navigation import RADIUS, Disc, clearance, obstacle_boxes, to_segment

REACH = 1.05
"""Farthest on the floor plan from where one stands that a hand takes or puts something, in metres."""
STANDING, SEATED, LOOKING, ROOMY = 0.8, 1.0, 5.0, 1.5
"""Farthest from furniture at which something is done there: by a body, from a seat, seeing it, with free floor."""
THROUGH = 0.02
"""How far a thing may stick into a part of what carries it, in metres."""
SLACK = 0.03
EVERY, THEN = 50, 5
"""After every so many commands a second home takes the state over, and is given as many as the second number says."""


@dataclass
class Tally:
    """What came of the commands."""

    given: int = 0
    done: int = 0
    refused: Counter[str] = field(default_factory=Counter)
    violations: list[str] = field(default_factory=list)


class Watched(World):
    """A home that remembers what was planned last in it, step by step."""

    last: Plan | None = None

    def _step(self, agent: AgentId, plan: Callable[[], Plan]) -> Result:
        return super()._step(agent, lambda: self._kept(plan()))

    def _plan(self, agent: AgentId, act: Act, watch: Onlooker | None) -> Plan:
        return self._kept(super()._plan(agent, act, watch))

    def _kept(self, plan: Plan) -> Plan:
        self.last = plan
        return plan


def attack(scene: str, robot: str, count: int, seed: int) -> Tally:
    """Give random commands in one home, and look at it after each."""
    tally, given = Tally(), list[Command]()
    with Watched(load_scene(scene), robot=robot) as world, World(load_scene(scene), robot=robot) as other:
        commander, twin = Commander(world, seed), None
        for number in range(count):
            if number % EVERY == 0:
                other.restore(json.loads(json.dumps(world.snapshot())))
                twin = other
            command, before, world.last = commander.command(), world.state, None
            answer = carry_out(world, command)
            given.append(command)
            tally.given += 1
            tally.done += answer.ok
            if not answer.ok:
                tally.refused[re.sub(r"'[^']*'|\([^)]*\)", "…", answer.reason)[:70]] += 1
            found = list(violations(world, before, command, world.last, answer))
            if twin is not None and not found:
                found = parted(world, twin, command, answer)
            twin = twin if number % EVERY < THEN - 1 and not found else None
            tally.violations += [f"{number}: {command}: {one}" for one in found]
            if found:  # what is wrong already is said once
                world.restore(before.model_dump(mode="json"))
                given.pop()
        last = digest(world.snapshot())
    if relived(scene, robot, given) != last:
        tally.violations.append("the same commands lead a new home to another state")
    return tally


def parted(world: World, twin: World, command: Command, answer: Answer) -> list[str]:
    """Whether a home restored from a snapshot does the same as the one that it was taken of."""
    same = as_told(carry_out(twin, command)) == as_told(answer) and digest(twin.snapshot()) == digest(world.snapshot())
    return [] if same else ["a home restored from a snapshot does something else"]


def relived(scene: str, robot: str, given: list[Command]) -> str:
    """The digest of a new home after the same commands."""
    with World(load_scene(scene), robot=robot) as world:
        for command in given:
            carry_out(world, command)
        return digest(world.snapshot())


def violations(world: World, before: HomeState, command: Command, plan: Plan | None, answer: Answer) -> Iterator[str]:
    """What does not hold after a command."""
    scene, after = world.layout, world.state
    if answer.raised:
        yield f"raises {answer.raised}"
    if not answer.ok:
        yield from refusal(before, after, answer.reason)
        return
    if command.kind.startswith("restore "):
        yield "a damaged snapshot is taken"
        return
    yield from problems(scene, after, world._ground.navigator)
    if plan is None:
        return
    yield from walks(scene, before, after, plan)
    yield from carried(scene, before, after, plan)
    for name, where in after.moved.items():
        if before.moved.get(name) != where and where.on is not None:
            yield from through(scene, after, name)
    if isinstance(command.what, FreeMotion):
        yield from reach(scene, after, command.agent, command.what)
    actor = command.agent
    went = plan.metres if command.kind.startswith("tool ") else answer.metres
    if math.dist(before.agents[actor].spot, after.agents[actor].spot) > went + SLACK:
        yield f"{actor} gets farther than the {went} m that it says it went"


def refusal(before: HomeState, after: HomeState, reason: str) -> Iterator[str]:
    """What is wrong with a refusal."""
    if before != after:
        yield "it is refused, and the home has changed"
    if not reason.endswith(".") or "\n" in reason or re.search(r"[.!?] [A-Z]", reason) or len(reason) > 400:
        yield f"the reason is no sentence: {reason[:90]!r}"


def walks(scene: Scene, before: HomeState, after: HomeState, plan: Plan) -> Iterator[str]:
    """Walks that start elsewhere than the walker is, or lead through something; things given from afar; and jumps."""
    boxes = obstacle_boxes((thing for thing in scene.fixed if blocks(thing)), scene.walls())
    spots = {agent: body.spot for agent, body in before.agents.items()}
    places = {agent: body.place for agent, body in before.agents.items()}
    floor = {agent: discs(before, agent) for agent in before.agents}
    for step in plan.steps:
        if isinstance(step, Give):
            gap = math.dist((step.stand.x, step.stand.y), places[step.receiver])
            if not HANDING[0] - SLACK <= gap <= HANDING[1] + SLACK:
                yield f"{step.thing} is handed over at {gap:.2f} m"
        elif isinstance(step, Play):
            places[step.agent] = step.person.place
        elif isinstance(step, Walk):
            if math.dist(step.points[0], spots[step.agent]) > SLACK:
                yield f"{step.agent} starts a walk elsewhere than they are"
            yield from _walk(step, boxes, floor)
            spots[step.agent] = places[step.agent] = step.points[-1]
            floor[step.agent] = [Disc(*step.points[-1])]
    for agent, body in after.agents.items():
        if math.dist(body.spot, spots[agent]) > SLACK:
            yield f"{agent} is {math.dist(body.spot, spots[agent]):.2f} m from where their walks lead"


def _walk(walk: Walk, boxes: Array, floor: dict[AgentId, list[Disc]]) -> Iterator[str]:
    """What a walk leads through: furniture, walls, or the floor that others take up."""
    legs = list(zip(walk.points, walk.points[1:], strict=False))
    line = np.concatenate([np.linspace(a, b, 2 + int(math.dist(a, b) / 0.05)) for a, b in legs])
    least = float(clearance(line[1:, 0], line[1:, 1], boxes).min())
    if least < RADIUS - SLACK:
        yield f"{walk.agent} walks {RADIUS - least:.2f} m into furniture or a wall"
    for other, taken in floor.items():
        for disc in taken if other != walk.agent else ():
            start = math.dist(walk.points[0], (disc.x, disc.y))
            least = min(float(to_segment(np.array([(disc.x, disc.y)]), a, b)[0]) for a, b in legs)
            if least < min(disc.radius + RADIUS, start) - SLACK:
                yield f"{walk.agent} walks through {other}"


def carried(scene: Scene, before: HomeState, after: HomeState, plan: Plan) -> Iterator[str]:
    """Things that are elsewhere without a hand that took them there."""
    given = {step.thing: step for step in plan.steps if isinstance(step, Give)}
    things = {thing.name: thing for state in (before, after) for thing in state.objects(scene)}
    for name, thing in things.items():
        old, new = _whereabouts(before, thing), _whereabouts(after, thing)
        if old == new or _goes_along(before, after, things, name):
            continue
        if not isinstance(old, str) and not _handled(plan, name, old, puts=False):
            yield f"nobody's hand takes {name} from where it was"
        for state in (before, after):
            yield from _through_a_door(scene, state, plan, name)
        if not isinstance(new, str) and not _handled(plan, name, new, puts=True):
            yield f"nobody's hand puts {name} where it is"
        if old in after.agents and new in after.agents:
            step = given.get(name)
            if step is None or (step.receiver if step.back else step.agent) != old:
                yield f"nobody hands {name} over"


def _through_a_door(scene: Scene, state: HomeState, plan: Plan, name: str) -> Iterator[str]:
    """Whether a thing got out of, or into, something closed that nobody opened."""
    around = state.find(scene, state.moved[name].inside or "") if name in state.moved else None
    if around is None or state.condition(around).get("open", True):
        return
    if not any(isinstance(step, Open) and step.name == around.name and step.opens for step in plan.steps):
        yield f"{name} gets through the closed {around.name}"


def _handled(plan: Plan, name: str, place: tuple[float, ...], *, puts: bool) -> bool:
    """Whether somebody takes a thing from a place, or puts it there, standing within reach."""
    return any(
        isinstance(step, Handle)
        and step.name == name
        and (step.put is not None) == puts
        and math.dist((step.stand.x, step.stand.y), place[:2]) <= REACH
        for step in plan.steps
    )


def _whereabouts(state: HomeState, thing: SceneObject) -> tuple[float, ...] | str:
    """A place, the agent that bears the thing, or "" where it is in the magic box."""
    bearer = state.bearer(thing.name)
    if bearer is not None:
        return str(bearer)
    out = thing.room == "" and thing.name not in state.box
    return "" if out else state.thing(thing).position


def _goes_along(before: HomeState, after: HomeState, things: dict[str, SceneObject], name: str) -> bool:
    """Whether a thing lies as it lay inside another, which may have been carried about."""
    where = before.moved.get(name)
    return where is not None and where == after.moved.get(name) and where.inside in things


def through(scene: Scene, state: HomeState, name: str) -> Iterator[str]:
    """Parts of what carries a thing that it sticks into, in the carrier's frame."""
    where, thing = state.moved[name], state.find(scene, name)
    carrier = scene.object(where.on or "")
    if carrier is None or thing is None:
        return
    x, y = carrier.to_local(*where.position[:2])
    z, turn = where.position[2] - carrier.position[2], where.yaw - carrier.yaw
    cos, sin = abs(math.cos(turn)), abs(math.sin(turn))
    half = ((thing.size[0] * cos + thing.size[1] * sin) / 2, (thing.size[0] * sin + thing.size[1] * cos) / 2)
    middle, size = np.array((x, y, z + thing.size[2] / 2)), np.array((*half, thing.size[2] / 2))
    for part in parts_of(carrier.cls, carrier.size, carrier.rgb):
        deep = (size + _half(part) - np.abs(middle - np.array(part.position))).min()
        if deep > THROUGH:
            yield f"{name} sticks {deep:.3f} m into a part of {carrier.name}"
            return


def _half(part: Part) -> Array:
    """Half extents of the box around a part."""
    long = part.length / 2 + (part.radius if part.kind == "capsule" else 0.0)
    half = (
        part.half if part.kind == "box" else (part.radius, part.radius, part.radius if part.kind == "sphere" else long)
    )
    return np.asarray(np.abs(matrix(part.orientation)) @ np.array(half))


def reach(scene: Scene, state: HomeState, agent: AgentId, act: FreeMotion) -> Iterator[str]:
    """Whether a free-form task is done within reach of its furniture."""
    person, target = state.person(agent), scene.object(act.target)
    if target is None:
        yield f"it is done at {act.target!r}, which there is not"
        return
    box = obstacle_boxes([target], [])
    away = float(clearance(np.array([person.place[0]]), np.array([person.place[1]]), box)[0])
    most = ROOMY if affordances().of(person.motion).roomy else STANDING
    if affordances().is_one_of(target.cls, affordances().looked_at):
        most = LOOKING
    if person.place != person.spot:  # on a seat
        most = max(most, SEATED)
    if away > most + SLACK:
        yield f"{person.motion!r} is done {away:.2f} m from {target.name}, more than {most} m"


def main() -> None:
    """Attack the homes that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default=",".join(list_scenes()), help="homes, separated by commas")
    parser.add_argument("--robots", default=",".join(usable_robots()), help="robot bodies, separated by commas")
    parser.add_argument("--commands", type=int, default=10_000, help="commands in each home with each robot body")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--shown", type=int, default=20, help="how many violations of each home are shown")
    args = parser.parse_args()
    wrong = 0
    for scene in args.scenes.split(","):
        for robot in args.robots.split(","):
            tally = attack(scene, robot, args.commands, args.seed)
            wrong += len(tally.violations)
            print(
                f"{scene:10} {robot:11} {tally.given} commands: {tally.done} done, {sum(tally.refused.values())} "
                f"refused, {len(tally.violations)} violations",
                flush=True,
            )
            for reason, times in tally.refused.most_common(8):
                print(f"    {times:6} {reason}")
            for line in tally.violations[: args.shown]:
                print(f"    !! {line}")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
