"""The person's side: what to do this hour, and the way to every other answer of the role "human"."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np

from coopera.core.affordances import affordances
from coopera.core.clock import WEEKDAYS, hour_label
from coopera.core.naming import plain
from coopera.core.people import Frozen
from coopera.core.randomness import rng_at
from coopera.core.replies import DayReply, IntentionReply
from coopera.models.offline.household.knowledge import Activity, Floats
from coopera.models.offline.household.placing import feasible_places
from coopera.models.offline.household.reading import (
    Memory,
    Surroundings,
    big_five_of,
    class_of,
    clip,
    hour_of,
    memories,
    room_kind,
)
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human import big_five, persona, verdicts
from coopera.models.offline.human import tasks as human_tasks
from coopera.models.offline.human.circumstances import circumstances, speaks_for
from coopera.models.offline.human.person import PrivateLife
from coopera.models.offline.human.routine import Choice, Done, Moment, Why, choose

NOON = 12
WANTS = 12
DIRTY = 0.5  # logits for what makes something clean that is dirty


class Human:
    """Answers the prompts of the role "human" as the person that their variables describe."""

    role = "human"

    def __init__(self, sense: CommonSense) -> None:
        self._sense = sense
        self._lives: dict[tuple[str, str], PrivateLife] = {}

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
        key = (str(variables["profile"]), str(traits))
        if key not in self._lives:
            self._lives[key] = PrivateLife(self._sense, key[0], traits)
        return self._lives[key]

    def _intention(self, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float) -> IntentionReply:
        life, hour = self._life(variables), int(variables["hour"])
        rng = _in_these_rooms(rng, variables["rooms"])
        today = memories(variables["today"], hour)
        moment = self._moment(variables, hour, today, lasting=bool(variables["may_go_on"]))
        choice = choose(life, moment, rng, temperature)
        activity = self._sense.household.activities[choice.activity]
        return IntentionReply(
            intention=clip(_anew(life, activity, rng, hour, today), 300),
            reason_human=clip(self._why(life, activity, choice, variables["changes"]), 400),
            reason_intentions=clip(self._since(activity, choice, today), 400),
            reason_tasks=clip(_tasks_before(variables["recalled_tasks"]), 400),
            continues=choice.continues,
            away=activity.away,
            wants=_wants(life, activity, variables),
        )

    def _day(self, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float) -> DayReply:
        """A day planned at once; what was not done yet cannot leave anything behind, such as dirty dishes."""
        life = self._life(variables)
        rng = _in_these_rooms(rng, variables["rooms"])
        planned: list[tuple[int, str]] = []
        replies: list[IntentionReply] = []
        for hour in map(hour_of, variables["hours"]):
            so_far = [Memory(text, then, hour - then, today=True) for then, text in planned]
            moment = self._moment({**variables, "states": {}}, hour, so_far, lasting=False)
            choice = choose(life, moment, rng, temperature)
            activity = self._sense.household.activities[choice.activity]
            text = clip(_anew(life, activity, rng, hour, so_far), 300)
            planned.append((hour, text))
            why = self._why(life, activity, choice, variables["changes"])
            wants = _wants(life, activity, variables)
            replies.append(IntentionReply(intention=text, reason_human=clip(why, 400), away=activity.away, wants=wants))
        return DayReply(intentions=replies)

    def _moment(self, variables: Mapping[str, Any], hour: int, today: Sequence[Memory], *, lasting: bool) -> Moment:
        activities = self._sense.household.activities
        kinds = {room_kind(room) for room in variables["rooms"]}
        changed = circumstances(self._sense.household, variables["changes"], absence=bool(variables["may_leave"]))
        return Moment(
            hour=hour,
            weekday=WEEKDAYS.index(str(variables["weekday"])),
            today=[Done(self._sense.index(memory.text), memory.hour) for memory in today],
            lasting=lasting,
            absence=bool(variables["may_leave"]),
            possible=np.array([bool(kinds.intersection(activity.rooms)) for activity in activities]) & changed.can_do,
            extra=changed.pull + self._called_for(variables["states"]),
            job=changed.job,
        )

    def _called_for(self, states: Mapping[str, str]) -> Floats:
        """Logits for what is done about something that is dirty at home."""
        dirty = {class_of(name) for name, said in states.items() if "dirty" in said.split(", ")}
        wants = [any(affordances().is_one_of(cls, a.dirty) for cls in dirty) for a in self._sense.household.activities]
        return DIRTY * np.array(wants, dtype=np.float64)

    def _why(self, life: PrivateLife, activity: Activity, choice: Choice, changes: Sequence[Any]) -> str:
        """What is different today, the person's own words where they bear on it, their traits; else a habit."""
        parts = [f"{change['text']}." for change in changes if speaks_for(change, activity)][:1]
        if own := life.own_words(activity):
            parts.append(own)
        if choice.why == "wish" and (found := life.strongest_trait(activity)):
            trait, score = found
            parts.append(f"My {trait} of {score:.1f} speaks for it.")
        if not parts or choice.why != "wish":
            parts.append(_HABIT[choice.why])
        return " ".join(parts)

    def _since(self, activity: Activity, choice: Choice, today: Sequence[Memory]) -> str:
        if not today:
            return "Nothing has been done yet today."
        if choice.continues:
            return "It takes longer than an hour, and I am not done with it."
        for memory in reversed(today[-3:]):
            before = self._sense.recognise(memory.text).activity
            if activity.id in before.follows or before.id in activity.after:
                return f'It comes naturally after "{memory.text}" at {hour_label(memory.hour)}.'
        return f'I have done "{today[-1].text}" at {hour_label(today[-1].hour)} and want to do something else now.'


_HABIT: dict[Why, str] = {
    "need": "It is a habit: it belongs to each of my days, at about this hour.",
    "work": "It is a habit: these are my hours for it.",
    "going on": "It is a habit: I seldom stop after an hour.",
    "chore": "It is a habit: it has to be done after what came before.",
    "asleep": "It is a habit: I am not up at this hour.",
    "wish": "It is a habit of mine.",
}
_TRIES = 12
_MORNING = re.compile(r"\b(?:morning|waking|wide awake|before the day (?:begins|gets going))\b", re.IGNORECASE)
_EVENING = re.compile(r"\b(?:evening|tonight|tonight's|wash off the day|for the night)\b", re.IGNORECASE)


def _anew(life: PrivateLife, activity: Activity, rng: np.random.Generator, hour: int, today: Sequence[Memory]) -> str:
    """Word an intention: not as the hour before, and naming no other time of day, if the person has such words."""
    text = life.wording(activity, rng)
    for _ in range(_TRIES):
        if not (today and text == today[-1].text) and not _out_of_time(text, hour):
            break
        text = life.wording(activity, rng)
    return text


def _out_of_time(text: str, hour: int) -> bool:
    """Whether a text speaks of the morning in the afternoon, or of the evening before it."""
    return bool(_MORNING.search(text) if hour >= NOON + 2 else hour < NOON + 3 and _EVENING.search(text))


def _in_these_rooms(rng: np.random.Generator, rooms: Sequence[str]) -> np.random.Generator:
    """Draw anew in another home, as a language model does that reads of other rooms; the person stays the same."""
    return rng_at(int(rng.integers(2**62)), *rooms)


def _wants(life: PrivateLife, activity: Activity, variables: Mapping[str, Any]) -> list[str]:
    """Name what an activity is done with, the most usual first: of furniture and movable things what the home has.

    Where things are put somewhere (type 1), they and their places as this person has them, the likeliest first. Without
    movable things (type 2) any things are wanted, since they are brought.
    """
    if activity.away:
        return []
    fixed, movable = Surroundings(variables["fixed"]), Surroundings(variables["movable"])
    own = life.at_home(activity, fixed)
    if movable.pieces:
        weights = life.place_weights(own)
        order = sorted(feasible_places(own, fixed, movable), key=lambda i: (-weights[i], i))
        named = list(chain.from_iterable(own.places[i] for i in order))
    else:
        named = [*filter(fixed.of, own.fixed), *own.thing_names]
    return list(dict.fromkeys(map(plain, named)))[:WANTS]


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
