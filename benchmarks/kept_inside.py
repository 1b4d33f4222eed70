"""Do people keep inside what we put inside? `python -m benchmarks.kept_inside RANKS.csv`.

RANKS.csv is Housekeep's table (github.com/yashkant/housekeep, MIT): ten people's ranks of places for 269 objects, above
0 for a right place, below 0 for a wrong one, 0 for an implausible one. For each container that core/affordances.yaml
knows, this prints how often people call it a right place for what we put inside it, and for everything else.
"""

from __future__ import annotations

import argparse
import csv
from collections import defaultdict
from pathlib import Path

from coopera.core.affordances import affordances

CONTAINERS = {
    "fridge": "fridge",
    "dishwasher": "dishwasher",
    "washer": "washing_machine",
    "chest": "dresser",
    "microwave": "microwave",
    "top_cabinet": "kitchen_cabinet",
    "bottom_cabinet": "kitchen_cabinet",
}
"""Housekeep's receptacles, and ours."""
PEOPLE = [f"person_{number}" for number in range(10)]


def main() -> None:
    """Print the table for the file that the argument names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ranks", type=Path)
    said: dict[tuple[str, bool], list[bool]] = defaultdict(list)
    with parser.parse_args().ranks.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            ours = CONTAINERS.get(row["receptacle"])
            if ours is not None:
                inside = affordances().means_one_of(row["object"], affordances().inside[ours])
                said[ours, inside] += [int(row[person]) > 0 for person in PEOPLE]
    print("| container | called right for what we put inside | for everything else |\n|---|---|---|")
    for ours in dict.fromkeys(CONTAINERS.values()):
        shares = [f"{sum(votes) / len(votes):.2f} of {len(votes)}" for votes in (said[ours, True], said[ours, False])]
        print(f"| {ours} | {shares[0]} | {shares[1]} |")


if __name__ == "__main__":
    main()
