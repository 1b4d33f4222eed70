"""What of a home is offered for an intention: what the person said they want, then what is nearest to the intention."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from itertools import chain, islice, zip_longest
from typing import Literal

from coopera.core.household import ObjectMap, plain
from coopera.core.naming import ends_with
from coopera.graphs.players.player import HumanContext

LEAST = 0.55
"""The least cosine at which words that name nothing in the home stand for what is nearest to them ("couch": sofa)."""
_SINGULARS = (
    (re.compile(r"(?<=\w)(?:ves?|fe)\b"), "f"),
    (re.compile(r"(?<=\w)(?:ies?|(?<=[^\Waeiou])y)\b"), "i"),
    (re.compile(r"(?:(?<=\w[sxzo])|(?<=[cs]h))es?\b"), ""),
    (re.compile(r"(?<=\w\w)s\b"), ""),
)


class Shelves:
    """All kinds of objects of a home, to be searched by what is wanted.

    DEVIATES: the authors' code searches by the intention's sentence alone, which for "Brainstorm ideas for my job"
    finds a wardrobe sooner than a desk; here the person says what they want, and the sentence fills up what is left.
    """

    def __init__(self, ctx: HumanContext) -> None:
        """Look at the home as it is now."""
        self._most = ctx.sizes.objects
        self._objects = {"fixed": ctx.home.objects("fixed"), "movable": ctx.home.objects("movable")}
        self._names: dict[str, list[str]] = {}
        for name in chain(*self._objects.values()):
            self._names.setdefault(plain(name), []).append(name)
        self._search = ctx.search(list(self._names))

    def offer(self, which: Literal["fixed", "movable"], wants: Sequence[str], text: str) -> ObjectMap:
        """At most as many objects as the person is offered: those that are wanted, then those nearest to a text.

        Of each want and then of the text the first object comes first, then of each the second, so that a bound leaves
        something of every want. The text counts as a want, too: it may name what it is about.
        """
        objects = self._objects[which]
        said = filter(str.strip, (*wants, text))
        meant = [[name for kind in self._meant(want) for name in self._names[kind]] for want in said]
        wanted = (name for turn in zip_longest(*meant) for name in turn if name)
        nearest = (name for kind, _ in self._search.top(text, len(self._search)) for name in self._names[kind])
        names = dict.fromkeys(name for name in chain(wanted, nearest) if name in objects)
        return {name: objects[name] for name in islice(names, self._most)}

    def _meant(self, want: str) -> list[str]:
        """The kinds that a want names, or those with its last word ("chair": "office chair"), or else the nearest one.

        It is sought among furniture and things at once: a notebook is not the furniture nearest to it.
        """
        said = _stem(want)
        named = [kind for kind in self._names if f" {_stem(kind)} " in f" {said} "]
        last = said.rpartition(" ")[2]
        if last and not any(ends_with(_stem(kind), last) for kind in named):
            named += [kind for kind in self._names if ends_with(_stem(kind), last)]
        return named or [kind for kind, cosine in self._search.top(want, 1) if cosine >= LEAST]


@lru_cache(maxsize=4096)
def _stem(words: str) -> str:
    """Words in lower case that end alike for one and for many, such as "box" and "boxes", "knife" and "knives".

    It is for comparing alone. Where a plural does not tell what its singular ends in, all that it may be end alike
    ("stove" and "shelf").
    """
    stems = " ".join(re.findall(r"\w+", words.lower()))
    for ending, one in _SINGULARS:
        stems = ending.sub(one, stems)
    return stems
