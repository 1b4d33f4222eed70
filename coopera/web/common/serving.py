"""Serving an application: in the foreground until Ctrl-C, or beside other work."""

from __future__ import annotations

import errno
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import uvicorn
from starlette.applications import Starlette

from coopera.config.files import reason
from coopera.core.errors import ConfigError
from coopera.web.common.door import Door

MakeApp = Callable[[Door], Starlette]
_PATIENCE = 2  # seconds that open connections may take to end


@dataclass(frozen=True, slots=True)
class Served:
    """A server that listens.

    Attributes:
        door: As it was opened, with the port that it has.
    """

    door: Door

    @property
    def address(self) -> str:
        """What to open in a browser."""
        return self.door.address()


def serve(make: MakeApp, door: Door, say: Callable[[str], None]) -> None:
    """Serve until Ctrl-C, which ends it in an orderly way.

    Args:
        make: Makes the application for the door as it was opened.
        door: Where to listen.
        say: Is told the address, once the server listens.

    Raises:
        ConfigError: If the address cannot be had, such as a port in use.
    """
    with _listening(door) as (listener, opened):
        server = _server(make(opened))
        say(opened.address())
        try:
            server.run(sockets=[listener])
        except KeyboardInterrupt:
            return


@contextmanager
def served(make: MakeApp, door: Door) -> Iterator[Served]:
    """Serve beside the work of the `with` block, in a thread of its own.

    Raises:
        ConfigError: If the address cannot be had, such as a port in use.
    """
    with _listening(door) as (listener, opened):
        server = _server(make(opened))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, name="pages", daemon=True)
        thread.start()
        try:
            yield Served(opened)
        finally:
            server.should_exit = True
            thread.join(_PATIENCE + 3)


def _server(app: Starlette) -> uvicorn.Server:
    return uvicorn.Server(
        uvicorn.Config(
            app,
            log_level="warning",
            access_log=False,  # it would show tokens
            server_header=False,
            ws="none",
            timeout_graceful_shutdown=_PATIENCE,
        )
    )


@contextmanager
def _listening(door: Door) -> Iterator[tuple[socket.socket, Door]]:
    """A socket that listens, and the door with its port."""
    if not 0 <= door.port <= 65535:
        raise ConfigError(f"port: {door.port} is no port; they go from 0 (any free one) to 65535.")
    try:
        family = socket.getaddrinfo(door.host, door.port, type=socket.SOCK_STREAM)[0][0]
    except (OSError, UnicodeError) as err:
        raise ConfigError(f"host: {door.host!r} is no address of this machine.") from err
    with socket.socket(family, socket.SOCK_STREAM) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((door.host, door.port))
            listener.listen(128)
        except OSError as err:
            raise ConfigError(_why_not(door, err)) from err
        yield listener, replace(door, port=listener.getsockname()[1])


def _why_not(door: Door, err: OSError) -> str:
    if err.errno == errno.EADDRINUSE:
        return f"port: {door.port} is in use; name another with --port, or 0 for any that is free."
    if err.errno == errno.EADDRNOTAVAIL:
        return f"host: {door.host!r} is no address of this machine."
    return f"port: {door.port} of {door.host} cannot be had ({reason(err)})."
