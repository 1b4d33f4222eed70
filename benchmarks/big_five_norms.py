"""Measure the norms by which the offline model reads the Big Five, over the distinct first profiles of a corpus.

python -m benchmarks.big_five_norms synthetic_persona_chat_valid.csv > models/offline/human/traits.yaml
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from coopera.config.schema import default_data_dir
from coopera.core.people import TRAITS
from coopera.core.randomness import rng_at
from coopera.memory import bundled
from coopera.models.offline.household.knowledge import shipped
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.big_five import nearest, raw_scores
from coopera.models.offline.human.persona import profile
from coopera.people.import_chat import read_rows

HEAD = """\
# What is usual among published personas, by which models/offline/human/big_five.py reads the Big Five:
# traits: mean and standard deviation of the raw score; items: of the nearest sentence's cosine, in the test's order.
# Measured by benchmarks/big_five_norms.py over the {count} distinct first profiles of {name}.
"""


def main() -> None:
    """Print traits.yaml."""
    path = Path(sys.argv[1])
    rows = {row.profile_1: row for row in reversed(read_rows(path))}
    near = []
    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        sense = CommonSense(shipped(), embeddings)
        for row in rows.values():
            given = {"profile_1": row.profile_1, "profile_2": row.profile_2, "conversation": row.conversation}
            text = profile(sense, given, rng_at(0, "norms", row.number)).profile
            found = nearest(sense, text, rng_at(0, "norms", row.number, "read"))
            if found is not None:
                near.append(found)
    raw = [raw_scores(one) for one in near]
    print(HEAD.format(count=len(near), name=path.name) + "traits:")
    for trait in TRAITS:
        values = [one[trait] for one in raw]
        print(f"  {trait}: {{mean: {np.mean(values):.4f}, sd: {np.std(values):.4f}}}")
    print("items:")
    for values in np.transpose(near):
        print(f"  - {{mean: {np.mean(values):.4f}, sd: {np.std(values):.4f}}}")


if __name__ == "__main__":
    main()
