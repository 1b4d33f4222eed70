"""The home as people and robots live in it: acts change it, recordings show it, snapshots keep it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from coopera.core.affordances import Relation
from coopera.core.errors import SimulationError
from coopera.core.household import Act, AgentId, ObjectMap, Outcome, Percept, PerceptErrors
from coopera.core.people import Persona
from coopera.simulation.acts import primitives
from coopera.simulation.acts.activity import stay
from coopera.simulation.acts.first_places import first_states
from coopera.simulation.acts.meaning import misfit
from coopera.simulation.acts.planning import planned
from coopera.simulation.acts.plans import Ground, Plan, UnableError
from coopera.simulation.acts.primitives import Result
from coopera.simulation.acts.skills import set_open, switch
from coopera.simulation.bodies.elbowroom import Elbowroom
from coopera.simulation.bodies.robot import load_robot
from coopera.simulation.drawing.context import Renderer
from coopera.simulation.drawing.lens import Camera, checked_size
from coopera.simulation.drawing.view import View
from coopera.simulation.goals import predicates
from coopera.simulation.homes.scene import Scene
from coopera.simulation.motions.library import Library, Rank, load_library
from coopera.simulation.people.appearance import appearance_of
from coopera.simulation.sight.percept import perceive
from coopera.simulation.sight.recording import Recording
from coopera.simulation.sight.studio import Films
from coopera.simulation.sight.timing import TICKS
from coopera.simulation.sight.video import FPS, write_video
from coopera.simulation.sight.views import view
from coopera.simulation.sight.watching import Onlooker, Order, Viewpoint, Watcher, onlooker, recorded
from coopera.simulation.state.agents import Agent, PersonAgent, RobotAgent, check_agents
from coopera.simulation.state.home_state import HomeState, room_of_thing, standing_now
from coopera.simulation.state.looks import place_in_words, states_in_sight, things_in_sight
from coopera.simulation.state.snapshots import read_snapshot
from coopera.simulation.ways.navigation import Navigator


class World:
    """One home with those who live in it, by default one person and one robot: the `Home` of the graphs.

    Truth is plain data (`state`); pybullet is started at the first recording and only shows and measures it.
    Use it as a context manager, or call `close`.
    """

    def __init__(  # noqa: PLR0913 - one parameter for each thing that a home is made of
        self,
        scene: Scene,
        *,
        agents: Sequence[Agent] | None = None,
        robot: str = "fetch",
        frame_size: tuple[int, int] = (320, 240),
        labels: bool = False,
        renderer: Renderer = "auto",
        motions: Library | None = None,
        match: Rank | None = None,
        errors: PerceptErrors | None = None,
    ) -> None:
        """Set up a home in its initial state.

        Args:
            scene: The home.
            agents: Who lives there, in the order of their first places; by default one person, "human", and one robot,
                "robot".
            robot: That one robot's body, as `coopera.simulation.bodies.robot.load_robot` takes it.
            frame_size: Width and height of the pictures in pixels.
            labels: Whether names are written into the pictures: of the thing in hand, the people, the furniture there.
            renderer: What draws the pictures: "auto" is "gl" where that is to be had, else "tiny". The first world of
                a process that draws with "egl" decides for all that draw with "tiny".
            motions: What the person's body can do; the shipped library without it.
            match: Ranks the captions of `motions` by how near in meaning they are to a free-form text; without it
                words are compared.
            errors: How often and how far the percept errs.

        Raises:
            SimulationError: If the home has no room for them to stand in.
            ConfigError: If there is no such robot, its files cannot be used, an agent's id cannot be used, or there can
                be no pictures of that size.
        """
        agents = [PersonAgent(), RobotAgent(body=robot)] if agents is None else agents
        check_agents(agents)
        self.scene = scene.id
        self.frame_size, self.labels = checked_size(frame_size), labels
        self.renderer = renderer
        self.errors = errors or PerceptErrors()
        self.layout = scene
        self._library: Library = motions or load_library()
        people = tuple(agent.id for agent in agents if isinstance(agent, PersonAgent))
        robots = {agent.id: load_robot(agent.body) for agent in agents if isinstance(agent, RobotAgent)}
        room = Elbowroom(scene)
        self._ground = Ground(scene, Navigator(scene), self._library, people, robots, room, match)
        self.state = self._start = HomeState(scene=self.scene, agents=first_states(self._ground, agents))
        self.looks = {one.id: one.looks for one in agents if isinstance(one, PersonAgent) and one.looks is not None}
        """How people look in pictures, and no more; who is not in it looks as the id has it."""
        self._watcher: Watcher | None = None
        self._films = Films(self._ground, renderer, self.looks, self._watching)
        self._recording: Recording | None = None
        self._planned: dict[AgentId, tuple[HomeState, Act, Plan]] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Give pybullet back; the state stays."""
        self._films.close()
        if self._watcher is not None:
            self._watcher.close()
            self._watcher = None

    @property
    def rooms(self) -> list[str]:
        """Names of the rooms, sorted."""
        return sorted(room.name for room in self.layout.rooms)

    @property
    def motions(self) -> list[str]:
        """Captions of the motions the person's body can do, sorted."""
        return self._library.captions

    def caption_of(self, text: str) -> str:
        """The caption of the motion that a free-form text means, whatever the place."""
        return self._library.ranked(text, self._ground.rank)[0].caption

    @property
    def motion_classes(self) -> list[str]:
        """The coarse labels of these motions, which a percept gives, sorted."""
        return self._library.classes

    def objects(self, kind: Literal["fixed", "movable"]) -> ObjectMap:
        """The object-room mapping as things now stand, sorted by name."""
        if kind == "fixed":
            return {thing.name: (thing.id, thing.room) for thing in self.layout.fixed}
        things = self.state.of_the_home(self.layout)
        return {thing.name: (thing.id, room_of_thing(self.layout, self.state, thing)) for thing in things}

    def as_scene(self) -> Scene:
        """The home as things now stand, as a home of its own: to be checked, drawn or written to a file.

        What somebody holds or wears, and what is inside something, is not in it.
        """
        return standing_now(self.layout, self.state)

    def class_of(self, name: str) -> str:
        """The object's class, such as "mug" for "mug_2"; a name not in the scene is its own class."""
        known = self.state.box.get(name)
        if known is not None:
            return known.text
        thing = self.layout.object(name)
        return thing.cls if thing is not None else name

    @property
    def people(self) -> list[AgentId]:
        """Ids of the people who live here."""
        return self.state.ids("person")

    @property
    def robots(self) -> list[AgentId]:
        """Ids of the robots that live here."""
        return self.state.ids("robot")

    def perform(
        self, agent: AgentId, act: Act, *, record: bool = False, watcher: AgentId | None = None, keep: bool = False
    ) -> Outcome:
        """Do an act with all that it needs (walk, reach, pick, place, move, hand over).

        With `record`, the act is kept for `percept` and `frames`; of a person's act a robot sees it, and first drives
        to where it does. That robot is `watcher`; by default it is the one that acts, or the only one. Of a robot's
        own act the pictures show the robot; `percept` then tells of the receiver of what it hands over, or else of the
        first person of the home. Something impossible is a failed outcome with its reason, and the home stays as it
        was (but for the drive of a robot that watches, and for who had to let it pass: then the recording shows the
        person as they are); of a robot's own act there is then no recording. `keep` keeps it, too, and nobody drives.

        Raises:
            SimulationError: If there is no such agent or watcher.
        """
        self.state.agent(agent)
        before, watch = self.state, onlooker(self._watching(), self.state, agent, act, watcher) if record else None
        try:
            plan = self._plan(agent, act, watch)
        except UnableError as unable:
            if agent in self.robots and record:
                self._recording = None
            elif watch is not None:  # there is still the person to be seen, doing what they were doing
                plan = stay(self._ground, before, watch.person, watch)
                self._record(plan, agent, watch)
            return Outcome(agent=agent, act=act, ok=False, reason=unable.sentence)
        if watch is not None:
            self._record(plan, agent, watch)
        elif keep:
            self._record(plan, agent, onlooker(self._watching(), self.state, agent, act, watcher))
        self.state = plan.state
        fetched, opened = tuple(plan.fetched), tuple(dict.fromkeys(plan.opened))
        done = Outcome(agent=agent, act=act, ok=True, metres=round(plan.metres, 3), fetched=fetched, opened=opened)
        if plan.meant is None:
            return done
        near = None if self._ground.rank is None else round(plan.meant.likeness, 3)
        said = {"motion": plan.meant.caption, "cosine": near, "asked": plan.meant.asked, "neutral": plan.meant.neutral}
        return done.model_copy(update=said)

    def misfit(self, agent: AgentId, act: Act) -> str:
        """What stands against an act whatever the moment, as a sentence that says what would do; empty if it fits.

        It asks after objects and their ids, and what can be done where and with what. Whether somebody stands in the
        way, or the table is full, is found out by doing it.

        Raises:
            SimulationError: If there is no such agent.
        """
        self.state.agent(agent)
        return misfit(self._ground, self.state, agent, act)

    def states(self, room: str | None = None) -> dict[str, str]:
        """{object: its states in words} of what is not as at first and can be seen: see `states_in_sight`."""
        return states_in_sight(self.layout, self.state, room)

    def plan(self, agent: AgentId, act: Act) -> Plan:
        """What `perform` would do, step by step, without doing it.

        Raises:
            UnableError: With the reason why it cannot be done.
            SimulationError: If there is no such agent.
        """
        self.state.agent(agent)
        plan = self._plan(agent, act, None)
        self._planned[agent] = (self.state, act, plan)
        return plan

    def go_to(self, agent: AgentId, target: str) -> Result:
        """Let an agent go to a room, a piece of furniture or a thing, by name."""
        return self._step(agent, lambda: primitives.go_to(self._ground, self.state, agent, target))

    def pick(self, agent: AgentId, thing: str) -> Result:
        """Let an agent go to a thing and take it into its hand."""
        return self._step(agent, lambda: primitives.pick(self._ground, self.state, agent, thing))

    def place(self, agent: AgentId, receptacle: str, relation: Relation = "on") -> Result:
        """Let an agent carry what it has in hand to furniture, or a thing that holds others, and put it down there."""
        return self._step(agent, lambda: primitives.place(self._ground, self.state, agent, receptacle, relation))

    def set_open(self, agent: AgentId, name: str, opens: bool) -> Result:
        """Let an agent go to what has a door, a drawer or a lid, and open or close it."""
        return self._step(agent, lambda: set_open(self._ground, self.state, agent, name, opens=opens))

    def switch(self, agent: AgentId, name: str, on: bool) -> Result:
        """Let an agent go to what can be switched, and switch it on or off."""
        return self._step(agent, lambda: switch(self._ground, self.state, agent, name, on=on))

    def _step(self, agent: AgentId, plan: Callable[[], Plan]) -> Result:
        self.state.agent(agent)
        try:
            made = plan()
        except UnableError as unable:
            return Result(ok=False, reason=unable.sentence)
        self.state = made.state
        return Result(ok=True, metres=round(made.metres, 3))

    def room_of(self, agent: AgentId) -> str:
        """The room in which an agent is."""
        return self.layout.room_at(*self.state.agent(agent).place).name

    def place_of(self, thing: str) -> str:
        """Where a movable thing is now: "on desk_1", "inside fridge_1", "with human" or "on the floor".

        Empty for what is not in the home.
        """
        known = self.state.find(self.layout, thing)
        return place_in_words(self.state, known) if known is not None and not known.fixed else ""

    def things_on(self, room: str) -> dict[str, str]:
        """The movable things of a room that can be seen: {thing: what it is on or inside, who has it, or "floor"}."""
        return things_in_sight(self.layout, self.state, room)

    def _record(self, plan: Plan, agent: AgentId, watch: Onlooker) -> None:
        self._recording = recorded(self._ground, self.state, plan, agent, watch)
        self.state = plan.state

    def _plan(self, agent: AgentId, act: Act, watch: Onlooker | None) -> Plan:
        ready = self._planned.pop(agent, None)
        if watch is None and ready is not None and ready[0] is self.state and ready[1] == act:
            return ready[2]
        seen = watch if agent in self._ground.people else None
        return planned(self._ground, self.state, agent, act, seen)

    def _watching(self) -> Watcher:
        if self._watcher is None:
            self._watcher = Watcher(self._ground, self.renderer, self.looks)
        return self._watcher

    def percept(self, rng: np.random.Generator) -> Percept:
        """What a perception module reports of the `recording`, with its errors drawn from `rng`."""
        recording, stage, library = self.recording, self._watching().stage, self._library
        return perceive(stage, self.layout, recording, library, errors=self.errors, class_of=self.class_of, rng=rng)

    def frames(self, count: int, folder: Path, name: str | None = None, *, wait: bool = True) -> list[Path]:
        """Render the `count` moments of the recording that differ most into `folder`, the deed and the end among them.

        Files are robot-0.webp … from the robot's eyes and human-0.webp … from across the room; with a `name` only the
        latter. Without `wait` they are written while the home goes on. A `SimulationError` where nothing can be.
        """
        stems: dict[Viewpoint, str] = {"robot": "robot", "human": "human"} if name is None else {"human": name}
        order = Order(count, self.frame_size, Path(folder), stems, self.labels)
        self._films.take(self.recording, order, wait=wait)
        return order.files(self.recording)

    def frame_views(self, count: int) -> dict[str, View]:
        """What `frames` shows, as data, by the names of the files; errors as of `frames` and `view`."""
        return self._watching().views(self.recording, count, self.frame_size)

    def frames_due(self) -> Callable[[], None] | None:
        """What waits for the files of `frames` asked for so far, or None; a `SimulationError` if they cannot be."""
        return self._films.due()

    def film(self, path: Path) -> Path:
        """Write the recording as H.264 video, the robot's view on the left, the third-person view on the right.

        Errors as of `frames`, and a `ConfigError` if the extra `video` is not installed.
        """
        return write_video(Path(path), self.filmed())

    def filmed(self) -> Iterator[NDArray[np.uint8]]:
        """The pictures of such a video, `FPS` of them a second."""
        return self._watching().video(self.recording, self.frame_size, TICKS // FPS)

    def view(self, through: Camera | AgentId, size: tuple[int, int] | None = None) -> View:
        """What a camera, or a robot by its head, sees of the home now: colours, depth, and what each pixel is of.

        Raises:
            SimulationError: If there is no such robot.
            ConfigError: If the renderer gl is not to be had, or there can be no picture of that size.
        """
        through = through if isinstance(through, Camera) else self.state.the("robot", through)
        return view(self._watching().drawn, self._ground, self.state, through, checked_size(size or self.frame_size))

    @property
    def recording(self) -> Recording:
        """The newest recording; a `SimulationError` where there is none since the start or the last `restore`."""
        if self._recording is None or not self._recording.shots:
            raise SimulationError("Nothing has been recorded: call perform with record=True first, and see it succeed.")
        return self._recording

    def inhabit(self, agent: AgentId, person: Persona) -> None:
        """Draw a person of the home as somebody from now on; nothing but pictures changes."""
        looks = appearance_of(person.profile, person.id, person.appearance)
        if self.looks.get(agent) != looks:
            self.looks[agent] = looks
            self._films.inhabited()

    def snapshot(self) -> dict[str, Any]:
        """The whole state as plain JSON data of a few kB; a recording is not part of it."""
        return self.state.model_dump(mode="json")

    def restore(self, snapshot: Mapping[str, Any]) -> None:
        """Set the state to a snapshot, exactly; the recording is forgotten. An empty one: the home as it was built.

        Raises:
            SimulationError: If the snapshot is damaged, cannot be true, or is of another home.
        """
        self.state = read_snapshot(self.layout, self._start, snapshot, self.motions)
        self._recording = None

    def on(self, cls: str, receptacle_cls: str) -> bool:
        """Whether some thing of a class is on (or in) some furniture of a class."""
        return predicates.on(self.layout, self.state, cls, receptacle_cls)

    def holding(self, agent: AgentId, cls: str) -> bool:
        """Whether an agent has a thing of a class in its hand."""
        return predicates.holding(self.layout, self.state, agent, cls)

    def near(self, agent: AgentId, cls: str, within: float = 1.0) -> bool:
        """Whether an agent is within some metres of furniture of a class, in the same room."""
        return predicates.near(self.layout, self.state, agent, cls, within)

    def at(self, agent: AgentId, room: str) -> bool:
        """Whether an agent is in a room."""
        return predicates.at(self.layout, self.state, agent, room)

    def holds(self, predicate: str) -> bool:
        """Whether a written predicate holds, such as "on(mug, sofa)": see `coopera.simulation.goals.predicates`.

        Raises:
            ConfigError: If it is no predicate.
        """
        return predicates.evaluate(self.layout, self.state, predicate)
