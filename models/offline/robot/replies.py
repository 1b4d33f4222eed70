"""The robot's side: what the person may be up to, from common sense and from what the robot was given. Nothing else.

This module and all that it imports know no person: the private parameters are out of its reach.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from coopera.core.household import plain
from coopera.core.people import Frozen
from coopera.core.replies import ImaginedIntention, IntentionsReply
from coopera.models.offline.household.knowledge import Activity, Floats, key
from coopera.models.offline.household.offers import wants
from coopera.models.offline.household.reading import Memory, big_five_of, class_of, clip, memories, room_kind
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.household.statements import statements
from coopera.models.offline.robot import tasks as robot_tasks
from coopera.models.offline.robot import traits as robot_traits

NEXT = 0.6  # logits for what tends to follow the intention before
SEEN_BEFORE = 1.6  # logits for what the person did at this very hour of an earlier day
LIKE_HOUR = 1.5  # hours within which a remembered hour counts as a like one
GOES_ON = 2.0  # logits for what was done in the hour before, times the chance that such a thing goes on
ALREADY_TODAY = 2.5  # logits against what was done today and does not repeat
BELIEF = 0.3  # logits per point of the inferred traits x loading
PROFILE = 0.5  # logits per standard deviation of the inferred profile's closeness
USUAL = 1.0  # what is usual counts as so many told hours that are just like this one
WRONG_ROOM, WRONG_SPOT, WRONG_THING = 0.08, 0.15, 0.2  # likelihoods that perception, or custom, is off
WRONG_MOTION = 0.15  # share of motions that are recognised wrongly or done for another reason


Known: TypeAlias = tuple[Memory, int]
"""A remembered intention, and the place of the activity that it is."""


class Robot:
    """Answers the prompts of the role "robot"."""

    role = "robot"

    def __init__(self, sense: CommonSense) -> None:
        self._sense = sense

    def answer(self, prompt: str, variables: Mapping[str, Any], rng: np.random.Generator, temperature: float) -> Frozen:
        """Answer one prompt.

        Raises:
            KeyError: If the prompt is none of this role's, or a variable is missing.
        """
        if prompt == "robot/intentions":
            return self._intentions(variables)
        if prompt == "robot/traits":
            return robot_traits.infer(self._sense, variables)
        return robot_tasks.ANSWERS[prompt](self._sense, variables, rng, temperature)

    def _intentions(self, variables: Mapping[str, Any]) -> IntentionsReply:
        """The n most probable activities, each in the words in which the person is known to put it."""
        household, hour = self._sense.household, int(variables["hour"])
        told = told_weights(variables["told"], hour)
        recalled = memories(variables["recalled_intentions"], hour)
        if told:  # what was told is counted, and so it is not remembered a second time
            recalled = [*(memory for memory in recalled if memory.today), *told]
        known, strange = self._sorted(recalled)
        usual = household.log_hours[:, hour] + self._sight(variables["percept"], variables["first_task"])
        past = self._recall(known, hour, told=bool(told))
        logits = usual + past + self._belief(variables)
        kinds = {room_kind(room) for room in variables["rooms"]}
        possible = np.array([bool(kinds.intersection(a.rooms)) and not a.away for a in household.activities])
        logits = np.where(possible | ~possible.any(), logits, -1e9)
        average = float(np.log(np.exp(usual).mean()))  # what is not known is as likely as anything
        odd = np.array([_of_strange(done, hour, told=bool(told)) for done in strange])
        logits = np.append(logits, average + odd)
        if told:
            logits = self._counted(logits, told, known, strange, np.append(past, odd))
        best = np.argsort(-np.round(logits, 6), kind="stable")[: int(variables["n_intentions"])]
        chance = np.exp(logits - logits.max())
        chance /= chance.sum()
        return IntentionsReply(
            seen=_seen(variables),
            intentions=[self._imagined(int(i), known, strange, hour, variables, float(chance[i])) for i in best],
        )

    def _counted(
        self,
        logits: Floats,
        told: Mapping[Memory, float],
        known: Sequence[Known],
        strange: Sequence[Sequence[Memory]],
        today: Floats,
    ) -> Floats:
        """Mix what is usual with the told hours, each by its weight, for what today leaves of them; log-chances."""
        mass = np.zeros(len(logits))
        for memory, index in known:
            mass[index] += told.get(memory, 0.0)
        for place, done in enumerate(strange, len(self._sense.household.activities)):
            mass[place] += sum(told.get(memory, 0.0) for memory in done)
        usual = np.exp(logits - logits.max())
        mixed = USUAL * usual / usual.sum() + mass * np.exp(np.minimum(today, 0.0))
        return np.asarray(np.log(np.maximum(mixed / mixed.sum(), 1e-12)), dtype=np.float64)

    def _sorted(self, recalled: Sequence[Memory]) -> tuple[list[Known], list[list[Memory]]]:
        """Memories of activities that the household file has, with these; and the others, by what they say."""
        known: list[Known] = []
        strange: dict[str, list[Memory]] = {}
        for memory in recalled:
            found = self._sense.recognise(memory.text)
            if found.sure:
                known.append((memory, self._sense.household.index[found.activity.id]))
            else:
                strange.setdefault(key(memory.text), []).append(memory)
        return known, list(strange.values())

    def _imagined(
        self,
        i: int,
        known: Sequence[Known],
        strange: Sequence[Sequence[Memory]],
        hour: int,
        variables: Mapping[str, Any],
        chance: float,
    ) -> ImaginedIntention:
        """An activity as an intention or, after the last activity, something remembered that no activity is."""
        activities = self._sense.household.activities
        activity = activities[i] if i < len(activities) else None
        done = [] if activity else strange[i - len(activities)]
        wording = _wording(activity, i, known) if activity else done[0].text
        past = _of_past(i, known if activity else [(memory, i) for memory in done], hour)
        return ImaginedIntention(
            intention=clip(wording, 300),
            reason_human=clip(_of_person(activity, variables), 400),
            reason_intentions=clip(past, 400),
            reason_tasks=clip(_of_tasks(variables["recalled_tasks"]), 400),
            reason_vision=clip(_of_sight(activity, variables), 400),
            probability=round(chance, 4),
        )

    def _sight(self, percept: Mapping[str, Any] | None, first_task: str | None) -> Floats:
        """Log-likelihood of what is seen and of the first task's words under each activity; shape (activities,)."""
        activities = self._sense.household.activities
        total = np.zeros(len(activities))
        if percept is not None:
            total += self._percept_fit(percept)
        if first_task:
            total += [self._task_fit(activity, first_task) for activity in activities]
        return total

    def _percept_fit(self, percept: Mapping[str, Any]) -> Floats:
        """Log-likelihood of a percept under each activity: room, furniture, motion class and the thing in hand."""
        activities, near = self._sense.household.activities, [class_of(name) for name in percept["near"]]
        room = room_kind(percept["room"])
        likelihood = np.array([1.0 if room in activity.rooms else WRONG_ROOM for activity in activities])
        if near:
            likelihood *= [_spot_fit(activity, near) for activity in activities]
        if percept["motion"]:
            share = self._sense.looks[self._sense.motion_class(str(percept["motion"]))]
            likelihood *= WRONG_MOTION / 5 + (1 - WRONG_MOTION) * share
        if percept.get("in_hand"):
            likelihood *= np.maximum(WRONG_THING, self._sense.thing_fit(str(percept["in_hand"])) ** 2)
        return np.asarray(np.log(np.maximum(likelihood, 1e-6)), dtype=np.float64)

    def _task_fit(self, activity: Activity, first_task: str) -> float:
        """Log-likelihood of a first pick-and-place, as words, under an activity."""
        want = wants([first_task])[0]
        pairs = [(plain(thing), plain(spot)) for thing, spot in activity.places]
        if want.spot is None:
            return 2.0 * self._sense.similarity(first_task, activity.statement)
        if (want.thing, want.spot) in pairs:
            return 0.0
        thing = want.thing in [a for a, _ in pairs]
        spot = want.spot in [b for _, b in pairs]
        return float(np.log(0.3 if thing and spot else 0.15 if thing else 0.05 if spot else 0.02))

    def _recall(self, known: Sequence[Known], hour: int, *, told: bool) -> Floats:
        """Logits for what was done at like hours of earlier days, against what was done today, for what follows it."""
        household = self._sense.household
        total = np.zeros(len(household.activities))
        latest = min((memory.hours_ago for memory, _ in known if memory.today), default=0)
        for memory, index in known:
            if not memory.today:
                total[index] += 0.0 if told else _seen_before(memory, hour)
                continue
            activity = household.activities[index]
            if memory.hours_ago == 1 and activity.lasts > 1:
                total[index] += GOES_ON * (1.0 - 1.0 / activity.lasts)
            elif not activity.repeatable or memory.hours_ago < 3:
                total[index] -= ALREADY_TODAY
            if memory.hours_ago == latest:
                total += NEXT * household.follow_matrix[index]
        return total

    def _belief(self, variables: Mapping[str, Any]) -> Floats:
        """Logits from the Big Five and the profile that the robot itself inferred."""
        household = self._sense.household
        total = BELIEF * household.trait_pull(big_five_of(variables["big_five"]))
        habits = statements(variables["profile"] or "").habits
        if habits:
            closeness = self._sense.fit(habits).max(axis=0)
            total = total + PROFILE * (closeness - closeness.mean()) / max(float(closeness.std()), 1e-6)
        return np.asarray(total, dtype=np.float64)


def _seen_before(memory: Memory, hour: int) -> float:
    """Logits for what was done on an earlier day: the nearer the hour of day, the more."""
    return SEEN_BEFORE * float(np.exp(-0.5 * ((memory.hour - hour) / LIKE_HOUR) ** 2))


def _of_strange(done: Sequence[Memory], hour: int, *, told: bool) -> float:
    """Logits for what no activity is, by when it was done; nothing says that it comes again on one day."""
    earlier = [0.0 if told else _seen_before(memory, hour) for memory in done if not memory.today]
    return sum(earlier) - ALREADY_TODAY * (len(done) - len(earlier))


def told_weights(told: Sequence[Any], hour: int) -> dict[Memory, float]:
    """The told hours as memories of their intentions, with what each counts."""
    return {memory: float(one["weight"]) for memory, one in zip(memories(told, hour), told, strict=True)}


def _spot_fit(activity: Activity, near: Sequence[str]) -> float:
    """Likelihood of acting at these classes of furniture, nearest first, under an activity."""
    ranks = [near.index(cls) for cls in activity.fixed if cls in near]
    return max(WRONG_SPOT, 1.0 / (1 + min(ranks)) / len(activity.fixed) ** 0.5) if ranks else WRONG_SPOT


def _wording(activity: Activity, index: int, known: Sequence[Known]) -> str:
    """The person's own words where they are remembered, the newest first; else the household file's."""
    own = sorted((memory.hours_ago, memory.text) for memory, other in known if other == index)
    return own[0][1] if own else activity.canonical[0]


def _of_person(activity: Activity | None, variables: Mapping[str, Any]) -> str:
    if not variables["big_five"]:
        return "Nothing is known of this person yet."
    if activity is None:
        return "What kind of people do this is not known."
    score = {trait: float(variables["big_five"][trait]) for trait in activity.big_five}
    pull = {trait: load * (score[trait] - 3.0) for trait, load in activity.big_five.items()}
    best = max(pull, key=lambda trait: (abs(pull[trait]), trait), default=None)
    if best is None:
        return "It says little about anybody's traits."
    way = "speaks for it" if pull[best] >= 0 else "speaks against it"
    return f"An inferred {best} of {score[best]:.1f} {way}."


def _of_past(index: int, known: Sequence[Known], hour: int) -> str:
    for memory, other in known:
        if other == index and not memory.today:
            return f'On an earlier day, {abs(memory.hour - hour)} h from this time of day, it was "{memory.text}".'
    if known:
        return f'Nothing recalled is just this; nearest in time of day comes "{known[0][0].text}".'
    return "There is no history to go by; it is a usual thing at this hour."


def _of_tasks(recalled: Sequence[Any]) -> str:
    tasks = memories(recalled, 24)
    return f"A remembered task: {tasks[0].text}." if tasks else "No earlier task is known."


def _seen(variables: Mapping[str, Any]) -> str:
    """What it was told of the first task, as a sentence: the task itself, else the percept's caption."""
    first_task, percept = variables["first_task"], variables["percept"]
    said = f"The person's first task was: {first_task}." if first_task else percept["caption"] if percept else ""
    return clip(said, 300)


def _of_sight(activity: Activity | None, variables: Mapping[str, Any]) -> str:
    percept, first_task = variables["percept"], variables["first_task"]
    if activity is None:
        return "What is needed for it is not known, so what is seen does not speak for it or against it."
    said = [f"The first task was: {first_task}."] if first_task else []
    if percept is not None:
        fits = []
        if room_kind(percept["room"]) in activity.rooms:
            fits.append(f"the {percept['room']}")
        fits += [f"the {plain(name)}" for name in percept["near"][:1] if class_of(name) in activity.fixed]
        if percept.get("in_hand") and plain(str(percept["in_hand"])) in activity.thing_names:
            fits.append(f"the {plain(str(percept['in_hand']))} in hand")
        said.append(f"Of what is seen, {', '.join(fits)} fits." if fits else "What is seen does not speak for it.")
    return " ".join(said) or "Nothing was seen."
