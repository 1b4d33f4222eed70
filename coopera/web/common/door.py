"""The door of a page's server: who may come in, and which requests are refused before a page sees them.

Four attacks are kept out: a foreign page that posts here (Origin and form token), a foreign name that was made to mean
this machine (Host), somebody else on the network (token), and text that becomes a script (the pages' policy).
"""

from __future__ import annotations

import hmac
import ipaddress
import secrets
import socket
from collections.abc import Mapping
from dataclasses import dataclass, field
from http import HTTPStatus
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs, parse_qsl, quote, urlencode, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import HTMLResponse, PlainTextResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from coopera.report.policy import served_policy

LOOPBACK = ("127.0.0.1", "localhost", "::1")
TOKEN, FORM_FIELD, FORM_HEADER = "token", "form_token", "x-form-token"
STALE = "This page is from before the server was started anew; load it again, and nothing that was given is lost."
MOST_BODY = 1 << 20
_SAFE = {"GET", "HEAD"}
_HEADERS = {
    "content-security-policy": served_policy(),
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}
# A page, not a redirection: a cookie that is SameSite=Strict is not sent along one that began on a foreign site.
_COME_IN = '<!doctype html><meta http-equiv="refresh" content="0;url={}"><title>coopera</title>'


@dataclass(frozen=True, slots=True)
class Door:
    """Where a server listens, and what it asks of those who come.

    Attributes:
        host: The address that it listens on; on another than this machine's own, a token is needed.
        port: 0 takes any free one.
        names: Names by which the server may be called besides addresses: that of a proxy with TLS before it.
        token: Stands in the address that is printed, then in a cookie; empty where none is needed.
        form_token: Stands in each page; what is posted must bring it back.
    """

    host: str = "127.0.0.1"
    port: int = 8765
    names: tuple[str, ...] = ()
    token: str = ""
    form_token: str = field(default_factory=lambda: secrets.token_urlsafe(32), repr=False)

    @classmethod
    def opened(cls, host: str = "127.0.0.1", port: int = 8765, names: tuple[str, ...] = ()) -> Door:
        """A door with a token where others than this machine can reach it, by the network or through a proxy."""
        alone = host in LOOPBACK and not names
        return cls(host, port, names, token="" if alone else secrets.token_urlsafe(24))

    @property
    def cookie(self) -> str:
        """The token's cookie; cookies are shared by all ports of a machine, so each port has a name of its own."""
        return f"coopera-{self.port}"

    def address(self, path: str = "/") -> str:
        """The address to be opened in a browser, with the token if there is one."""
        query = f"?{urlencode({TOKEN: self.token})}" if self.token else ""
        if self.names:
            return f"https://{self.names[0]}{path}{query}"
        host = socket.gethostname() if self.host in {"0.0.0.0", "::"} else self.host
        host = f"[{host}]" if ":" in host else host
        return f"http://{host}:{self.port}{path}{query}"

    def called(self, host: str) -> bool:
        """Whether a Host header names this server: by an address, or by a name that is known to be its own."""
        name = _name(host)
        if name in LOOPBACK or name in {one.lower() for one in self.names}:
            return True
        if not self.token:
            return False
        return _is_address(name) or name in {socket.gethostname().lower(), socket.getfqdn().lower()}

    def knows(self, token: str) -> bool:
        """Whether a token is this door's."""
        return hmac.compare_digest(token.encode(), self.token.encode())


class Guard:
    """Refuses what must not come in, and gives every answer the headers that keep a page what it is."""

    def __init__(self, app: ASGIApp, door: Door) -> None:
        self._app, self._door = app, door

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request through, or answer it here."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        refused = self._refused(scope, headers)
        if scope["type"] != "http":  # no page of ours speaks anything else
            await _close(receive, send)
            return
        if refused is None and scope["method"] not in _SAFE:
            body, whole = await _body(receive)
            refused = self._unsigned(headers, body) if whole else _no(413, "That is more than a form can hold.")
            receive = _again(body, receive)
        target: ASGIApp = self._app if refused is None else refused
        await target(scope, receive, _with_headers(send))

    def _refused(self, scope: Scope, headers: Headers) -> Response | None:
        """What a request is answered that must not come in at all."""
        door, host = self._door, headers.get("host", "")
        if not door.called(host):
            return _no(421, f"This server is not called {_name(host)[:100]!r}; open the address that it printed.")
        if not door.token:
            return None
        query = scope.get("query_string", b"").decode("latin-1")
        given = parse_qs(query).get(TOKEN)
        if given and scope.get("method") == "GET" and door.knows(given[0]):
            return self._welcome(scope, query)
        if door.knows(_cookies(headers).get(door.cookie, "")):
            return None
        return _no(403, "This page needs the token of the address that was printed where it was started.")

    def _welcome(self, scope: Scope, query: str) -> Response:
        rest = urlencode([(name, value) for name, value in parse_qsl(query) if name != TOKEN])
        path = "/" + quote(scope["path"].lstrip("/\\"))  # one bar: two would name another machine
        page = HTMLResponse(_COME_IN.format(path + (f"?{rest}" if rest else "")).replace("&", "&amp;"))
        page.set_cookie(
            self._door.cookie, self._door.token, httponly=True, samesite="strict", secure=scope["scheme"] == "https"
        )
        return page

    def _unsigned(self, headers: Headers, body: bytes) -> Response | None:
        """What a post is answered that does not come from one of our own pages."""
        origin, site = headers.get("origin"), headers.get("sec-fetch-site", "")
        foreign = urlsplit(origin).netloc != headers["host"] if origin else site not in {"same-origin", ""}
        if foreign:
            return _no(403, "Only a page of this server may post here.")
        given = headers.get(FORM_HEADER) or _form_token(headers, body)
        if not hmac.compare_digest(given.encode(), self._door.form_token.encode()):
            return _no(403, STALE, {"x-stale": "1"})
        return None


def _form_token(headers: Mapping[str, str], body: bytes) -> str:
    if headers.get("content-type", "").split(";")[0] != "application/x-www-form-urlencoded":
        return ""
    return parse_qs(body.decode("utf-8", "replace")).get(FORM_FIELD, [""])[0]


def _no(status: int, sentence: str, headers: Mapping[str, str] | None = None) -> Response:
    return PlainTextResponse(f"{HTTPStatus(status).phrase}. {sentence}\n", status, headers)


def _name(host: str) -> str:
    """The name in a Host header, without the port."""
    try:
        return (urlsplit(f"//{host}").hostname or "").lower()
    except ValueError:
        return ""


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _cookies(headers: Headers) -> dict[str, str]:
    try:
        return {name: morsel.value for name, morsel in SimpleCookie(headers.get("cookie", "")).items()}
    except CookieError:
        return {}


async def _close(receive: Receive, send: Send) -> None:
    await receive()
    await send({"type": "websocket.close", "code": 1008})


async def _body(receive: Receive) -> tuple[bytes, bool]:
    """The body of a request, and whether that is all of it."""
    body = b""
    while True:
        message = await receive()
        body += message.get("body", b"")
        if len(body) > MOST_BODY:
            return b"", False
        if message["type"] != "http.request" or not message.get("more_body"):
            return body, True


def _again(body: bytes, receive: Receive) -> Receive:
    """Hands out a body that has been read, then whatever comes."""
    parts: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def give() -> Message:
        return parts.pop() if parts else await receive()

    return give


def _with_headers(send: Send) -> Send:
    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in _HEADERS.items():
                headers.setdefault(name, value)
        await send(message)

    return sent
