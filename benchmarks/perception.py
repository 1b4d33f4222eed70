"""How well the offline robot's perception recognises motions: `python -m benchmarks.perception [--scenes ID,…]`.

The acts are those of the offline people's common sense (household.yaml), at the furniture of each home, drawn evenly
from all pairs of motion and furniture; one in five is a pick-and-place. No error is put on top, so what is counted is
the pose matching's own: with the noise of the pose estimator, and with what furniture hides.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter

import numpy as np

from coopera.core.household import HUMAN, FreeMotion, PerceptErrors, PickPlace, SceneId
from coopera.core.randomness import rng_at
from coopera.models.offline.household.knowledge import shipped
from coopera.simulation import World, load_scene
from coopera.simulation.motions.library import load_library
from coopera.simulation.sight.pose_matching import TIDYING, matcher

HOMES = "maple,oak,pine,rowan,willow"


def acts(world: World, count: int, rng: np.random.Generator) -> list[FreeMotion | PickPlace]:
    """Acts that the household file knows and this home has the furniture for."""
    fixed: dict[str, list[str]] = {}
    for name in world.objects("fixed"):
        fixed.setdefault(world.class_of(name), []).append(name)
    movable = {world.class_of(name): name for name in world.objects("movable")}
    ids = {name: number for kind in ("fixed", "movable") for name, (number, _) in world.objects(kind).items()}
    free: dict[tuple[str, str], str] = {}
    placed: list[tuple[str, str]] = []
    for activity in shipped().activities:
        for cls in activity.fixed:
            for target in fixed.get(cls, []):
                for thing, motion in activity.things.items():
                    free.setdefault((motion, target), thing)
        placed += [(movable[a], fixed[b][0]) for a, b in activity.places if a in movable and b in fixed]
    pairs = sorted(free)
    motions = sorted({motion for motion, _ in pairs})
    found: list[FreeMotion | PickPlace] = []
    for i in range(count):
        if i % 5 == 4:
            thing, there = placed[int(rng.integers(len(placed)))]
            found.append(PickPlace(object_id=ids[thing], object=thing, receptacle_id=ids[there], receptacle=there))
        else:
            motion = motions[int(rng.integers(len(motions)))]
            choices = [pair for pair in pairs if pair[0] == motion]
            _, target = choices[int(rng.integers(len(choices)))]
            found.append(FreeMotion(target_id=ids[target], target=target, in_hand=free[motion, target], motion=motion))
    return found


def main() -> None:
    """Count what is recognised, and print what is mixed up."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--acts", type=int, default=80, help="acts in each home")
    parser.add_argument("--scenes", default=HOMES)
    parser.add_argument("--noise", type=float, default=PerceptErrors().joint_noise, help="of a joint (metres)")
    options = parser.parse_args()
    library, begun = load_library(), time.process_time()
    matcher(library)
    print(f"poses of the library: {time.process_time() - begun:.1f} s once")
    errors = PerceptErrors(motion_confused=0.0, in_hand_missed=0.0, joint_noise=options.noise)
    said: Counter[tuple[str, str]] = Counter()
    seconds = []
    for scene in options.scenes.split(","):
        with World(load_scene(SceneId(scene)), errors=errors) as world:
            rng = rng_at(0, "perception", scene)
            for act in acts(world, options.acts, rng):
                if world.perform(HUMAN, act, record=True).ok:
                    begun = time.process_time()
                    found = world.percept(rng).motion
                    seconds.append(time.process_time() - begun)
                    truth = TIDYING if isinstance(act, PickPlace) else act.motion
                    said[library[truth].cls, found or "nothing"] += 1
    print(f"{said.total()} acts, {1000 * np.mean(seconds):.0f} ms a percept")
    report(said)


def report(said: Counter[tuple[str, str]]) -> None:
    """Print the share that is right, by class, and all confusions."""
    for cls in sorted({cls for cls, _ in said}):
        total = sum(count for (truth, _), count in said.items() if truth == cls)
        print(f"{said[cls, cls] / total:5.2f} of {total:3} {cls}")
    right = sum(count for (truth, found), count in said.items() if truth == found)
    print(f"{right / said.total():6.3f} of all")
    for (truth, found), count in said.most_common():
        if truth != found:
            print(f"{count:4} x {truth!r} taken for {found!r}")


if __name__ == "__main__":
    main()
