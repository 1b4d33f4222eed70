"""What a robot may know of an hour: one type, for our robot and for one of your own, and nothing else reaches either.

A view holds plain data, and functions that read. It cannot act in the home, write a memory, ask the person's or the
judge's model, or see what the person intends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, NamedTuple, Protocol

from coopera.core.asks import ASKS
from coopera.core.clock import Clock
from coopera.core.errors import RunError
from coopera.core.hour import Observation
from coopera.core.household import Act, AgentId, Collab, ObjectMap, SceneId
from coopera.core.people import Belief, PersonId
from coopera.core.protocols import Ask, Home, Reply
from coopera.core.randomness import Address
from coopera.memory import MemoryStream, Recollection, Record, Relevances, Texts, extend_together


class RobotAsk(Protocol):
    """The one door to language models, as far as it is open to a robot: for the prompts of its own role."""

    def __call__(
        self,
        prompt: str,
        reply: type[Reply],
        /,
        *,
        at: Address,
        variables: Mapping[str, Any],
        images: Sequence[Path] = (),
    ) -> Reply:
        """Ask, as `coopera.core.protocols.Ask` does.

        Raises:
            RunError: If the prompt is not a robot's.
            ModelOutputError: If no attempt gave a valid reply; the hour is then unscored.
        """
        ...


@dataclass(frozen=True, slots=True)
class HomeView:
    """A home as it stands while the robot thinks: what can be looked at, as data, and whether an act fits it."""

    scene: SceneId
    rooms: list[str]
    """Names of the rooms, sorted."""
    motions: list[str]
    """Captions of the motions the person's body can do."""
    fixed: ObjectMap
    movable: ObjectMap
    classes: Mapping[str, str]
    states: Mapping[str, str]
    """{object: its states in words} of what is not as at first and can be seen from the room that the robot is in."""
    misfit: Callable[[Act], str] = field(compare=False)
    """What stands against an act of the robot's, as a sentence; empty where it can be tried: see `Home.misfit`."""

    @classmethod
    def of(cls, home: Home, robot: AgentId) -> HomeView:
        """Look at a home as a robot that lives there."""
        fixed, movable = home.objects("fixed"), home.objects("movable")

        def misfit(act: Act) -> str:
            return home.misfit(robot, act)

        return cls(
            scene=home.scene,
            rooms=list(home.rooms),
            motions=list(home.motions),
            fixed=fixed,
            movable=movable,
            classes={name: home.class_of(name) for name in (*fixed, *movable)},
            states=home.states(home.room_of(robot)),
            misfit=misfit,
        )

    def objects(self, kind: Literal["fixed", "movable"]) -> ObjectMap:
        """The object-room mapping, sorted by name."""
        return dict(self.fixed if kind == "fixed" else self.movable)

    def class_of(self, name: str) -> str:
        """The object's class, such as "mug" for "mug_2"; a name not in the home is its own class."""
        return self.classes.get(name, name)


class Recall(Protocol):
    """How a memory stream is recalled; see `coopera.memory.MemoryStream.recall`."""

    def __call__(self, query: str, now: int, k: int, since: int | None = None) -> list[Recollection]:
        """The best `k` records until the global hour `now`, best first."""
        ...


class Compare(Protocol):
    """How alike all of a memory stream is to some texts; see `coopera.memory.MemoryStream.relevances`."""

    def __call__(
        self,
        queries: Sequence[str],
        now: int,
        since: int | None = None,
        within: tuple[float, float] | None = None,
    ) -> Relevances:
        """The records until the global hour `now`, oldest first, and for each query the likeness of each."""
        ...


class Records(Protocol):
    """How a memory stream is read through; see `coopera.memory.MemoryStream.records`."""

    def __call__(self, since: int | None = None) -> list[Record]:
        """The records in order of time."""
        ...


class Words(Protocol):
    """How the words of a memory stream are read through; see `coopera.memory.MemoryStream.texts`."""

    def __call__(self, since: int | None = None) -> Texts:
        """The records in order of time, as columns."""
        ...


@dataclass(frozen=True, slots=True)
class Readable:
    """A memory stream that can be read and not written."""

    recall: Recall
    records: Records
    texts: Words
    relevances: Compare

    @classmethod
    def of(cls, stream: MemoryStream) -> Readable:
        """Leave out of a stream whatever writes."""

        def recall(query: str, now: int, k: int, since: int | None = None) -> list[Recollection]:
            return stream.recall(query, now, k, since=since)

        def records(since: int | None = None) -> list[Record]:
            return list(stream.records(since=since))

        def texts(since: int | None = None) -> Texts:
            return stream.texts(since)

        def relevances(
            queries: Sequence[str],
            now: int,
            since: int | None = None,
            within: tuple[float, float] | None = None,
        ) -> Relevances:
            return stream.relevances(queries, now, since=since, within=within)

        return cls(recall, records, texts, relevances)


class ReadMemories(NamedTuple):
    """Two streams about a person, to be read: one of intentions, one of tasks."""

    intentions: Readable
    tasks: Readable


class Memories(NamedTuple):
    """The two streams an agent keeps of a person: one of intentions, one of tasks."""

    intentions: MemoryStream
    tasks: MemoryStream

    def to_read(self) -> ReadMemories:
        """The same, without what writes."""
        return ReadMemories(Readable.of(self.intentions), Readable.of(self.tasks))

    def forget_from(self, now: int) -> None:
        """Drop what is of this hour or later, before an hour is done (again)."""
        self.intentions.forget_from(now)
        self.tasks.forget_from(now)

    def flush(self) -> None:
        """Have these on disk, with all that was added to other streams of their store."""
        self.tasks.flush()

    def add(self, intention: str, tasks: Sequence[str], now: int, *, seen: Sequence[str] = ()) -> None:
        """Append one hour; what a robot has `seen` of its tasks is marked as such, and comes first."""
        known = [Record(task, now, {"source": "seen"}) for task in seen]
        done = [*known, *(Record(task, now, {}) for task in tasks)]
        extend_together([(self.intentions, [Record(intention, now, {})]), (self.tasks, done)])

    def extend(self, hours: Iterable[tuple[int, str, Sequence[str]]]) -> None:
        """Append hours, each with its intention and tasks, at once: a write takes the store as long as an hour's do."""
        added = list(hours)
        intentions = [Record(intention, now, {}) for now, intention, _ in added]
        done = [Record(task, now, {}) for now, _, tasks in added for task in tasks]
        extend_together([(self.intentions, intentions), (self.tasks, done)])


@dataclass(frozen=True, slots=True)
class RobotView:
    """All that a robot may know in an hour.

    Attributes:
        clock: Now, in the person's calendar.
        observation: What was seen of the first task.
        pictures: The observation's frames as files, robot views first, in order of time.
        person: Whom the robot is with, or takes them for.
        belief: What it believes about them so far.
        collab: The collaboration type: 1 tidies (`PickPlace`), 2 is brought things (`HandOver`).
        home: The home as it now stands.
        history: What was told in the evenings of earlier days.
        guesses: What the robot itself inferred, of which only today's count: the evening replaces them by the truth.
        ask: The one door to language models, for the robot's prompts.
        looks: Whether the robot's language model looks at pictures itself.
    """

    clock: Clock
    observation: Observation
    pictures: tuple[Path, ...]
    person: PersonId
    belief: Belief
    collab: Collab
    home: HomeView
    history: ReadMemories
    guesses: ReadMemories
    ask: RobotAsk
    looks: bool

    @property
    def states(self) -> dict[str, str]:
        """{object: its states in words} of all that the robot can know not to be as at first: here, and as it was seen.

        What it sees now counts more than what perception reported.
        """
        percept = self.observation.percept
        known = {**(percept.states if percept else {}), **self.home.states}
        return {name: known[name] for name in sorted(known)}


def robots_door(ask: Ask) -> RobotAsk:
    """The one door, shut for prompts that are not a robot's."""

    def door(
        prompt: str,
        reply: type[Reply],
        /,
        *,
        at: Address,
        variables: Mapping[str, Any],
        images: Sequence[Path] = (),
    ) -> Reply:
        if prompt not in ASKS or ASKS[prompt].role != "robot":
            raise RunError(f"{prompt}: a robot asks prompts of its own role alone ({', '.join(_OWN)}).")
        return ask(prompt, reply, at=at, variables=variables, images=images)

    return door


_OWN = sorted(name for name, spec in ASKS.items() if spec.role == "robot")
