"""The joints of the house: what one room needs of another, without importing it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, Protocol, TypeVar

import numpy as np

from coopera.core.hour import Evening, Example, HourRecord, ModelCall
from coopera.core.household import Act, AgentId, ObjectMap, Outcome, Percept, SceneId
from coopera.core.people import Frozen, Persona
from coopera.core.randomness import Address

Reply = TypeVar("Reply", bound=Frozen)
Role = Literal["human", "robot", "judge"]


class Ask(Protocol):
    """The one door to language models (DESIGN rule 1)."""

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
        """Render the prompt, ask its role's model, validate and if need be repair the reply.

        Raises:
            ModelOutputError: If no attempt gave a valid reply; the hour is then unscored.
            ModelCallError: If the model could not be reached.
        """
        ...

    def sees(self, role: Role) -> bool:
        """Whether this role's model looks at pictures itself."""
        ...

    def instant(self, role: Role) -> bool:
        """Whether this role's model answers at once, so that nothing is gained by asking it later or several times."""
        ...

    def take_calls(self, at: Address | None = None) -> list[ModelCall]:
        """Return the calls made since the last time, or only those made at an address, in order, and forget them."""
        ...


class Rendered(Frozen):
    """A prompt ready to be sent."""

    name: str
    role: Role
    text: str
    sha: str
    reply: str
    temperature: float


class Prompts(Protocol):
    """The prompt folder."""

    def render(self, name: str, variables: Mapping[str, Any]) -> Rendered:
        """Fill a prompt's template; every declared input must be given and no other.

        Raises:
            PromptError: Naming file and line.
        """
        ...


class Home(Protocol):
    """A household simulation, as the graphs use it. Truth is kept between calls; time is not."""

    scene: SceneId

    @property
    def rooms(self) -> list[str]:
        """Names of the rooms, sorted."""
        ...

    @property
    def motions(self) -> list[str]:
        """Captions of the motions the person's body can do."""
        ...

    def objects(self, kind: Literal["fixed", "movable"]) -> ObjectMap:
        """The object-room mapping as things now stand, sorted by name."""
        ...

    def class_of(self, name: str) -> str:
        """The object's class, such as "mug" for "mug_2"; a name not in the scene is its own class."""
        ...

    def perform(self, agent: AgentId, act: Act, *, record: bool = False, watcher: AgentId | None = None) -> Outcome:
        """Do an act with all that it needs (walk, reach, pick, place, move, hand over).

        With `record`, the motion is kept for `percept` and `frames` (the newest recording counts), a person's as the
        robot `watcher` sees it (None: the only one).
        Something impossible is a failed `Outcome` with its reason, and the world stays consistent.
        """
        ...

    def misfit(self, agent: AgentId, act: Act) -> str:
        """What stands against an act in this home, as a sentence that says what would do; empty where it can be tried.

        It asks what never changes while an hour is planned: objects and their ids, what can be done where and with
        what. Whether somebody stands in the way, or the table is full, is found out by doing it.
        """
        ...

    def states(self, room: str | None = None) -> dict[str, str]:
        """{object: its states in words} of all that is not as at first and can be seen, in a room or everywhere.

        Also what is inside something, where one can look in. Sorted by name.
        """
        ...

    def room_of(self, agent: AgentId) -> str:
        """The room in which an agent is."""
        ...

    def place_of(self, thing: str) -> str:
        """Where a movable thing is now, in words: "on desk_1", "inside fridge_1", "with human" or "on the floor".

        Empty for what is not in the home.
        """
        ...

    def percept(self, rng: np.random.Generator) -> Percept:
        """What a perception module reports of the recording, with its errors drawn from `rng`."""
        ...

    def frames(self, count: int, folder: Path, name: str | None = None, *, wait: bool = True) -> list[Path]:
        """Render the `count` moments of the recording that differ most into `folder`, the deed and the end among them.

        Files are robot-0.webp … from the robot's own eyes and human-0.webp … from across the room, in this order; with
        a `name` only the latter, as NAME-0.webp …. Without `wait` the files may come later: see `frames_due`.
        """
        ...

    def frames_due(self) -> Callable[[], None] | None:
        """What waits for the files of `frames` asked for so far; None where all are there.

        It raises a `SimulationError` if they cannot be written.
        """
        ...

    def film(self, path: Path) -> Path:
        """Write the recording as a video file."""
        ...

    def inhabit(self, agent: AgentId, person: Persona) -> None:
        """Draw a person of the home as somebody from now on; nothing but pictures changes."""
        ...

    def snapshot(self) -> dict[str, Any]:
        """The whole state as plain JSON data of a few kB."""
        ...

    def restore(self, snapshot: Mapping[str, Any]) -> None:
        """Set the state to a snapshot, exactly; an empty one means the home as it was built."""
        ...


class Classifier(Protocol):
    """A yes/no judge of candidates, trained each evening (PAPER §3.3)."""

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        """P(yes) per example, in [0, 1]; exactly 0.5 for all while untrained."""
        ...

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        """Learn from labelled examples, on top of what it knows; returns what was measured in training.

        What comes out depends on what it knew, the examples and the seed alone. With fewer than one example of each
        label nothing can be learned and the classifier stays as it was.

        Raises:
            LearningError: If training fails; the classifier is then as it was.
        """
        ...

    def save(self, folder: Path) -> None:
        """Write the learned state in open formats (no pickle)."""
        ...

    def load(self, folder: Path) -> None:
        """Read what `save` wrote.

        Raises:
            CooperaError: If the folder holds no state of this kind, or a damaged one.
        """
        ...


class Recorder(Protocol):
    """The run directory, as the graphs use it. Writes are atomic; writing an hour again replaces it."""

    root: Path

    def frames_folder(self, day: int, hour: int) -> Path:
        """An empty folder for an hour's frames."""
        ...

    def video_file(self, day: int, hour: int) -> Path:
        """Where an hour's video goes."""
        ...

    def write_hour(self, record: HourRecord, after: Callable[[], None] | None = None) -> None:
        """Write trace/day-DD/hour-HH.json; with `after`, once that has returned, while the work goes on.

        Whatever is written later waits for it.
        """
        ...

    def read_hour(self, day: int, hour: int) -> HourRecord | None:
        """An hour; None where it has not been written, or not yet."""
        ...

    def read_day(self, day: int) -> list[HourRecord]:
        """The hours of a day, in order, also those that wait to be written."""
        ...

    def read_evening(self, day: int) -> Evening | None:
        """A day's evening; None where it has not been written."""
        ...

    def write_evening(self, evening: Evening) -> None:
        """Write trace/day-DD/evening.json, once all hours before it are written."""
        ...

    def adapters_folder(self, day: int) -> Path:
        """The folder of a day's classifiers."""
        ...
