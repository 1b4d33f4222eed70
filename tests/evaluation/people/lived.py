"""Small made-up lives, on which every figure can be worked out by hand."""

from __future__ import annotations

from coopera.core.household import SceneId
from coopera.core.people import BigFive, Persona, PersonId
from coopera.evaluation.people.lives import LivedDay, Lives


def day(
    person: str, scene: str = "home", number: int = 0, *, seed: int = 0, does: list[str], tasks: list[str] | None = None
) -> LivedDay:
    return LivedDay(
        person=PersonId(person),
        scene=SceneId(scene),
        seed=seed,
        number=number,
        hours=list(range(9, 9 + len(does))),
        intentions=does,
        tasks=[[task] for task in (tasks or does)],
    )


def persona(name: str, **scores: float) -> Persona:
    return Persona(id=PersonId(name), name=name.title(), profile=f"I am {name}.", big_five=BigFive(**scores))


def lives(days: list[LivedDay], **personas: Persona) -> Lives:
    people = {PersonId(d.person): persona(d.person) for d in days}
    return Lives(days, {**people, **{PersonId(name): one for name, one in personas.items()}})
