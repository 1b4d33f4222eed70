"""A client for OpenAI-compatible servers that keeps within bounds what they send, and goes nowhere else for them.

The answer's bytes are counted as they come, so a flood is broken off. Compression is not asked for and not taken, since
a small answer could grow without bound. A redirect is an answer like any other: nothing is sent to another address.
"""

from __future__ import annotations

import os
import weakref
from collections.abc import Sequence
from typing import Any

from openai import DefaultHttpxClient, OpenAIError
from typing_extensions import override

from coopera.core.errors import ConfigError
from coopera.models.reading.depth import MOST_DEEP, too_deep
from coopera.models.servers.saying import LOGIN
from coopera.models.servers.waiting import given_up

_PLAIN = {"", "identity"}


class BoundedClient(DefaultHttpxClient):
    """The openai package's own HTTP client, whose answers have at most so many bytes and levels."""

    def __init__(self, most_bytes: int, login: tuple[str, str] | None = None) -> None:
        """Open it.

        Args:
            most_bytes: How long an answer may be.
            login: User and password, sent in place of a key.
        """
        self._most_bytes = most_bytes
        super().__init__(auth=login, follow_redirects=False, headers={"accept-encoding": "identity"})
        ways = [self._transport, *self._mounts.values()]
        # Nothing else knows when nobody uses it any more; `__del__` could come after that of its connections.
        weakref.finalize(self, _close, [way for way in ways if way is not None]).atexit = False

    @override
    def send(self, request: Any, *, stream: bool = False, **options: Any) -> Any:
        """Send a request and read its answer whole; `stream` is not heeded.

        Raises:
            OpenAIError: If the answer is compressed, too long or too deep, or nobody waits for it any longer.
        """
        response = super().send(request, stream=True, **options)
        try:
            body = self._body(response)
        finally:
            response.close()
        return type(response)(response.status_code, headers=response.headers, content=body, request=response.request)

    def _body(self, response: Any) -> bytes:
        packed = str(response.headers.get("content-encoding", "")).strip().lower()
        if packed not in _PLAIN:
            raise OpenAIError(f"the answer is compressed ({packed[:40]}), though none was asked to be")
        body = bytearray()
        for piece in response.iter_bytes():
            body += piece
            if len(body) > self._most_bytes:
                raise OpenAIError(f"the answer has more than {self._most_bytes} bytes (calls.max_bytes)")
            if given_up():
                raise OpenAIError("nobody waits for the answer any longer")
        if too_deep(body.decode("latin-1")):  # the same brackets and quotes as in UTF-8
            raise OpenAIError(f"the answer's JSON is nested more than {MOST_DEEP} levels deep")
        return bytes(body)


def _close(ways: Sequence[Any]) -> None:
    """Close a client's connections."""
    for way in ways:
        way.close()


def login() -> tuple[str, str] | None:
    """User and password for the server, from the environment.

    Raises:
        ConfigError: If the variable holds something else.
    """
    said = os.environ.get(LOGIN)
    if not said:
        return None
    user, colon, password = said.partition(":")
    if not user or not colon:
        raise ConfigError(f"the environment variable {LOGIN} must be USER:PASSWORD.")
    return user, password
