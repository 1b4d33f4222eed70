"""Pictures that are taken in a process of their own, while the home goes on.

Python does one thing at a time in a process, and half of what a picture costs is Python: beside the work of an hour it
would take turns with it. All homes of a process share one such process; it ends with the last of them.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Future
from contextlib import contextmanager
from functools import partial
from itertools import count
from multiprocessing.connection import Connection
from typing import NamedTuple

from coopera.core.errors import SimulationError
from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Ground, Step
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.drawing.context import Renderer, chosen
from coopera.simulation.homes.scene import Scene
from coopera.simulation.motions.library import Library
from coopera.simulation.people.appearance import Appearance
from coopera.simulation.sight.recording import Recording
from coopera.simulation.sight.watching import Order
from coopera.simulation.state.home_state import HomeState

_BEGIN = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[2]); "
    "from coopera.simulation.sight.darkroom import serve; serve(int(sys.argv[1]))"
)
_PATIENCE = 5.0
"""Seconds that the process may take to end; then it is ended."""


class Opened(NamedTuple):
    """A home of which pictures will be taken."""

    home: int
    scene: Scene
    motions: Library
    people: tuple[AgentId, ...]
    robots: Mapping[AgentId, RobotBody]
    renderer: Renderer


class Filmed(NamedTuple):
    """An act of which pictures are to be taken: all that it is filmed from."""

    home: int
    number: int
    """By which the answer names it."""
    state: HomeState
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
        """Have the process get ready; `looks` says how people look, and may change."""
        self._home, self._looks = next(_numbers), looks
        self._process = _started(self._home)
        self._process.send(Opened(self._home, ground.scene, ground.motions, ground.people, ground.robots, renderer))

    def take(self, recording: Recording, order: Order) -> Future[None]:
        """Have the pictures of a recording taken; see `Watcher.take`.

        Its error is a `SimulationError`, too, where the process has ended.
        """
        told = recording.state, recording.steps, recording.robot, recording.person, recording.actor
        return self._process.ask(lambda number: Filmed(self._home, number, *told, dict(self._looks), order))

    def close(self) -> None:
        """Leave what is not begun, and wait for what is; a second time does nothing."""
        if self._home in self._process.homes:
            self._process.leave(self._home)


class Films:
    """Pictures of a home that are being taken, and that nobody has waited for yet; `close` it after use."""

    def __init__(self, ground: Ground, renderer: Renderer, looks: Mapping[AgentId, Appearance]) -> None:
        """Begin with none; for the arguments see `Studio`."""
        self._ground, self._renderer, self._looks = ground, renderer, looks
        self._studio: Studio | None = None
        self._films: dict[Future[None], None] = {}

    def beside(self) -> Studio | None:
        """What takes pictures while the home goes on; None where only the home itself can."""
        if self._studio is None and possible(self._renderer):
            self._studio = Studio(self._ground, self._renderer, self._looks)
        return self._studio

    def close(self) -> None:
        """Leave what is not begun."""
        if self._studio is not None:
            self._studio.close()
            self._studio = None

    def add(self, film: Future[None]) -> None:
        """Count pictures in."""
        self._films[film] = None

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


class _Process:
    """The process, and who waits for what of it."""

    def __init__(self) -> None:
        ours, theirs = socket.socketpair()
        with theirs:
            pipe = theirs.fileno()
            given = [sys.executable, "-I", "-c", _BEGIN, str(pipe), json.dumps(sys.path)]
            self._process = subprocess.Popen(
                given, pass_fds=[pipe], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL
            )
        self._pipe = Connection(ours.detach())
        self._awaited: dict[int, Future[None]] = {}
        self._sending = threading.Lock()
        self.ended = False
        self.homes: set[int] = set()
        self._hearing = threading.Thread(target=self._hear, name="pictures", daemon=True)
        self._hearing.start()

    def ask(self, message: Callable[[int], Filmed | Closed]) -> Future[None]:
        """Send what is answered."""
        number, awaited = next(_numbers), Future[None]()
        self._awaited[number] = awaited
        self.send(message(number))
        if self.ended:
            self._give_up()
        return awaited

    def send(self, message: Opened | Filmed | Closed | None) -> None:
        """Send something; whether it arrives is told by the answer."""
        with self._sending:
            try:
                self._pipe.send(message)
            except OSError:
                self.ended = True

    def leave(self, home: int) -> None:
        """Have a home closed, and the process ended where it was the last one."""
        closed = self.ask(partial(Closed, home))
        try:
            closed.result(_PATIENCE)
        except (TimeoutError, SimulationError):
            self._process.kill()
        with _one_at_a_time:
            self.homes.discard(home)
            self.end_if_idle()

    def end_if_idle(self) -> None:
        """End the process where it has no home."""
        if self.homes:
            return
        self.send(None)
        self.ended = True
        try:
            self._process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._hearing.join()

    def _hear(self) -> None:
        """Take the answers, until the process ends."""
        while True:
            try:
                number, wrong = self._pipe.recv()
            except (EOFError, OSError):
                break  # it has ended
            awaited = self._awaited.pop(number, Future())
            if wrong is None:
                awaited.set_result(None)
            elif wrong:
                awaited.set_exception(SimulationError(wrong))
            else:
                awaited.cancel()
        self.ended = True
        self._give_up()
        self._pipe.close()

    def _give_up(self) -> None:
        """Tell all who still wait, each once, whichever thread does so."""
        for number in list(self._awaited):
            if (awaited := self._awaited.pop(number, None)) is not None:
                awaited.set_exception(SimulationError("The process that draws pictures ended before these were drawn."))


_numbers = count()
_one_at_a_time = threading.Lock()
_processes: list[_Process] = []


def possible(renderer: Renderer) -> bool:
    """Whether pictures can be taken beside: our own renderer's, by Python's own program, which takes an open pipe."""
    return chosen(renderer) == "gl" and os.name == "posix" and bool(sys.executable)


@contextmanager
def ready(renderer: Renderer) -> Iterator[None]:
    """Begin the process, if there can be one, before there is a home: that takes a second. It ends if there is none."""
    if possible(renderer):
        _started()
    try:
        yield
    finally:
        with _one_at_a_time:
            if _processes and not _processes[0].ended:
                _processes[0].end_if_idle()


def _started(home: int | None = None) -> _Process:
    """The process of this one that takes pictures, begun where there is none; a home keeps it from ending."""
    with _one_at_a_time:
        if not _processes or _processes[0].ended:
            _processes[:] = [_Process()]
        if home is not None:
            _processes[0].homes.add(home)
        return _processes[0]
