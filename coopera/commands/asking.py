"""Who asks a real person: the terminal, or a page in the browser."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from coopera.core.errors import CooperaError, StoppedError

if TYPE_CHECKING:
    from coopera.config.schema import Config
    from coopera.graphs.players.real_person import Interview

PageHost = Annotated[
    str,
    typer.Option("--host", metavar="ADDRESS", help="Where pages listen; on another than 127.0.0.1 they need a token."),
]
PagePort = Annotated[int, typer.Option("--port", metavar="N", help="The pages' port; 0 takes any that is free.")]
HOST, PORT = "127.0.0.1", 8765


@contextmanager
def asked(config: Config, host: str, port: int) -> Iterator[Interview]:
    """What puts a run's questions to the person; with `played_by: web` a page, whose address is told.

    Raises:
        ConfigError: If the page cannot have its address.
    """
    if config.played_by != "web":
        from coopera.people.terminal import Terminal

        yield Terminal()
        return
    from coopera.web.common import Door, served
    from coopera.web.person.app import make_person_app
    from coopera.web.person.person import WebPerson

    person = WebPerson()
    with served(lambda door: make_person_app(person, door), Door.opened(host, port)) as server:
        typer.echo(f"The day is lived at {server.address}", err=True)
        try:
            yield person
        except (KeyboardInterrupt, StoppedError):
            person.end("The run was stopped; it goes on with the same page when it is resumed.")
            raise
        except CooperaError as err:
            person.end(f"The run has stopped: {err}")
            raise
        person.end("The study is over.")
