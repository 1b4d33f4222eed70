"""Is the person offered what they need? `python -m benchmarks.search [FILE] [--objects N] [--missed] [--json]`.

`samples/intentions.yaml` holds ten intentions in people's own words for each shipped home: what they want to do this
hour, what they would ask for (`wants`), and the classes of that home's catalogue without which it cannot be done
(`needed`). For each the person's own Search runs in that home, with MiniLM, by three ways:

intention   by the intention's sentence alone
wants       by what the intention's reply names as wanted, too
all         nothing is searched: everything in the home is listed

A class is found if some object of it is offered. Of the intentions of type 2 only furniture counts, since there the
things come out of the robot's box. Characters are those of the lists as prompts print them: a line for each room with
the names in it.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple

import yaml
from langchain_core.embeddings import Embeddings
from langgraph.runtime import Runtime
from pydantic import TypeAdapter

from coopera.config.schema import default_data_dir
from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, Found, Intention, SearchSizes
from coopera.core.household import Collab, ObjectMap
from coopera.core.people import Frozen
from coopera.graphs.human import search
from coopera.graphs.players.player import HumanContext
from coopera.memory import bundled
from coopera.people.shipped import SHIPPED, read_persona, shipped_ids
from coopera.simulation import World, load_scene

SAMPLES = Path(__file__).with_name("samples") / "intentions.yaml"
CLOCK = Clock(day=0, hour=9)
Way = Literal["intention", "wants", "all"]


class Needed(Frozen):
    """Classes of a home's catalogue."""

    furniture: list[str]
    things: list[str]


class Sample(Frozen):
    """An intention in somebody's own words, with the key to it."""

    type: Collab
    who: str
    intention: str
    wants: list[str]
    needed: Needed


class Offered(NamedTuple):
    """What one way offers for an intention: needed classes found and missed, objects and characters listed."""

    home: str
    sample: Sample
    furniture: set[str]
    things: set[str]
    objects: int
    characters: int

    @property
    def needed(self) -> tuple[set[str], set[str]]:
        """The classes of furniture and of things that count."""
        return set(self.sample.needed.furniture), set(self.sample.needed.things if self.sample.type == 1 else ())

    @property
    def missed(self) -> set[str]:
        """What is needed and not offered."""
        furniture, things = self.needed
        return (furniture - self.furniture) | (things - self.things)


def samples(file: Path = SAMPLES) -> dict[str, list[Sample]]:
    """The intentions by home, in the order of the file."""
    return TypeAdapter(dict[str, list[Sample]]).validate_python(yaml.safe_load(file.read_text(encoding="utf-8")))


def listed(objects: ObjectMap) -> str:
    """Objects as prompts print them: a line for each room."""
    rooms: dict[str, list[str]] = {}
    for name, (_, room) in objects.items():
        rooms.setdefault(room, []).append(name)
    return "\n".join(f"- {room}: {', '.join(rooms[room])}" for room in sorted(rooms))


def found(sample: Sample, way: Way, ctx: HumanContext) -> Found:
    """What the person is offered for an intention by one of the ways."""
    if way == "all":
        movable = ctx.home.objects("movable") if ctx.collab == 1 else {}
        return Found(fixed=ctx.home.objects("fixed"), movable=movable, motions=[])
    said = {"text": sample.intention} | ({"wants": sample.wants} if way == "wants" else {})
    state: Any = {"clock": CLOCK, "intention": Intention.model_validate(said)}
    answer: Found = search(state, Runtime(context=ctx))["found"]
    return answer


def offered(
    file: Path, embeddings: Embeddings, ways: Sequence[Way], sizes: SearchSizes
) -> Iterator[tuple[Way, Offered]]:
    """Search by each way for each intention."""
    nobody: Any = None  # a search asks nobody and remembers nothing
    persona = read_persona(SHIPPED / f"{shipped_ids()[0]}.yaml")
    for scene, wanted in samples(file).items():
        with World(load_scene(scene)) as home:
            for sample in wanted:
                plan = DayPlan(
                    day=0, episode_day=0, person=persona.id, scene=scene, hours=[CLOCK.hour], collab=sample.type
                )
                ctx = HumanContext(nobody, persona, plan, home, nobody, embeddings, nobody, sizes=sizes)
                for way in ways:
                    here = found(sample, way, ctx)
                    parts = (here.fixed, here.movable)
                    furniture, things = ({home.class_of(name).replace("_", " ") for name in part} for part in parts)
                    text = "\n".join(listed(part) for part in parts if part)
                    yield way, Offered(scene, sample, furniture, things, sum(map(len, parts)), len(text))


def figures(rows: Sequence[Offered]) -> dict[str, float]:
    """Shares of what is needed that is offered, and what is listed for it, on average."""
    furniture = [cls in row.furniture for row in rows for cls in row.needed[0]]
    things = [cls in row.things for row in rows for cls in row.needed[1]]
    return {
        "furniture": sum(furniture),
        "furniture_needed": len(furniture),
        "furniture_share": sum(furniture) / max(1, len(furniture)),
        "things": sum(things),
        "things_needed": len(things),
        "things_share": sum(things) / max(1, len(things)),
        "complete": sum(not row.missed for row in rows),
        "intentions": len(rows),
        "objects": sum(row.objects for row in rows) / max(1, len(rows)),
        "characters": sum(row.characters for row in rows) / max(1, len(rows)),
    }


def possible() -> list[Way]:
    """The ways that there are: by wants where an intention has them."""
    return ["intention", "wants", "all"] if "wants" in Intention.model_fields else ["intention", "all"]


def main(argv: Sequence[str] | None = None) -> int:
    """Print the figures of each way, for all homes and for each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=Path, default=SAMPLES, help="intentions with their keys")
    parser.add_argument("--objects", type=int, default=SearchSizes().objects, help="objects offered, as in a study")
    parser.add_argument("--missed", action="store_true", help="name what is needed and not offered")
    parser.add_argument("--json", action="store_true", help="end with one line of JSON")
    given = parser.parse_args(argv)
    ways = possible()
    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        rows = list(offered(given.file, embeddings, ways, SearchSizes(objects=given.objects)))
    answer: dict[str, dict[str, dict[str, float]]] = {}
    print("way        home     furniture      things         complete  objects  characters")
    for way in ways:
        mine = [row for name, row in rows if name == way]
        homes = dict.fromkeys(row.home for row in mine)
        answer[way] = {home: figures([row for row in mine if row.home == home]) for home in homes}
        answer[way]["all"] = figures(mine)
        for home, f in answer[way].items():
            print(
                f"{way:10s} {home:7s} {f['furniture']:4.0f} of {f['furniture_needed']:3.0f}    "
                f"{f['things']:4.0f} of {f['things_needed']:3.0f}    "
                f"{f['complete']:4.0f} of {f['intentions']:2.0f} {f['objects']:8.0f} {f['characters']:11.0f}"
            )
        for row in mine if given.missed else []:
            if row.missed:
                print(f"  {row.home}: {row.sample.intention}: no {', '.join(sorted(row.missed))}")
    if given.json:
        print(json.dumps(answer))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
