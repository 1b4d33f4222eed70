"""Does a learner notice that a person's taste has changed? `python -m benchmarks.pahf DIR --json`.

DIR holds the four files of PAHF (github.com/facebookresearch/PAHF, MIT), original_scenarios_A.json to
evolved_scenarios_B.json: requests of people in a kitchen, and what they then wanted of what was there. The answer is
the place, where a thing is to be put somewhere, and else the thing; everything in the scene may be chosen.

`same`: learnt on original A, asked original B. `shifted`: the same learner asked evolved B. `relearned`: it goes on to
evolved A, and is asked evolved B. It is `coopera.models.learners.choices.Choices`: one request after the other with its
answer, and never told of a phase or a change. The controls: `unchanged` (original A twice, then asked original B),
`unchanged_never` (the same with a learner that never forgets), `same_never` and `relearned_never`.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import fmean
from typing import Any, NamedTuple

from langchain_core.embeddings import Embeddings

from benchmarks.outside import is_name, read_json, run
from coopera.core.errors import ConfigError
from coopera.memory.embeddings import bundled
from coopera.models.learners.choices import Choices

PHASES = ("original_A", "original_B", "evolved_A", "evolved_B")
PEOPLE = 20
MOST, MOST_THINGS = 20_000, 50
_FIELDS = {"user", "context", "task", "scene_objects", "user_intent_object", "user_intent_location"}
_TO_HAND = "pick-up"


class Request(NamedTuple):
    """What a person asked for, what was there, and which of it was wanted (which may be none of it)."""

    text: str
    things: list[str]
    wanted: str


Phase = Mapping[str, Sequence[Request]]


def read_phases(folder: Path) -> dict[str, Phase]:
    """Return the requests of each phase by person, in their order.

    Raises:
        ConfigError: If a file is missing or wrong, or the phases are not of the same people.
    """
    phases = {phase: read_phase(folder / f"{phase.replace('_', '_scenarios_')}.json") for phase in PHASES}
    people = set(phases[PHASES[0]])
    for phase, found in phases.items():
        if set(found) != people:
            who = sorted(set(found) ^ people)[0]
            raise ConfigError(f"{folder}: {who!r} is not in both {PHASES[0]} and {phase}, expected the same people")
    return phases


def read_phase(path: Path) -> Phase:
    """Return the requests of a file by person.

    Raises:
        ConfigError: If the file is not as the module says.
    """
    lines = read_json(path)
    if not isinstance(lines, list) or not 0 < len(lines) <= MOST:
        raise ConfigError(f"{path}: expected a JSON list of 1 to {MOST} requests")
    found: dict[str, list[Request]] = {}
    for place, line in enumerate(lines):
        if not isinstance(line, dict) or not set(line) >= _FIELDS:
            raise ConfigError(f"{path}: request {place}: expected an object with {', '.join(sorted(_FIELDS))}")
        things = line["scene_objects"]
        if not isinstance(things, list) or len(things) > MOST_THINGS or not all(map(is_name, things)):
            raise ConfigError(f"{path}: request {place}: scene_objects: expected at most {MOST_THINGS} names")
        if len(set(things)) < len(things):
            raise ConfigError(f"{path}: request {place}: scene_objects: a name stands twice")
        for name in _FIELDS - {"scene_objects"}:
            if not is_name(line[name]):
                raise ConfigError(f"{path}: request {place}: {name}: expected a text of at most 300 characters")
        place_wanted = line["user_intent_location"]
        wanted = line["user_intent_object"] if place_wanted == _TO_HAND else place_wanted
        found.setdefault(line["user"], []).append(Request(line["task"], things, wanted))
    return found


def learn(learner: Choices, requests: Sequence[Request]) -> Choices:
    """Tell the learner each answer in turn; one that was not in the scene cannot be told."""
    for request in requests:
        if request.wanted in request.things:
            learner.told(*request)
    return learner


def accuracy(learner: Choices, requests: Sequence[Request]) -> float:
    """Return the share of requests answered as wanted; where what is wanted is not there, the answer is wrong."""
    right = 0
    for request in requests:
        chances = learner.probabilities(request.text, request.things)
        right += len(chances) > 0 and request.things[int(chances.argmax())] == request.wanted
    return right / len(requests)


def person(phases: Sequence[Sequence[Request]], embeddings: Embeddings) -> dict[str, float]:
    """Return the accuracies of one person's learner, and of the controls."""
    first, first_test, second, second_test = phases
    found: dict[str, float] = {}
    for name, fades in (("", True), ("_never", False)):
        learner = learn(Choices(embeddings, fades=fades), first)
        found[f"same{name}"] = accuracy(learner, first_test)
        found[f"shifted{name}"] = accuracy(learner, second_test)
        found[f"relearned{name}"] = accuracy(learn(learner, second), second_test)
        again = learn(learn(Choices(embeddings, fades=fades), first), first)
        found[f"unchanged{name}"] = accuracy(again, first_test)
    return found


def measure(asked: argparse.Namespace) -> dict[str, Any]:
    """Return the mean accuracies over the first people."""
    phases = read_phases(asked.folder)
    embeddings = bundled()
    found = []
    for name in list(phases[PHASES[0]])[: asked.people]:
        found.append(person([phases[phase][name] for phase in PHASES], embeddings))
        print(
            f"{name}: " + ", ".join(f"{key} {found[-1][key]:.2f}" for key in ("same", "shifted", "relearned")),
            flush=True,
        )
    return {"pahf": {key: round(fmean(one[key] for one in found), 4) for key in found[0]}}


def _count(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of people")
    return int(text)


def main(given: Sequence[str] | None = None) -> int:
    """Print a line per person; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--people", type=_count, default=PEOPLE, help="the first so many people")
    return run(measure, parser, given)


if __name__ == "__main__":
    raise SystemExit(main())
