"""Is every motion made at the right place? `python -m benchmarks.motions_at_home [--scenes …]`.

A person makes every motion at every piece of furniture of each home, with a usual thing in hand, in a home as it was
built. What is done is looked at as it would be drawn: the body within reach of the furniture, in the motion's posture
(or standing, where that will do without a seat), what the motion needs in hand or lying there, and a thing that lies
before one at the height of the surface, with a hand at it; and where it counts, that hand, tool and surface meet (see
benchmarks/contact.py). `--motions` names only some, separated by commas. Everything else has to be refused, with a
reason. Prints how often each motion was made, and what was wrong; exit status 1 if anything was.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator

import numpy as np

from benchmarks.contact import contacts
from benchmarks.truth import reach
from coopera.core.affordances import affordances
from coopera.core.household import HUMAN, FreeMotion
from coopera.models.offline.household.knowledge import shipped
from coopera.simulation import World, list_scenes, load_scene
from coopera.simulation.acts.workplace import working
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.motions.holding import held_at
from coopera.simulation.motions.library import Motion, load_library
from coopera.simulation.motions.poses import pose_at, working_height
from coopera.simulation.shapes.rotations import Array

HAND = 0.12
"""A hand comes this near to the box of what is in it, or lies before it, at some moment (metres)."""
LEVEL = 0.01
MOMENTS = 12
ANYTHING = "mug"


def usual_things() -> dict[str, str]:
    """A thing that people have in hand for each motion."""
    found: dict[str, str] = {}
    for activity in shipped().activities:
        for thing, caption in activity.things.items():
            found.setdefault(caption, thing)
    for motion in load_library().motions:
        needs = affordances().of(motion.caption).needs
        if needs and not affordances().means_one_of(found.get(motion.caption, ""), needs):
            found[motion.caption] = affordances().names(needs)[0].replace("_", " ")
    return found


def wrong(world: World, motion: Motion, act: FreeMotion, target: SceneObject) -> Iterator[str]:
    """What is not as it should be once a motion is being made."""
    person, said = world.state.person(), affordances().of(motion.caption)
    yield from reach(world.layout, world.state, HUMAN, act)
    on_a_rug = target.cls == "rug" and person.posture in ("floor", "lie")
    if person.posture != motion.posture and not on_a_rug and (said.seated or person.posture != "stand"):
        yield f"one should {motion.posture}, and {person.posture}s"
    if not affordances().suits(motion.caption, target.cls):
        yield f"nobody does that at a {target.cls}"
    if said.needs and not affordances().means_one_of(act.in_hand, said.needs):
        lying = [thing.cls for thing in world.state.carried_by(world.layout, target.name)]
        if not any(affordances().is_one_of(cls, said.needs) for cls in lying):
            yield "what it needs is not there"
    if person.thing is not None:
        yield from _held(world, motion)
        yield from contacts(world, motion)


def _held(world: World, motion: Motion) -> Iterator[str]:
    """What is wrong with the place of the thing in hand, as it is drawn."""
    person = world.state.person()
    thing = world.state.find(world.layout, person.thing or "")
    if thing is None:
        yield "what is in hand is nowhere"
        return
    setting, grip = working(world.layout, world.state, person, motion)
    gaps = []
    for seconds in np.linspace(0.0, motion.keys.period, MOMENTS, endpoint=False):
        pose = pose_at(motion, float(seconds), setting)
        place, turn = held_at(pose, thing.size, grip)
        frames = forward(pose)
        gaps += [_gap(frames.place[hand], place, turn, thing) for hand in ("right_hand", "left_hand")]
        if grip.laid is not None and abs(float(place[2]) - working_height(setting)) > LEVEL:
            yield f"the {thing.cls} lies {float(place[2]) - working_height(setting):+.2f} m off the surface"
            return
    if min(gaps) > HAND and grip.hold not in ("head", "beside", "floor"):
        yield f"no hand comes nearer than {min(gaps):.2f} m to the {thing.cls}"


def _gap(hand: Array, place: Array, turn: Array, thing: SceneObject) -> float:
    """How far a hand is from the box of a thing, in metres."""
    x, y, z = (hand - place) @ turn
    wide, deep, high = thing.size
    out = np.maximum(np.abs((x, y, z - high / 2)) - np.array((wide, deep, high)) / 2, 0.0)
    return float(np.linalg.norm(out))


def main() -> None:
    """Try all motions in the homes that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default=",".join(list_scenes()), help="homes, separated by commas")
    parser.add_argument("--motions", default="", help="only these motions, separated by commas")
    args = parser.parse_args()
    scenes, only = args.scenes.split(","), args.motions.split(",") if args.motions else load_library().captions
    things, made, troubles = usual_things(), Counter[tuple[str, str]](), Counter[str]()
    refused, unsaid = Counter[str](), 0
    for scene in scenes:
        with World(load_scene(scene)) as world:
            for motion in (one for one in load_library().motions if one.caption in only):
                for target in world.layout.fixed:
                    world.restore({})
                    thing = things.get(motion.caption, ANYTHING)
                    act = FreeMotion(target_id=target.id, target=target.name, in_hand=thing, motion=motion.caption)
                    outcome = world.perform(HUMAN, act)
                    if not outcome.ok:
                        refused[scene] += 1
                        unsaid += not outcome.reason.endswith(".")
                        continue
                    made[motion.caption, scene] += 1
                    for trouble in wrong(world, motion, act, target):
                        troubles[f"{scene}: {motion.caption} at {target.name} with the {thing}: {trouble}"] += 1
    print("| motion |", " | ".join(scenes), "|\n|---|" + "---|" * len(scenes))
    for motion in (one for one in load_library().motions if one.caption in only):
        print(f"| {motion.caption} |", " | ".join(str(made[motion.caption, scene]) for scene in scenes), "|")
    total = sum(made.values())
    print(f"made {total}, of them at the right place {total - len(troubles)}")
    print(f"refused {sum(refused.values())}, of them without a reason {unsaid}")
    for trouble in list(troubles)[:40]:
        print(f"!! {trouble}")
    raise SystemExit(1 if troubles or unsaid else 0)


if __name__ == "__main__":
    main()
