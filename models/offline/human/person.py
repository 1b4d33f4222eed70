"""What is private to a person: likings, own hours, favourite things. Only the person's side may import this.

The profile text and the Big Five determine all of it; under another id and name somebody is the same. The text and the
traits say which activities attract the person. The text seeds the rest, too: a liking without reason, the habitual
hour, the favourite mug.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from copy import copy
from functools import cached_property, partial

import numpy as np

from coopera.core.affordances import affordances
from coopera.core.people import BigFive
from coopera.core.randomness import rng_at
from coopera.models.offline.household.knowledge import Activity, Floats, Household, key
from coopera.models.offline.household.reading import Surroundings
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.household.statements import Statements, statements
from coopera.models.offline.human.belongings import Belongings
from coopera.models.offline.human.facts import Facts, facts
from coopera.models.offline.human.own_time import OwnTime
from coopera.models.offline.human.rhythm import Rhythm, shipped_rhythm
from coopera.models.offline.human.style import Style

TEXT_PULL = 0.95  # logits per standard deviation of affinity over the activities
TRAIT_PULL = 1.1  # logits per point of (trait - 3) x loading 1
LIKING = 0.7  # standard deviation of the likings that no text explains, in logits
AVERSION = 0.5  # share of an aversion's closeness that is taken off the affinity
NEED = 0.3  # share of all these for what everybody needs, such as meals
SPOT_FAVOUR = 0.7  # scale of the favourites among spots, which custom decides more than taste
FAVOUR = 1.3  # scale of the Gumbel draws behind favourites: at 1.3 some five of ten things carry most of the weight
ENOUGH = 5  # things that must be left of an activity, so that its hour can be filled


def private_rng(profile: str, *what: object) -> np.random.Generator:
    """What is drawn of somebody once and for all; the profile's text alone decides."""
    return rng_at(0, "private life", key(profile), *what)


class PrivateLife:
    """One person's private parameters. Arrays are in the household file's order of activities."""

    def __init__(self, sense: CommonSense, profile: str, big_five: BigFive, rhythm: Rhythm | None = None) -> None:
        self._sense = sense
        self.household: Household = sense.household
        self._rng = partial(private_rng, profile)
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
        self._own = {activity.id: self.facts.kept(activity, sense.household) for activity in sense.household.activities}
        self.can_do = np.array([self._can_do(activity) for activity in sense.household.activities])
        """What the facts that the person states allow; shape (activities,)."""
        self.time = OwnTime(sense.household, big_five, self.facts, self._rng, rhythm or shipped_rhythm())
        """When this person does what."""

    def own(self, activity: Activity) -> Activity:
        """An activity as this person does it: without the things, places and motions that facts rule out."""
        return self._own[activity.id]

    def at_home(self, activity: Activity, fixed: Surroundings) -> Activity:
        """An activity as this person does it among this furniture: with each thing put where they want it to be."""
        return self._belongings.at_home(self.own(activity), fixed)

    @cached_property
    def _belongings(self) -> Belongings:
        return Belongings(self._rng, self.household)

    def keeping(self, rhythm: Rhythm) -> PrivateLife:
        """The same person in a population of another rhythm."""
        life = copy(self)
        life.time = OwnTime(self.household, self.big_five, self.facts, self._rng, rhythm)
        return life

    def wish(self, weekday: int, hour: int) -> Floats:
        """Logits of each activity for this person in a free hour; shape (activities,)."""
        return self.time.usual(weekday, hour) + self.pull

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

    def own_words(self, activity: Activity) -> str | None:
        """Return that sentence as the reason that the person gives for it."""
        sentence = self.evidence(activity)
        return f'I say of myself: "{sentence.rstrip(" .,;")}".' if sentence else None

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

    def _can_do(self, activity: Activity) -> bool:
        """Whether an activity is possible: not ruled out, and with enough left of it, unless it is a need."""
        own = self._own[activity.id]
        enough = len(own.things) >= min(ENOUGH, len(activity.things)) and own.places
        return activity.id not in self.facts.never and (activity.need or bool(enough))

    def _favour(self, what: str, count: int, scale: float = FAVOUR) -> Floats:
        weights = np.exp(scale * self._rng(what).gumbel(size=count))
        return np.asarray(weights / weights.sum(), dtype=np.float64)
