"""Which object of a home a name means, where it is written a little otherwise; and the names nearest to one."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from coopera.models.reading.words import is_nothing

_NUMBERED = re.compile(r"(?P<word>.*?)_?0*(?P<number>\d+)")
_IN_BRACKETS = re.compile(r"(?P<name>[^()]+)\((?:id:?\s*)?(?P<said>[^()]+)\)")
_ARTICLE = re.compile(r"(?:the|a|an|my)_")
_NEAR = 0.6


def mended(said: str, objects: Mapping[str, Sequence[object]]) -> str | None:
    """The one object that a name means, where only capitals, spaces, an article or a missing number differ.

    Args:
        said: A name as a model wrote it, such as "Sofa 1", "the sofa" or "sofa_1 (id 7)".
        objects: Id and room of each object, by name.

    Returns:
        Its name; None if no object is meant, or more than one could be. Another number is another object.
    """
    if said in objects:
        return said
    if bracket := _IN_BRACKETS.fullmatch(said.strip()):
        name = mended(bracket["name"].strip(), objects)
        known = [] if name is None else [_plain(str(one)) for one in objects[name]]
        return name if _plain(bracket["said"]) in known else None
    word, number = parts(said)
    alike = [(name, parts(name)[1]) for name in objects if parts(name)[0] == word]
    if number is not None and any(theirs == number for _, theirs in alike):
        alike = [(name, theirs) for name, theirs in alike if theirs == number]
    elif number is not None:
        alike = [(name, theirs) for name, theirs in alike if theirs is None]
    return alike[0][0] if len(alike) == 1 else None


def parts(name: str) -> tuple[str, int | None]:
    """A name's class and number: "Sofa 01" is ("sofa", 1), "the desk" is ("desk", None)."""
    plain = _ARTICLE.sub("", _plain(name), count=1) if _ARTICLE.match(_plain(name)) else _plain(name)
    found = _NUMBERED.fullmatch(plain)
    return (found["word"], int(found["number"][:9])) if found and found["word"] else (plain, None)


def nearest(said: object, names: Iterable[str], count: int = 3) -> list[str]:
    """The names most like one that is not there, best first: first those of its class, then those spelt alike."""
    known = sorted(names)
    if not isinstance(said, str):
        return []
    word, _ = parts(said)
    own = [name for name in known if parts(name)[0] == word]
    spelt = [(difflib.SequenceMatcher(None, _plain(said)[:120], _plain(name)).ratio(), name) for name in known]
    alike = [name for near, name in sorted(spelt, key=lambda one: (-one[0], one[1])) if near >= _NEAR]
    return list(dict.fromkeys([*own, *alike]))[:count]


def name_in(value: Any) -> Any:
    """What stands for an object's name: also inside an object with name and id, or alone in a list."""
    if isinstance(value, dict):
        return value.get("name", value.get("id"))
    return value[0] if isinstance(value, list) and len(value) == 1 else value


def id_in(value: Any) -> int | None:
    """The id that a value is, also as a text."""
    if isinstance(value, str) and value.strip().isdecimal() and len(value) < 10:
        return int(value)
    return value if isinstance(value, int) and not isinstance(value, bool) else None


def agrees(said: Any, name: str) -> bool:
    """Whether a name that is missing or unknown may be that of the object with the id: nothing said, or its class."""
    if said is None or (isinstance(said, str) and is_nothing(said)):
        return True
    return isinstance(said, str) and parts(said)[0] == parts(name)[0]


def _plain(name: str) -> str:
    return re.sub(r"[\s_\-]+", "_", name.strip(" \t\n\"'`*.")).casefold()[:200]
