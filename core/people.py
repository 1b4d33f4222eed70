"""People: who they are, and what the robot believes they are."""

from __future__ import annotations

from typing import Literal, NewType, TypeAlias

from pydantic import BaseModel, ConfigDict, Field

PersonId = NewType("PersonId", str)

TRAITS = ("openness", "conscientiousness", "extroversion", "agreeableness", "neuroticism")
"""The Big Five in the order used everywhere (PAPER §3.2 spells it "extroversion")."""


class Frozen(BaseModel):
    """Base of everything stored or parsed: immutable, and unknown fields are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid")


def is_none(value: object) -> bool:
    """Whether a field need not be written: it has no value."""
    return value is None


def is_empty(value: object) -> bool:
    """Whether a field need not be written: it is empty or has no value."""
    return not value


class BigFive(Frozen):
    """Big-Five scores, each in [1, 5]; 3 is the middle of the scale."""

    openness: float = Field(3.0, ge=1, le=5)
    conscientiousness: float = Field(3.0, ge=1, le=5)
    extroversion: float = Field(3.0, ge=1, le=5)
    agreeableness: float = Field(3.0, ge=1, le=5)
    neuroticism: float = Field(3.0, ge=1, le=5)

    def __str__(self) -> str:
        """One line in the fixed trait order, two decimals."""
        return ", ".join(f"{trait} {getattr(self, trait):.2f}" for trait in TRAITS)


class Trial(Frozen):
    """One of the readings of a person's Big Five: inferred directly, and by the 50-item test with its answers."""

    direct: BigFive
    test: BigFive
    answers: list[int]


class Provenance(Frozen):
    """The origin of an imported persona: the file and the row, the model and the prompts, and the votes."""

    file: str
    row: int = Field(ge=1)
    model: str
    prompts: dict[str, str]
    """SHA of each prompt's text, by name."""
    trials: list[Trial]


HairStyle: TypeAlias = Literal["bald", "ring", "cropped", "short", "parted", "bob", "long", "bun", "ponytail", "curly"]
"""How hair is worn; "ring" is hair about a bald crown."""
HairColour: TypeAlias = Literal["black", "dark brown", "brown", "light brown", "blond", "red", "grey", "white"]
SkinTone: TypeAlias = Literal["pale", "fair", "light", "tan", "olive", "brown", "dark", "deep"]
Build: TypeAlias = Literal["slim", "medium", "broad"]
Beard: TypeAlias = Literal["shaven", "moustache", "goatee", "full"]


class Looks(Frozen):
    """How somebody looks in pictures, as far as it is stated; the rest is drawn. No model is told of it."""

    figure: Literal["woman", "man"] | None = None
    age: int | None = Field(None, ge=16, le=110)
    build: Build | None = None
    skin: SkinTone | None = None
    hair: HairStyle | None = None
    hair_colour: HairColour | None = None
    glasses: bool | None = None
    beard: Beard | None = None


class Persona(Frozen):
    """A person as written in a persona file: the truth that the robot must infer.

    `source` says where the text came from ("coopera", or the file and row of an import). `notes` are a short paragraph
    of traits, and the profile extends them; the ablation without profile extension uses the notes alone. Only imported
    personas have a `provenance`. `appearance` is for pictures alone.
    """

    id: PersonId = Field(pattern=r"^[a-z0-9][a-z0-9_-]{0,63}$")
    name: str = Field(min_length=1, max_length=80)
    profile: str = Field(min_length=1, max_length=20_000)
    big_five: BigFive
    source: str = "coopera"
    notes: str = Field("", max_length=20_000)
    provenance: Provenance | None = None
    appearance: Looks | None = Field(None, exclude_if=is_none)


class Belief(Frozen):
    """What the robot believes about one person: inferred Big Five and a three-sentence profile.

    `None` until the first evening (PAPER App. D: empty at the first collaboration).
    """

    big_five: BigFive | None = None
    profile: str | None = None


ChangeKind: TypeAlias = Literal["mood", "drift", "job", "illness", "hobby", "season", "other"]
"""What may become different in a life."""


class Circumstance(Frozen):
    """Something that is different in a person's life, as it is felt on a day; `strength` from 0 to 1."""

    kind: ChangeKind
    text: str
    strength: float = Field(ge=0, le=1)
