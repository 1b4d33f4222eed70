"""What the robot makes of a person from the day's true intentions and tasks: Big Five and three sentences."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from coopera.core.people import TRAITS, BigFive
from coopera.core.replies import TraitsReply
from coopera.models.offline.household.offers import wants
from coopera.models.offline.household.reading import Memory, clip, memories
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.household.statements import sentences

SPREAD = 15.0  # points of a trait per unit of mean loading beyond that of an average day
PATIENCE = 20.0  # as many activities seen leave an estimate half-way to the middle of the scale
KNOWN = 2.0  # how many of today's hours an activity weighs that the earlier profile names

_PARTS = (("morning", 0, 12), ("afternoon", 12, 18), ("evening", 18, 24))


def infer(sense: CommonSense, variables: Mapping[str, Any]) -> TraitsReply:
    """Answer robot/traits: shrunk estimates, and a profile that revises the earlier one.

    The profile names the person's activities, their hours and their things; what the robot's common sense does not know
    says nothing to it. The activities of the earlier profile stay
    first if today confirms them.
    """
    lived = memories(variables["intentions"], 24)
    found = [(memory, sense.recognise(memory.text)) for memory in lived]
    seen = [(memory, sense.household.index[it.activity.id]) for memory, it in found if it.sure]
    earlier = _named_before(sense, variables["profile"])
    weights: Counter[int] = Counter()
    for _, index in seen:
        weights[index] += 1
    for index in earlier:
        weights[index] += KNOWN  # type: ignore[assignment]
    big_five, because = _estimate(sense, weights)
    profile = " ".join((_what(sense, weights), _when(sense, seen), _things(variables["tasks"])))
    kept = sum(index in earlier for index in {index for _, index in seen})
    agreed = f"; the earlier profile knew {kept} of the activities" if earlier else ""
    return TraitsReply(
        big_five=big_five,
        profile=clip(profile, 900),
        reasons_big_five=clip(because, 900),
        reasons_profile=clip(f"It rests on {len(lived)} intentions{agreed}.", 900),
    )


def _estimate(sense: CommonSense, weights: Mapping[int, float]) -> tuple[BigFive, str]:
    """Mean loading of what was done, against what anybody does, scaled and shrunk."""
    household = sense.household
    usual = np.exp(household.log_hours[:, 9:22]).sum(axis=1)
    average = usual @ household.loadings / usual.sum()
    total = float(sum(weights.values()))
    if total == 0:
        return BigFive(), "Nothing was seen."
    mean = sum(weight * household.loadings[index] for index, weight in sorted(weights.items())) / total
    scores = 3.0 + SPREAD * (total / (total + PATIENCE)) * (mean - average)
    telling = []
    for i, trait in enumerate(TRAITS):
        ranked = sorted(weights, key=lambda index: (-abs(household.loadings[index, i]), index))
        if ranked and household.loadings[ranked[0], i]:
            telling.append(f'{trait}: "{household.activities[ranked[0]].canonical[0]}"')
    values = {trait: round(float(np.clip(score, 1.0, 5.0)), 2) for trait, score in zip(TRAITS, scores, strict=True)}
    return BigFive(**values), f"Most telling were, for {'; for '.join(telling) or 'nothing'}."


def _what(sense: CommonSense, weights: Mapping[int, float]) -> str:
    ranked = sorted(weights, key=lambda index: (-weights[index], _usual(sense, index), index))[:6]
    names = [_low(sense.household.activities[index].canonical[0]) for index in ranked]
    return f"This person likes to {_list(names)}." if names else "Nothing is known of what this person does."


def _when(sense: CommonSense, seen: Sequence[tuple[Memory, int]]) -> str:
    said = []
    for name, first, last in _PARTS:
        inside = [index for memory, index in seen if first <= memory.hour < last]
        rare = sorted(dict.fromkeys(inside), key=lambda index: (_usual(sense, index), index))[:2]
        if rare:
            said.append(f"in the {name} to {_list([_low(sense.household.activities[i].canonical[0]) for i in rare])}")
    return f"It is usual {', '.join(said)}." if said else "When is not known."


def _things(tasks: Sequence[Any]) -> str:
    counted = Counter(want.thing for want in wants(tasks))
    ranked = sorted(counted, key=lambda thing: (-counted[thing], thing))[:6]
    return f"The things most often in use are the {_list(ranked)}." if ranked else "No thing stands out."


def _named_before(sense: CommonSense, profile: str | None) -> list[int]:
    """The activities that the first sentence of an earlier profile names, by their usual wording."""
    text = (sentences(profile or "") or [""])[0].lower()
    return [i for i, activity in enumerate(sense.household.activities) if _low(activity.canonical[0]) in text]


def _usual(sense: CommonSense, index: int) -> float:
    """How much everybody does this: rare things tell more about a person."""
    return float(np.exp(sense.household.log_hours[index, 9:22]).sum())


def _low(text: str) -> str:
    return text[:1].lower() + text[1:]


def _list(items: Sequence[str]) -> str:
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}"
