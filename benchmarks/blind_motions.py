"""Can a reader name a motion from four frames? Draws shuffled sheets without captions, and keeps the key apart.

python -m benchmarks.blind_motions draw OUT [--all] [--seed N] # OUT/sheets/01.png, OUT/key.yaml (not for the reader)
python -m benchmarks.blind_motions score OUT ANSWERS           # ANSWERS: a YAML mapping of sheet number to words

A sheet shows one motion at four moments, from two sides. The eight motions that a reader once failed to name are there,
and five others, or (`--all`) every one. The reader sees the sheets alone and writes in own words what the person does.
An answer counts where it shares its meaning with the caption: `score` prints both side by side, and counts those that
have the caption or one of the words beside it in the table below; a person judges the rest.
"""

from __future__ import annotations

import argparse
import random
from pathlib import Path

import yaml

from benchmarks.studio import strip
from coopera.simulation.motions.library import load_library

SHARES = (0.08, 0.33, 0.58, 0.83)
TILE = (300, 300)
ONCE_MISSED = {
    "pour a drink": "pour",
    "set the table": "set the table,sets the table,setting the table,lays the table,laying the table",
    "tie the shoes": "shoe,lace",
    "wipe the surface": "wip,clean the table,cleaning the table,polish",
    "type on a keyboard": "typ,laptop,computer",
    "eat a meal": "eat,meal,dining",
    "sweep the floor": "sweep,broom",
    "lie in the bath": "bath",
}
OTHERS = {
    "play the guitar": "guitar",
    "iron clothes": "iron",
    "mop the floor": "mop",
    "brush teeth": "teeth,tooth",
    "carry a box": "carr,box",
}
"""Captions, and parts of words that name them, separated by commas."""


def draw(out: Path, captions: list[str], seed: int) -> None:
    """Write the sheets in a shuffled order, and the key beside them."""
    random.Random(seed).shuffle(captions)
    (out / "sheets").mkdir(parents=True, exist_ok=True)
    for number, caption in enumerate(captions, start=1):
        strip(load_library()[caption], SHARES, TILE).save(out / "sheets" / f"{number:02}.png")
    (out / "key.yaml").write_text(yaml.safe_dump(dict(enumerate(captions, start=1))), encoding="utf-8")
    print(f"{len(captions)} sheets in {out / 'sheets'}, the key in {out / 'key.yaml'}")


def score(out: Path, answers: Path) -> None:
    """Print what was shown and what was read, and how many were named."""
    key: dict[int, str] = yaml.safe_load((out / "key.yaml").read_text(encoding="utf-8"))
    said: dict[int, str] = yaml.safe_load(answers.read_text(encoding="utf-8"))
    words, right = ONCE_MISSED | OTHERS, 0
    for number, caption in sorted(key.items()):
        answer = str(said.get(number, "")).lower()
        named = any(word in answer for word in words.get(caption, caption).split(","))
        right += named
        print(f"{'right' if named else 'judge'}  {number:2}  {caption:22} {answer}")
    print(f"{right} of {len(key)} named")


def main() -> None:
    """Draw the sheets, or score what a reader wrote."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("draw", "score"))
    parser.add_argument("out", type=Path)
    parser.add_argument("answers", type=Path, nargs="?")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--all", action="store_true", help="every motion, not thirteen")
    args = parser.parse_args()
    if args.what == "draw":
        captions = [motion.caption for motion in load_library().motions] if args.all else [*ONCE_MISSED, *OTHERS]
        draw(args.out, captions, args.seed)
    elif args.answers is None:
        parser.error("score takes a file of answers")
    else:
        score(args.out, args.answers)


if __name__ == "__main__":
    main()
