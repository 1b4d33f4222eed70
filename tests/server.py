"""An OpenAI-compatible server for tests and benchmarks, to be run in a process of its own: `python -m tests.server`.

It answers with a tiny model that it holds to `response_format` (or a tool's parameters), or makes up a reply that fits.
It can be slow, and it can misbehave in every way that servers do. What it did it tells at /done, one kind per request.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import threading
from collections.abc import Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

FAULTS = ("500", "429", "hang", "cut", "empty", "prose", "html", "types", "ids")
OF_THE_WAY = ("500", "429", "hang", "html")
"""Those that are no reply at all."""
_LETTERS = "abcdefghijklmnopqrstuvwxyz"


def made_up(schema: Mapping[str, Any], key: str, definitions: Mapping[str, Any] | None = None) -> Any:
    """A value that fits a schema and depends on nothing but the key."""
    known = schema.get("$defs", {}) if definitions is None else definitions
    if "$ref" in schema:
        return made_up(known[schema["$ref"].rpartition("/")[2]], key, known)
    if "const" in schema:
        return schema["const"]
    number = int(hashlib.sha256(key.encode()).hexdigest()[:12], 16)
    if "enum" in schema:
        return schema["enum"][number % len(schema["enum"])]
    if "anyOf" in schema:
        return made_up(schema["anyOf"][number % len(schema["anyOf"])], key, known)
    kind = schema["type"]
    if kind == "null":
        return None
    if kind == "object":
        return {name: made_up(part, f"{key}.{name}", known) for name, part in schema["properties"].items()}
    if kind == "array":
        return [made_up(schema["items"], f"{key}.{n}", known) for n in range(max(1, schema.get("minItems", 1)))]
    if kind == "boolean":
        return bool(number % 2)
    if kind == "string":
        return "".join(_LETTERS[number // 26**n % 26] for n in range(5)) + " something"
    return 1 + number % 5


def scripted(value: Any, script: Mapping[str, Any]) -> Any:
    """A made-up value in which the fields of these names say what the script says."""
    if isinstance(value, dict):
        return {name: script.get(name, scripted(part, script)) for name, part in value.items()}
    return [scripted(item, script) for item in value] if isinstance(value, list) else value


class Served:
    """What the server was told to do, and what it did."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.latency: float = options.latency
        self.share: float = options.faults
        self.hang: float = options.hang
        self.refuse: list[str] = options.refuse
        self.script: dict[str, Any] = json.loads(options.say)
        self.done: list[str] = []
        self.lock = threading.Lock()
        self.model: Any = None
        if options.model:
            from coopera.models.huggingface import open_model  # noqa: PLC0415 - heavy, and not always needed

            self.model = open_model(options.model)

    def next_kind(self) -> str:
        """Every so many requests go wrong, each kind in its turn."""
        with self.lock:
            n = len(self.done)
            wrong = int((n + 1) * self.share) - int(n * self.share)
            kind = FAULTS[sum(one in FAULTS for one in self.done) % len(FAULTS)] if wrong else "good"
            self.done.append(kind)
        return kind

    def answer(self, asked: dict[str, Any]) -> tuple[str, int, int]:
        """The reply's text, and the tokens of prompt and reply."""
        schema = schema_of_request(asked)
        told = json.dumps(asked["messages"])
        if self.model is None:
            key = f"{told} {asked.get('seed')}"
            text = json.dumps(scripted(made_up(schema, key), self.script)) if schema is not None else "No."
            return text, len(told) // 4, len(text) // 4
        from langchain_core.messages import convert_to_messages  # noqa: PLC0415

        drawn = {"temperature": asked.get("temperature", 1.0), "seed": asked.get("seed", 0)}
        limit = asked.get("max_tokens", 256)
        reply = self.model.invoke(convert_to_messages(asked["messages"]), **drawn, max_tokens=limit, schema=schema)
        usage = reply.usage_metadata
        return reply.text, usage["input_tokens"], usage["output_tokens"]


def schema_of_request(asked: Mapping[str, Any]) -> dict[str, Any] | None:
    if "response_format" in asked:
        return asked["response_format"].get("json_schema", {}).get("schema")
    if "tools" in asked:
        return asked["tools"][0]["function"]["parameters"]
    return None


def spoilt(kind: str, text: str) -> str:
    """A good reply as one that went wrong in some way."""
    if kind == "cut":
        return text[: len(text) // 2]
    if kind == "empty":
        return ""
    if kind == "prose":
        return "Certainly! As for your question, I should say yes to all of it."
    reply = json.loads(text)
    if kind == "types":  # what was seen may be any text, so a field that decides something
        field = next((name for name, part in reply.items() if not isinstance(part, str)), next(iter(reply)))
        return json.dumps({**reply, field: 7})
    return json.dumps(_astray(reply))


def _astray(value: Any) -> Any:
    """Name objects that do not exist; where none is named, give one item too many."""
    if isinstance(value, dict):
        changed = {name: "unicorn_9" if name in {"object", "target"} else _astray(v) for name, v in value.items()}
        return {name: 9999 if name in {"object_id", "target_id"} else part for name, part in changed.items()}
    if isinstance(value, list):
        return [_astray(item) for item in [*value, *value[-1:]]]
    return value


class Handler(BaseHTTPRequestHandler):
    """One request."""

    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    served: Served

    def log_message(self, *_: Any) -> None:
        """Say nothing."""

    def do_GET(self) -> None:
        self._send(200, json.dumps(self.served.done))

    def do_POST(self) -> None:
        asked = json.loads(self.rfile.read(int(self.headers["content-length"])))
        form = "response_format" if "response_format" in asked else "tools" if "tools" in asked else ""
        if form in self.served.refuse:
            self._send(400, json.dumps({"error": {"message": f"{form} is not supported here"}}))
            return
        kind = self.served.next_kind()
        threading.Event().wait(self.served.hang if kind == "hang" else self.served.latency)
        if kind in {"500", "429"}:
            self._send(int(kind), json.dumps({"error": {"message": f"a fault of kind {kind}"}}), {"retry-after": "0"})
        elif kind in {"html", "hang"}:
            self._send(200, f"<html><body>{kind}</body></html>", {"content-type": "text/html"})
        else:
            text, tokens_in, tokens_out = self.served.answer(asked)
            said = text if kind == "good" else spoilt(kind, text)
            self._send(200, json.dumps(completion(asked, said, tokens_in, tokens_out, cut=kind == "cut")))

    def _send(self, status: int, body: str, more: Mapping[str, str] | None = None) -> None:
        data = body.encode()
        headers = {"content-type": "application/json", "content-length": str(len(data)), **(more or {})}
        try:
            self.send_response(status)
            for name, value in headers.items():
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(data)
        except ConnectionError:  # the client has lost patience
            self.close_connection = True


def completion(asked: Mapping[str, Any], text: str, tokens_in: int, tokens_out: int, *, cut: bool) -> dict[str, Any]:
    message: dict[str, Any] = {"role": "assistant", "content": text}
    if "tools" in asked:
        called = {"name": asked["tools"][0]["function"]["name"], "arguments": text}
        message = {"role": "assistant", "content": None}
        message["tool_calls"] = [{"id": "call_1", "type": "function", "function": called}]
    choice = {"index": 0, "message": message, "finish_reason": "length" if cut else "stop"}
    usage = {"prompt_tokens": tokens_in, "completion_tokens": tokens_out, "total_tokens": tokens_in + tokens_out}
    return {"id": "1", "object": "chat.completion", "created": 0, "model": "tiny", "choices": [choice], "usage": usage}


class _Server(ThreadingHTTPServer):
    request_queue_size = 128
    daemon_threads = True


def main() -> None:
    """Serve on a free port, which is the first line of standard output, until standard input ends."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--model", default="")
    parser.add_argument("--latency", type=float, default=0.0)
    parser.add_argument("--faults", type=float, default=0.0)
    parser.add_argument("--hang", type=float, default=5.0)
    parser.add_argument("--refuse", nargs="*", default=[])
    parser.add_argument("--say", default="{}", help="what fields of a name always say, as JSON")
    Handler.served = Served(parser.parse_args())
    server = _Server(("127.0.0.1", 0), Handler)
    sys.stdout.write(f"{server.server_address[1]}\n")
    sys.stdout.flush()
    threading.Thread(target=server.serve_forever, daemon=True).start()
    sys.stdin.read()


if __name__ == "__main__":
    main()
