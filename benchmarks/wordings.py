"""Measure the offline person's words: how many there are, how much they are a person's own, how well MiniLM reads them.

python -m benchmarks.wordings --days 15

The shipped people live without a world: each hour's intention is asked of the offline person, who knows the day so far.
"""

from __future__ import annotations

import argparse
import json
from collections import defaultdict
from itertools import combinations

import numpy as np
from langchain_core.embeddings import Embeddings
from langchain_core.messages import HumanMessage

from coopera.config.schema import default_data_dir
from coopera.core.clock import Clock
from coopera.core.people import Persona
from coopera.core.randomness import seed_at
from coopera.memory import bundled
from coopera.models.offline import OfflineChatModel
from coopera.models.offline.household.grammar import cores
from coopera.models.offline.household.knowledge import FIRST, LAST, key, shipped
from coopera.models.offline.household.sense import CommonSense
from coopera.people.shipped import SHIPPED, read_persona, shipped_ids

ROOMS = sorted({room for activity in shipped().activities for room in activity.rooms})


def day_of(person: Persona, day: int, model: OfflineChatModel) -> list[str]:
    """The intentions of a day, each knowing those before it."""
    lived: list[tuple[Clock, str]] = []
    for hour in range(FIRST, LAST + 1):
        now = Clock(day=day, hour=hour)
        today = [{"when": t.label, "hours_ago": now.now - t.now, "text": text} for t, text in lived]
        variables = {
            **{"person": person.id, "name": person.name, "profile": person.profile},
            **{"big_five": person.big_five.model_dump(), "rooms": ROOMS, "states": {}, "today": today},
            **{"time": now.label, "hour": hour, "weekday": now.weekday, "day": day},
            **{"recalled_intentions": [], "recalled_tasks": [], "changes": [], "may_go_on": False, "may_leave": False},
            **{"fixed": {}, "movable": {}, "side": "", "rhythm": "", "earlier_days": ""},
        }
        seed = seed_at(0, person.id, day, hour)
        asked = {"prompt": "human/intention", "variables": variables, "seed": seed, "temperature": 0.7}
        reply = model.invoke([HumanMessage("", additional_kwargs={"coopera": asked})])
        lived.append((now, str(json.loads(str(reply.content))["intention"])))
    return [text for _, text in lived]


def core(text: str) -> str:
    """The wording within a text, touches aside, as its `key`; the whole text where none is known."""
    known = (key(part) for part in cores(text) if key(part) in shipped().by_wording)
    return next(known, key(text))


def share_read(embeddings: Embeddings) -> float:
    """Share of the expansions, but for the embedded ones, whose own activity is the nearest in meaning."""
    right: list[bool] = []
    sense = CommonSense(shipped(), embeddings)
    for index, activity in enumerate(shipped().activities):
        texts = [text for text in activity.expansions() if text not in activity.canonical]
        right += [int(best) == index for best in sense.fit(texts).argmax(axis=1)] if texts else []
    return float(np.mean(right))


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--days", type=int, default=15, help="days of each of the shipped people")
    days = parser.parse_args().days
    said: dict[tuple[str, str], list[str]] = defaultdict(list)
    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        model = OfflineChatModel(role="human", embeddings=embeddings)
        people = [read_persona(SHIPPED / f"{person}.yaml") for person in shipped_ids()]
        texts = [(p.id, text) for p in people for day in range(days) for text in day_of(p, day, model)]
        read = share_read(embeddings)
    for person, text in texts:
        if activity := shipped().named(text):
            said[activity.id, person].append(core(text))
    own = [a == b for cores_said in said.values() for a, b in combinations(cores_said, 2)]
    others = [
        a == b for (one, other) in combinations(said, 2) if one[0] == other[0] for a in said[one] for b in said[other]
    ]
    touched = np.mean([key(text) not in shipped().by_wording for _, text in texts])
    print(
        f"{len(shipped().by_wording)} texts for {len(shipped().activities)} activities; MiniLM reads {read:.1%} of them"
    )
    print(f"{len(texts)} hours of {len(people)} people: {len({text for _, text in texts})} different texts, ", end="")
    print(f"{len({core(text) for _, text in texts})} without touches; {touched:.0%} have a touch; ", end="")
    print(f"{sum(map(len, said.values()))} understood for certain")
    print(f"the same words for the same thing: {np.mean(own):.1%} by one person, {np.mean(others):.1%} by two")


if __name__ == "__main__":
    main()
