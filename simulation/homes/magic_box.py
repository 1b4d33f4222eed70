"""What a thing from the magic box looks like: any text names a thing, and known words lead to known shapes.

The catalogue's classes come first, then what is in looks.yaml, then words that come near to those in meaning, which
looks_alike.yaml lists. What none of them knows is a box with its first letter on it.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import NamedTuple, TypeAlias

import yaml
from pydantic import TypeAdapter, ValidationError

from coopera.core.errors import ConfigError
from coopera.core.lazy import made_once
from coopera.core.randomness import seed_at
from coopera.simulation.homes.catalogue import SHAPES, Hex, Metres, catalogue
from coopera.simulation.homes.scene import rgb_of

Point3: TypeAlias = tuple[float, float, float]
Look: TypeAlias = str | tuple[str, tuple[Metres, Metres, Metres], Hex]
"""A class of the catalogue, or a recipe, its size and its colour."""
FILE, ALIKE = (Path(__file__).parent / name for name in ("looks.yaml", "looks_alike.yaml"))
_SIZE: Point3 = (0.12, 0.10, 0.12)
_COLOURS = ("#c8503c", "#3c78b4", "#d2a03c", "#5a9650", "#8c5aa0")
_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast where PyYAML has its C part


class Shape(NamedTuple):
    """What a thing looks like: the class or recipe by which it is drawn (or its own text), size and colour.

    `kind` is what it counts as: a class of the catalogue, or its own words.
    """

    cls: str
    size: Point3
    rgb: Point3
    kind: str


@made_once()
def looks() -> dict[str, Look]:
    """What things look like that the catalogue does not know, by words."""
    return read_looks(FILE)


@made_once()
def alike() -> dict[str, str]:
    """Words, and the known words that come nearest to them in meaning; see benchmarks/looks_alike.py."""
    found: dict[str, str] = yaml.load(ALIKE.read_text(encoding="utf-8"), _Loader) or {}
    return found


def read_looks(path: Path) -> dict[str, Look]:
    """Read a file like looks.yaml.

    Raises:
        ConfigError: If it cannot be used; names the file, the words and what was expected.
    """
    try:
        found = TypeAdapter(dict[str, Look]).validate_python(yaml.load(path.read_text(encoding="utf-8"), _Loader))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as err:
        raise ConfigError(f"The file {path} cannot be read: {err}.") from err
    except ValidationError as err:
        first = err.errors()[0]
        raise ConfigError(f"The file {path}, {'.'.join(map(str, first['loc'][:1]))}: {first['msg']}.") from err
    for words, look in found.items():
        name, known = (look, catalogue().movable) if isinstance(look, str) else (look[0], SHAPES)
        if name not in known:
            raise ConfigError(f"The file {path}, {words!r}: there is no class or recipe {name!r}.")
    return found


@lru_cache(maxsize=4096)
def shape_of(text: str) -> Shape:
    """How a thing looks: by the longest words in its text that are known, the last ones where two are as long.

    Of a glass of wine it is the glass. What is not known is a labelled box, with a colour of its own that follows from
    the text.
    """
    words = text.lower().replace("_", " ").split()
    own = "_".join(words)
    first = words[: words.index("of")] if "of" in words else []
    for part in (words,) if looks().get(" ".join(words)) else (first, words):
        for size in range(len(part), 0, -1):
            for start in range(len(part) - size, -1, -1):
                found = _known(part[start : start + size], own)
                if found is not None:
                    return found
    for said in (" ".join(words), *reversed(words)):
        near = alike().get(said) or alike().get(said.removesuffix("s"))
        found = _known(near.split(), own) if near else None
        if found is not None:
            return found._replace(kind=own)
    return Shape(own, _SIZE, rgb_of(_COLOURS[seed_at(0, "magic box", text.lower()) % len(_COLOURS)]), own)


def _known(words: list[str], whole: str) -> Shape | None:
    """What some words look like, also without the ending of a plural; None if they are not known."""
    said = " ".join(words)
    for name in (said, said.removesuffix("s"), said.removesuffix("es")):
        look = looks().get(name)
        cls = look if isinstance(look, str) else name.replace(" ", "_")
        known = None if isinstance(look, tuple) else catalogue().movable.get(cls)
        if known is not None:
            return Shape(cls, known.size, rgb_of(known.colours[0]), cls)
        if isinstance(look, tuple):
            recipe, size, colour = look
            return Shape(recipe, size, rgb_of(colour), whole)
    return None
