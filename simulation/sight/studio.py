"""Pictures that are taken in processes of their own, while the home goes on.

Python does one thing at a time in a process, and half of what a picture costs is Python: beside the work of an hour it
would take turns with it. A picture costs more than what an hour does meanwhile, so there are two. The second is a fork
of the first, which has imported what they need and made the people who are expected: they share its memory. All homes
of a process share the two; they end with the last of them.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from functools import partial
from itertools import count
from multiprocessing.connection import Connection
from typing import NamedTuple

from coopera.core.errors import SimulationError
from coopera.core.household import AgentId
from coopera.core.people import Persona
from coopera.simulation.acts.plans import Ground, Step
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.drawing.context import Renderer, chosen
from coopera.simulation.homes.scene import Scene
from coopera.simulation.motions.library import Library
from coopera.simulation.people.appearance import Appearance, appearance_of
from coopera.simulation.sight.recording import Recording
from coopera.simulation.sight.stances import Stances
from coopera.simulation.sight.watching import Order, Watcher
from coopera.simulation.state.home_state import HomeState

_BEGIN = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[2]); "
    "from coopera.simulation.sight.darkroom import serve; serve(json.loads(sys.argv[1]))"
)
_AT_ONCE = 2
"""How many processes take pictures, where there are so many cores."""
_ENDED = "The process that draws pictures ended before these were drawn."
_WITH = {"OPENBLAS_NUM_THREADS": "1", "MALLOC_ARENA_MAX": "1"}
"""A fork is to be made of one thread; a second heap, for the thread that draws, would be 8 MB more."""
_PATIENCE = 5.0
"""Seconds that the processes may take to close a home; then they are ended."""
_IDLE_PATIENCE = 0.2
"""Seconds that they may take to end where they have not had a home, such as in the middle of their imports."""


class Expected(NamedTuple):
    """Who will be drawn: the first message, to the first process, which makes them before there is a second."""

    looks: tuple[Appearance, ...]


class Opened(NamedTuple):
    """A home of which pictures will be taken."""

    home: int
    scene: Scene
    motions: Library
    people: tuple[AgentId, ...]
    robots: Mapping[AgentId, RobotBody]
    renderer: Renderer


class Inhabited(NamedTuple):
    """Who lives in a home from now on; they will be wanted in pictures."""

    home: int
    looks: dict[AgentId, Appearance]


class Filmed(NamedTuple):
    """An act of which pictures are to be taken: all that it is filmed from."""

    home: int
    number: int
    """By which the answer names it."""
    state: HomeState
    before: Stances
    steps: list[Step]
    robot: AgentId
    person: AgentId
    actor: AgentId
    looks: dict[AgentId, Appearance]
    order: Order


class Closed(NamedTuple):
    """A home of which no more pictures are taken; those that are not begun are left."""

    home: int
    number: int


class Studio:
    """Takes pictures of one home; `close` it after use."""

    def __init__(self, ground: Ground, renderer: Renderer, looks: Mapping[AgentId, Appearance]) -> None:
        """Have the processes get ready; `looks` says how people look, and may change."""
        self._home, self._looks = next(_numbers), looks
        self._processes = _started(self._home)
        self._processes.tell(Opened(self._home, ground.scene, ground.motions, ground.people, ground.robots, renderer))

    def take(self, recording: Recording, order: Order) -> Future[None]:
        """Have the pictures of a recording taken; see `Watcher.take`.

        Its error is a `SimulationError`, too, where a process has ended.
        """
        told = recording.state, recording.before, recording.steps, recording.robot, recording.person, recording.actor
        looks, pictures = dict(self._looks), order.moments * len(order.stems)
        return self._processes.film(lambda number: Filmed(self._home, number, *told, looks, order), pictures)

    def inhabited(self) -> None:
        """Have people got ready as they look now."""
        self._processes.tell(Inhabited(self._home, dict(self._looks)))

    def close(self) -> None:
        """Leave what is not begun, and wait for what is; a second time does nothing."""
        if self._home in self._processes.homes:
            self._processes.leave(self._home)


class Films:
    """Pictures of a home that are being taken, and that nobody has waited for yet; `close` it after use."""

    def __init__(
        self, ground: Ground, renderer: Renderer, looks: Mapping[AgentId, Appearance], watcher: Callable[[], Watcher]
    ) -> None:
        """Begin with none; `watcher` is what takes pictures in this process, for the others see `Studio`.

        Where others are `ready`, they are told of the home at once.
        """
        self._ground, self._renderer, self._looks, self._watcher = ground, renderer, looks, watcher
        self._studio = Studio(ground, renderer, looks) if _are_ready() and possible(renderer) else None
        self._films: dict[Future[None], None] = {}

    def inhabited(self) -> None:
        """Have people got ready as they look now, where others take pictures."""
        if self._studio is not None:
            self._studio.inhabited()

    def take(self, recording: Recording, order: Order, *, wait: bool) -> None:
        """Have the pictures of a recording taken: now, or while the home goes on, where that can be.

        Raises:
            SimulationError: If they are to be there now, and cannot be taken.
        """
        if not wait and self._studio is None and possible(self._renderer):
            self._studio = Studio(self._ground, self._renderer, self._looks)
        if not wait and self._studio is not None:
            self._films[self._studio.take(recording, order)] = None
        else:
            self._watcher().take(recording, order)

    def close(self) -> None:
        """Leave what is not begun."""
        if self._studio is not None:
            self._studio.close()
            self._studio = None

    def due(self) -> Callable[[], None] | None:
        """What waits for all that were counted in so far; None where all are there.

        It raises what went wrong, and something else than a `CooperaError` where the home was closed before.
        """
        for film in [one for one in list(self._films) if one.done() and not one.cancelled() and not one.exception()]:
            self._films.pop(film, None)
        films = list(self._films)
        return partial(self._wait_for, films) if films else None

    def _wait_for(self, films: Iterable[Future[None]]) -> None:
        for film in films:
            try:
                film.result()
            finally:
                self._films.pop(film, None)


class _Processes:
    """The processes, and who waits for what of them; if one of them ends, all are at an end."""

    def __init__(self, looks: tuple[Appearance, ...]) -> None:
        pairs = [socket.socketpair() for _ in range(min(_AT_ONCE, cores()))]
        theirs = [pair[1].fileno() for pair in pairs]
        given = [sys.executable, "-I", "-c", _BEGIN, json.dumps(theirs), json.dumps(sys.path)]
        self._first = subprocess.Popen(
            given,
            pass_fds=theirs,
            process_group=0,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            env={**os.environ, **_WITH},
        )
        for _, one in pairs:
            one.close()
        self._pipes = [_Pipe(Connection(ours.detach()), self._end) for ours, _ in pairs]
        self._pipes[0].send(Expected(looks))
        self.homes: set[int] = set()

    @property
    def ended(self) -> bool:
        """Whether no more can be asked of them."""
        return any(pipe.ended for pipe in self._pipes)

    def tell(self, message: Opened | Inhabited) -> None:
        """Have all get something ready."""
        for pipe in self._pipes:
            pipe.send(message)

    def film(self, message: Callable[[int], Filmed], pictures: int) -> Future[None]:
        """Have the one film an act that has the fewest pictures to take."""
        pipe = min(self._pipes, key=lambda one: one.left)
        return pipe.ask(message, pictures)

    def leave(self, home: int) -> None:
        """Have a home closed, and the processes ended where it was the last one."""
        closed = [pipe.ask(partial(Closed, home)) for pipe in self._pipes]
        try:
            for one in closed:
                one.result(_PATIENCE)
        except (TimeoutError, SimulationError):
            self._end()
        with _one_at_a_time:
            self.homes.discard(home)
            self.end_if_idle(_PATIENCE)

    def end_if_idle(self, patience: float) -> None:
        """End the processes where they have no home, within so many seconds."""
        if self.homes:
            return
        for pipe in self._pipes:
            pipe.ended = True  # before it hears that the other end is gone
            pipe.send(None)
        try:
            self._first.wait(patience)
        except subprocess.TimeoutExpired:
            self._end()
            self._first.wait()
        for pipe in self._pipes:
            pipe.hearing.join()

    def _end(self) -> None:
        """End them at once."""
        with suppress(ProcessLookupError):
            os.killpg(self._first.pid, signal.SIGKILL)


class _Pipe:
    """What is asked of one process, and who waits for it."""

    def __init__(self, pipe: Connection, broken: Callable[[], None]) -> None:
        """`broken` is called when the process has ended by itself, once or more often."""
        self._pipe, self._broken = pipe, broken
        self._awaited: dict[int, tuple[Future[None], int]] = {}
        self._sending = threading.Lock()
        self.ended = False
        self.hearing = threading.Thread(target=self._hear, name="pictures", daemon=True)
        self.hearing.start()

    @property
    def left(self) -> int:
        """How many pictures are asked for and not there."""
        return sum(pictures for _, pictures in [*self._awaited.values()])

    def ask(self, message: Callable[[int], Filmed | Closed], pictures: int = 0) -> Future[None]:
        """Send what is answered, and how many pictures that is."""
        number, awaited = next(_numbers), Future[None]()
        self._awaited[number] = awaited, pictures
        self.send(message(number))
        if self.ended:
            self._give_up()
        return awaited

    def send(self, message: Expected | Opened | Inhabited | Filmed | Closed | None) -> None:
        """Send something; whether it arrives is told by the answer."""
        with self._sending:
            try:
                self._pipe.send(message)
            except OSError:
                self._broken()
                self.ended = True

    def _hear(self) -> None:
        """Take the answers, until the process ends."""
        while True:
            try:
                number, wrong = self._pipe.recv()
            except (EOFError, OSError):
                break  # it has ended
            awaited, _ = self._awaited.pop(number, (Future(), 0))
            if wrong is None:
                awaited.set_result(None)
            elif wrong:
                awaited.set_exception(SimulationError(wrong))
            else:
                awaited.cancel()
        if not self.ended:
            self._broken()
        self.ended = True
        self._give_up()
        self._pipe.close()

    def _give_up(self) -> None:
        """Tell all who still wait, each once, whichever thread does so."""
        for number in list(self._awaited):
            if (waits := self._awaited.pop(number, None)) is not None:
                waits[0].set_exception(SimulationError(_ENDED))


_numbers = count()
_one_at_a_time = threading.Lock()
_processes: list[_Processes] = []


def cores() -> int:
    """How many cores this process may use: a benchmark's worker keeps to its own."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def possible(renderer: Renderer) -> bool:
    """Whether pictures can be taken beside: our own renderer's, by Python's own program, which takes an open pipe."""
    return chosen(renderer) == "gl" and os.name == "posix" and bool(sys.executable)


@contextmanager
def ready(renderer: Renderer, people: Iterable[Persona] = ()) -> Iterator[None]:
    """Begin the processes, if there can be any, before there is a home: that takes a second.

    They end if there is none. The people are made, while there is nothing else to do.
    """
    if possible(renderer):
        _started(looks=tuple(appearance_of(one.profile, one.id, one.appearance) for one in people))
    try:
        yield
    finally:
        with _one_at_a_time:
            if _are_ready():
                _processes[0].end_if_idle(_IDLE_PATIENCE)


def _are_ready() -> bool:
    """Whether there are processes that take pictures."""
    return bool(_processes) and not _processes[0].ended


def _started(home: int | None = None, looks: tuple[Appearance, ...] = ()) -> _Processes:
    """The processes of this one that take pictures, begun where there are none; a home keeps them from ending."""
    with _one_at_a_time:
        if not _are_ready():
            _processes[:] = [_Processes(looks)]
        if home is not None:
            _processes[0].homes.add(home)
        return _processes[0]
