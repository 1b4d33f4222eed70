"""Replies as models really write them: read as they are meant, or refused, and never as something else."""

from __future__ import annotations

import json
import random
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml

from coopera.core.people import Frozen
from coopera.core.replies import REPLIES
from coopera.models.parsing import BadReplyError, Read, Wanted, read_reply

CORPUS = Path(__file__).parent / "corpus"
HOME = {
    "fixed": {
        "cabinet_1": (5, "kitchen"),
        "desk": (9, "study"),
        "sofa_1": (7, "living room"),
        "table_1": (3, "kitchen"),
        "table_2": (4, "kitchen"),
    },
    "movable": {
        "alarm_clock_1": (14, "study"),
        "magazine_1": (11, "study"),
        "mug_1": (12, "kitchen"),
        "mug_2": (13, "kitchen"),
    },
}
GIVEN: dict[str, dict[str, Any]] = {
    "none": {},
    "one": {"offers": ["bring the mug"]},
    "two": {"offers": ["bring the mug", "bring the novel"]},
    "three": {"n_intentions": 3},
    "hand": {"n_tasks": 2},
    "home": {**HOME, "n_tasks": 1},
    "draft": {**HOME, "tasks": ["read on the sofa"]},
}
FILLED = {**HOME, "n_tasks": 2, "n_intentions": 2, "offers": ["a", "b"], "tasks": ["a", "b"]}
GENERATED = 106
"""So that 200 of each kind are read."""
MANY = 3000
"""So many are read by `python -m tests.models.test_reading`."""


class Entry(NamedTuple):
    """A reply as a model wrote it, and the gist that it has; None where it must be refused."""

    wanted: Wanted[Any]
    text: str
    means: Any = None


def gist(reply: Any) -> Any:
    """What a reply says, without its reasons."""
    data = reply.model_dump()
    if "verdicts" in data and "tasks" not in data:
        return [one["yes"] for one in data["verdicts"]]
    if "grades" in data:
        return [one["grade"] for one in data["grades"]]
    if "reviews" in data:
        return [[one["yes"], one["task"] and _act(one["task"]["act"])] for one in data["reviews"]]
    if "tasks" in data:
        return [_act(one["act"]) for one in data["tasks"]]
    if "profile" in data:
        return [list(data["big_five"].values()), data["profile"]] if "big_five" in data else data["profile"]
    if "big_five" in data:
        return list(data["big_five"].values())
    if "intention" in data:
        return [data["intention"], data["continues"], data["away"]]
    return [[one["intention"], one.get("probability", one.get("away"))] for one in data["intentions"]]


def _act(act: Mapping[str, Any]) -> Any:
    if act["kind"] == "pick_place":
        assert [act["object_id"], act["receptacle_id"]] == [
            HOME["movable"][act["object"]][0],
            HOME["fixed"][act["receptacle"]][0],
        ]
        return [act["object"], act.get("relation", "on"), act["receptacle"]]
    if act["kind"] == "free_motion":
        assert act["target_id"] == HOME["fixed"][act["target"]][0]
        return [act["target"], act["in_hand"], act["motion"]]
    return act["object"]


def by_hand(name: str) -> list[Entry]:
    entries = yaml.safe_load((CORPUS / name).read_text(encoding="utf-8"))
    return [Entry(Wanted(REPLIES[e["reply"]], GIVEN[e["given"]]), e["text"], e.get("means")) for e in entries]


def read(entry: Entry) -> Read[Any] | None:
    """The reply as it is read, or None if it is refused."""
    try:
        found = read_reply(entry.text, entry.wanted)
    except BadReplyError:
        return None
    return None if found.strays else found


@pytest.mark.parametrize("entry", by_hand("meaningful.yaml"), ids=lambda entry: entry.text[:60])
def test_a_reply_written_by_hand_is_read_as_it_is_meant(entry: Entry) -> None:
    found = read(entry)
    assert found is not None
    assert gist(found.reply) == entry.means


@pytest.mark.parametrize("entry", by_hand("meaningless.yaml"), ids=lambda entry: entry.text[:60])
def test_a_meaningless_reply_written_by_hand_is_refused(entry: Entry) -> None:
    assert read(entry) is None


# --- replies of all types, put out of form or out of meaning by the seed


def filled(schema: Mapping[str, Any], draw: random.Random, definitions: Mapping[str, Any], name: str = "") -> Any:
    """A value that fits an enforced schema."""
    if "$ref" in schema:
        return filled(definitions[schema["$ref"].rpartition("/")[2]], draw, definitions, name)
    if "anyOf" in schema:
        return filled(schema["anyOf"][0], draw, definitions, name)
    if "enum" in schema:
        return draw.choice(schema["enum"])
    match schema["type"]:
        case "object":
            return {one: filled(part, draw, definitions, one) for one, part in schema["properties"].items()}
        case "array":
            count = max(2, schema.get("minItems", 0))
            return [filled(schema["items"], draw, definitions, name) for _ in range(count)]
        case "boolean":
            return draw.random() < 0.5
        case "integer":
            return draw.randint(1, 5)
        case "number":
            return round(draw.uniform(1, 5), 1)
    words = ["water the roses", "it's warm", "read [slowly]", "say “hello”, then rest", "Übung {leicht}", "cook; eat"]
    return draw.choice(words)


def _everywhere(value: Any, change: Callable[[Any, str], Any], name: str = "") -> Any:
    if isinstance(value, dict):
        value = {key: _everywhere(part, change, key) for key, part in value.items()}
    elif isinstance(value, list):
        value = [_everywhere(part, change, name) for part in value]
    return change(value, name)


Bend = Callable[[Any, random.Random], Any]


def _words(value: Any, draw: random.Random) -> Any:
    yes, no = draw.choice([("yes", "no"), ("True", "False"), ("JA", "NEIN"), ("Yes.", "No."), ("oui", "non")])
    return _everywhere(value, lambda one, _: (yes if one else no) if isinstance(one, bool) else one)


def _quoted(value: Any, _: random.Random) -> Any:
    return _everywhere(value, lambda one, _: str(one) if type(one) in (int, float) else one)


def _extra(value: Any, _: random.Random) -> Any:
    more = {"confidence": 0.7, "notes": None}
    return _everywhere(value, lambda one, _: {**one, **more} if isinstance(one, dict) else one)


def _camel(value: Any, _: random.Random) -> Any:
    def change(one: Any, _: str) -> Any:
        return {key.title().replace("_", ""): part for key, part in one.items()} if isinstance(one, dict) else one

    return _everywhere(value, change)


def _no_reasons(value: Any, draw: random.Random) -> Any:
    nothing = draw.choice([None, "N/A", "", "-"])
    return _everywhere(value, lambda one, name: nothing if name.startswith("reason") else one)


def _long_reasons(value: Any, _: random.Random) -> Any:
    return _everywhere(value, lambda one, name: "because of this " * 70 if name.startswith("reason") else one)


def _names(value: Any, draw: random.Random) -> Any:
    form = draw.choice([str.upper, str.title, lambda name: name.replace("_", " "), lambda name: f" {name}. "])
    names = {*HOME["fixed"], *HOME["movable"]}
    return _everywhere(value, lambda one, _: form(one) if isinstance(one, str) and one in names else one)


def _ids(value: Any, draw: random.Random) -> Any:
    ids = {name: place[0] for kind in HOME.values() for name, place in kind.items()}
    form = draw.choice([int, str])
    return _everywhere(value, lambda one, _: form(ids[one]) if isinstance(one, str) and one in ids else one)


def _numbered(value: Any, _: random.Random) -> Any:
    def change(one: Any, _: str) -> Any:
        objects = isinstance(one, list) and bool(one) and isinstance(one[0], dict)
        return {str(n): part for n, part in enumerate(one, 1)} if objects else one

    return _everywhere(value, change)


def _wrapped(value: Any, draw: random.Random) -> Any:
    key = draw.choice(["answer", "result", "Final Answer", "output"])
    return {key: draw.choice([value, json.dumps(value)])}


BENDS: list[Bend] = [
    *(_words, _quoted, _extra, _camel, _no_reasons, _long_reasons, _names, _ids, _numbered, _wrapped),
]


def _written(value: Any, draw: random.Random) -> str:
    """A value as text, in one of the ways in which models write JSON."""
    plain = json.dumps(value, ensure_ascii=False, indent=draw.choice([None, 1]))
    way = draw.randrange(5)
    if way == 0:
        return repr(value)
    if way == 1:
        return re.sub(r"\n( *[}\]])", r",  // so it is\n\1", json.dumps(value, indent=1))
    if way == 2:
        return re.sub(r"}, *\n", "}\n", json.dumps(value, ensure_ascii=False, indent=1))
    return plain


def _amid(text: str, draw: random.Random) -> str:
    before, after = draw.choice(
        [
            ("", ""),
            ("```json\n", "\n```"),
            ("Here you are (as asked):\n\n", "\n\nI hope {this} helps!"),
            ("<think>[1] hmm, {}</think>", ""),
            ("\ufeffjson\n", "}"),
        ]
    )
    return f"{before}{text}{after}"


def bent(count: int) -> Iterator[Entry]:
    """Good replies of every type, each bent in one to three ways that leave its meaning."""
    kinds = list(REPLIES.values())
    for n in range(count):
        draw = random.Random(n)
        wanted: Wanted[Any] = Wanted(kinds[n % len(kinds)], FILLED)
        value = filled(wanted.enforced, draw, wanted.enforced.get("$defs", {}))
        means = read_reply(json.dumps(value), wanted)
        assert means.leniencies == {}
        for bend in draw.sample(BENDS, draw.randint(1, 3)):
            value = bend(value, draw)
        yield Entry(wanted, _amid(_written(value, draw), draw), meaning(means.reply))


def meaning(reply: Frozen) -> Any:
    """All of a reply but its reasons."""

    def change(one: Any, _: str) -> Any:
        if isinstance(one, dict):
            return {key: part for key, part in one.items() if not key.startswith("reason")}
        return one

    return _everywhere(reply.model_dump(), change)


def broken(count: int) -> Iterator[Entry]:
    """Good replies of every type, each spoilt so that nobody can say what it means."""
    kinds = list(REPLIES.values())
    for n in range(count):
        draw = random.Random(n)
        wanted: Wanted[Any] = Wanted(kinds[n % len(kinds)], FILLED)
        value = filled(wanted.enforced, draw, wanted.enforced.get("$defs", {}))
        text = json.dumps(value)
        match n % 4:
            case 0:  # cut off
                yield Entry(wanted, text[: draw.randint(1, len(text) - 1)])
            case 1:  # two different answers
                other = filled(wanted.enforced, random.Random(n + 1000), wanted.enforced.get("$defs", {}))
                changed = _everywhere(other, lambda one, _: one + 0.05 if type(one) is float and one < 4 else one)
                changed = _everywhere(changed, lambda one, _: not one if isinstance(one, bool) else one)
                changed = _everywhere(changed, lambda one, _: one % 5 + 1 if type(one) is int else one)
                changed = {**changed, **({"profile": "I sing."} if "profile" in changed else {})}
                yield Entry(wanted, f"{text} or {json.dumps(changed)}")
            case 2:  # a needed field without a value
                needed = wanted.reply.model_json_schema()["required"][0]
                yield Entry(wanted, json.dumps({**value, needed: draw.choice([{}, 7, True, "<fill in>"])}))
            case _:  # letters without sense
                letters = draw.choices('{}[]":,abc 123\n', k=200)
                yield Entry(wanted, "".join(letters))


def told_of(entries: Iterable[Entry], said: Callable[[Any], Any]) -> Counter[str]:
    """How many replies were read as they are meant, otherwise, or not at all."""
    found = [(read(entry), entry.means) for entry in entries]
    return Counter(
        "refused" if one is None else "right" if said(one.reply) == means else "wrong" for one, means in found
    )


def test_two_hundred_meaningful_replies_are_read_as_they_are_meant() -> None:
    told = told_of(by_hand("meaningful.yaml"), gist) + told_of(bent(GENERATED), meaning)
    assert sum(told.values()) >= 200
    assert told["wrong"] == 0
    assert told["right"] >= 0.95 * sum(told.values()), told


def test_two_hundred_meaningless_replies_are_all_refused() -> None:
    entries = [*by_hand("meaningless.yaml"), *broken(GENERATED)]
    assert len(entries) >= 200
    assert [entry.text for entry in entries if read(entry) is not None] == []


if __name__ == "__main__":
    sys.stdout.write(f"meaningful: {dict(told_of(bent(MANY), meaning))}\n")
    sys.stdout.write(f"meaningless: {dict(told_of(broken(MANY), meaning))}\n")
