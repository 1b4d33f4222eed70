"""Which motion does a text mean? `python -m benchmarks.motions_meant [--key FILE] [--show]`.

The key (`benchmarks/samples/motions.yaml`) holds motions in other people's words, each at a piece of furniture and with
a thing in hand, and the clips that would be right; its head says where they come from. Each is planned in the first of
the five homes that has such furniture. Prints how many play a right clip, a neutral one that says so, a wrong one, and
how many are refused; apart for the lines on which the matcher's rules were tried, and for those that they never saw. A
neutral one is right where the key has no clip.
"""

from __future__ import annotations

import argparse
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

import yaml

from coopera.config.schema import default_data_dir
from coopera.core.household import HUMAN, FreeMotion
from coopera.memory import Search, bundled
from coopera.simulation import World, list_scenes, load_scene
from coopera.simulation.acts.plans import UnableError
from coopera.simulation.motions.library import load_library

KEY = Path(__file__).parent / "samples" / "motions.yaml"
NONSENSE = ("asdf qwer", "qwertz blorp", "lorem ipsum dolor", "xyzzy", "12345", "foo bar baz", "zzz kkk", "the of and")
"""What no one means anything by; none may play a clip in silence."""


def played(worlds: list[World], motion: str, furniture: str, thing: str) -> tuple[str, float, bool]:
    """The clip, its likeness and whether it is a neutral one; the reason with -1 where the act is refused."""
    world = next(world for world in worlds if any(one.cls == furniture for one in world.layout.fixed))
    target = next(one for one in world.layout.fixed if one.cls == furniture)
    try:
        plan = world.plan(HUMAN, FreeMotion(target_id=target.id, target=target.name, in_hand=thing, motion=motion))
    except UnableError as unable:
        return unable.sentence, -1.0, False
    assert plan.meant is not None
    return plan.meant.caption, plan.meant.likeness, getattr(plan.meant, "neutral", False)


def main() -> None:
    """Plan every line of the key and print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--key", type=Path, default=KEY, help="another key")
    parser.add_argument("--show", action="store_true", help="also print every line")
    options = parser.parse_args()
    rows = [(source, *row) for source, some in yaml.safe_load(options.key.read_text()).items() for row in some]
    with ExitStack() as stack:
        embeddings = stack.enter_context(bundled(default_data_dir() / "embeddings.sqlite"))
        captions = load_library().captions
        search = Search(embeddings, captions)
        worlds = [
            stack.enter_context(World(load_scene(scene), match=lambda text: search.top(text, len(captions))))
            for scene in list_scenes()
        ]
        found: dict[str, Counter[str]] = {"seen": Counter(), "held out": Counter()}
        for source, motion, furniture, thing, right in rows:
            clip, near, neutral = played(worlds, motion, furniture, thing)
            ended = (
                "refused"
                if near < 0
                else "neutral"
                if neutral and right
                else "right"
                if clip in right or neutral
                else "wrong"
            )
            found["held out" if source == "held_out" else "seen"][ended] += 1
            if options.show:
                print(f"{ended:8}{source}: {motion!r} at {furniture} with {thing} -> {clip} ({near:.2f})")
        for part, counts in found.items():
            print(part, dict(sorted(counts.items())))
        silent = [text for text in NONSENSE if (said := played(worlds, text, "sofa", "mug"))[1] >= 0 and not said[2]]
        print(f"{len(rows)} lines; of {len(NONSENSE)} texts without a meaning {len(silent)} play a clip in silence")


if __name__ == "__main__":
    main()
