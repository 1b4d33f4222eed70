"""What one sentence of a profile states: an age, the facts of facts.yaml, food that is kept from, activities."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from coopera.models.offline.human.facts_file import Effects, FactsFile, Kind, Rule, Spoken, what
from coopera.models.offline.human.stated import Clause, Standing, clauses, plain_sentence, unfigured

SPEAKS = 1.6  # logits for an activity of which a sentence speaks, as a liking two standard deviations above others has
HINTS = 0.6  # logits for an activity near to which a sentence speaks
WISHES = 0.4  # logits for what one wants to do
AGAINST: Mapping[Standing, float] = {"never": -2.5, "dislikes": -2.5, "seldom": -0.8}
"""Logits of what one does not do or like; where it is never done and nobody needs it, it is left out of the day."""
HINTS_AGAINST = -1.0

_WORDS = "three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen"
_TENS = ("twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")
_DECADES = ("teens", "twenties", "thirties", "forties", "fifties", "sixties", "seventies", "eighties", "nineties")
_UNITS = ["one", "two", "three", "four", "five", "six", "seven", "eight", "nine"]
NUMBERS: Mapping[str, int] = {
    **{word: 3 + i for i, word in enumerate([*_WORDS.split(), "nineteen"])},
    **{ten: 20 + 10 * i for i, ten in enumerate(_TENS)},
    **{f"{ten} {unit}": 21 + 10 * i + j for i, ten in enumerate(_TENS) for j, unit in enumerate(_UNITS)},
}
_NUMBER = rf"(?P<n>\d{{1,3}}|{'|'.join(sorted(NUMBERS, key=len, reverse=True))})"
_AGES = (
    re.compile(
        r"\bi (?:am|will (?:soon )?be|will (?:soon )?turn|have (?:just )?turned|(?:just |recently )?turned|"
        r"just became)"
        r"(?: (?:about to (?:be|turn)|turning|almost|nearly|over|past|only|just|currently|now|already|around|"
        r"about|still))*"
        rf"(?: an?)?(?: the (?:ripe )?(?:old )?age of)? {_NUMBER}(?P<unit> ?(?:years? (?:old|young|of age)|"
        rf"yrs? old|yo\b|y o\b))?"
        r"(?=\s*(?:$|,| and\b| or so\b|(?: \w+)? (?:male|female|man|woman|guy|girl|boy|lady|mom|dad|gentleman)\b|"
        r" now\b| today\b| this (?:year|month)\b| (?:next|last) \w+| in (?:a|two|three) \w+$)|(?P<rest> .*))"
    ),
    re.compile(
        rf"\bi (?:am|have)\b(?: (?!to\b|of\b|with\b|for\b)[\w']+,?){{0,4}}? {_NUMBER}(?P<unit> years? (?:old|"
        rf"young|of age))(?! \w*(?:dog|cat|car|house|son|daughter|kid|child|boy|girl friend))"
    ),
    re.compile(rf"\bmy age is {_NUMBER}(?P<unit>)"),
)
_DECADE = re.compile(
    rf"\bin my (?P<part>early|mid|middle|late)?(?: to (?:mid|late))? ?(?:(?P<word>{'|'.join(_DECADES)})|"
    rf"(?P<n>[1-9]0) ?'?s)\b"
)
_PART = {"early": 2, "late": 8}
_EATING = re.compile(
    r"\b(?:eat(?:ing)?|like|love|drink(?:ing)?|stand|touch|tolerate|digest|consume|have|allergic to|allerg(?:y|"
    r"ies) to|"
    r"intolerant (?:to|of)|hate|dislike|avoid|detest|despise|loathe|fan of|gave up|smell of|taste of|sensitive to)"
    r"(?:(?:,| or| and| to)? (?:the|any|raw|eat|all|taste|smell|of|cooked|green|red|dark|white|[\w']+,?(?= or|"
    r" and|,))){0,6}"
    r"(?:,| or| and)? ?$"
)
_ALLERGY = re.compile(r"^ (?:allerg(?:y|ies|ic)|intolerant|intolerance|disease|free(?: diet)?)\b")


class Found(NamedTuple):
    """One thing that a sentence states."""

    sentence: str
    kind: Kind
    says: str
    effects: Effects
    age: int | None = None
    gives: tuple[str, ...] = ()
    spoken: Mapping[str, float] = {}
    """Logits by activity id, against it below 0."""
    direct: Mapping[str, int] = {}
    """How many of the sentence's words are about doing an activity, by id."""


class Heard(NamedTuple):
    """A sentence as it was split: its clauses, and all of it in plain form without figures of speech."""

    sentence: str
    text: str
    clauses: Sequence[Clause]

    @classmethod
    def of(cls, sentence: str) -> Heard:
        """Split a sentence."""
        return cls(sentence, unfigured(plain_sentence(sentence)), clauses(sentence))


def read(sentence: str, file: FactsFile, needs: frozenset[str]) -> Iterator[Found]:
    """Tell what a sentence states; `needs` are the activities that nobody can do without."""
    heard = Heard.of(sentence)
    age = _age(heard)
    if age is not None:
        yield _of_age(heard, age, file)
    yield from _rules(heard, file)
    yield from _food(heard, file)
    yield from _activities(heard, file, needs)


def _rules(heard: Heard, file: FactsFile) -> Iterator[Found]:
    """Tell the facts of a sentence; of several jobs only the best known one: "a teacher", not just "employed"."""
    stated = [(rule, found) for rule in file.rules if (found := _stated(rule, heard, file)) is not None]
    jobs = [rule for rule, _ in stated if rule.employment == "employed"]
    job = max(jobs, key=lambda rule: rule.rank, default=None)
    for rule, found in stated:
        if rule is job or rule.employment != "employed":
            yield Found(heard.sentence, rule.kind, rule.says.replace("{what}", found), rule, gives=rule.gives)


def _stated(rule: Rule, heard: Heard, file: FactsFile) -> str | None:
    """Return what the group "what" of a rule caught, or "" without one; None where the fact is not stated."""
    search = file.search(rule.any)
    if heard.text not in search and not any(clause.text in search for clause in heard.clauses):
        return None
    if rule.unless and heard.text in file.search(rule.unless):
        return None
    if rule.reads == "sentence":
        return next((what(found) for found in search.all(heard.text)), None)
    counts = {"does", *rule.even}
    for clause in heard.clauses:
        for found in search.all(clause.text):
            if clause.standing(found.start(), found.end(), strict=rule.kind in ("body", "job", "diet")) in counts:
                return what(found)
    return None


def _age(heard: Heard) -> int | None:
    for clause in heard.clauses:
        if not clause.own or clause.past and "turned" not in clause.text:
            continue
        if found := _DECADE.search(clause.text):
            decade = 10 * (1 + _DECADES.index(found["word"])) if found["word"] else int(found["n"])
            return 16 if decade == 10 else decade + _PART.get(found["part"] or "", 5)
        for pattern in _AGES:
            for found in pattern.finditer(clause.text):
                years = NUMBERS.get(found["n"]) or (int(found["n"]) if found["n"].isdigit() else 0)
                if not found["unit"] and found.groupdict().get("rest"):
                    continue
                if 1 <= years <= 129 and not re.search(r"\b(?:not|never)\b", clause.text[: found.start("n")]):
                    return years
    return None


def _of_age(heard: Heard, age: int, file: FactsFile) -> Found:
    group = next((one for one in file.ages if one.first <= age <= one.last), None)
    says = f"is {age} years old" if re.search(rf"\b{age}\b", heard.text) else f"is about {age} years old"
    return Found(heard.sentence, "age", says, group or Effects(), age=age)


def _food(heard: Heard, file: FactsFile) -> Iterator[Found]:
    for clause in heard.clauses:
        for words, search in file.food_words.items():
            for found in search.finditer(clause.text):
                if _kept_from(clause, found):
                    yield Found(
                        heard.sentence, "diet", f"keeps from {found.group()}", Effects(never_things=file.foods[words])
                    )
                    break


def _kept_from(clause: Clause, found: re.Match[str]) -> bool:
    standing = clause.standing(found.start(), found.end(), strict=True)
    if standing in ("never", "dislikes") and _EATING.search(clause.text[: found.start()]):
        return True
    return standing == "does" and _ALLERGY.search(clause.text[found.end() :]) is not None


def _activities(heard: Heard, file: FactsFile, needs: frozenset[str]) -> Iterator[Found]:
    """Tell of which activities a sentence speaks, and against which."""
    likes: dict[str, float] = {}
    direct: dict[str, int] = {}
    gives: list[str] = []
    against: dict[str, float] = {}
    never: list[str] = []
    for activity, spoken in file.activities.items():
        stands = [*_stands(heard, spoken, file)]
        about = [standing for standing, hint in stands if not hint]
        near = [standing for standing, hint in stands if hint]
        if "does" in about:
            likes[activity] = SPEAKS
            direct[activity] = about.count("does")
            gives += [spoken.gives] if spoken.gives else []
        elif denied := [standing for standing in about if standing in AGAINST]:
            against[activity] = min(AGAINST[standing] for standing in denied)
            if "never" in denied and activity not in needs and not spoken.strict:
                never.append(activity)
        elif "does" in near:
            likes[activity] = HINTS
        elif not spoken.strict and any(standing in ("never", "dislikes") for standing in near):
            against[activity] = HINTS_AGAINST
        elif "wish" in about:
            likes[activity] = WISHES
    if likes:
        yield _spoken(heard, file, likes, gives=tuple(gives), direct=direct)
    if against:
        effects = Effects(never=tuple(never), gives_way=True)
        yield _spoken(heard, file, against, effects=effects)


def _spoken(
    heard: Heard,
    file: FactsFile,
    sizes: Mapping[str, float],
    effects: Effects | None = None,
    gives: tuple[str, ...] = (),
    direct: Mapping[str, int] | None = None,
) -> Found:
    strongest = max(abs(size) for size in sizes.values())
    named = ", ".join(file.activities[a].called for a, size in sizes.items() if abs(size) == strongest)
    kind: Kind = "aversion" if effects else "hobby"
    if effects:
        says = f"does not do or like: {named}" if strongest >= abs(AGAINST["never"]) else f"is not much for: {named}"
    else:
        says = f"speaks of {named}" if direct else f"hints at {named}"
    return Found(heard.sentence, kind, says, effects or Effects(), gives=gives, spoken=sizes, direct=direct or {})


def _stands(heard: Heard, spoken: Spoken, file: FactsFile) -> Iterator[tuple[Standing, bool]]:
    """Give the standing of each word about an activity, and whether it only hints at it."""
    mask = file.search(spoken.without)
    for clause in heard.clauses:
        text = mask.masked(clause.text)
        for patterns, hint in ((spoken.speaks, False), (spoken.hints, True)):
            for found in file.search(patterns).all(text) if patterns else ():
                yield clause.standing(found.start(), found.end()), hint
