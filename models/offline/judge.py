"""The judge: would this task candidate help with this intention? By common sense, not by the predicate's rule.

The predicate compares the candidate with the tasks, class by class or cosine by cosine. The judge also accepts
candidates with the same purpose: another thing for the motion of a task, or another usual place for the same thing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from coopera.core.household import plain
from coopera.core.people import Frozen
from coopera.core.replies import VerdictReply, VerdictsReply
from coopera.models.offline.household.knowledge import Activity
from coopera.models.offline.household.offers import Want, wants
from coopera.models.offline.household.reading import clip
from coopera.models.offline.household.sense import CommonSense

SAME_KIND = 0.75  # cosine from which two things are taken for the same kind


class Judge:
    """Answers the prompts of the role "judge"."""

    role = "judge"

    def __init__(self, sense: CommonSense) -> None:
        self._sense = sense

    def answer(self, prompt: str, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float) -> Frozen:
        """Answer one prompt; the judge has no moods, so neither chance nor temperature enters.

        Raises:
            KeyError: If the prompt is none of this role's, or a variable is missing.
        """
        return {"judge/tasks": self._tasks}[prompt](variables)

    def _tasks(self, variables: Mapping[str, Any]) -> VerdictsReply:
        intention = str(variables["intention"])
        activity, needed = self._sense.recognise(intention).activity, wants(variables["tasks"])
        return VerdictsReply(
            verdicts=[self._judge(offer, intention, activity, needed) for offer in wants(variables["offers"])]
        )

    def _judge(self, offer: Want, intention: str, activity: Activity, needed: Sequence[Want]) -> VerdictReply:
        what = offer.thing if offer.spot is None else f"{offer.thing} for the {offer.spot}"
        task = self._task_served(offer, activity, needed)
        if task is not None:
            return VerdictReply(yes=True, reason=clip(f"The {what} serves whoever is about to {task.text}.", 400))
        return VerdictReply(
            yes=False, reason=clip(f'The {what} does not help with what is left of "{intention}".', 400)
        )

    def _task_served(self, offer: Want, activity: Activity, needed: Sequence[Want]) -> Want | None:
        """Return a task that asks for the same kind of thing, or for what one usually does with it in this activity."""
        for task in needed:
            same_thing = self._sense.similarity(offer.thing, task.thing) >= SAME_KIND
            if offer.spot is None or task.spot is None:
                if same_thing or (task.motion and self._usual_motion(offer.thing, activity) == task.motion):
                    return task
            else:
                same_spot = self._sense.similarity(offer.spot, task.spot) >= SAME_KIND
                usual = (offer.thing, offer.spot) in {(plain(a), plain(b)) for a, b in activity.places}
                if (same_thing and same_spot) or ((same_thing or same_spot) and usual):
                    return task
        return None

    def _usual_motion(self, thing: str, activity: Activity) -> str | None:
        """Return what one does with a thing in an activity, by the thing of the household file that is most like it."""
        place, likeness = self._sense.nearest(thing, activity.thing_names)
        return activity.things[activity.thing_names[place]] if likeness >= SAME_KIND else None
