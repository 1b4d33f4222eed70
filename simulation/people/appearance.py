"""How a person looks, drawn from the id and from what the profile says, and what they wear for what they do.

Every draw has an address (`core.randomness`), so that a person looks the same in every run and process. What is stated
comes first: by the person file (`core.people.Looks`), then by the profile's own words, read by a few rules that rather
miss something than make it up. Names are not read. Looks are for pictures alone: no text is made of them.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Literal, TypeVar

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.people import Beard, Build, HairColour, HairStyle, Looks, SkinTone
from coopera.core.randomness import rng_at
from coopera.simulation.people import palettes
from coopera.simulation.people.clothes import Bottom, Clothes, Top
from coopera.simulation.people.figure import Measures
from coopera.simulation.people.head import Face
from coopera.simulation.people.palettes import Colour

Outfit = Literal["day", "bath", "sleep", "sport"]
BODIES = "COOPERA_BODIES"
"""The environment variable that names a folder of body models, whose bodies then take the place of ours."""

T = TypeVar("T")
_YOUNGEST = 16
"""Bodies are adults': who is younger is drawn as of this age."""
_FRAMES: tuple[Literal["round", "square"], ...] = ("round", "square")

_I_AM = r"\bI(?:'m| am)\b(?:(?!\b(?:my|to|with|for|the|his|her|not)\b)[^.;:!?]){0,70}?\b"
_AGES = (
    re.compile(r"\bI(?:'m| am)(?: an?| now| already)? (\d\d)\b(?! (?:minutes|hours|metres|miles|weeks|months|days))"),
    re.compile(_I_AM + r"(\d\d)[- ]years?[- ]old"),
)
_DECADE = re.compile(
    r"\bin my (?:early |mid |mid-|late )?(twenties|thirties|forties|fifties|sixties|seventies|eighties)"
)
_DECADES = ("twenties", "thirties", "forties", "fifties", "sixties", "seventies", "eighties")
_RETIRED = re.compile(_I_AM + r"(?:retired|pensioner|in retirement|grandmother|grandfather)\b", re.IGNORECASE)
_STUDENT = re.compile(r"(?:\bI study\b|" + _I_AM + r"(?:student|undergraduate|teenager)\b)")
_WOMAN = re.compile(
    _I_AM + r"(?:woman|mother|mum|mom|wife|widow|grandmother|grandma|girl|lady|housewife|waitress|actress)\b"
)
_MAN = re.compile(_I_AM + r"(?:man|father|dad|husband|widower|grandfather|grandpa|boy|guy|househusband|bachelor)\b")
_GLASSES = re.compile(r"\bI (?:\w+ )?wear (?:\w+ ){0,2}(?:glasses|spectacles)\b|\bmy (?:reading glasses|spectacles)\b")
_BEARD = re.compile(r"\bmy (?:\w+ ){0,2}beard\b|\bI (?:have|wear|keep) a (?:\w+ ){0,2}beard\b")
_BALD = re.compile(_I_AM + r"bald(?:ing)?\b|\bmy bald head\b")
_GREY = re.compile(
    r"\bmy (?:\w+ ){0,2}(?:grey|gray|white) hair\b|\bmy hair (?:is|has gone|has turned) (?:grey|gray|white)\b"
)
_ACTIVE = re.compile(_I_AM + r"(?:trainer|athlete|runner|dancer|gymnast|climber|swimmer)\b")

_BATHES = re.compile(r"\b(?:shower|bath|bathe|towel|swim)\b")
_RESTS = re.compile(r"\b(?:lie|nap|sleep|asleep|doze)\b")
_MOVES = re.compile(
    r"\b(?:squats?|stretch|dumbbells?|jumping|jump rope|yoga|sit-ups|push-ups|run on|box and punch|kick|treadmill)\b"
)


@dataclass(frozen=True, slots=True)
class Appearance:
    """A person's looks; the height and all joints are those of everybody (`humanoid`)."""

    measures: Measures = Measures()
    face: Face = Face()
    skin: Colour = palettes.SKINS["light"]
    iris: Colour = palettes.IRISES[0]
    hair_style: HairStyle = "short"
    hair: Colour = palettes.HAIRS["dark brown"]
    recede: float = 0.0
    """How far the hair has left the forehead, 0 to 1."""
    beard: Beard = "shaven"
    glasses: Literal["round", "square"] | None = None
    lined: bool = False
    """Whether age has drawn lines in the face."""
    day: Clothes = field(default_factory=lambda: Clothes("jumper", "trousers", "shoes"))
    bath: Clothes = field(default_factory=lambda: Clothes(bottom="trunks"))
    sleep: Clothes = field(default_factory=lambda: Clothes("pyjamas", "trousers"))
    sport: Clothes = field(default_factory=lambda: Clothes("tee", "shorts", "trainers"))
    model: Path | None = None
    """A file of the SMPL-X model, whose body takes the place of ours."""

    def wears(self, outfit: Outfit) -> Clothes:
        """The clothes of an outfit."""
        found: Clothes = getattr(self, outfit)
        return found


def outfit_for(motion: str, place: str | None = None) -> Outfit:
    """What is worn while a motion is done, by its caption; `place` is the furniture it is done at.

    Only who lies on a bed is dressed for the night.
    """
    if _BATHES.search(motion):
        return "bath"
    if _RESTS.search(motion):
        return "sleep" if place is None or "bed" in place else "day"
    return "sport" if _MOVES.search(motion) else "day"


def stated_looks(profile: str) -> Looks:
    """What a profile says of its writer's looks."""
    age = next((int(found[1]) for rule in _AGES if (found := rule.search(profile))), None)
    if age is None and (decade := _DECADE.search(profile)):
        age = 25 + 10 * _DECADES.index(decade[1])
    if age is None and _RETIRED.search(profile):
        age = 70
    if age is None and _STUDENT.search(profile):
        age = 22
    return Looks(
        age=None if age is None else max(age, _YOUNGEST),
        figure="woman" if _WOMAN.search(profile) else "man" if _MAN.search(profile) else None,
        build="slim" if _ACTIVE.search(profile) else None,
        glasses=True if _GLASSES.search(profile) else None,
        beard="full" if _BEARD.search(profile) else None,
        hair="bald" if _BALD.search(profile) else None,
        hair_colour="grey" if _GREY.search(profile) else None,
    )


@lru_cache(maxsize=64)
def appearance_of(profile: str, person: str, stated: Looks | None = None) -> Appearance:
    """How a person looks: the same for the same profile, id and stated looks, in every process.

    Args:
        profile: What the person says of themselves; may be empty.
        person: Their id.
        stated: What their file states of their looks.

    Raises:
        ConfigError: If COOPERA_BODIES names no folder of body models.
    """
    said = stated_looks(profile).model_dump(exclude_none=True)
    said |= stated.model_dump(exclude_none=True) if stated is not None else {}
    draw = _Draw(person, Looks.model_validate(said))
    folder = os.environ.get(BODIES)
    models = body_models(Path(folder).expanduser()) if folder else {}
    return replace(draw.appearance(), model=models.get("woman" if draw.woman else "man", models.get("any")))


def body_models(folder: Path) -> dict[str, Path]:
    """The files of the SMPL-X model in a folder, by the figure they are for: `woman`, `man` and `any`.

    Raises:
        ConfigError: If it is no folder, or holds none of SMPLX_NEUTRAL.npz, SMPLX_FEMALE.npz and SMPLX_MALE.npz.
    """
    names = {"woman": "SMPLX_FEMALE.npz", "man": "SMPLX_MALE.npz", "any": "SMPLX_NEUTRAL.npz"}
    found = {figure: folder / name for figure, name in names.items() if (folder / name).is_file()}
    if not found:
        raise ConfigError(f"{BODIES}: {folder} must be a folder with {', '.join(names.values())}, or one of them.")
    return {"any": next(iter(found.values())), **found}


class _Draw:
    """Draws what is not stated; each thing at an address of its own, so that stating one leaves the others."""

    def __init__(self, person: str, stated: Looks) -> None:
        self._person, self._stated = person, stated
        self.woman = stated.figure == "woman" if stated.figure else self._chance("figure", 0.5)
        self.age = stated.age if stated.age is not None else round(self._between("age", 22, 66))
        self.old = float(np.clip((self.age - 40) / 35, 0.0, 1.0))

    def _between(self, what: str, low: float, high: float) -> float:
        return float(rng_at(0, "appearance", self._person, what).uniform(low, high))

    def _chance(self, what: str, share: float) -> bool:
        return self._between(what, 0.0, 1.0) < share

    def _one(self, what: str, options: Sequence[T]) -> T:
        return options[int(self._between(what, 0.0, len(options) - 1e-9))]

    def _likely(self, what: str, options: Mapping[T, float]) -> T:
        """One of the options, by their weights."""
        at = self._between(what, 0.0, sum(options.values()))
        for option, weight in options.items():
            at -= weight
            if at < 0:
                return option
        return next(iter(options))

    def appearance(self) -> Appearance:
        """All of it."""
        said = self._stated
        tones: Sequence[SkinTone] = tuple(palettes.SKINS)
        skin = self._one("skin", tones) if said.skin is None else said.skin
        style, beard = said.hair or self._style(), said.beard or self._beard()
        glasses = self._chance("glasses", 0.22 + 0.38 * self.old) if said.glasses is None else said.glasses
        receding = not self.woman and style not in ("bald", "ring", "curly")
        return Appearance(
            measures=self._measures(),
            face=self._face(),
            skin=palettes.SKINS[skin],
            iris=self._iris(skin),
            hair_style=style,
            hair=self._hair(skin),
            recede=self._between("recede", 0.0, 0.15 + 0.75 * self.old) if receding else 0.0,
            beard=beard,
            glasses=self._one("frames", _FRAMES) if glasses else None,
            lined=self.age >= 58,
            day=self._day(),
            bath=self._bath(),
            sleep=self._sleep(),
            sport=self._sport(),
        )

    def _measures(self) -> Measures:
        builds: dict[Build, float] = {"slim": 1.0, "medium": 1.4, "broad": 0.8}
        build = self._likely("build", builds) if self._stated.build is None else self._stated.build
        low, high = {"slim": (0.88, 0.95), "medium": (0.95, 1.05), "broad": (1.08, 1.20)}[build]
        girth = self._between("girth", low, high) + 0.03 * self.old
        round_ = 0.45 * (girth - 0.95) / 0.25 + 0.35 * self.old + self._between("belly", -0.25, 0.25)
        if self.woman:
            curves = self._between("curves", 0.55, 1.0)
            return Measures(0.97 * girth, self._between("shoulders", 0.90, 0.97), 1.04, curves, 0.5 * max(round_, 0.0))
        return Measures(girth, self._between("shoulders", 0.98, 1.06), 0.98, 0.0, float(np.clip(round_, 0.0, 0.9)))

    def _face(self) -> Face:
        soft = self._between("soft", 0.6, 1.0) if self.woman else self._between("soft", 0.0, 0.5)
        jaw = self._between("jaw", 0.88, 0.97) if self.woman else self._between("jaw", 0.96, 1.10)
        return Face(
            width=self._between("width", 0.95, 1.05) * (0.97 if self.woman else 1.0),
            length=self._between("length", 0.95, 1.05),
            jaw=jaw,
            nose=self._between("nose", 0.88, 1.18) * (0.95 if self.woman else 1.0),
            lips=self._between("lips", 0.85, 1.15) * (1.15 if self.woman else 0.95),
            soft=soft,
        )

    def _iris(self, skin: SkinTone) -> Colour:
        pale = skin in ("pale", "fair", "light")
        return self._one("iris", palettes.IRISES if pale else palettes.IRISES[:2])

    def _style(self) -> HairStyle:
        if self.woman:
            young = 1.0 - 0.7 * self.old
            weights: dict[HairStyle, float] = {
                **{"bob": 1.2, "long": 1.4 * young, "bun": 0.8, "ponytail": 0.9 * young},
                **{"curly": 0.7, "parted": 0.3 + 1.2 * self.old},
            }
        else:
            weights = {
                **{"short": 1.3, "parted": 1.2, "cropped": 0.9, "curly": 0.5 * (1 - self.old)},
                **{"bald": 0.15 + 0.5 * self.old, "ring": 1.1 * self.old},
            }
        return self._likely("style", weights)

    def _beard(self) -> Beard:
        if self.woman or self.age < 20:
            return "shaven"
        return self._likely("beard", {"shaven": 1.6, "full": 0.7, "moustache": 0.3, "goatee": 0.25})

    def _hair(self, skin: SkinTone) -> Colour:
        if self._stated.hair_colour:
            return palettes.HAIRS[self._stated.hair_colour]
        grey = float(np.interp(self.age, (35, 45, 55, 65, 75), (0.0, 0.10, 0.45, 0.93, 0.99)))
        if self._chance("grey", grey):
            return palettes.HAIRS["white" if self._between("white", 0, 1) < (self.age - 62) / 20 else "grey"]
        dark = skin in ("olive", "brown", "dark", "deep")
        natural: dict[HairColour, float] = {"black": 3.0, "dark brown": 1.0}
        if not dark:
            natural = {"black": 1.0, "dark brown": 1.5, "brown": 1.5}
        if skin in ("pale", "fair", "light"):
            natural |= {"light brown": 1.0, "blond": 1.0, "red": 0.5}
        return palettes.HAIRS[self._likely("hair", natural)]

    def _day(self) -> Clothes:
        if self.woman:
            tops: dict[Top, float] = {
                **{"jumper": 1.2, "blouse": 1.3, "tee": 1.1 - 0.6 * self.old, "cardigan": 0.7 + 0.8 * self.old},
                **{"dress": 0.8, "hoodie": 0.5 * (1 - self.old), "shirt": 0.6},
            }
            bottoms: dict[Bottom, float] = {"trousers": 0.9, "slim": 1.2 - 0.6 * self.old, "skirt": 0.8}
        else:
            tops = {
                **{"jumper": 1.2, "shirt": 1.3 + 0.5 * self.old, "tee": 1.2 - 0.7 * self.old, "polo": 0.8},
                **{"hoodie": 0.9 * (1 - self.old), "cardigan": 0.2 + 0.8 * self.old},
            }
            bottoms = {"trousers": 1.3, "slim": 0.8 * (1 - self.old) + 0.1}
        top = self._likely("top", tops)
        bottom: Bottom = "nothing" if top == "dress" else self._likely("bottom", bottoms)
        over = self._one("top colour", palettes.SHIRTS if top in ("shirt", "blouse") else palettes.TOPS)
        under = self._apart(over, self._one("bottom colour", palettes.BOTTOMS))
        casual = self._chance("trainers", 0.45 * (1 - 0.6 * self.old)) and bottom != "skirt"
        return Clothes(
            top=top,
            bottom=bottom,
            footwear="trainers" if casual else "shoes",
            top_colour=over,
            bottom_colour=under,
            shoe_colour=self._one("shoes", palettes.TRAINERS if casual else palettes.SHOES),
            accent=self._apart(over, self._one("accent", palettes.SHIRTS)),
            banded=top in ("jumper", "tee") and self._chance("banded", 0.3),
        )

    def _apart(self, over: Colour, under: Colour) -> Colour:
        """A colour that can be told from another: as it is, else darker or lighter."""
        if max(abs(a - b) for a, b in zip(over, under, strict=True)) > 0.16:
            return under
        factor = 0.45 if sum(over) > 0.9 else 2.2
        return (min(factor * under[0], 1.0), min(factor * under[1], 1.0), min(factor * under[2], 1.0))

    def _bath(self) -> Clothes:
        towel = self._chance("towel", 0.35)
        colour = self._one("swim", palettes.TOWELS if towel else palettes.SWIM)
        if self.woman:
            return Clothes(top="towel" if towel else "swimsuit", top_colour=colour)
        return Clothes(bottom="skirt" if towel else "trunks", bottom_colour=colour)

    def _sleep(self) -> Clothes:
        colour = self._one("night", palettes.NIGHT)
        trim = (0.80 * colour[0], 0.80 * colour[1], 0.84 * colour[2])
        return Clothes("pyjamas", "trousers", "bare", colour, colour, accent=trim)

    def _sport(self) -> Clothes:
        over, shoe = self._one("sport", palettes.SPORTS), self._one("sport shoes", palettes.TRAINERS)
        top: Top = self._likely("sport top", {"tank": 1.0, "tee": 1.0} if self.woman else {"tee": 1.6, "tank": 0.5})
        bottom: Bottom = "slim" if self.woman else "shorts"
        return Clothes(top, bottom, "trainers", over, self._one("sport bottom", palettes.BOTTOMS[:2]), shoe)
