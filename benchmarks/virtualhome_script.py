"""How much of a day written for another simulator can be done here? `python -m benchmarks.virtualhome_script FILE`.

FILE is a day of VirtualHome scripts, such as HouseholdA-train-000.txt of HOMER+ (github.com/Maithili/HOMER_PLUS, MIT):
lines like `[PUTIN] <plate> (1) <cupboard> (2) [1]`. The person does them by the single steps of `World`. Names are
taken for the nearest of ours (`ALIKE`). What the home lacks, the robot brings from the magic box. The person here has
one hand, so what is in it is put down nearby before the other one would be used. Prints how many lines of each verb
were done, why the others were not, and what is not true of the home afterwards.
"""

from __future__ import annotations

import argparse
import re
from collections import Counter
from pathlib import Path

from coopera.core.affordances import affordances
from coopera.core.household import HUMAN, ROBOT, HandOver
from coopera.simulation import World, load_scene
from coopera.simulation.acts.primitives import Result
from coopera.simulation.state.truth import problems

ALIKE = {
    "chair": "dining_chair", "coffe_maker": "coffee_machine", "computer": "laptop", "cookingpot": "cooking_pot",
    "couch": "sofa", "cupboard": "kitchen_cabinet", "cd_player": "radio", "drinking_glass": "glass",
    "faucet": "kitchen_sink", "filing_cabinet": "dresser", "fryingpan": "frying_pan", "headset": "headphones",
    "home_office": "desk", "instrument_guitar": "guitar", "knife": "kitchen_knife", "light": "floor_lamp",
    "oven": "stove", "sink": "kitchen_sink", "table": "dining_table", "tvstand": "tv_stand",
}  # fmt: skip
_LINE = re.compile(r"^\[(\w+)\]")
_NAME = re.compile(r"<([^>]+)>")


class Script:
    """A script being done in a home; things from the magic box keep their names here."""

    def __init__(self, world: World) -> None:
        self.world = world
        self._brought: dict[str, str] = {}

    def do(self, verb: str, names: list[str]) -> Result | None:
        """Do one line; None for a verb that moves nothing."""
        what = self._named(names[0]) if names else None
        if verb in ("WALK", "FIND"):
            return self.world.go_to(HUMAN, what) if what is not None else None
        if verb == "GRAB":
            return self._grab(names[0], what)
        if verb in ("PUTBACK", "PUTIN") and len(names) == 2:
            return self._put(names, inside=verb == "PUTIN")
        if verb not in ("OPEN", "CLOSE", "SWITCHON", "SWITCHOFF"):
            return None
        self._put_down()
        step = self.world.set_open if verb in ("OPEN", "CLOSE") else self.world.switch
        return step(HUMAN, what or names[0], verb in ("OPEN", "SWITCHON"))

    def _grab(self, name: str, what: str | None) -> Result:
        held = self.world.state.person().thing
        if held is not None and held == what:
            return Result(ok=True)
        self._put_down()
        if what is not None:
            return self.world.pick(HUMAN, what)
        done = self.world.perform(ROBOT, HandOver(object=name.replace("_", " ")))
        if done.ok:
            self._brought[name] = str(self.world.state.person().thing)
        return Result(done.ok, done.reason, done.metres)

    def _put(self, names: list[str], *, inside: bool) -> Result:
        what, where = (self._named(name) for name in names)
        if what is None or where is None:
            return Result(ok=False, reason=f"there is no {names[0] if what is None else names[1]}")
        if self.world.state.person().thing != what:
            self._put_down()
            taken = self.world.pick(HUMAN, what)
            if not taken.ok:
                return taken
        within = inside and affordances().contains(self.world.class_of(where))
        return self.world.place(HUMAN, where, "inside" if within else "on")

    def _named(self, name: str) -> str | None:
        """The object that a name means: one of this room first; or the room."""
        brought = self._brought.get(name)
        if brought is not None and brought in self.world.state.box:
            return brought
        cls, room = ALIKE.get(name, name), self.world.room_of(HUMAN)
        things = [thing for thing in self.world.layout.objects if thing.cls == cls]
        things.sort(key=lambda thing: (thing.room != room, thing.name))
        rooms = [one.name for one in self.world.layout.rooms if one.kind == name.replace("_", " ")]
        return next(iter([*(thing.name for thing in things), *rooms]), None)

    def _put_down(self) -> None:
        """Put what is in hand on the first furniture of the room that takes it."""
        room = self.world.room_of(HUMAN)
        for furniture in self.world.layout.fixed:
            if self.world.state.person().thing is None:
                return
            if furniture.room == room:
                self.world.place(HUMAN, furniture.name)


def main() -> None:
    """Do the script that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--scene", default="oak")
    args = parser.parse_args()
    done, tried, reasons = Counter[str](), Counter[str](), Counter[str]()
    with World(load_scene(args.scene)) as world:
        script = Script(world)
        for line in args.file.read_text(encoding="utf-8").splitlines():
            if (verb := _LINE.match(line)) is None:
                continue
            result = script.do(verb[1], _NAME.findall(line))
            if result is not None:
                tried[verb[1]] += 1
                done[verb[1]] += result.ok
                if not result.ok:
                    reasons[f"{verb[1]}: {result.reason}"] += 1
        print(f"{sum(done.values())} of {sum(tried.values())} lines done in {args.scene}: ", end="")
        print(", ".join(f"{verb} {done[verb]}/{tried[verb]}" for verb in tried))
        for reason, count in reasons.most_common():
            print(f"{count:5} {reason}")
        for problem in problems(world.layout, world.state):
            print(f"   !! {problem}")


if __name__ == "__main__":
    main()
