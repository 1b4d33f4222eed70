"""The processes in which pictures are taken: they are told of homes and of acts, and film them; see `studio`."""

from __future__ import annotations

import gc
import os
import signal
from contextlib import suppress
from multiprocessing.connection import Connection
from queue import SimpleQueue
from threading import Thread
from typing import get_args

import scipy.interpolate  # noqa: F401 - people are made with it: a fork is to have it already
from PIL import Image

from coopera.core.errors import CooperaError
from coopera.core.household import AgentId
from coopera.core.lazy import NEW_OBJECTS
from coopera.simulation.acts.plans import Ground
from coopera.simulation.bodies.elbowroom import Elbowroom
from coopera.simulation.drawing.materials import pictures
from coopera.simulation.drawing.renderer import get_ready
from coopera.simulation.people.appearance import Appearance, Outfit
from coopera.simulation.people.skin import skinned
from coopera.simulation.sight.recording import Filming
from coopera.simulation.sight.studio import Closed, Filmed, Inhabited, Opened, cores
from coopera.simulation.sight.watching import Watcher
from coopera.simulation.ways.navigation import Navigator

_NICE = 5
"""The work that orders pictures goes before them: it is then ahead of them, and they have something to do when it has
none for them, as in an evening."""


def serve(pipes: list[int]) -> None:
    """Do what is asked through pipes, by their numbers: a process for each, this one and forks of it.

    The first message, through the first pipe, says who is expected.
    A process ends with its pipe's last message (None) or when the other end is gone; this one, when all have.
    """
    gc.set_threshold(NEW_OBJECTS)  # a picture makes thousands
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who asks for pictures says when it is over
    os.nice(_NICE)
    Image.init()
    pictures()
    asked = [Connection(pipe) for pipe in pipes]
    first = mine = asked[0]
    with suppress(EOFError, OSError):  # who asks is gone, which shows again below
        _make_people(first)
    for other in asked[1:]:
        if os.fork() == 0:
            mine = other
            break
    for other in asked:
        if other is not mine:
            other.close()
    # Mesa's own threads would only take cores from the other processes; where there are many, some are left to it.
    os.environ.setdefault("LP_NUM_THREADS", str(max(0, cores() // 2 - 1)))
    with mine:
        _Darkroom(mine).work()
    if mine is first:
        with suppress(ChildProcessError):
            while True:
                os.wait()


def _make_people(asked: Connection) -> None:
    """Make who is expected as they are dressed for anything, until something else is asked for."""
    for looks in asked.recv().looks:
        for outfit in get_args(Outfit):
            if asked.poll():
                return
            with suppress(CooperaError):  # who asks for pictures is told
                skinned(looks, outfit)


class _Darkroom:
    """The homes of which pictures are taken."""

    def __init__(self, asked: Connection) -> None:
        self._asked = asked
        self._homes: dict[int, tuple[Watcher, dict[AgentId, Appearance]]] = {}
        self._waiting: SimpleQueue[Opened | Inhabited | Filmed | Closed | None] = SimpleQueue()
        self._left: set[int] = set()
        """Homes of which no more pictures are taken."""
        self._over = False

    def work(self) -> None:
        """Do what is asked for, one after another, until it is over."""
        Thread(target=self._hear, daemon=True).start()
        with suppress(CooperaError):  # who asks for pictures is told
            get_ready()
        while (message := self._waiting.get()) is not None and not self._over:
            if isinstance(message, Opened):
                self._open(message)
            elif isinstance(message, Inhabited):
                self._get_ready(message)
            elif isinstance(message, Filmed):
                self._answer(message.number, "" if message.home in self._left else self._film(message))
            else:
                self._homes.pop(message.home)[0].close()
                self._answer(message.number, None)
        for watcher, _ in self._homes.values():
            watcher.close()

    def _hear(self) -> None:
        """Take what is asked for at once, so that nobody waits to ask, and what is left is known before its turn."""
        with suppress(EOFError, OSError):
            while (message := self._asked.recv()) is not None:
                if isinstance(message, Closed):
                    self._left.add(message.home)
                self._waiting.put(message)
        self._over = True
        self._waiting.put(None)

    def _open(self, message: Opened) -> None:
        scene, looks = message.scene, dict[AgentId, Appearance]()
        room = Elbowroom(scene)
        ground = Ground(scene, Navigator(scene), message.motions, message.people, message.robots, room)
        watcher = Watcher(ground, message.renderer, looks)
        self._homes[message.home] = watcher, looks
        with suppress(CooperaError):  # who asks for pictures is told
            _ = watcher.drawn
        gc.freeze()  # what stays as long as the home does is not looked through again for garbage

    def _get_ready(self, message: Inhabited) -> None:
        """Make the people of a home as they are dressed by day: they will soon be wanted."""
        for looks in message.looks.values():
            with suppress(CooperaError):  # who asks for pictures is told
                skinned(looks, "day")

    def _film(self, act: Filmed) -> str | None:
        """What is wrong with the pictures of an act; None where they are there."""
        watcher, looks = self._homes[act.home]
        looks.clear()
        looks.update(act.looks)
        try:
            filming = Filming(watcher.ground, act.state, act.robot, act.person, act.before)
            watcher.take(filming.film(act.steps, act.actor), act.order)
        except CooperaError as err:
            return str(err)
        except Exception as err:  # noqa: BLE001 - who asked is told
            return f"The pictures cannot be drawn ({type(err).__name__}: {err})."
        return None

    def _answer(self, number: int, wrong: str | None) -> None:
        """Say that something is done (None), left ("") or what is wrong with it."""
        with suppress(OSError):  # nobody asks any more
            self._asked.send((number, wrong))
