"""A reply server whose roles go by rules: a robot that answers well, one that answers badly, and a judge of words.

The name of the model says who answers: `good` reads what was seen and offers what goes with it, `bad` answers in the
same form with what nobody needs at home, and `judge` says yes where an offer and what the person wanted share a word.
All of them read the prompt's text alone, as a language model would.
"""

from __future__ import annotations

import json
import re
import threading
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tests.server import Handler, Served, _Server, made_up, schema_of_request

HOUSEHOLD = {
    "have something to eat or drink": ("mug", "bread", "knife", "glass", "plate"),
    "get some sleep": ("pillow", "blanket", "duvet", "sleep mask", "book"),
    "wash and get ready": ("towel", "soap", "toothbrush", "hairbrush", "face cream"),
    "talk to somebody": ("phone", "headphones", "photo", "cushion", "notebook"),
    "clean and tidy up": ("sponge", "cloth", "broom", "vase", "glass"),
    "work at the computer": ("laptop", "notebook", "pen", "mouse", "documents"),
}
CUES = {
    "have something to eat or drink": "kitchen counter mug cup bowl plate bread food cut dining fridge stove",
    "get some sleep": "bed lying pillow blanket duvet rest",
    "wash and get ready": "washbasin bathroom face hair toothbrush soap towel shower",
    "talk to somebody": "phone headphones head armchair",
    "clean and tidy up": "carry tidy box sponge broom wipe floor",
    "work at the computer": "desk laptop keyboard study office",
}
SILLY = ("traffic cone", "snorkel", "trombone", "ship anchor", "cricket stumps")
COMMON = {
    *("a", "an", "and", "at", "bring", "for", "hand", "in", "is", "it", "of", "on", "person", "put", "robot"),
    *("seems", "some", "the", "they", "this", "to", "wants", "with"),
}


def words(text: str) -> set[str]:
    """What a text is about."""
    return set(re.findall(r"[a-z]+", text.lower())) - COMMON


class Roles(Served):
    """Answers by rules."""

    def __init__(self) -> None:
        super().__init__(Namespace(latency=0.0, faults=0.0, hang=0.0, refuse=[], say="{}", model=""))

    def answer(self, asked: dict[str, Any]) -> tuple[str, int, int]:
        """The reply of the role that the model's name says, in the form that the schema asks for."""
        schema = schema_of_request(asked) or {}
        told = "\n".join(str(message["content"]) for message in asked["messages"])
        reply = made_up(schema, "rules")
        known, good = schema.get("$defs", {}), asked["model"] == "good"
        if "verdicts" in reply:
            fill(reply, "verdicts", [{"yes": yes} for yes in judged(told)], schema, known)
        elif "intentions" in reply:
            fill(reply, "intentions", [{"intention": aim} for aim in guesses(told, good=good)], schema, known)
        elif "tasks" in reply:
            last = max(HOUSEHOLD, key=told.lower().rfind)  # what is asked stands at a prompt's end
            aim = last if last in told.lower() else ""
            things = HOUSEHOLD[aim] if aim else SILLY
            acts = [{"thought": f"Needed to {aim or 'surprise them'}.", "act": brought(thing)} for thing in things]
            fill(reply, "tasks", acts, schema, known)
        text = json.dumps(reply)
        return text, len(told) // 4, len(text) // 4


def fill(reply: dict[str, Any], name: str, items: list[dict[str, Any]], schema: Any, known: Any) -> None:
    """Put items into a list of the reply; fields that the rules do not know are made up."""
    blank = made_up(schema["properties"][name]["items"], "rules", known)
    reply[name] = [{**blank, **item} for item in items]


def brought(thing: str) -> dict[str, str]:
    return {"kind": "hand_over", "object": thing}


def guesses(told: str, *, good: bool) -> list[str]:
    """Aims, the one with most cues in what was seen first; a bad robot's have to do with nothing."""
    if not good:
        return [f"{what} on the roof" for what in ("Juggle", "Race camels", "Dig for gold", "Tame lions", "Sail")]
    seen = words(told.split("Your perception reports")[-1].split("In view")[0])
    ranked = sorted(CUES, key=lambda aim: -len(seen & words(CUES[aim])))
    return [aim.capitalize() for aim in ranked[:5]]


def judged(told: str) -> list[bool]:
    """Whether each offer shares a word with what the person wanted or had left to do."""
    before, after = told.split("The robot's offers:")
    wanted = words(before.split("What the person wanted:")[-1])
    offers = [line for line in after.splitlines() if re.match(r"\s*\d+\. ", line)]
    return [bool(words(offer.split("The robot's thought:")[0]) & wanted) for offer in offers]


@contextmanager
def roles() -> Iterator[str]:
    """Serve the three roles in this process; gives the base URL."""
    handler = type("RolesHandler", (Handler,), {"served": Roles()})
    server = _Server(("127.0.0.1", 0), handler)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}/v1"
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
