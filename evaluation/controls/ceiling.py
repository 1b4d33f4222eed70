"""The ceiling: Bayes' rule with the true person. What could be known without being told anything of the hour.

It is given what no robot can know: the private parameters from which the offline model makes the person. It asks
them what this person does at this hour of the week and with what, and weighs that by what it sees. So it shows how far
one can come by knowing somebody perfectly. It knows nothing of the day so far, which a robot can guess.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import repeat
from typing import Any

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.clock import FIRST_HOUR, HOURS_PER_DAY, WEEKDAYS
from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.core.household import Use, plain
from coopera.core.people import Persona, PersonId
from coopera.core.randomness import rng_at
from coopera.evaluation.controls.acts import help_with
from coopera.graphs.robots.method import Method, Numbers
from coopera.graphs.robots.robot_view import RobotView
from coopera.graphs.robots.told import held, same
from coopera.models.offline.household.knowledge import Household
from coopera.models.offline.household.placing import feasible_places
from coopera.models.offline.household.reading import Surroundings, class_of, room_kind, weighted_order
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.person import PrivateLife
from coopera.models.offline.human.routine import Moment, live_day

DAYS, HOURS = 60, 100
"""Days of each weekday, and hours of each activity, that are drawn to know how often something comes."""
WORTH = 0.3  # see `coopera.graphs.robots.verdicts`
STRANGE = 0.02  # the likelihood of what this person never does: perception errs


@dataclass
class Knower:
    """A robot that knows each person as the offline model does."""

    people: Mapping[PersonId, str]
    """The text that each lives by."""
    personas: Mapping[PersonId, Persona]
    sense: CommonSense
    _lives: dict[PersonId, PrivateLife] = field(default_factory=dict, repr=False)
    _usual: dict[tuple[PersonId, int, int], Counter[int]] = field(default_factory=dict, repr=False)

    def help(self, view: RobotView) -> Proposal:
        """Propose what this person most probably needs."""
        life = self._life(view.person)
        usual = self._usual_at(life, view)
        now, chance, wanted = held(view.observation), Counter[int](), Counter[Use]()
        for index, often in sorted(usual.items()):
            drawn = self._drawn(life, index, view)
            fits = [uses for uses in drawn if now is None or same(uses[0], now)] if drawn else []
            likely = often * self._at_spot(life, index, view) * max(STRANGE, len(fits) / HOURS)
            chance[index] += likely  # type: ignore[assignment]
            for uses in fits or drawn:
                for use in dict.fromkeys(uses if fits else uses[1:]):
                    if now is None or not same(use, now):
                        wanted[use] += likely / len(fits or drawn)  # type: ignore[assignment]
        total = sum(chance.values())
        if not total:
            return Proposal(fallbacks=["this person does nothing at this hour"])
        best = self.sense.household.activities[max(sorted(chance), key=lambda index: chance[index])]
        tasks: dict[str, TaskCandidate] = {}
        for use, weight in sorted(wanted.items(), key=lambda pair: (-pair[1], str(pair[0]))):
            p, act = round(min(1.0, weight / total), 6), help_with(view, use)
            if act and p > WORTH / 3:
                task = TaskCandidate(intention=best.canonical[0], thought="as this person does", act=act)
                tasks.setdefault(act.describe(), task.model_copy(update={"probability": p, "accepted": p >= WORTH}))
        sure = round(max(chance.values()) / total, 6)
        guess = IntentionCandidate(text=best.canonical[0], probability=sure, accepted=True)
        return Proposal(intentions=[guess], tasks=list(tasks.values()))

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, Any]:
        """Learn nothing: there is nothing left to know."""
        return {"hours": len(account.hours)}

    def _life(self, person: PersonId) -> PrivateLife:
        if person not in self._lives:
            self._lives[person] = PrivateLife(self.sense, self.people[person], self.personas[person].big_five)
        return self._lives[person]

    def _usual_at(self, life: PrivateLife, view: RobotView) -> Counter[int]:
        """How often each activity comes at this hour of such a weekday, of `DAYS` drawn days."""
        day = WEEKDAYS.index(view.clock.weekday)
        if (view.person, day, FIRST_HOUR) not in self._usual:
            self._usual |= {(view.person, day, hour): often for hour, often in self._days(life, view, day).items()}
        return self._usual.get((view.person, day, view.clock.hour), Counter())

    def _days(self, life: PrivateLife, view: RobotView, weekday: int) -> dict[int, Counter[int]]:
        kinds = {room_kind(room) for room in view.home.rooms}
        activities = self.sense.household.activities
        possible = np.array([bool(kinds.intersection(activity.rooms)) for activity in activities])
        hours = range(FIRST_HOUR, FIRST_HOUR + max(HOURS_PER_DAY, view.clock.hour + 1 - FIRST_HOUR))
        found: dict[int, Counter[int]] = {hour: Counter() for hour in hours}
        any_hour = Moment(hours[0], weekday, (), True, False, possible, np.zeros(len(activities)))
        for number in range(DAYS):
            rng = rng_at(0, "ceiling", view.person, weekday, number)
            for hour, choice in zip(hours, live_day(life, any_hour, hours, repeat(rng)), strict=True):
                found[hour][choice.activity] += 1
        return found

    def _drawn(self, life: PrivateLife, index: int, view: RobotView) -> list[list[Use]]:
        """What this person uses in `HOURS` drawn hours of an activity, in the order in which it is done."""
        home = Surroundings(view.home.fixed), Surroundings(view.home.movable)
        activity = life.at_home(self.sense.household.activities[index], home[0])
        count, rng = Numbers.HUMAN_TASKS[view.collab], rng_at(0, "ceiling", view.person, activity.id)
        if view.collab == 1:
            items = feasible_places(activity, *home)
            uses = [Use(plain(activity.places[i][0]), plain(activity.places[i][1])) for i in items]
            weights = life.place_weights(activity)[items]
        else:
            uses, weights = [Use(plain(name)) for name in activity.thing_names], life.thing_weights(activity)
        if not uses:
            return []
        return [[uses[i] for i in sorted(weighted_order(weights, rng)[:count])] for _ in range(HOURS)]

    def _at_spot(self, life: PrivateLife, index: int, view: RobotView) -> float:
        """How gladly this person does an activity at the furniture where they are seen."""
        percept = view.observation.percept
        if percept is None or not percept.near:
            return 1.0
        activity = life.own(self.sense.household.activities[index])
        spots = dict(zip(activity.fixed, life.spot_weights(activity), strict=True))
        return max(STRANGE, float(spots.get(class_of(percept.near[0]), 0.0)))


def knower(
    people: Mapping[PersonId, str], personas: Mapping[PersonId, Persona], household: Household, embeddings: Embeddings
) -> Knower:
    """Make the robot that knows these people, by the household file that they live by."""
    return Knower(people, personas, CommonSense(household, embeddings))


CEILING = Method(name="ceiling", traits=False, learns=False, knows=knower)
