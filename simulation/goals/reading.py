"""Read a goal from text: "on(mug, dining table) and not clean(plate)", "then(at(human, kitchen), inside(egg, fridge))".

`not` binds more than `and`, and `and` more than `or`; brackets group. A word may stand in double quotes, and must
where it has a comma or a bracket in it.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TypeVar

from coopera.core.errors import ConfigError
from coopera.simulation.goals.tree import PREDICATES, And, Atom, Eventually, Goal, Not, Or, Then, near

Part = TypeVar("Part")
LONGEST = 2000
"""Characters of a goal."""
DEEPEST = 20
"""Brackets, operators and `not`s within one another."""
_NAME = re.compile(r"[^\W\d]\w*")
_WORD = re.compile(r'\s*(?:"(?P<quoted>(?:[^"]|"")+)"|(?P<plain>[^,()"]*[^,()"\s]))\s*(?=[,)])')
_OPERATORS = ("then", "eventually", "not")


def read_goal(text: str) -> Goal:
    """Read a goal.

    Raises:
        ConfigError: If it cannot be read; the sentence says where, and what was expected.
    """
    if len(text) > LONGEST:
        raise ConfigError(f"The goal {text[:40]!r}… has {len(text)} characters; {LONGEST} is the most.")
    return _Reader(text).whole()


class _Reader:
    """Goes through a text once, from left to right; one method for each rule of the notation."""

    def __init__(self, text: str) -> None:
        self._text, self._at, self._depth = text, 0, 0

    def whole(self) -> Goal:
        goal = self._goal()
        if self._rest():
            raise self._wrong("'and', 'or' or its end")
        return goal

    def _goal(self) -> Goal:
        parts = self._joined("or", lambda: _one_or(And, self._joined("and", self._one)))
        return _one_or(Or, parts)

    def _joined(self, word: str, part: Callable[[], Goal]) -> list[Goal]:
        found = [part()]
        while self._takes_word(word):
            found.append(part())
        return found

    def _one(self) -> Goal:
        self._depth += 1
        if self._depth > DEEPEST:
            raise ConfigError(f"The goal {self._text[:40]!r}… is nested more than {DEEPEST} deep.")
        if self._takes_word("not"):
            goal: Goal = Not(self._one())
        elif self._takes("("):
            goal = self._goal()
            self._needs(")")
        else:
            goal = self._called()
        self._depth -= 1
        return goal

    def _called(self) -> Goal:
        """A predicate with its words, or an operator with its goals."""
        found = _NAME.match(self._rest())
        if found is None:
            raise self._wrong("a predicate such as on(mug, sofa), 'not' or '('")
        name = found[0]
        if name not in PREDICATES and name not in _OPERATORS:
            known = ", ".join((*PREDICATES, *_OPERATORS))
            raise self._wrong(f"a predicate{near(name, (*PREDICATES, *_OPERATORS))}", f"known are {known}")
        self._at += len(found[0])
        self._needs("(")
        goal: Goal
        if name == "then":
            goal = Then(tuple(self._listed(self._goal)))
        elif name == "eventually":
            goal = Eventually(self._goal())
        else:
            every = self._takes_word("every")
            goal = Atom(name, tuple(self._listed(self._word)), every)
        self._needs(")")
        return goal

    def _listed(self, part: Callable[[], Part]) -> list[Part]:
        found = [part()]
        while self._takes(","):
            found.append(part())
        return found

    def _word(self) -> str:
        self._rest()
        found = _WORD.match(self._text, self._at)
        if found is None:
            raise self._wrong("a word, and after it ',' or ')'")
        self._at = found.end()
        return found["plain"] or found["quoted"].replace('""', '"')

    def _rest(self) -> str:
        """What is still to be read, after spaces."""
        while self._at < len(self._text) and self._text[self._at].isspace():
            self._at += 1
        return self._text[self._at :]

    def _takes(self, sign: str) -> bool:
        taken = self._rest().startswith(sign)
        self._at += len(sign) if taken else 0
        return taken

    def _takes_word(self, word: str) -> bool:
        found = _NAME.match(self._rest())
        taken = found is not None and found[0] == word
        self._at += len(word) if taken else 0
        return taken

    def _needs(self, sign: str) -> None:
        if not self._takes(sign):
            raise self._wrong(repr(sign))

    def _wrong(self, expected: str, more: str = "") -> ConfigError:
        rest = self._rest()
        found = _NAME.match(rest)
        here = f"not {found[0] if found else rest[:1]!r}" if rest else "and there it ends"
        place = f"at character {self._at + 1} {expected} was expected, {here}"
        return ConfigError(f"The goal {self._text!r}: {place}{f'; {more}' if more else ''}.")


def _one_or(kind: type[And] | type[Or], goals: list[Goal]) -> Goal:
    return goals[0] if len(goals) == 1 else kind(tuple(goals))
