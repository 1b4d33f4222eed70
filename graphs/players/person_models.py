"""A way of simulating the person is data: the paper's, and its ablations as differences from it (PAPER §4.5)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from coopera.core.people import Persona


@dataclass(frozen=True, slots=True)
class PersonModel:
    """One way of simulating a person; `PERSON_MODELS` lists them.

    Attributes:
        name: As given to `--person-model`.
        extension: Whether the person lives by the extended profile, rather than by the notes that it extends.
        hourly: Whether each intention is proposed in its hour; otherwise all of a day at once.
        history: Whether what was done earlier that day enters the prompts.
        reflection: Whether the two reflections revise the tasks.
    """

    name: str
    extension: bool = True
    hourly: bool = True
    history: bool = True
    reflection: bool = True

    def profile(self, persona: Persona) -> str:
        """The text that the person lives by."""
        return persona.profile if self.extension else persona.notes


FULL = PersonModel("full")

PERSON_MODELS: dict[str, PersonModel] = {
    model.name: model
    for model in (
        FULL,
        replace(FULL, name="no_extension", extension=False),  # PAPER §4.5: only the short trait paragraph
        replace(FULL, name="single_shot", hourly=False, history=False, reflection=False),  # PAPER §4.5
    )
}
"""All ways of simulating a person, by name."""
