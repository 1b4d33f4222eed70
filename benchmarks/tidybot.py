"""Where do things belong, by a few examples? `python -m benchmarks.tidybot SCENARIOS.yml --json`.

SCENARIOS.yml is that of TidyBot (Wu et al. 2023, github.com/jimmyyhwu/tidybot, MIT): per scenario some things with the
receptacle in which a person put them, and as many others to be placed. Given are the seen placements and the names of
the things to be placed; the annotator's notes are not read.

`ours` is `coopera.models.learners.places.places`, `alone` the same for each thing as if it were the only one, and
`nearest` the receptacle of the thing seen whose name is most alike. `within_seen` is how `ours` was chosen: one thing
of each receptacle held out of the seen ones, four times per scenario; the unseen placements had no part in it.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml

from benchmarks.outside import is_name, read_text, run
from coopera.core.errors import ConfigError
from coopera.core.strict_yaml import load_yaml
from coopera.memory.embeddings import bundled
from coopera.models.learners.places import nearest, places

MOST, MOST_THINGS = 2_000, 500
HELD_OUT = 4

Place = Callable[[Mapping[str, str], Sequence[str]], Mapping[str, str]]


class Scenario(NamedTuple):
    """Things and where they belong: those of which the learner is told, and those it is asked for."""

    seen: dict[str, str]
    unseen: dict[str, str]


def read_scenarios(path: Path) -> list[Scenario]:
    """Return the scenarios of a file.

    Raises:
        ConfigError: If the file is not as the module says.
    """
    text = read_text(path)
    try:
        found = load_yaml(text)
    except yaml.MarkedYAMLError as err:
        line = err.problem_mark.line + 1 if err.problem_mark else 0
        raise ConfigError(f"{path}: line {line}: is not YAML ({err.problem})") from err
    except (yaml.YAMLError, ValueError, RecursionError) as err:
        raise ConfigError(f"{path}: is not YAML that can be read ({' '.join(str(err).split())})") from err
    if not isinstance(found, list) or not 0 < len(found) <= MOST:
        raise ConfigError(f"{path}: expected a list of 1 to {MOST} scenarios")
    return [_scenario(f"{path}: scenario {place}", one) for place, one in enumerate(found)]


def _scenario(where: str, one: object) -> Scenario:
    if not isinstance(one, dict):
        raise ConfigError(f"{where}: expected a mapping with seen_placements and unseen_placements")
    seen, unseen = (_placements(f"{where}: {name}", one.get(name)) for name in ("seen_placements", "unseen_placements"))
    strange = sorted(set(unseen.values()) - set(seen.values()))
    if strange:
        raise ConfigError(f"{where}: unseen_placements: nothing was seen in {strange[0]!r}")
    return Scenario(seen, unseen)


def _placements(where: str, lines: object) -> dict[str, str]:
    if not isinstance(lines, list) or not 0 < len(lines) <= MOST_THINGS:
        raise ConfigError(f"{where}: expected a list of 1 to {MOST_THINGS} pairs of thing and receptacle")
    for line in lines:
        if not (isinstance(line, list) and len(line) == 2 and all(map(is_name, line))):
            raise ConfigError(f"{where}: expected pairs of thing and receptacle, not {str(line)[:60]!r}")
    found: dict[str, str] = dict(lines)
    if len(found) < len(lines):
        raise ConfigError(f"{where}: a thing stands twice")
    return found


def accuracy(scenarios: Iterable[Scenario], place: Place) -> float:
    """Return the share of all unseen things that are placed where they belong."""
    right = total = 0
    for seen, unseen in scenarios:
        found = place(seen, list(unseen))
        right += sum(found[thing] == where for thing, where in unseen.items())
        total += len(unseen)
    return round(right / max(total, 1), 4)


def within_seen(scenarios: Iterable[Scenario]) -> list[Scenario]:
    """Return scenarios made of seen placements only: of each receptacle with two things or more, one is held out."""
    rng = np.random.default_rng(0)
    found = []
    for seen, _ in scenarios:
        inside: dict[str, list[str]] = {}
        for thing, where in seen.items():
            inside.setdefault(where, []).append(thing)
        for _ in range(HELD_OUT):
            out = {str(rng.choice(things)): where for where, things in sorted(inside.items()) if len(things) > 1}
            found.append(Scenario({thing: where for thing, where in seen.items() if thing not in out}, out))
    return found


def measure(asked: argparse.Namespace) -> dict[str, Any]:
    """Return the accuracy of ours and of the yardsticks."""
    scenarios = read_scenarios(asked.file)
    embeddings = bundled()

    def ours(seen: Mapping[str, str], things: Sequence[str]) -> dict[str, str]:
        return places(seen, things, embeddings)

    def alone(seen: Mapping[str, str], things: Sequence[str]) -> dict[str, str]:
        return places(seen, things, embeddings, together=False)

    def by_name(seen: Mapping[str, str], things: Sequence[str]) -> dict[str, str]:
        return nearest(seen, things, embeddings)

    found = {name: accuracy(scenarios, way) for name, way in (("ours", ours), ("alone", alone), ("nearest", by_name))}
    found["within_seen"] = accuracy(within_seen(scenarios), ours)
    print(", ".join(f"{name} {value:.3f}" for name, value in found.items()))
    return {"tidybot": found}


def main(given: Sequence[str] | None = None) -> int:
    """Print the accuracies; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    return run(measure, parser, given)


if __name__ == "__main__":
    raise SystemExit(main())
