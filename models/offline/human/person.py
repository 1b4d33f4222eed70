"""What is private to a person: likings, own hours, favourite things. Only the person's side may import this.

The profile text and the Big Five determine all of it; under another id and name somebody is the same. The text and the
traits say which activities attract the person. The text seeds the rest, too: a liking without reason, the habitual
hour, the favourite mug.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from coopera.core.affordances import affordances
from coopera.core.people import BigFive
from coopera.core.randomness import rng_at
from coopera.models.offline.household.knowledge import FIRST, LAST, Activity, Floats, Household, key
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.household.statements import Statements, statements
from coopera.models.offline.human.facts import Facts, facts
from coopera.models.offline.human.rhythm import Rhythm, Schedule, due_by_hour, of_day_type, shipped_rhythm
from coopera.models.offline.human.style import Style

TEXT_PULL = 0.95  # logits per standard deviation of affinity over the activities
TRAIT_PULL = 1.1  # logits per point of (trait - 3) x loading 1
LIKING = 0.7  # standard deviation of the likings that no text explains, in logits
AVERSION = 0.5  # share of an aversion's closeness that is taken off the affinity
NEED = 0.3  # share of all these for what everybody needs, such as meals
HABIT = 1.6  # logits that the habitual hour of an activity gains
SPOT_FAVOUR = 0.7  # scale of the favourites among spots, which custom decides more than taste
FAVOUR = 1.3  # scale of the Gumbel draws behind favourites: at 1.3 some five of ten things carry most of the weight
ENOUGH = 5  # things that must be left of an activity, so that its hour can be filled
OF_AGE = 18  # years up to which somebody of whom nothing else is stated goes to school
OCCUPATIONS: Mapping[tuple[str, str, bool], str] = {
    ("employed", "home", False): "desk_work",
    ("employed", "home", True): "desk_work",
    ("employed", "outside", True): "work_out_of_home",
    ("student", "outside", True): "school",
    ("student", "home", False): "study",
    ("student", "home", True): "study",
}
"""What the hours of work are for, by employment, workplace and whether people may be away; else they are free."""
AGREES: Mapping[str, Callable[[Schedule], bool]] = {
    "mornings": lambda one: one.end <= 16,
    "evenings": lambda one: one.end >= 20,
    "nights": lambda one: one.end >= 22,
    "weekdays": lambda one: max(one.days) < 5,
    "weekends": lambda one: max(one.days) >= 5,
}
"""Which hours of work agree with what people state. DEVIATES: nights are the late shift; no day here begins so late."""
_SET_HOURS = ("sleep_in", "desk_work", "work_out_of_home", "school")


class PrivateLife:
    """One person's private parameters. Arrays are in the household file's order of activities."""

    def __init__(self, sense: CommonSense, profile: str, big_five: BigFive, rhythm: Rhythm | None = None) -> None:
        self._sense = sense
        self._rhythm = rhythm or shipped_rhythm()
        self.household: Household = sense.household
        self._who = key(profile)
        self.big_five = big_five
        self.said: Statements = statements(profile)
        self.facts: Facts = facts(profile, sense.household)
        """What the profile states, and what binds because of it."""
        self._fit = self._closeness(self.said.habits)
        self.affinity = self._affinity()
        """How much the profile's text speaks for each activity: mean 0, standard deviation 1."""
        self.liking: Floats = self._rng("liking").normal(0.0, LIKING, len(sense.household.activities))
        wanted = TEXT_PULL * self.affinity + TRAIT_PULL * sense.household.trait_pull(big_five) + self.liking
        wanted = wanted + [self.facts.pulls.get(activity.id, 0.0) for activity in sense.household.activities]
        self.pull = np.where([activity.need for activity in sense.household.activities], NEED * wanted, wanted)
        """Logits by which this person prefers each activity, whatever the hour."""
        self.own_hours = self._own_hours()
        """Log weights of each activity by hour of the day, as this person lives; shape (activities, 24)."""
        self._usual = self._rhythm.hours_of(sense.household) + (self.own_hours - sense.household.log_hours)
        self.schedule: Schedule | None = self._drawn_schedule()
        """The hours of work or school, for those who have such."""
        self.daily: tuple[int, ...] = self._own_needs()
        """Places of what belongs to each day: meals, and this person's way to wash."""
        self._due = {index: self._due_by_hour(index) for index in self.daily}
        self._own = {activity.id: self.facts.kept(activity, sense.household) for activity in sense.household.activities}
        self.can_do = np.array([self._can_do(activity) for activity in sense.household.activities])
        """What the facts that the person states allow; shape (activities,)."""
        self.set_hours = self._has_set_hours()
        """What is done at its own hours, and not because somebody feels like it; shape (activities,)."""
        self._late = self._lateness()

    def own(self, activity: Activity) -> Activity:
        """An activity as this person does it: without the things, places and motions that facts rule out."""
        return self._own[activity.id]

    def wish(self, weekday: int, hour: int) -> Floats:
        """Logits of each activity for this person in a free hour; shape (activities,)."""
        return np.asarray(self._usual[of_day_type(weekday), :, hour] + self.pull, dtype=np.float64)

    def due(self, index: int, hour: int) -> float:
        """Chance that a need is met in an hour if it was not before."""
        return float(self._due[index][hour])

    def serves(self, index: int) -> tuple[int, ...]:
        """Places of what meets the same need."""
        same = {self.household.activities[index].id, *self.household.activities[index].instead}
        return tuple(
            i for i, one in enumerate(self.household.activities) if one.id in same or same & {one.id, *one.instead}
        )

    def occupation(self, *, absence: bool) -> int | None:
        """Place of what fills the hours of work: at home, or away where people may be."""
        if self.schedule is None:
            return None
        return self.household.index.get(OCCUPATIONS.get((self._employment, self._workplace, absence), ""))

    def asleep(self, weekday: int, hour: int, *, already: bool) -> float:
        """Chance to be asleep in an hour of the morning, given that one was until then."""
        share = self._rhythm.morning_sleep[of_day_type(weekday)]
        share = np.maximum(share - share[FIRST + 4], 0.0)  # who sleeps at 13 o'clock has not slept late, but naps
        if not already:
            return float(np.clip(share[hour] * self._late, 0.0, 0.97)) if hour == FIRST else 0.0
        return float(np.clip(share[hour] / max(share[hour - 1], 1e-9) * self._late**0.5, 0.0, 0.97))

    def wording(self, activity: Activity, rng: np.random.Generator) -> str:
        """Word an intention as this person does, in one of the many ways that the household file has for it."""
        return self._style.word(activity, rng)

    @cached_property
    def _style(self) -> Style:
        return Style(partial(self._rng, "style"), self.big_five)

    def thing_weights(self, activity: Activity) -> Floats:
        """How gladly each thing is taken in hand for an activity; sums to 1."""
        return self._favour(f"thing|{activity.id}", len(activity.things))

    def place_weights(self, activity: Activity) -> Floats:
        """How usual each pick-and-place of an activity is for this person; sums to 1."""
        return self._favour(f"place|{activity.id}", len(activity.places))

    def spot_weights(self, activity: Activity) -> Floats:
        """How gladly the activity is done at each class of its `fixed`, common sense included; sums to 1."""
        usual = 0.7 ** np.arange(len(activity.fixed))
        weights = usual * self._favour(f"spot|{activity.id}", len(activity.fixed), scale=SPOT_FAVOUR)
        return np.asarray(weights / weights.sum(), dtype=np.float64)

    def motion(self, activity: Activity, thing: str, spots: Collection[str], rng: np.random.Generator) -> str:
        """Choose the motion for a thing: the common one, or another of the activity's that looks like it.

        Only motions for this thing at these classes of furniture are in question; without any, the common one is taken.
        Each person has a habitual motion, and now and then makes another.
        """
        common, looks = activity.things[thing], self.household.looks_like
        made = self.household.uses[thing]
        alike = [m for m in activity.all_motions if looks[m] == looks[common] and m in made] or [common]
        alike = [m for m in alike if any(affordances().suits(m, spot) for spot in spots)] or alike
        own = self._rng("motion", activity.id, thing)
        habit = common if own.random() < 0.7 and common in alike else alike[int(own.integers(len(alike)))]
        return habit if rng.random() < 0.9 else alike[int(rng.integers(len(alike)))]

    def favourite(self, names: Sequence[str], what: str) -> str:
        """Choose among equals, such as two mugs, always the same."""
        ranked = sorted(names, key=lambda name: (float(self._rng("favourite", what, name).random()), name))
        return ranked[0]

    def evidence(self, activity: Activity) -> str | None:
        """Return the person's own sentence that speaks for an activity, if one does; a borrowed one is none."""
        return self.facts.because.get(activity.id)

    def strongest_trait(self, activity: Activity) -> tuple[str, float] | None:
        """Return the trait that speaks most for an activity, with this person's score, if one does."""
        pulls = {t: load * (getattr(self.big_five, t) - 3.0) for t, load in activity.big_five.items()}
        best = max(pulls, key=lambda trait: (pulls[trait], trait), default=None)
        return (best, getattr(self.big_five, best)) if best is not None and pulls[best] >= 0.1 else None

    def _affinity(self) -> Floats:
        """Closeness of the nearest own sentence, less what aversions speak against it; centred and scaled."""
        raw = np.zeros(len(self._sense.household.activities))
        if self.said.habits:
            raw = raw + self._fit.max(axis=0)
        if self.said.aversions:
            raw = raw - AVERSION * np.maximum(self._closeness(self.said.aversions).max(axis=0), 0.0)
        return np.asarray((raw - raw.mean()) / max(float(raw.std()), 1e-6), dtype=np.float64)

    def _closeness(self, said: Sequence[str]) -> Floats:
        """Cosine of each sentence to each activity, beyond how near either is to anything at all.

        Without that, "I like to go skiing" would be near to all that anybody says to like.
        """
        if not said:
            return np.zeros((0, len(self._sense.household.activities)))
        fit = self._sense.fit(said)
        generic = self._sense.generic_fit
        return np.asarray(fit - fit.mean(axis=1, keepdims=True) - (generic - generic.mean()), dtype=np.float64)

    def _own_hours(self) -> Floats:
        """Common hours, moved to an earlier or later type, sharpened by orderliness, with a habitual hour each.

        Conscientious people are earlier types (Tsaousis 2010, a meta-analysis) and keep to a schedule.
        """
        household, order = self._sense.household, self.big_five.conscientiousness - 3.0
        rng = self._rng("hours")
        shift = float(rng.normal(-0.35 * order, 0.6)) + self.facts.hours_shift
        hours = np.arange(24, dtype=np.float64)
        curves = np.stack([np.interp(hours - shift, hours, row) for row in household.log_hours])
        usual = np.exp(curves[:, FIRST : LAST + 1])
        usual /= usual.sum(axis=1, keepdims=True)
        habitual = np.array([FIRST + rng.choice(LAST - FIRST + 1, p=row) for row in usual])
        width = float(np.clip(1.1 - 0.2 * order + rng.normal(0.0, 0.15), 0.6, 1.8))
        bump = np.exp(-0.5 * ((hours[None, :] - habitual[:, None]) / width) ** 2)
        return np.asarray(curves + (HABIT + 0.25 * order) * bump, dtype=np.float64)

    def _can_do(self, activity: Activity) -> bool:
        """Whether an activity is possible: not ruled out, and with enough left of it, unless it is a need."""
        own = self._own[activity.id]
        enough = len(own.things) >= min(ENOUGH, len(activity.things)) and own.places
        return activity.id not in self.facts.never and (activity.need or bool(enough))

    @property
    def _employment(self) -> str:
        """What is stated; else by age, and of most people that they are employed."""
        if self.facts.employment:
            return self.facts.employment
        if self.facts.age is not None and self.facts.age < OF_AGE:
            return "student"
        return "retired" if self.facts.life_stage == "older" else "employed"

    @property
    def _workplace(self) -> str:
        """What is stated; else students learn outside, and the others work at home, where the study is."""
        return self.facts.workplace or ("outside" if self._employment == "student" else "home")

    def _drawn_schedule(self) -> Schedule | None:
        """Draw the hours of work or lessons from those of the population that agree with what is stated."""
        if self._employment not in ("employed", "student"):
            return None
        schedules, drawn = self._rhythm.schedules, float(self._rng("schedule").random())
        if stated := self.facts.work_time:
            schedules = tuple(one for one in schedules if AGREES[stated](one))
            drawn *= sum(one.share for one in schedules)
        place = int(np.searchsorted(np.cumsum([one.share for one in schedules]), drawn))
        return schedules[place] if place < len(schedules) else None

    def _own_needs(self) -> tuple[int, ...]:
        """What this person does daily; where something else serves as well, one of them is their habit."""
        own = []
        for activity in self.household.activities:
            if activity.daily:
                ways = [activity.id, *activity.instead]
                own.append(self.household.index[ways[int(self._rng("way", activity.id).integers(len(ways)))]])
        return tuple(own)

    def _due_by_hour(self, index: int) -> Floats:
        daily = max(self.household.activities[i].daily for i in self.serves(index))
        return due_by_hour(np.exp(self.own_hours[index]) - 0.005, daily)

    def _has_set_hours(self) -> NDArray[np.bool_]:
        own = [self.household.index[name] for name in _SET_HOURS if name in self.household.index]
        mask = np.zeros(len(self.household.activities), dtype=bool)
        mask[[*own, *self.daily]] = True
        return mask

    def _lateness(self) -> float:
        """How much likelier than others this person sleeps late; conscientious people rise earlier (Tsaousis 2010)."""
        z = float(self._rng("lateness").normal()) - 0.5 * (self.big_five.conscientiousness - 3.0)
        z += self.facts.hours_shift
        return float(np.exp(0.7 * z - 0.25))

    def _favour(self, what: str, count: int, scale: float = FAVOUR) -> Floats:
        weights = np.exp(scale * self._rng(what).gumbel(size=count))
        return np.asarray(weights / weights.sum(), dtype=np.float64)

    def _rng(self, *what: str) -> np.random.Generator:
        return rng_at(0, "private life", self._who, *what)
