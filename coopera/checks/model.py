"""Trying a model before a study depends on it: a structured reply, the names of objects, and pictures."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from langchain_core.embeddings import Embeddings
from PIL import Image, ImageDraw

from coopera.checks.knowledge import strange_words, words_of_homes
from coopera.core.errors import ModelCallError, ModelOutputError
from coopera.core.hour import ModelCall
from coopera.core.people import Frozen
from coopera.core.protocols import Role
from coopera.core.randomness import Address
from coopera.core.replies import IntentionsReply, PickPlaceReply, VerdictsReply
from coopera.models.backends import Backend, open_backend
from coopera.models.door import Door
from coopera.models.households import household_of
from coopera.models.offline.household.knowledge import Household, load
from coopera.models.schemas import enforced_schema, strays
from coopera.models.settings import OWN, CallSettings
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples

_SIZE = (320, 240)
_FORMS = {
    "json_schema": "held to a JSON schema",
    "tools": "made to call a tool",
    "json_object": "held to JSON",
    "text": "told in words only",
}


class Tried(NamedTuple):
    """One call: what it was for, whether it worked, and what it took."""

    name: str
    ok: bool
    words: str
    call: ModelCall | None = None

    def data(self) -> dict[str, Any]:
        """As JSON."""
        told: dict[str, Any] = {"check": self.name, "ok": self.ok, "words": self.words}
        if self.call is not None:
            names = ("seconds", "tokens_in", "tokens_out", "attempts", "faults")
            told |= {name: getattr(self.call, name) for name in names}
        return told


def check_model(
    spec: str,
    *,
    base_url: str | None,
    settings: CallSettings,
    embeddings: Embeddings,
    homes: Sequence[Path] = (),
    household: str = OWN,
) -> tuple[Backend, list[Tried]]:
    """Ask a model what coopera asks of models; the first check must hold for it to be of any use.

    Args:
        spec: The model.
        base_url: Address of an OpenAI-compatible server.
        settings: How it is called.
        embeddings: What the offline model compares texts with.
        homes: Folders of imported homes, of which an offline model's household file may speak.
        household: Which household file an offline model has as the robot, where it names none.

    Raises:
        ConfigError: If it cannot be opened.
    """
    roles: tuple[Role, ...] = ("judge", "robot")
    backends = {role: open_backend(spec, role, embeddings, base_url, settings, household=household) for role in roles}
    door = Door(prompts=PromptLibrary(), backends=backends, seed=0, settings=settings)
    tried = [_ask(door, "structured reply", "judge/tasks", VerdictsReply)]
    if tried[0].ok:
        tried.append(_ask(door, "objects that exist", "robot/tasks_type1", PickPlaceReply))
        tried.append(_look(door) if backends["robot"].sees else _blind(spec))
    if own := household_of(spec, "robot", household):
        tried.append(_knowledge(load(own), homes))
    return backends["judge"], tried


def in_words(backend: Backend, tried: Tried) -> str:
    """One line on one check."""
    took = ""
    if tried.call is not None:
        call = tried.call
        took = f" ({call.seconds:.1f} s, {call.tokens_in} tokens in, {call.tokens_out} out, attempts: {call.attempts})"
    how = f", {_FORMS[backend.structure]}" if tried.name == "structured reply" and not backend.reads_variables else ""
    return f"{'works' if tried.ok else 'FAILS'}: {tried.name}{how}: {tried.words}{took}"


def _ask(door: Door, name: str, prompt: str, reply: type[Frozen], images: tuple[Path, ...] = ()) -> Tried:
    variables = dict(examples(prompt)[0])
    if images:
        variables["percept"] = None
    try:
        given = door(prompt, reply, at=Address("check", 0, 9, "check"), variables=variables, images=images)
    except (ModelOutputError, ModelCallError) as err:
        return Tried(name, False, str(err), door.take_calls()[-1])
    (call,) = door.take_calls()
    wrong = strays(given.model_dump(), enforced_schema(reply, variables))
    if wrong:
        return Tried(name, False, f"the reply is valid but strays: {wrong[0]}", call)
    return Tried(name, True, "the reply is valid and names only what is there", call)


def _look(door: Door) -> Tried:
    """Show a red square and a blue disc."""
    with tempfile.TemporaryDirectory() as folder:
        paths = tuple(Path(folder, f"{view}-0.png") for view in ("robot", "human"))
        for path, colour in zip(paths, ("red", "blue"), strict=True):
            picture = Image.new("RGB", _SIZE, "white")
            draw = ImageDraw.Draw(picture)
            (draw.rectangle if colour == "red" else draw.ellipse)((80, 40, 240, 200), fill=colour)
            picture.save(path)
        return _ask(door, "pictures", "robot/intentions", IntentionsReply, paths)


def _blind(spec: str) -> Tried:
    words = "it is not known to look at pictures, so as the robot it would be told what perception reports"
    may_look = ":" in spec and not spec.startswith("offline")
    return Tried("pictures", True, f"{words}; if it does look, name it {spec}+images" if may_look else words)


def _knowledge(household: Household, homes: Sequence[Path]) -> Tried:
    """Say how much a household file holds, and what of it no home has."""
    loadings = sum(len(activity.big_five) for activity in household.activities)
    assumed = sum(len(activity.assumed) for activity in household.activities)
    words = f"{len(household.activities)} activities; {assumed} of {loadings} Big-Five loadings are assumed"
    strange = list(strange_words(household, words_of_homes(homes)))
    return Tried("household file", not strange, "; ".join(strange[:5]) or words)
