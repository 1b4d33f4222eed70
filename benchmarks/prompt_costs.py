"""What an hour and an evening ask of a language model: calls, serial round trips, tokens in and out, in both types.

    python -m benchmarks.prompt_costs [--types 1 2] [--days 2] [--hours 3] [--tokenizer tokenizer.json] [--json]

Everything but the model is real. The model is a scripted OpenAI-compatible server in this process. Its replies fit the
schema that arrives, name what the home has, and are about as long as those of the first capable model that lived here
(`LENGTHS`). In a reflection it finds fault with one task of five.

A round trip is counted as it happens: the server holds every request until no other has come for `--quiet` seconds, and
then answers all that it holds. So requests that wait for each other can never share a trip. Tokens are those of the
messages and, apart, of the schema in `response_format`, which servers read too. They are counted by a tokenizer's file
(`--tokenizer`), else by four characters a token.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import re
import tempfile
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, NamedTuple

from coopera import Config, run_study
from coopera.config.schema import Models
from coopera.core.affordances import affordances
from coopera.core.hour import ModelCall
from coopera.models.specs import LETTERS
from coopera.rundir.directory import RunDir

LENGTHS = {
    "intention": 50,
    "thought": 65,
    "reason": 60,
    "reason_human": 65,
    "reason_intentions": 60,
    "reason_tasks": 55,
    "reason_vision": 60,
    "reasons_big_five": 250,
    "reasons_profile": 200,
    "profile": 400,
    "seen": 60,
    "motion": 30,
}
"""Characters of a field, on average; 40 where it is not named. A reflection on five tasks then has some 700 tokens."""
_LISTED = {"wants": 6, "tasks": 3}
"""Items of a list whose length the schema leaves open; as few as may be where it is not named."""
_WANTED = 10  # characters of one of the things that an intention names
_FAULTY = 5  # one task of so many is found wanting
_WORDS = """
the and a to in of for with at my on it this that is be after before then morning evening quiet some little time kitchen
desk table sofa window garden cup tea book notebook plan work music lunch dinner clean wash dry put take bring make read
write call rest stretch slowly carefully together again because likes prefers usually calm tidy
"""
_THINGS = "mug, notebook, pen, laptop, sponge, towel, phone, novel, water bottle, apple, blanket, remote control, plate"
Tokens = Callable[[str], int]


class Asked(NamedTuple):
    """One request: in which trip it was answered, what it said, and its tokens."""

    trip: int
    text: str
    words: int
    schema: int
    out: int


class Writer:
    """Writes replies that fit a schema; what it writes depends on the prompt alone."""

    def reply(self, schema: Mapping[str, Any], prompt: str) -> dict[str, Any]:
        """One reply."""
        written: dict[str, Any] = self._value("", schema, schema.get("$defs", {}), random.Random(prompt), 0)
        return written

    def _value(self, name: str, part: Mapping[str, Any], known: Mapping[str, Any], rng: random.Random, n: int) -> Any:
        """A value; `n` is its place in the list that it stands in."""
        if "$ref" in part:
            return self._value(name, known[part["$ref"].rpartition("/")[2]], known, rng, n)
        if "anyOf" in part:
            part = next(one for one in part["anyOf"] if one.get("type") != "null")
            return self._value(name, part, known, rng, n)
        if "const" in part:
            return part["const"]
        if "enum" in part:
            return "on" if "on" in part["enum"] else _pick(part["enum"], rng, n)
        kind = part["type"]
        if kind == "object":
            return self._object(part, known, rng, n)
        if kind == "array":
            open_end = part.get("minItems", 0) < part.get("maxItems", 64)
            count = _LISTED.get(name, part.get("minItems", 0)) if open_end else part["minItems"]
            return [self._value(name, part["items"], known, rng, m) for m in range(count)]
        if kind == "boolean":
            return name == "yes" and n % _FAULTY != 1
        return self._text(name, rng, n) if kind == "string" else 3

    def _object(self, part: Mapping[str, Any], known: Mapping[str, Any], rng: random.Random, n: int) -> dict[str, Any]:
        found = {name: self._value(name, one, known, rng, n) for name, one in part["properties"].items()}
        if found.get("yes") is True and "task" in found:
            found["task"] = None
        if {"target", "motion", "in_hand"} <= set(found):
            self._can_be_done(found, n)
        return found

    def _can_be_done(self, task: dict[str, Any], n: int) -> None:
        """A motion that is made at the furniture, with what it needs in hand."""
        named = affordances().motions_at(task["target"].rpartition("_")[0])
        if motions := [one for one in named if not one.startswith(("sit", "lie"))]:  # there may be no seat
            task["motion"] = motions[n % len(motions)]
            needed = affordances().names(affordances().of(task["motion"]).needs)
            task["in_hand"] = needed[0].replace("_", " ") if needed else task["in_hand"]

    def _text(self, name: str, rng: random.Random, n: int) -> str:
        if name in {"object", "in_hand"}:
            return _pick(_THINGS.split(", "), rng, n)
        long = (_WANTED if name == "wants" else LENGTHS.get(name, 40)) * rng.uniform(0.7, 1.3)
        words = _WORDS.split()
        said = rng.choice(words)
        while len(said) < long:
            said += f" {rng.choice(words)}"
        return said


def _pick(some: Sequence[str], rng: random.Random, n: int) -> str:
    """One of some things; the items of a list have different ones."""
    return some[(rng.randrange(997) + n) % len(some)]


class Scripted:
    """What the server knows: how to reply, what was asked, and which trip it is."""

    def __init__(self, writer: Writer, tokens: Tokens, quiet: float) -> None:
        self.asked: list[Asked] = []
        self._writer, self._tokens, self._quiet = writer, tokens, quiet
        self._turn = threading.Condition()
        self._trip, self._last = 0, 0.0

    def answer(self, asked: Mapping[str, Any]) -> dict[str, Any]:
        """A completion, given together with all that were asked for meanwhile."""
        trip = self._held()
        schema = asked.get("response_format", {}).get("json_schema", {}).get("schema", {})
        said = [str(message["content"]) for message in asked["messages"]]
        reply = json.dumps(self._writer.reply(schema, said[-1]), ensure_ascii=False)
        held_to = self._tokens(json.dumps(schema, ensure_ascii=False)) if schema else 0
        found = Asked(trip, said[0], sum(map(self._tokens, said)), held_to, self._tokens(reply))
        with self._turn:
            self.asked.append(found)
        usage = {"prompt_tokens": found.words + found.schema, "completion_tokens": found.out}
        usage["total_tokens"] = sum(usage.values())
        choice = {"index": 0, "message": {"role": "assistant", "content": reply}, "finish_reason": "stop"}
        return {
            "id": "1",
            "object": "chat.completion",
            "created": 0,
            "model": "scripted",
            "choices": [choice],
            "usage": usage,
        }

    def _held(self) -> int:
        with self._turn:
            mine, self._last = self._trip, time.monotonic()
            while self._trip == mine:
                if (left := self._last + self._quiet - time.monotonic()) <= 0:
                    self._trip += 1
                    self._turn.notify_all()
                else:
                    self._turn.wait(left)
            return mine


@contextmanager
def serving(scripted: Scripted) -> Iterator[str]:
    """Serve while the context lasts; gives the base URL."""

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def log_message(self, *_: Any) -> None:
            """Say nothing."""

        def do_POST(self) -> None:
            asked = json.loads(self.rfile.read(int(self.headers["content-length"])))
            data = json.dumps(scripted.answer(asked)).encode()
            self.send_response(200)
            self.send_header("content-type", "application/json")
            self.send_header("content-length", str(len(data)))
            self.end_headers()
            self.wfile.write(data)

    class Server(ThreadingHTTPServer):
        request_queue_size = 128
        daemon_threads = True

    with Server(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_address[1]}/v1"
        server.shutdown()


def live(collab: int, days: int, hours: int, scene: str, tokens: Tokens, quiet: float) -> dict[str, Any]:
    """Live some days of one type and count."""
    scripted = Scripted(Writer(), tokens, quiet)
    with tempfile.TemporaryDirectory() as folder, serving(scripted) as url:
        root = Path(folder)
        config = Config(
            humans=["amara"],
            scenes=[scene],
            days=days,
            hours=hours,
            collab=collab,
            pictures="none",
            models=Models(human="openai:scripted", robot="openai:scripted", judge="openai:scripted"),
            base_url=url,
            out=root / "run",
            cache=root / "cache.sqlite",
            data_dir=root / "data",
        )
        summary = run_study(config)
        return {"failed_hours": summary["failed_hours"], **counted(RunDir.open(root / "run"), scripted.asked)}


def counted(run: RunDir, asked: list[Asked]) -> dict[str, Any]:
    """The figures of an hour and of an evening, on average, and of each prompt's calls in a day."""
    calls: dict[str, tuple[tuple[int, int | None], ModelCall]] = {}
    for hour in run.hours():
        calls |= {_said(call): ((hour.day, hour.hour), call) for call in hour.calls}
    for evening in run.evenings():
        calls |= {_said(call): ((evening.day, None), call) for call in evening.calls}
    trips: dict[int, list[Asked]] = defaultdict(list)
    for one in asked:
        trips[one.trip].append(one)
    places: dict[tuple[int, int | None], Counter[str]] = defaultdict(Counter)
    prompts: dict[str, Counter[str]] = defaultdict(Counter)
    for together in trips.values():
        where = [calls[one.text][0] for one in together]
        # what is asked together with an evening's questions is asked in the evening, wherever it is recorded
        place = next((one for one in where if one[1] is None), where[0])
        places[place]["round_trips"] += 1
        for one in together:
            said = {"calls": 1, "tokens_text": one.words, "tokens_schema": one.schema, "tokens_out": one.out}
            said["tokens_in"] = one.words + one.schema
            places[place].update(said)
            prompts[calls[one.text][1].prompt].update(said)
    hours = [found for (_, hour), found in places.items() if hour is not None]
    evenings = [found for (_, hour), found in places.items() if hour is None]
    return {
        "hour": _mean(hours),
        "most_round_trips_of_an_hour": max(found["round_trips"] for found in hours),
        "evening": _mean(evenings),
        "prompts": {name: dict(found) for name, found in sorted(prompts.items())},
        "repairs": sum(call.attempts - 1 for _, call in calls.values()),
    }


def _said(call: ModelCall) -> str:
    return str(call.messages[0]["content"])


def _mean(found: list[Counter[str]]) -> dict[str, float]:
    names = ("calls", "round_trips", "tokens_text", "tokens_schema", "tokens_in", "tokens_out")
    return {name: round(sum(one[name] for one in found) / len(found), 1) for name in names}


def counter(file: Path | None) -> Tokens:
    """How tokens are counted."""
    if file is None:
        return lambda text: math.ceil(len(text) / LETTERS)
    from tokenizers import Tokenizer  # noqa: PLC0415 - not needed without a file

    tokenizer = Tokenizer.from_file(str(file))
    return lambda text: len(tokenizer.encode(text).ids)


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--types", type=int, nargs="+", default=[1, 2], choices=[1, 2])
    parser.add_argument("--days", type=int, default=2)
    parser.add_argument("--hours", type=int, default=3)
    parser.add_argument("--scene", default="maple")
    parser.add_argument("--tokenizer", type=Path, help="a tokenizer.json")
    parser.add_argument("--quiet", type=float, default=0.5)
    parser.add_argument("--json", action="store_true", help="one JSON object in the last line")
    given = parser.parse_args()
    tokens = counter(given.tokenizer)
    found = {
        f"type {collab}": live(collab, given.days, given.hours, given.scene, tokens, given.quiet)
        for collab in given.types
    }
    if given.json:
        print(json.dumps({"tokenizer": str(given.tokenizer or "4 characters a token"), **found}))
        return
    unit = f"by {given.tokenizer}" if given.tokenizer else "of 4 characters"
    print(f"{given.days} x {given.hours} hours, means; tokens {unit}; in = text + schema")
    for name, one in found.items():
        print(f"\n{name}: {one['failed_hours']} hours failed, {one['repairs']} replies asked for again")
        for place in ("hour", "evening"):
            print(f"  {place:8}" + "".join(f"{_words(key)} {value:g}  " for key, value in one[place].items()))
        for prompt, sums in one["prompts"].items():
            per_call = "  ".join(f"{_words(key)} {value / sums['calls']:.0f}" for key, value in sums.items())
            print(f"    {prompt:28} {sums['calls']:3} calls, each: {per_call}")


def _words(key: str) -> str:
    return re.sub("^tokens_", "", key).replace("_", " ")


if __name__ == "__main__":
    main()
