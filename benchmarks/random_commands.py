"""Random commands for a home, sensible and odd ones, as plain values: the same seed gives the same commands."""

from __future__ import annotations

import copy
import json
from typing import Any, NamedTuple

import numpy as np

from coopera.core.errors import SimulationError
from coopera.core.household import Act, AgentId, FreeMotion, HandOver, PickPlace
from coopera.simulation import World
from coopera.simulation.tools import world_tools

BOX = ("mug", "book", "towel", "water bottle", "phone", "apple", "magic wand", "broom", "dirty plate", "red scarf")
NONSENSE = ("xyzzy", "levitate", "sit", "cook the moon", "…", "do nothing at all, but slowly", "sweep", "SIT AND READ")
LONG = "a very " + "very " * 300 + "long thing"
KINDS = ["perform", "go_to", "pick", "place", "set_open", "switch", "tool", "restore"]
DAMAGES = ("spot", "yaw", "position", "home", "hands", "held", "unknown", "on", "inside", "state", "box")
ODD_NAMES = ("", " ", "no_such_thing_7", LONG, "mug_1; drop table", "\n", "0")


class Command(NamedTuple):
    """What is asked of a home, of whom, and with what: `kind` is "perform", a step, "tool …" or "restore …"."""

    kind: str
    agent: AgentId
    what: Any

    def __str__(self) -> str:
        """One line, cut short."""
        said = self.what.model_dump_json() if isinstance(self.what, PickPlace | FreeMotion | HandOver) else self.what
        return f"{self.agent} {self.kind} {'' if self.kind.startswith('restore ') else said}"[:220]


class Answer(NamedTuple):
    """What came of a command: done or not, why not, the metres of it, and what it raised that it should not have."""

    ok: bool
    reason: str = ""
    metres: float = 0.0
    motion: str | None = None
    raised: str = ""


class Commander:
    """Makes up commands for a home as it now stands."""

    def __init__(self, world: World, seed: int) -> None:
        """Take the home that they will be given to."""
        self.world, self.rng = world, np.random.default_rng([seed, len(world.layout.objects)])
        self.crowded: list[str] = self.rng.choice([thing.name for thing in world.layout.fixed], 3).tolist()

    def command(self) -> Command:
        """The next command."""
        agent = AgentId(self._one([*self.world.state.agents, *self.world.state.agents, "nobody"], [9, 9, 9, 9, 1]))
        kind = self._one(KINDS, [12, 2, 2, 3, 1, 1, 2, 1])
        body = self.world.state.agents.get(agent)
        if body is not None and body.thing is not None and self.rng.random() < 0.3:
            return Command("place", agent, (self._name(self._furniture()), "on"))
        if kind == "perform":
            return Command(kind, agent, self._act(agent))
        if kind == "restore":
            damage = self._one(list(DAMAGES))
            return Command(f"restore {damage}", agent, self._damaged(damage))
        if kind == "tool":
            return Command(*self._tool())
        if kind == "go_to":
            return Command(kind, agent, (self._name([*self.world.rooms, *self._names()]),))
        if kind == "pick":
            return Command(kind, agent, (self._name(self._things()),))
        if kind == "place":
            where = self._one(["on", "inside"], [2, 1])
            return Command(kind, agent, (self._name(self._names() if where == "inside" else self._furniture()), where))
        return Command(kind, agent, (self._name(self._names()), bool(self.rng.integers(2))))

    def _one(self, of: list[str], weights: list[int] | None = None) -> str:
        shares = None if weights is None else np.array(weights[: len(of)]) / sum(weights[: len(of)])
        return of[int(self.rng.choice(len(of), p=shares))]

    def _things(self) -> list[str]:
        held = [body.thing for body in self.world.state.agents.values() if body.thing is not None]
        return [*(thing.name for thing in self.world.layout.movable), *self.world.state.box, *held, *held]

    def _furniture(self) -> list[str]:
        fixed = [thing.name for thing in self.world.layout.fixed]
        return [*fixed, *self.crowded * (len(fixed) // 6)]

    def _names(self) -> list[str]:
        return self._things() + self._furniture()

    def _name(self, usual: list[str]) -> str:
        """Mostly one of the usual names; now and then any name of the home, or an odd one."""
        draw = self.rng.random()
        return self._one(usual if draw < 0.92 else self._names() if draw < 0.97 else list(ODD_NAMES))

    def _in_hand(self) -> str:
        return self._name(list(BOX) if self.rng.random() < 0.6 else self._things())

    def _act(self, agent: AgentId) -> Act:
        """An act; one with a text that no act may have is made without checks, as a careless caller would."""
        own, others = ("give", "move") if agent in self.world.robots else ("move", "give")
        kind = self._one(["put", own, others], [10, 8, 1])
        if kind == "put":
            inside = self.rng.random() < 0.35
            thing = self._name(self._things())
            receptacle = self._name(self._names() if inside else self._furniture())
            receptacle = thing if self.rng.random() < 0.02 else receptacle
            return PickPlace.model_construct(
                kind="pick_place",
                object_id=self._id(thing),
                object=thing,
                receptacle_id=self._id(receptacle),
                receptacle=receptacle,
                relation="inside" if inside else "on",
            )
        if kind == "move":
            target = self._name(self._furniture())
            motion = self._one([*self.world.motions, *NONSENSE, *ODD_NAMES])
            return FreeMotion.model_construct(
                kind="free_motion",
                target_id=self._id(target),
                target=target,
                in_hand=self._in_hand(),
                motion=motion,
            )
        receiver = self._one(["", *self.world.people, *self.world.robots, "nobody"], [6, 2, 1, 1])
        receiver_id = AgentId(receiver) if receiver else None
        return HandOver.model_construct(kind="hand_over", object=self._in_hand(), receiver=receiver_id)

    def _id(self, name: str) -> int:
        """The object's id, or now and then a wrong one."""
        known = self.world.layout.object(name)
        return known.id if known is not None and self.rng.random() < 0.97 else int(self.rng.integers(1000))

    def _tool(self) -> tuple[str, AgentId, dict[str, Any]]:
        agent = AgentId(self._one(list(self.world.state.agents)))
        tool = self._one([tool.name for tool in world_tools(self.world, agent)])
        some: dict[str, Any] = {
            "room": self._name(["", *self.world.rooms]),
            "target": self._name(self._furniture()),
            "thing": self._in_hand() if tool == "hand_over" else self._name(self._things()),
            "receptacle": self._name(self._furniture()),
            "person": self._one(["", "human", "robot"]),
            "motion": self._one([*self.world.motions, *NONSENSE, LONG, ""]),
            "in_hand": self._in_hand(),
            "name": self._name(self._names()),
            "relation": self._one(["on", "inside"]),
            "opens": bool(self.rng.integers(2)),
            "on": bool(self.rng.integers(2)),
        }
        takes = next(one for one in world_tools(self.world, agent) if one.name == tool).args
        return f"tool {tool}", agent, {name: value for name, value in some.items() if name in takes}

    def _damaged(self, damage: str) -> dict[str, Any]:
        """A snapshot with something wrong in it."""
        snapshot = copy.deepcopy(self.world.snapshot())
        bodies, things = snapshot["agents"], [thing.name for thing in self.world.layout.movable]
        one, two = self._one(list(bodies)), self._one(things)
        place = {"position": [0.0, 0.0, 0.0], "yaw": 0.0, "on": None}
        number = self._one(["nan", "inf", "1e9"])
        if damage in ("spot", "yaw"):
            bodies[one][damage] = float(number) if damage == "yaw" else [float(number), 0.0]
        elif damage == "position":
            snapshot["moved"][two] = {**place, "position": [1.0, float(number), 0.0]}
        elif damage == "home":
            snapshot["scene"] = "elsewhere"
        elif damage == "hands":
            for body in bodies.values():
                body["thing"] = two
            snapshot["moved"].pop(two, None)
        elif damage == "held":
            bodies[one]["thing"], snapshot["moved"][two] = two, place
        elif damage == "unknown":
            bodies[one]["thing"] = "harp_77"
        elif damage in ("on", "inside"):
            snapshot["moved"][two] = {**place, damage: two}
        elif damage == "state":
            snapshot.setdefault("conditions", {})[self._one([two, "harp_77"])] = {"form": "molten"}
        else:
            snapshot.setdefault("box", {})["pen_99"] = {"id": 999_999, "text": "pen"}
        return dict(snapshot)


def carry_out(world: World, command: Command) -> Answer:
    """Give a home a command; what it raises, but for the refusals that it documents, is in the answer."""
    kind, agent, what = command
    try:
        if kind == "perform":
            outcome = world.perform(agent, what)
            return Answer(outcome.ok, outcome.reason, outcome.metres, outcome.motion)
        if kind.startswith("restore "):
            world.restore(what)
            return Answer(True)
        if kind.startswith("tool "):
            tool = next(one for one in world_tools(world, agent) if one.name == kind[5:])
            said = str(tool.invoke(what))
            return Answer(not said.startswith("That failed:"), said.removeprefix("That failed: "))
        return Answer(*getattr(world, kind)(agent, *what))
    except SimulationError as err:
        refused = agent not in world.state.agents or kind.startswith("restore ")
        return Answer(False, str(err), raised="" if refused else f"SimulationError: {err}")
    except Exception as err:  # noqa: BLE001 - whatever it is, it is what the home must not do
        return Answer(False, str(err), raised=f"{type(err).__name__}: {' '.join(str(err).split())[:160]}")


def as_told(answer: Answer) -> str:
    """An answer as text, to be compared with that of another home."""
    return json.dumps(answer)
