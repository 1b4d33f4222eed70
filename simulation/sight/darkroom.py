"""The process in which pictures are taken: it is told of homes and of acts, and films them; see `studio`."""

from __future__ import annotations

import signal
from concurrent.futures import Future
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection
from threading import Lock

from coopera.core.errors import CooperaError
from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Ground
from coopera.simulation.bodies.elbowroom import Elbowroom
from coopera.simulation.people.appearance import Appearance
from coopera.simulation.sight.recording import Filming
from coopera.simulation.sight.studio import Closed, Filmed, Opened
from coopera.simulation.sight.watching import Watcher
from coopera.simulation.ways.navigation import Navigator


def serve(pipe: int) -> None:
    """Do what is asked through a pipe, by its number, until the last message (None) or until its other end is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who asks for pictures says when it is over
    with Connection(pipe) as asked:
        darkroom = _Darkroom(asked)
        with suppress(EOFError, OSError):
            while (message := asked.recv()) is not None:
                darkroom.do(message)
        darkroom.close()


class _Darkroom:
    """The homes of which pictures are taken."""

    def __init__(self, answers: Connection) -> None:
        self._answers, self._answering = answers, Lock()
        self._homes: dict[int, tuple[Watcher, dict[AgentId, Appearance]]] = {}

    def do(self, message: Opened | Filmed | Closed) -> None:
        if isinstance(message, Opened):
            scene, looks = message.scene, dict[AgentId, Appearance]()
            room = Elbowroom(scene)
            ground = Ground(scene, Navigator(scene), message.motions, message.people, message.robots, room)
            watcher = Watcher(ground, message.renderer, looks)
            self._homes[message.home] = watcher, looks
            watcher.get_ready()
        elif isinstance(message, Filmed):
            self._film(message)
        else:
            self._homes.pop(message.home)[0].close()
            self._answer(message.number, None)

    def close(self) -> None:
        """Leave what is not begun."""
        for watcher, _ in self._homes.values():
            watcher.close()

    def _film(self, act: Filmed) -> None:
        watcher, looks = self._homes[act.home]
        if looks != act.looks:
            watcher.rest()  # those who are being drawn
            looks.clear()
            looks.update(act.looks)
        try:
            recording = Filming(watcher.ground, act.state, act.robot, act.person).film(act.steps, act.actor)
            film = watcher.take(recording, act.order)
        except Exception as err:  # noqa: BLE001 - who asked is told
            self._answer(act.number, _sentence(err))
            return
        film.add_done_callback(partial(self._done, act.number))

    def _done(self, number: int, film: Future[None]) -> None:
        if film.cancelled():
            self._answer(number, "")
        else:
            err = film.exception()
            self._answer(number, None if err is None else _sentence(err))

    def _answer(self, number: int, wrong: str | None) -> None:
        """Say that something is done (None), left ("") or what is wrong with it."""
        with self._answering, suppress(OSError):  # nobody asks any more
            self._answers.send((number, wrong))


def _sentence(err: BaseException) -> str:
    return str(err) if isinstance(err, CooperaError) else f"The pictures cannot be drawn ({type(err).__name__}: {err})."
