"""How much the person's and the robot's common sense have in common, by the sentence encoder that the robot uses.

    python -m benchmarks.household_overlap
    python -m benchmarks.household_overlap --robot my_household.yaml

The robot's file is another cut of the day, so `SAME` says by hand which of its activities are which of the person's;
nobody is there for what the robot's file leaves out. Printed, with the number in brackets:

- wordings: share of the person's wordings that the robot takes for one of the activities that `SAME` names, among
  those that have one, and how sure it is of these, of mistaken ones, and of those that it cannot know (cosine, tenths);
- things: share of the things that the person may have in hand that stand in the robot's activities of `SAME`, and in
  the activity that the robot takes the person's first wording for: in the same words, and by a cosine of 0.6, from
  which the predicate counts a thing as the one that is needed. Once by the activities that the robot has, once by all.

With a file of one's own there is no `SAME`; only the last of these shares are printed.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from coopera.config.schema import default_data_dir
from coopera.memory.embeddings import bundled
from coopera.models.offline.household.knowledge import ROBOTS, Activity, key, load, shipped
from coopera.models.offline.household.sense import CommonSense

ALIKE = 0.6  # PAPER: cosine from which the predicate takes two things for the same

SAME: dict[str, tuple[str, ...]] = {
    "breakfast": ("morning_meal",),
    "lunch": ("midday_meal",),
    "dinner": ("cook_supper", "eat_supper"),
    "bake": ("baking",),
    "hot_drink": ("coffee", "tea"),
    "snack": ("between_meals",),
    "dishes": ("kitchen_cleanup",),
    "wash_up": ("morning_bathroom",),
    "bath": ("soak", "shower"),
    "dress_up": (),
    "bedtime": ("go_to_bed",),
    "nap": ("rest_a_bit",),
    "relax": ("rest_a_bit",),
    "meditate": (),
    "tidy": ("clear_up",),
    "dust": ("surfaces",),
    "sweep": ("floors",),
    "laundry": ("wash_clothes", "iron_fold"),
    "paperwork": ("accounts",),
    "repair": ("handiwork",),
    "mend": (),
    "knit": (),
    "paint": ("drawing",),
    "guitar": ("instrument",),
    "piano": ("instrument",),
    "sing": (),
    "listen": ("music",),
    "read": ("read_book", "newspaper"),
    "journal": (),
    "watch_series": ("television",),
    "sports_tv": ("television",),
    "video_games": ("console",),
    "puzzle": ("table_games",),
    "photos": (),
    "collection": (),
    "strength": ("exercise",),
    "cardio": ("exercise",),
    "yoga": ("stretching",),
    "call": ("phone_call",),
    "messages": ("online",),
    "guests": (),
    "desk_work": ("computer_work",),
    "study": ("computer_work",),
    "pet_play": ("animals",),
    "pet_care": ("animals",),
    "plants": ("houseplants",),
    "sleep_in": (),
    "sleep": ("go_to_bed",),
    "work_out_of_home": (),
    "school": (),
    "errands": (),
    "see_people": (),
}
"""The robot's activities that are an activity of the person's, by the ids of the two shipped files."""


def main() -> None:
    """Print the shares."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", type=Path, default=ROBOTS, help="the robot's household file")
    args = parser.parse_args()
    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        sense = CommonSense(load(args.robot), embeddings)
        print(
            f"{len(shipped().activities)} activities of the person's, {len(sense.household.activities)} of the robot's"
        )
        if args.robot == ROBOTS:
            _wordings(sense)
            _things(sense, "things in the activities of SAME, those that have one", _paired(sense))
        nearest = [(mine, [sense.recognise(mine.wordings[0]).activity]) for mine in shipped().activities]
        _things(sense, "things in the activity taken for it, all", nearest)


def _paired(sense: CommonSense) -> list[tuple[Activity, list[Activity]]]:
    known = sense.household
    return [
        (mine, [known.activities[known.index[id]] for id in SAME[mine.id]])
        for mine in shipped().activities
        if SAME[mine.id]
    ]


def _wordings(sense: CommonSense) -> None:
    right: list[float] = []
    wrong: list[float] = []
    unknown: list[float] = []
    for mine in shipped().activities:
        for wording in mine.wordings:
            found = sense.recognise(wording)
            kind = right if found.activity.id in SAME[mine.id] else wrong if SAME[mine.id] else unknown
            kind.append(found.certainty)
    print(f"wordings taken for the right activity: {_share(len(right), len(right) + len(wrong))}")
    for name, sure in (("right", right), ("wrong", wrong), ("not to be known", unknown)):
        tenths = " ".join(f"{value:.2f}" for value in np.percentile(sure, range(0, 101, 10)))
        print(f"  sure of the {name} ones ({len(sure)}): {tenths}")


def _things(sense: CommonSense, name: str, pairs: Iterable[tuple[Activity, Sequence[Activity]]]) -> None:
    exact = alike = total = 0
    for mine, theirs in pairs:
        known = [thing for activity in theirs for thing in activity.things]
        for thing in mine.things:
            total += 1
            exact += key(thing) in {key(other) for other in known}
            alike += sense.nearest(thing, known)[1] >= ALIKE
    print(f"{name}: in the same words {_share(exact, total)}, by a cosine of {ALIKE} {_share(alike, total)}")


def _share(part: int, whole: int) -> str:
    return f"{part / whole:.0%} ({part} of {whole})"


if __name__ == "__main__":
    main()
