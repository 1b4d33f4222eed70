"""What a profile states of a person, and what binds because of it: read by rules of text, each sentence by itself.

A fact keeps the sentence that states it. Nothing is guessed from what merely sounds alike; what is not stated leaves
the person free, except where facts.yaml asks for a statement (a pet to play with, an instrument to play).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TypeVar

from pydantic import field_serializer

from coopera.core.lazy import made_once
from coopera.core.naming import plain
from coopera.core.people import Frozen
from coopera.models.offline.household.knowledge import Household, key
from coopera.models.offline.household.statements import sentences
from coopera.models.offline.human.facts_file import (
    Effects,
    Employment,
    FactsFile,
    Kind,
    LifeStage,
    Workplace,
    WorkTime,
    shipped,
)
from coopera.models.offline.human.facts_found import Found, read
from coopera.models.offline.human.persona import shipped_aspects

MOST = 3.0  # no activity gains or loses more logits than this, however often it is spoken of
AGAIN = 0.4  # share at which each further sentence about the same activity counts

T = TypeVar("T")


class Fact(Frozen):
    """A stated fact. `sentence` is verbatim, empty for what is not stated; `effects` are said for a reader."""

    sentence: str
    own: bool
    """Whether these are the person's own words; a sentence of aspects.yaml is borrowed."""
    kind: Kind
    says: str
    effects: tuple[str, ...]


class Facts(Frozen):
    """All that a profile states, and what binds: what is never done, taken in hand or made, and what is done more."""

    listed: tuple[Fact, ...] = ()
    """What is stated, in the profile's order."""
    unstated: tuple[Fact, ...] = ()
    """What would have to be stated and is not, such as a pet."""
    age: int | None = None
    """In years; of "in my seventies" the middle, 75."""
    life_stage: LifeStage | None = None
    """Young below 30, older from 65 on, by the age stated, or by what else is stated of it."""
    employment: Employment | None = None
    workplace: Workplace | None = None
    work_time: WorkTime | None = None
    hours_shift: float = 0.0
    """By how many hours the person's day lies later than usual; earlier is negative."""
    never: frozenset[str] = frozenset()
    """Ids of activities."""
    never_things: frozenset[str] = frozenset()
    """Names of things and classes of movable objects, with spaces, not underscores."""
    never_motions: frozenset[str] = frozenset()
    pulls: dict[str, float] = {}
    """Logits by activity id, at most `MOST` either way; none of an activity that is never done."""
    because: dict[str, str] = {}
    """Activity id -> the person's own sentence that speaks most directly for it."""

    @field_serializer("never", "never_things", "never_motions")
    def _sorted(self, names: frozenset[str]) -> list[str]:
        return sorted(names)


def facts(profile: str, household: Household) -> Facts:
    """Read the facts that a profile states; ids, things and motions that the household does not have are left out.

    The person's own words are believed before borrowed ones, and a fact that `gives_way` before what they state to do.
    """
    file = shipped()
    needs = frozenset(activity.id for activity in household.activities if activity.need)
    found = [one for sentence in sentences(profile) for one in read(sentence, file, needs)]
    return _Weighing(file, household, found).result()


class _Weighing:
    """All that was found, and what binds of it."""

    def __init__(self, file: FactsFile, household: Household, found: Sequence[Found]) -> None:
        self._file, self._household, self._found = file, household, found
        self._own = {one.sentence: not borrowed(one.sentence) for one in found}
        self._states = {a for one in found if self._own[one.sentence] for a in one.direct}
        """The activities that the person says to do."""
        self._given = {name for one in found for name in one.gives}
        self._things = {plain(thing) for one in household.activities for thing in one.things}
        self._things |= {plain(movable) for movable, _ in household.usual_places}
        aged = [one for one in found if one.age is not None]
        self._age = self._first(aged, lambda one: one.age)
        self._life_stage = self._first(aged, lambda one: one.effects.life_stage) or self._first(
            found, lambda one: one.effects.life_stage
        )
        self._employment = self._first(found, lambda one: one.effects.employment)
        at_work = [one for one in found if one.effects.employment == self._employment]
        self._workplace = self._first(at_work, lambda one: one.effects.workplace)
        works = self._employment in ("employed", "student")
        self._work_time = self._first(found, lambda one: one.effects.work_time) if works else None
        self._hours_shift = self._first(found, lambda one: one.effects.hours_shift) or 0.0

    def result(self) -> Facts:
        """Put together what binds."""
        binding = [self._binding(one) for one in self._found]
        missing = self._missing()
        never = frozenset(name for one in (*binding, *missing.values()) for name in one.never)
        pulls = {activity: pull for activity, pull in self._pulls(binding).items() if activity not in never}
        listed = [self._fact(one, binds, never) for one, binds in zip(self._found, binding, strict=True)]
        return Facts(
            listed=tuple(dict.fromkeys(listed)),
            unstated=tuple(
                Fact(
                    sentence="",
                    own=False,
                    kind=self._kind(name),
                    says=self._file.requires.says[name],
                    effects=_said(one),
                )
                for name, one in missing.items()
                if _said(one)
            ),
            age=self._age,
            life_stage=self._life_stage,
            employment=self._employment,
            workplace=self._workplace,
            work_time=self._work_time,
            hours_shift=self._hours_shift,
            never=never,
            never_things=frozenset(name for one in (*binding, *missing.values()) for name in one.never_things),
            never_motions=frozenset(name for one in binding for name in one.never_motions),
            pulls=pulls,
            because={activity: text for activity, text in self._because().items() if activity not in never},
        )

    def _first(self, found: Iterable[Found], of: Callable[[Found], T | None]) -> T | None:
        """Return what the most trusted fact says: own before borrowed, then by rank, then in the profile's order."""
        known = [(one, of(one)) for one in found if of(one) is not None]
        ranked = sorted(known, key=lambda pair: (not self._own[pair[0].sentence], -pair[0].effects.rank))
        return ranked[0][1] if ranked else None

    def _binding(self, one: Found) -> Effects:
        """Return what follows from a fact in this household, less what the person states to do in spite of it."""
        effects, household = one.effects, self._household
        if effects.employment not in (None, self._employment):
            return Effects()
        free: set[str] = set()
        if effects.gives_way:
            free = self._states & {*effects.never, *effects.less}
        spared = [household.activities[household.index[a]] for a in free if a in household.index]
        motions = {motion for activity in spared for motion in activity.all_motions}
        things = {plain(thing) for activity in spared for thing in activity.things}

        def known(names: Iterable[str]) -> tuple[str, ...]:
            return tuple(name for name in names if name in household.index and name not in free)

        more = {**effects.more, **{a: size for a, size in one.spoken.items() if size > 0}}
        less = {**effects.less, **{a: -size for a, size in one.spoken.items() if size < 0}}
        return effects.model_copy(
            update={
                "never": known(effects.never),
                "never_things": tuple(t for t in effects.never_things if t in self._things and t not in things),
                "never_motions": tuple(
                    m for m in effects.never_motions if m in household.looks_like and m not in motions
                ),
                "more": {a: more[a] for a in more if a in household.index},
                "less": {a: less[a] for a in known(less)},
                "speaks_for": tuple(a for a in effects.speaks_for if a in household.index),
            }
        )

    def _missing(self) -> dict[str, Effects]:
        """What nobody does who does not state the fact that it takes, by the fact's name."""
        requires, missing = self._file.requires, {}
        for name in requires.says:
            if name not in self._given:
                never = tuple(
                    a for a, fact in requires.activities.items() if fact == name and a in self._household.index
                )
                things = tuple(t for t, fact in requires.things.items() if fact == name and t in self._things)
                missing[name] = Effects(never=never, never_things=things)
        return missing

    def _kind(self, name: str) -> Kind:
        return "hobby" if name in {spoken.gives for spoken in self._file.activities.values()} else "pets"

    def _pulls(self, binding: Sequence[Effects]) -> dict[str, float]:
        """Add up the logits: of several sentences the strongest counts in full, the others `AGAIN`, at most `MOST`."""
        sizes: defaultdict[str, dict[bool, dict[str, float]]] = defaultdict(lambda: {True: {}, False: {}})
        for one, effects in zip(self._found, binding, strict=True):
            for positive, logits in ((True, effects.more), (False, effects.less)):
                for activity, size in logits.items():
                    by_sentence = sizes[activity][positive]
                    by_sentence[one.sentence] = max(size, by_sentence.get(one.sentence, 0.0))
        total = {a: _sum(both[True].values()) - _sum(both[False].values()) for a, both in sizes.items()}
        return {a: round(max(-MOST, min(MOST, total[a])), 3) for a in sorted(total) if abs(total[a]) >= 0.001}

    def _because(self) -> dict[str, str]:
        """Return for each activity the own sentence with most words about doing it; the first of equals."""
        hits: defaultdict[str, defaultdict[str, int]] = defaultdict(lambda: defaultdict(int))
        for one in self._found:
            if self._own[one.sentence]:
                for activity, count in one.direct.items():
                    hits[activity][one.sentence] += 2 * count
                if one.effects.employment in (None, self._employment):
                    for activity in one.effects.speaks_for:
                        hits[activity][one.sentence] += 1
        known = {a: by_sentence for a, by_sentence in hits.items() if a in self._household.index}
        return {a: max(known[a], key=lambda sentence: known[a][sentence]) for a in sorted(known)}

    def _fact(self, one: Found, binds: Effects, never: frozenset[str]) -> Fact:
        """Say a fact and what follows from it for a reader."""
        said = list(_said(binds, never))
        for name, value, final in (
            ("employment", binds.employment, self._employment),
            ("workplace", binds.workplace, self._workplace),
            ("work time", binds.work_time, self._work_time),
            ("life stage", binds.life_stage, self._life_stage),
        ):
            said += [f"{name}: {value}"] if value is not None and value == final else []
        if binds.hours_shift and binds.hours_shift == self._hours_shift:
            said.append(f"the day lies {abs(binds.hours_shift):g} h {'later' if binds.hours_shift > 0 else 'earlier'}")
        asked = [a for a, name in self._file.requires.activities.items() if name in one.gives and a not in never]
        said += [f"allows: {', '.join(asked)}"] if asked else []
        said += [binds.keeps] if binds.keeps else []
        return Fact(
            sentence=one.sentence, own=self._own[one.sentence], kind=one.kind, says=one.says, effects=tuple(said)
        )


def _sum(sizes: Iterable[float]) -> float:
    ranked = sorted(sizes, reverse=True)
    return sum(size * (1.0 if i == 0 else AGAIN) for i, size in enumerate(ranked))


def _said(effects: Effects, never: frozenset[str] = frozenset()) -> tuple[str, ...]:
    return tuple(_lines(effects, never))


def _lines(effects: Effects, never: frozenset[str]) -> Iterator[str]:
    for what, names in (
        ("never", effects.never),
        ("never in hand", effects.never_things),
        ("never the motions", effects.never_motions),
        ("more", [a for a in effects.more if a not in never]),
        ("less", [a for a in effects.less if a not in never]),
        ("no more for it, as it is never done", [a for a in effects.more if a in never]),
    ):
        if names:
            yield f"{what}: {', '.join(names)}"


@made_once()
def _borrowed() -> frozenset[str]:
    return frozenset(key(one.says) for aspect in shipped_aspects() for one in aspect.statements)


def borrowed(sentence: str) -> bool:
    """Whether a sentence stands in aspects.yaml: the import added it, and the person never said it."""
    return key(sentence) in _borrowed()
