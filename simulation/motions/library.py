"""The library of household motions: their captions and classes, and which one a free-form text means."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
import yaml
from pydantic import Field, ValidationError, model_validator

from coopera.core.errors import ConfigError
from coopera.core.lazy import made_once
from coopera.core.people import Frozen
from coopera.simulation.shapes.rotations import Array

Posture: TypeAlias = Literal["stand", "sit", "lie", "floor"]
Hold: TypeAlias = Literal["right", "left", "both", "head", "floor", "surface", "beside", "feet", "flat", "torso"]
Base: TypeAlias = Literal["crossed", "kneel", "prone", "supine", "crouch"]
Frame: TypeAlias = Literal["surface", "mouth", "head", "chest", "hips", "body"]
Triple: TypeAlias = tuple[float, float, float]
Path3: TypeAlias = Triple | list[Triple]

FOLDER = Path(__file__).parent
_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast where PyYAML has its C part
FALLBACK = "stand and wait"
"""What a text is taken for that shares no word with any caption."""
_STOP = frozenset(("a", "an", "and", "at", "for", "from", "her", "his", "in", "into", "it", "my", "of", "off", "on"))
_STOP |= {"or", "out", "some", "someone", "the", "their", "to", "up", "while", "with"}
_WORD = re.compile(r"[a-z]+")


class HandPath(Frozen):
    """Where a hand goes: points, each in a frame; written in the file as one list, a frame before its points."""

    frames: list[Frame] = Field(min_length=1)
    points: list[Triple] = Field(min_length=1)

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, data: Any) -> Any:
        if not isinstance(data, list) or not data:
            return data
        frames, points = [data[0]], []
        for entry in data[1:]:
            if isinstance(entry, str):
                frames[-1] = entry
            else:
                points.append(entry)
                frames.append(frames[-1])
        return {"frames": frames[: max(len(points), 1)], "points": points}


class Aid(Frozen):
    """A small thing that belongs to a motion and is no thing of the home, such as the fork that one eats with.

    Within the shares `when` of the period it is in the `hand` ; afterwards it lies `at` a place,
    which is x, y, z and a turn in degrees in the surface's frame (or, `floor`, in the body's, above what bears it).
    Without a hand it lies there just then. It is left out where the thing in hand is one of its kind, and where that is
    not held as `only` says.
    """

    thing: str = Field(min_length=1, max_length=40)
    hand: Hold | None = None
    when: tuple[float, float] = (0.0, 1.0)
    at: tuple[float, float, float, float] | None = None
    floor: bool = False
    only: Literal["laid", "left", "right", "surface"] | None = None


class Prop(Aid):
    """An aid that pictures alone show: nothing stands in the way of a percept's rays, and no body reaches for it.

    It is seen with things of the kinds `of` (groups or classes of affordances.yaml, or words) in hand, where there are
    any, and not with those `but`. It is seen `over` a surface or only where there is `none`; `bare`, where nothing
    lies there that the motion is done with; `fits`, where that much room to each side of its place is on the surface
    and free (metres). What one has in hand is tipped as `tip` says.
    """

    of: list[str] = []
    but: list[str] = []
    over: Literal["surface", "none"] | None = None
    bare: bool = False
    fits: float = Field(0.0, ge=0)
    tip: list[float] = []


class Showing(Frozen):
    """How pictures show the thing in hand where it is what the motion is done to, and not what it is done with.

    From the share `after` of the period on it lies `at` a place (see Aid), or is in `hand`, tipped as `tip` says, or
    `bitten` at the mouth; else it is not seen. `of` and `but` are those of Prop.
    """

    of: list[str] = []
    but: list[str] = []
    after: float = Field(0.0, ge=0, lt=1)
    at: tuple[float, float, float, float] | None = None
    floor: bool = False
    hand: Hold | None = None
    bitten: bool = False
    tip: list[float] = []


class Laying(Frozen):
    """The thing in hand is put down in the course of a motion: at this share of its period, at x, y and a turn."""

    after: float = Field(gt=0, lt=1)
    at: Triple


class Keys(Frozen):
    """How the body does a motion: see the head of motion_keys.yaml."""

    period: float = Field(4.0, gt=0)
    clip: str | None = None
    base: Base | None = None
    pelvis: Path3 = (0.0, 0.0, 0.0)
    hips: Path3 = (0.0, 0.0, 0.0)
    chest: Path3 = (0.0, 0.0, 0.0)
    neck: Path3 = (0.0, 0.0, 0.0)
    right: HandPath | None = None
    left: HandPath | None = None
    inside: HandPath | None = None
    right_foot: Path3 = (0.0, 0.0, 0.0)
    left_foot: Path3 = (0.0, 0.0, 0.0)
    elbows: float = 0.15
    knees: float = 0.1
    hold: Hold = "right"
    works_at: tuple[float, float] | None = None
    above: float = Field(0.0, ge=0)
    tip: list[float] = []
    lays: Laying | None = None
    aids: list[Aid] = []
    props: list[Prop] = []
    shows: list[Showing] = []


class Motion(Frozen):
    """One motion: `cls` is what a coarse action recogniser calls it, a verb phrase."""

    caption: str = Field(min_length=1, max_length=60)
    cls: str = Field(alias="class", min_length=1, max_length=60)
    posture: Posture
    keys: Keys


class Meant(NamedTuple):
    """A motion that a text may mean: its caption, and how alike the two are (a cosine, or the share of words).

    `asked` is what was compared, where it was no caption. `neutral`: nothing came near, and this stands for it.
    """

    caption: str
    likeness: float
    asked: str = ""
    neutral: bool = False


Rank: TypeAlias = Callable[[str], Sequence[tuple[str, float]]]
"""Ranks captions by how near they are in meaning to a text: (caption, cosine), the nearest first."""


class Library:
    """All motions, in the order of the file."""

    def __init__(self, motions: list[Motion]) -> None:
        self.motions = motions
        self._by_caption = {motion.caption: motion for motion in motions}

    @cached_property
    def captions(self) -> list[str]:
        """What the motions are called, sorted."""
        return sorted(self._by_caption)

    @cached_property
    def classes(self) -> list[str]:
        """The coarse labels, sorted."""
        return sorted({motion.cls for motion in self.motions})

    def __getitem__(self, caption: str) -> Motion:
        """The motion of that caption."""
        return self._by_caption[caption]

    def __contains__(self, caption: str) -> bool:
        return caption in self._by_caption

    def confusable(self, motion: Motion) -> list[str]:
        """The other classes that some motion in the same posture has: what a recogniser may mistake it for."""
        return sorted({other.cls for other in self.motions if other.posture == motion.posture} - {motion.cls})

    def match(self, text: str) -> Motion:
        """Find the motion that shares most words with a text; "stand and wait" where none shares any.

        Rare words count more, and ties go to the first listed.
        """
        best = self.ranked(text)[0]
        return self._by_caption[best.caption if best.likeness > 0 else FALLBACK]

    def ranked(self, text: str, rank: Rank | None = None) -> list[Meant]:
        """The motions that a free-form text may mean, the likeliest first.

        A caption means itself. For another text `rank` decides, if it is given. Otherwise shared words do.
        """
        plain = " ".join(text.lower().split())
        if plain in self._by_caption:
            return [Meant(plain, 1.0)]
        if rank is not None:
            return [Meant(caption, likeness) for caption, likeness in rank(text) if caption in self._by_caption]
        words = _words(text)
        found = [Meant(motion.caption, round(self._overlap(words, motion), 9)) for motion in self.motions]
        return sorted(found, key=lambda one: -one.likeness)

    @cached_property
    def _rarity(self) -> dict[str, float]:
        bags = [_words(motion.caption) for motion in self.motions]
        return {
            word: math.log((1 + len(bags)) / sum(word in bag for bag in bags))
            for word in sorted(frozenset().union(*bags))
        }

    def _overlap(self, words: frozenset[str], motion: Motion) -> float:
        """Weight of the shared words over that of all (unknown words of the text count as rare ones)."""
        caption = _words(motion.caption)
        rare = math.log(1 + len(self.motions))

        def weight(bag: frozenset[str]) -> float:
            return sum(self._rarity.get(word, rare) for word in sorted(bag))

        return weight(words & caption) / max(weight(words | caption), 1e-9)


def _words(text: str) -> frozenset[str]:
    return frozenset(_stem(word) for word in _WORD.findall(text.lower()) if word not in _STOP)


def _stem(word: str) -> str:
    """Cut the commonest endings, so that "reading a book" meets "sit and read"."""
    for ending in ("ing", "es", "ed", "s"):
        if word.endswith(ending) and len(word) - len(ending) >= 3:
            word = word[: -len(ending)]
            break
    if len(word) > 3 and word[-1] == word[-2] and word[-1] not in "sl":
        word = word[:-1]
    return word.rstrip("e") if len(word) > 3 else word


@made_once()
def load_library(folder: Path = FOLDER) -> Library:
    """Read motions.yaml and motion_keys.yaml.

    Raises:
        ConfigError: If a motion has no keys, keys have no motion, or a field is not as the files' heads say.
    """
    listed = _read(folder / "motions.yaml").get("motions", [])
    keys = _read(folder / "motion_keys.yaml")
    if twice := [row["caption"] for i, row in enumerate(listed) if row in listed[:i]]:
        raise ConfigError(f"motions.yaml lists {twice[0]!r} twice.")
    if strange := sorted({row["caption"] for row in listed} ^ set(keys)):
        raise ConfigError(
            f"motions.yaml and motion_keys.yaml must name the same motions; {strange[0]!r} is in one only."
        )
    motions = []
    for row in listed:
        try:
            motions.append(Motion.model_validate(row | {"keys": keys[row["caption"]]}))
        except ValidationError as err:
            first = err.errors()[0]
            field = ".".join(str(part) for part in first["loc"])
            raise ConfigError(f"The motion {row['caption']!r}, field {field}: {first['msg']}.") from err
    return Library(motions)


def _read(path: Path) -> dict[str, Any]:
    try:
        data = yaml.load(path.read_text(encoding="utf-8"), _Loader)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as err:
        raise ConfigError(f"The motion file {path.name} cannot be read: {err}.") from err
    if not isinstance(data, dict):
        raise ConfigError(f"The motion file {path.name} must hold a mapping.")
    return data


def along(path: Path3, share: float) -> Array:
    """A point on a closed smooth path (periodic Catmull-Rom) at a share of its period; one triple stands still."""
    points = np.atleast_2d(np.array(path, dtype=np.float64))
    count = len(points)
    if count == 1:
        still: Array = points[0]
        return still
    where = (share % 1.0) * count
    i = int(where)
    u = where - i
    before, here, after, later = (points[(i + k) % count] for k in (-1, 0, 1, 2))
    leave, enter = (after - before) / 2, (later - here) / 2
    point: Array = (
        (2 * u**3 - 3 * u**2 + 1) * here
        + (u**3 - 2 * u**2 + u) * leave
        + (3 * u**2 - 2 * u**3) * after
        + (u**3 - u**2) * enter
    )
    return point


class Clip:
    """Recorded motion, played on the spot: poses of `humanoid.SIZE` numbers over time.

    Attributes:
        starts: When each pose begins (seconds), and after them the end.
        poses: Shape (n, 43).
        travel: How far the recorded body went forward (metres).
    """

    def __init__(self, starts: Array, poses: Array, travel: float = 0.0) -> None:
        self.starts, self.poses, self.travel = starts, poses, travel
        self.seconds = float(starts[-1])

    @classmethod
    def shipped(cls, name: str) -> Clip:
        """A clip that ships with pybullet.

        A row of its file is: seconds, root place, then quaternions (w first) and hinge angles in the body's joint
        order, with y up and z to the right.
        """
        import pybullet_data  # noqa: PLC0415  (prints nothing, but lives with pybullet)

        path = Path(pybullet_data.getDataPath()) / "data" / "motions" / f"humanoid3d_{name}.txt"
        rows = np.array(json.loads(path.read_text(encoding="utf-8"))["Frames"], dtype=np.float64)
        starts = np.concatenate(([0.0], np.cumsum(rows[:, 0])))
        return cls(starts, np.array([_as_pose(row) for row in rows]), float(rows[-1, 1] - rows[0, 1]))

    def at(self, seconds: float) -> Array:
        """The pose at a time, running round; between rows the nearer earlier one holds (rows are 30 a second or so)."""
        where = int(np.searchsorted(self.starts, seconds % self.seconds, side="right")) - 1
        pose: Array = self.poses[min(where, len(self.poses) - 1)]
        return pose


def _as_pose(row: Array) -> Array:
    pose = [0.0, 0.0, row[2]]
    start = 4
    for width in (4, 4, 4, 4, 1, 4, 4, 1, 4, 1, 4, 4, 1):
        part = row[start : start + width]
        part = part / np.sqrt(part @ part) if width == 4 else part
        pose += [part[1], -part[3], part[2], part[0]] if width == 4 else [part[0]]
        start += width
    return np.array(pose)
