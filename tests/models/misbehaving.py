"""A server in this process that misbehaves in one way at a time, and the ways: what each sends, and what is said of it.

docs/reliability.md has one line for each (`tests/models/test_misbehaving.py`).
"""

from __future__ import annotations

import gzip
import json
import socket
import struct
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from itertools import chain, repeat
from typing import Any

from tests.server import completion, made_up, schema_of_request

ESCAPES = "\x1b[31mred\x1b]0;title\x07 \x9b2J \u202eback"
JSON = {"content-type": "application/json"}


class Server(ThreadingHTTPServer):
    """Serves in threads while it is entered; `way` may change at any time. With `elsewhere`, redirects lead there."""

    daemon_threads = True
    request_queue_size = 64

    def __init__(self, way: str = "good", port: int = 0) -> None:
        self.way = way
        self.requests = 0
        self.begun, self.ended = threading.Event(), threading.Event()
        self.elsewhere = ""
        super().__init__(("127.0.0.1", port), Handler)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.server_address[1]}/v1"

    def __enter__(self) -> Server:
        threading.Thread(target=self.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()
        return self

    def __exit__(self, *error: object) -> None:
        self.ended.set()
        self.shutdown()
        self.server_close()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing: clients hang up on such a server."""


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    server: Server

    def log_message(self, *_: Any) -> None:
        """Say nothing."""

    def do_GET(self) -> None:
        self.do_POST()

    def do_POST(self) -> None:
        self.server.requests += 1
        body = self.rfile.read(int(self.headers.get("content-length") or 0))
        self.close_connection = True
        self.server.begun.set()
        with suppress(OSError):
            WAYS[self.server.way].serve(self, json.loads(body or "{}"))

    def raw(self, pieces: Iterable[bytes], every: float = 0.0) -> None:
        """Send bytes as they are, until the client or the test has had enough."""
        for piece in pieces:
            if self.server.ended.wait(every) if every else self.server.ended.is_set():
                return
            self.wfile.write(piece)

    def head(self, status: int = 200, **more: str) -> bytes:
        lines = [f"HTTP/1.1 {status} Any", *(f"{name.replace('_', '-')}: {value}" for name, value in more.items())]
        return ("\r\n".join(lines) + "\r\n\r\n").encode("latin-1")

    def answer(self, body: str | bytes, status: int = 200, **more: str) -> None:
        data = body.encode() if isinstance(body, str) else body
        kind = {"content_type": "application/json", "connection": "close", **more}
        self.raw([self.head(status, **{"content_length": str(len(data)), **kind}), data])


Serve = Callable[[Handler, dict[str, Any]], None]


@dataclass(frozen=True)
class Way:
    """One way.

    Attributes:
        serve: Answers a request, which it is given as it was sent.
        said: What the error says, as a pattern; empty where there is none.
        hangs: Whether the client must lose patience first.
        replies: Whether it is a reply, so that the run goes on with it.
    """

    serve: Serve
    said: str = ""
    hangs: bool = False
    replies: bool = False


def good(asked: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    """A completion as it should be, with other fields instead."""
    schema = schema_of_request(asked)
    text = json.dumps(made_up(schema, json.dumps(asked["messages"]))) if schema is not None else "No."
    return {**completion(asked, text, 100, 20, cut=False), **more}


def saying(text: str) -> Serve:
    """Answer with a completion that says this."""
    return lambda to, asked: to.answer(json.dumps(completion(asked, text, 100, 20, cut=False)))


def counting(said: str) -> Serve:
    """Answer well, and count the tokens so; written as it is, since not all of it is JSON."""
    usage = f'"usage": {{"prompt_tokens": {said}, "completion_tokens": {said}, "total_tokens": {said}}}'
    return lambda to, asked: to.answer(json.dumps(good(asked, usage=None)).replace('"usage": null', usage))


def sending(*body: bytes, endless: bytes = b"", every: float = 0.0, **head: str) -> Serve:
    """Send a head and a body, which may go on without end."""
    kind = {"content_type": "application/json", **head}
    return lambda to, _: to.raw(chain([to.head(**kind)], body, repeat(endless) if endless else ()), every)


def failing(status: int, body: str = '{"error": {"message": "overloaded"}}', **head: str) -> Serve:
    return lambda to, _: to.answer(body, status, **head)


def leading(status: int, *, around: bool = False) -> Serve:
    """Redirect to another server, or to itself."""
    return lambda to, _: to.answer("", status, location=f"{to.server.url if around else to.server.elsewhere}/more")


def hang_up(to: Handler, _: object) -> None:
    """Reset the connection."""
    to.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))


def be_silent(to: Handler, _: object) -> None:
    to.server.ended.wait(30)


def drip_headers(to: Handler, _: object) -> None:
    to.raw(chain([b"HTTP/1.1 200 OK\r\n"], repeat(b"x")), 0.02)


def flood_headers(to: Handler, _: object) -> None:
    to.raw(chain([b"HTTP/1.1 200 OK\r\n"], repeat(b"x-more: " + b"y" * 4000 + b"\r\n")))


def lie_of_error(to: Handler, _: object) -> None:
    to.answer(json.dumps({"error": {"message": "the model is not loaded", "code": 17}}))


def echo(to: Handler, _: object) -> None:
    to.answer(json.dumps({"error": {"message": f"bad request: {to.headers}"}}), 404)


def no_choices(said: object) -> Serve:
    return lambda to, asked: to.answer(json.dumps(good(asked, choices=said)))


def _cut(to: Handler, asked: dict[str, Any]) -> None:
    body = json.dumps(good(asked)).encode()
    to.raw([to.head(content_type="application/json", content_length=str(len(body))), body[: len(body) // 2]])


def _as_text(to: Handler, asked: dict[str, Any]) -> None:
    to.answer(json.dumps(good(asked)), content_type="text/plain")


def _in_utf16(to: Handler, asked: dict[str, Any]) -> None:
    to.answer(json.dumps(good(asked)).encode("utf-16")[:-1])


def _events(to: Handler, asked: dict[str, Any]) -> None:
    to.answer(f"data: {json.dumps(good(asked))}\n\ndata: [DONE]\n\n", content_type="text/event-stream")


LIMIT = 1_000_000
"""What `calls.max_bytes` is where nobody says otherwise."""
_MEGABYTE = b" " * 2**20
_BOMB = gzip.compress(b" " * 10_000_000)
_ELSEWHERE = r"sends its callers elsewhere \(30\d: http://127.0.0.1:\d+/v1/more\)"
_TOO_LONG = f"more than {LIMIT} bytes"
_NO_REPLY = "what the server sent is no reply"
_TEXT = b'{"choices": [{"index": 0, "message": {"role": "assistant", "content": "'

WAYS: dict[str, Way] = {
    "good": Way(lambda to, asked: to.answer(json.dumps(good(asked))), replies=True),
    "hangs up at once": Way(hang_up, "Connection error"),
    "hangs up midway": Way(_cut, "Connection error"),
    "says nothing": Way(be_silent, "timed out", hangs=True),
    "drips headers": Way(drip_headers, "timed out", hangs=True),
    "drips white space": Way(sending(endless=b" ", every=0.02), "timed out", hangs=True),
    "drips text": Way(sending(_TEXT, endless=b"a", every=0.02), "timed out", hangs=True),
    "floods white space": Way(sending(endless=_MEGABYTE), _TOO_LONG),
    "floods text": Way(sending(_TEXT, endless=b"a" * 2**20), _TOO_LONG),
    "sends 100 MB": Way(sending(*[_MEGABYTE] * 100, content_length=str(100 * 2**20)), _TOO_LONG),
    "floods headers": Way(flood_headers, "Connection error"),
    "sends a gzip bomb": Way(sending(_BOMB, content_encoding="gzip"), "compressed .gzip., though none was asked"),
    "nests its answer 200,000 deep": Way(lambda to, _: to.answer("[" * 200_000), "nested more than 100 levels deep"),
    "nests its reply 200,000 deep": Way(saying("[" * 200_000), "not valid JSON", replies=True),
    "nests its reply 200 deep": Way(
        saying('{"verdicts": ' * 200 + "1" + "}" * 200), "nested more than 100 levels deep", replies=True
    ),
    "is no HTTP server": Way(lambda to, _: to.raw([b"\x16\x03\x01 220 mail ready\r\n"]), "Connection error"),
    "sends broken chunks": Way(sending(b"zz\r\nno chunk\r\n", transfer_encoding="chunked"), "Connection error"),
    "sends no JSON": Way(lambda to, _: to.answer("{never mind"), _NO_REPLY),
    "sends nothing": Way(lambda to, _: to.answer(""), _NO_REPLY),
    "sends an HTML page": Way(lambda to, _: to.answer("<html>502</html>", content_type="text/html"), _NO_REPLY),
    "sends JSON as plain text": Way(_as_text, replies=True),
    "streams events unasked": Way(_events, _NO_REPLY),
    "sends half a UTF-16 text": Way(_in_utf16, _NO_REPLY),
    "has null for choices": Way(no_choices(None), _NO_REPLY),
    "has no choices": Way(no_choices([]), _NO_REPLY),
    "has choices without a message": Way(no_choices([{"index": 0}]), _NO_REPLY),
    "says 200 and means an error": Way(lie_of_error, "the model is not loaded"),
    "leads elsewhere (301)": Way(leading(301), _ELSEWHERE),
    "leads elsewhere (307)": Way(leading(307), _ELSEWHERE),
    "leads around in a circle": Way(leading(308, around=True), _ELSEWHERE),
    "is busy (429)": Way(failing(429), "overloaded"),
    "is busy for ten years (429)": Way(failing(429, retry_after="315360000"), "left alone for 3.1536e.08 seconds"),
    "is busy for ever (503)": Way(failing(503, retry_after="1e999"), "left alone for inf seconds"),
    "fails (500)": Way(failing(500), "overloaded"),
    "fails in colour (500)": Way(failing(500, json.dumps({"error": {"message": ESCAPES}})), "red"),
    "wants a password (401)": Way(failing(401, www_authenticate="Basic"), "overloaded"),
    "knows no such model (404)": Way(failing(404), "overloaded"),
    "tells what it was sent": Way(echo, "authorization: B"),
    "answers something else": Way(saying('{"mood": "fine"}'), "Field required", replies=True),
    "answers in colour": Way(saying(ESCAPES), "not valid JSON", replies=True),
    "answers with half a character": Way(saying("\ud800 no"), "there is no JSON object", replies=True),
    "counts tokens below nothing": Way(counting("-1000"), replies=True),
    "counts too many tokens": Way(counting("1" + "0" * 20), replies=True),
    "counts endless tokens": Way(counting("1e400"), replies=True),
    "counts tokens that are no number": Way(counting("NaN"), replies=True),
    "counts half tokens": Way(counting("10.5"), replies=True),
    "counts no tokens": Way(lambda to, asked: to.answer(json.dumps(good(asked, usage=None))), replies=True),
}
"""What a server does, besides not being there, and being killed and started again."""


@contextmanager
def misbehaving(way: str) -> Iterator[Server]:
    """Run a server that misbehaves so, with a good one beside it to which redirects lead."""
    with Server() as other, Server(way) as server:
        server.elsewhere = other.url
        yield server
        assert other.requests == 0, "the prompt went to another server"
