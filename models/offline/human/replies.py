"""The person's side: what to do this hour, and the way to every other answer of the role "human"."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coopera.core.affordances import affordances
from coopera.core.clock import hour_label
from coopera.core.people import Frozen
from coopera.core.randomness import rng_at
from coopera.core.replies import DayReply, IntentionReply
from coopera.models.offline.household.knowledge import Activity, Floats
from coopera.models.offline.household.reading import Memory, big_five_of, class_of, clip, hour_of, memories, room_kind
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human import big_five, persona, verdicts
from coopera.models.offline.human import tasks as human_tasks
from coopera.models.offline.human.person import PrivateLife

USUAL_TEMPERATURE = 0.7  # PAPER App. A: proposing at 0.7; the logits are meant for it
NEXT = 0.9  # logits for an activity that tends to follow what was done last
LATER = 0.25  # the same for what was done before that
DIRTY = 0.5  # logits for what makes something clean that is dirty
AGAIN_AFTER = 3  # hours until a repeatable activity may come again
NEVER = -1e9


class Human:
    """Answers the prompts of the role "human" as the person that their variables describe."""

    role = "human"

    def __init__(self, sense: CommonSense) -> None:
        self._sense = sense
        self._lives: dict[tuple[str, str, str], PrivateLife] = {}

    def answer(self, prompt: str, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float) -> Frozen:
        """Answer one prompt.

        Raises:
            KeyError: If the prompt is none of this role's, or a variable is missing.
        """
        if prompt == "human/intention":
            return self._intention(variables, rng, temperature)
        if prompt == "human/day":
            return self._day(variables, rng, temperature)
        if prompt in human_tasks.ANSWERS:
            life = self._life(variables) if "person" in variables else None
            return human_tasks.ANSWERS[prompt](self._sense, life, variables, rng)
        if prompt in _OTHERS:
            return _OTHERS[prompt](self._sense, variables)
        return _OF_TEXT[prompt](self._sense, variables, rng)

    def _life(self, variables: Mapping[str, Any]) -> PrivateLife:
        traits = big_five_of(variables["big_five"])
        key = (str(variables["person"]), str(variables["profile"]), str(traits))
        if key not in self._lives:
            self._lives[key] = PrivateLife(self._sense, key[0], key[1], traits)
        return self._lives[key]

    def _intention(self, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float) -> IntentionReply:
        life, hour = self._life(variables), int(variables["hour"])
        rng = _in_these_rooms(rng, variables["rooms"])
        today = memories(variables["today"], hour)
        wish = life.pull + life.own_hours[:, hour] + self._flow(today) + self._called_for(variables["states"])
        activity = self._draw(wish, self._allowed(today, variables["rooms"]), rng, temperature)
        return IntentionReply(
            intention=clip(life.wording(activity, rng), 300),
            reason_human=clip(self._why(life, activity, hour), 400),
            reason_intentions=clip(self._since(activity, today), 400),
            reason_tasks=clip(_tasks_before(variables["recalled_tasks"]), 400),
        )

    def _day(self, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float) -> DayReply:
        """A day planned at once: each hour for itself, since nothing has been done yet that could lead on to it.

        What stands in the plan is not planned again, unless it is repeatable and three hours old.
        """
        life = self._life(variables)
        rng = _in_these_rooms(rng, variables["rooms"])
        planned: list[tuple[int, str]] = []
        replies: list[IntentionReply] = []
        for hour in map(hour_of, variables["hours"]):
            so_far = [Memory(text, then, hour - then, today=True) for then, text in planned]
            allowed = self._allowed(so_far, variables["rooms"])
            activity = self._draw(life.pull + life.own_hours[:, hour], allowed, rng, temperature)
            text = clip(life.wording(activity, rng), 300)
            planned.append((hour, text))
            replies.append(IntentionReply(intention=text, reason_human=clip(self._why(life, activity, hour), 400)))
        return DayReply(intentions=replies)

    def _draw(self, wish: Floats, allowed: NDArray[np.bool_], rng: np.random.Generator, temperature: float) -> Activity:
        """Draw an activity from logits that are meant for the usual temperature."""
        logits = np.where(allowed, wish * USUAL_TEMPERATURE / max(temperature, 0.01), NEVER)
        weights = np.exp(logits - logits.max())
        choice = int(rng.choice(len(weights), p=weights / weights.sum()))
        return self._sense.household.activities[choice]

    def _flow(self, today: Sequence[Memory]) -> Floats:
        """Logits for what tends to follow the day so far, the last activity most."""
        household = self._sense.household
        total = np.zeros(len(household.activities))
        for memory, weight in zip(reversed(today), (NEXT, LATER, LATER), strict=False):
            total = total + weight * household.follow_matrix[self._sense.index(memory.text)]
        return total

    def _called_for(self, states: Mapping[str, str]) -> Floats:
        """Logits for what is done about something that is dirty at home."""
        dirty = {class_of(name) for name, said in states.items() if "dirty" in said.split(", ")}
        wants = [any(affordances().is_one_of(cls, a.dirty) for cls in dirty) for a in self._sense.household.activities]
        return DIRTY * np.array(wants, dtype=np.float64)

    def _allowed(self, today: Sequence[Memory], rooms: Sequence[str]) -> NDArray[np.bool_]:
        """Nothing of today again, unless it is repeatable and three hours old; only what the home has rooms for.

        After what closes a day, only what that leads on to.
        """
        activities = self._sense.household.activities
        kinds = {room_kind(room) for room in rooms}
        possible = np.array([bool(kinds.intersection(activity.rooms)) for activity in activities])
        fresh = np.ones(len(activities), dtype=bool)
        for memory in today:
            index = self._sense.index(memory.text)
            fresh[index] &= activities[index].repeatable and memory.hours_ago >= AGAIN_AFTER
            if activities[index].closes:
                fresh &= self._sense.household.follow_matrix[index] > 0
        for mask in (possible & fresh, fresh):
            if mask.any():
                return mask
        return np.ones(len(activities), dtype=bool)

    def _why(self, life: PrivateLife, activity: Activity, hour: int) -> str:
        parts = []
        if sentence := life.evidence(activity):
            parts.append(f'I say of myself: "{sentence.rstrip(".")}".')
        if found := life.strongest_trait(activity):
            trait, score = found
            parts.append(f"My {trait} of {score:.1f} speaks for it.")
        if not parts and life.liking[self._sense.household.index[activity.id]] > 0.4:
            parts.append("I simply have a liking for it.")
        own = life.own_hours[self._sense.household.index[activity.id]]
        if own[hour] >= own[9:22].max() - 0.5:
            parts.append("This is my usual time for it.")
        return " ".join(parts) or "It is a usual thing to do at this hour."

    def _since(self, activity: Activity, today: Sequence[Memory]) -> str:
        if not today:
            return "Nothing has been done yet today."
        for memory in reversed(today[-3:]):
            before = self._sense.recognise(memory.text).activity
            if activity.id in before.follows:
                return f'It comes naturally after "{memory.text}" at {hour_label(memory.hour)}.'
        return f'I have done "{today[-1].text}" at {hour_label(today[-1].hour)} and want to do something else now.'


def _in_these_rooms(rng: np.random.Generator, rooms: Sequence[str]) -> np.random.Generator:
    """Draw anew in another home, as a language model does that reads of other rooms; the person stays the same."""
    return rng_at(int(rng.integers(2**62)), *rooms)


def _tasks_before(recalled: Sequence[Any]) -> str:
    tasks = memories(recalled, 24)
    if not tasks:
        return "There are no earlier tasks to build on."
    return f"Of what I did earlier I remember: {tasks[0].text}."


_OTHERS: dict[str, Callable[[CommonSense, Mapping[str, Any]], Frozen]] = {
    "human/feedback_intentions": verdicts.feedback_intentions,
    "human/feedback_tasks": verdicts.feedback_tasks,
    "human/grade_intentions": verdicts.grade_intentions,
    "human/grade_tasks": verdicts.grade_tasks,
}
_OF_TEXT: dict[str, Callable[[CommonSense, Mapping[str, Any], np.random.Generator], Frozen]] = {
    "persona/profile": persona.profile,
    "persona/big_five": lambda sense, variables, rng: big_five.infer(sense, str(variables["profile"]), rng),
    "persona/big_five_test": lambda sense, variables, rng: big_five.take_test(sense, str(variables["profile"]), rng),
}
