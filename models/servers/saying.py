"""Errors of clients in words: one line of bounded length, with its cause, and without anything secret."""

from __future__ import annotations

import base64
import os
import re
from collections.abc import Iterator

LOGIN = "COOPERA_SERVER_LOGIN"
"""The environment variable with USER:PASSWORD for a server that asks for them."""
MOST_SAID = 500  # characters
_LOGIN = re.compile(r"(?<=://)[^\s'\"]*@")
_BEHIND = re.compile(r"(?<=://)([^\s'\"?#]*)[?#][^\s'\"]*")
_LINKS = 5  # clients wrap each other's errors, but not more often
_LEAST = 4  # characters of a value that is looked for: shorter ones stand in any text


def one_line(err: BaseException) -> str:
    """An error's text on one line, with what caused it, but without any key or password that the environment holds."""
    said = " ".join(str(err).split()) or type(err).__name__
    why = next((text for cause in _causes(err) if (text := " ".join(str(cause).split())) and text not in said), "")
    said = f"{said.rstrip('.')}: {why}" if why else said
    for name, secret in _secrets():
        said = said.replace(secret, f"<{name}>")
    return bare_addresses(said)[:MOST_SAID]


def _causes(err: BaseException) -> Iterator[BaseException]:
    """What an error came of, the nearest first, as far as it matters."""
    cause = err.__cause__
    for _ in range(_LINKS):
        if cause is None:
            return
        yield cause
        cause = cause.__cause__


def bare_addresses(text: str) -> str:
    """A text whose addresses have no user and password, and nothing behind ? or #, where keys may stand."""
    return _BEHIND.sub(r"\1", _LOGIN.sub("", text))


def _secrets() -> Iterator[tuple[str, str]]:
    """What the environment holds that nobody is to read, longest first, each with the variable's name."""
    found = [(name, value) for name, value in os.environ.items() if name.endswith("_API_KEY")]
    if login := os.environ.get(LOGIN):
        coded = base64.b64encode(login.encode()).decode()
        found += [(LOGIN, part) for part in (login, coded, login.partition(":")[2])]
    return iter(sorted(((name, part) for name, part in found if len(part) >= _LEAST), key=lambda one: -len(one[1])))
