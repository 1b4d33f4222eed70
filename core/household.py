"""What can be done in a home, and what a robot can see of it."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Annotated, Literal, NamedTuple, NewType, TypeAlias

from pydantic import Field
from pydantic.json_schema import SkipJsonSchema

from coopera.core.affordances import Relation
from coopera.core.naming import plain as plain
from coopera.core.people import Frozen, is_empty, is_none
from coopera.core.setting import Setting

SceneId = NewType("SceneId", str)
AgentId = NewType("AgentId", str)
HUMAN, ROBOT = AgentId("human"), AgentId("robot")
"""The ids of the one person and the one robot that ship; a home may hold others, and more of them."""
Collab: TypeAlias = Literal[1, 2]
ObjectMap: TypeAlias = dict[str, tuple[int, str]]
"""{unique object name: (object id, room)}: the scene as language models read it (PAPER App. A)."""

Name = Annotated[str, Field(min_length=1, max_length=120)]
MotionText = Annotated[str, Field(min_length=1, max_length=200)]


class PickPlace(Frozen):
    """Take a movable object and put it on (or in) a fixed one: a task of collaboration type 1."""

    kind: Literal["pick_place"] = "pick_place"
    object_id: int
    object: Name
    receptacle_id: int
    receptacle: Name
    relation: Relation = Field("on", exclude_if=lambda relation: relation == "on")
    """Whether it goes on top, or inside what can be opened or is a container."""

    def describe(self) -> str:
        """Say it as a sentence fragment, without ids."""
        where = "on" if self.relation == "on" else "in"
        return f"put the {plain(self.object)} {where} the {plain(self.receptacle)}"


class FreeMotion(Frozen):
    """Move freely at a fixed object with a thing in hand: a task of collaboration type 2."""

    kind: Literal["free_motion"] = "free_motion"
    target_id: int
    target: Name
    in_hand: Name
    motion: MotionText

    def describe(self) -> str:
        """Say it as a sentence fragment, without ids."""
        return f"{self.motion} at the {plain(self.target)} with the {plain(self.in_hand)} in hand"


class HandOver(Frozen):
    """Bring a small thing from the magic box to the person: what the robot does in type 2."""

    kind: Literal["hand_over"] = "hand_over"
    object: Name
    receiver: SkipJsonSchema[AgentId | None] = Field(None, exclude_if=is_none)
    """Who gets it; None, which is neither asked of a model nor written, for the only person of the home."""

    def describe(self) -> str:
        """Say it as a sentence fragment."""
        return f"bring the {plain(self.object)}" + (f" to {self.receiver}" if self.receiver else "")


Act = Annotated[PickPlace | FreeMotion | HandOver, Field(discriminator="kind")]


class Use(NamedTuple):
    """What an act in words is about: a thing and, but for what is brought, the furniture; both as words."""

    thing: str
    place: str | None = None


_IN_WORDS = (
    re.compile(r" at the (?P<place>.+?) with the (?P<thing>.+) in hand$"),
    re.compile(r"^put the (?P<thing>.+?) (?:on|in) the (?P<place>.+)$"),
    re.compile(r"^bring the (?P<thing>.+?)(?: to \S+)?$"),
)


@lru_cache(maxsize=8192)  # a robot reads weeks of told tasks every hour
def use_of(described: str) -> Use | None:
    """Read back what `describe` says of an act; None for other words."""
    for pattern in _IN_WORDS:
        if found := pattern.search(described.strip()):
            return Use(**found.groupdict())
    return None


class Outcome(Frozen):
    """How an act ended in the world; a failure is data with a reason, not an exception."""

    agent: AgentId
    act: Act
    ok: bool
    reason: str = ""
    metres: float = 0.0
    """Distance walked or driven."""
    motion: str | None = Field(None, exclude_if=is_none)
    """The motion that was played for a free-form task, by its caption."""
    cosine: float | None = Field(None, exclude_if=is_none)
    """How near that motion is to what was asked for; None where words were compared, not meanings."""
    asked: str = Field("", exclude_if=is_empty)
    """What was compared with the motions, in words; empty where the task named a motion by its caption."""
    neutral: bool = Field(False, exclude_if=is_empty)
    """Whether no motion that fits came near enough, so that a neutral one was played in its stead."""
    fetched: tuple[str, ...] = Field((), exclude_if=is_empty)
    """What the agent fetched for it before, by name."""
    opened: tuple[str, ...] = Field((), exclude_if=is_empty)
    """What the agent opened for it; it was closed again."""


class Percept(Frozen):
    """What a perception module reports of the first task: seen things only, with its errors.

    `near`: fixed objects at which the person acted, nearest first, by name.
    `motion`: the recognised motion label, empty where none was; may be wrong. `in_hand`: the class of the thing seen
    in the hand, or None. `visible`: names of objects seen from the robot, sorted.
    """

    room: str
    near: list[str]
    motion: str
    in_hand: str | None = None
    visible: list[str] = []
    states: dict[str, str] = Field({}, exclude_if=is_empty)
    """{visible object: its states in words}, for those that are not as at first, such as "open" or "dirty"."""

    def caption(self) -> str:
        """The percept as one sentence for a model that cannot look at pictures."""
        at = f" at the {plain(self.near[0])}" if self.near else ""
        thing = f", holding something like a {plain(self.in_hand)}" if self.in_hand else ""
        doing = f"seems to {self.motion}" if self.motion else "is"
        return f"In the {self.room}, the person {doing}{at}{thing}."


_SHARE, _METRES = "a share from 0 to 1", "a number of metres from 0 to 1"


class PerceptErrors(Frozen):
    """How often and how far perception errs: shares in [0, 1], and metres."""

    motion_confused: Annotated[
        float,
        Field(ge=0, le=1),
        Setting("How often another motion of the same posture is reported than the one that was recognised.", _SHARE),
    ] = 0.15
    in_hand_missed: Annotated[
        float, Field(ge=0, le=1), Setting("How often the thing in the hand is not recognised.", _SHARE)
    ] = 0.20
    joint_noise: Annotated[
        float,
        Field(ge=0, le=1),
        Setting("Standard deviation of each coordinate of a joint; 0.03 puts a joint 5 cm off on average.", _METRES),
    ] = 0.03
