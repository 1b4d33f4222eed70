"""One call of the door as it goes: what was said, how the reply's form was asked for, and what it took."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from langchain_core.messages import AIMessage, BaseMessage, HumanMessage
from langchain_core.runnables import RunnableConfig

from coopera.core.protocols import Rendered
from coopera.core.randomness import Address
from coopera.models.asking import ENFORCED, Backend
from coopera.models.cache import CachedReply
from coopera.models.parsing import Wanted
from coopera.models.recorded import ASKED_FOR
from coopera.models.settings import CallSettings, Structure

SHOWN = 4000  # characters of a bad reply that the model is shown again


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture to be shown to a model."""

    name: str
    mime: str
    data: bytes


@dataclass(frozen=True, slots=True)
class Turn:
    """What was said at one go; a seed of None marks the model's own turn."""

    text: str
    seed: int | None = None
    pictures: Sequence[Picture] = ()


@dataclass(slots=True)
class Talk:
    """One call as it goes: what was said so far, and what it took.

    Attributes:
        shown: Whether the prompt ends with the schema though the model is held to it, since its server ignores schemas
            or this call's first reply did. Fixed between two turns, whatever other calls find out meanwhile.
    """

    rendered: Rendered
    backend: Backend
    wanted: Wanted[Any]
    settings: CallSettings
    at: Address
    turns: list[Turn] = field(default_factory=list)
    way: Structure = "text"
    shown: bool = field(init=False)
    reply: str = ""
    tokens_in: int = 0
    tokens_out: int = 0
    attempts: int = 0
    cached: int = 0
    faults: list[str] = field(default_factory=list)
    leniencies: dict[str, int] = field(default_factory=dict)
    fresh: list[tuple[str, CachedReply]] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Decide by what is known of the server at the first turn."""
        self.shown = self.backend.ignores

    def shows_schema(self, structure: Structure) -> bool:
        """Whether the prompt ends with the schema: where nothing else tells the model, or holds it to it."""
        if self.settings.show_schema == "auto":
            return self.shown or structure not in ENFORCED
        return self.settings.show_schema == "always"

    def texts(self, structure: Structure) -> list[str]:
        """What was said, turn by turn, to a model that is held to its schema in a certain way."""
        said = [turn.text for turn in self.turns]
        if self.backend.reads_variables:
            return said
        schema = f" It must fit this JSON schema:\n{self.wanted.shown}" if self.shows_schema(structure) else ""
        return [f"{said[0]}{ASKED_FOR}{schema}", *said[1:]]

    def messages(self, structure: Structure) -> list[BaseMessage]:
        """What was said, as LangChain's clients take it."""
        made: list[BaseMessage] = []
        for turn, text in zip(self.turns, self.texts(structure), strict=True):
            if turn.seed is None:
                made.append(AIMessage(content=text))
                continue
            shown = [
                {"type": "image", "base64": base64.b64encode(picture.data).decode(), "mime_type": picture.mime}
                for picture in turn.pictures
            ]
            content: Any = [*shown, {"type": "text", "text": text}] if shown else text
            made.append(HumanMessage(content=content, **self._told(turn.seed)))
        return made

    def traced(self) -> RunnableConfig:
        """What tells this call from all others in a tracer: whose hour it is in, for which node, by which prompt.

        The day is that of the person's life with this robot (`episode_day`), as in the prompts.
        """
        at = {"person": self.at.person, "day": self.at.day, "hour": self.at.hour, "node": self.at.node}
        return {
            "run_name": self.rendered.name,
            "tags": ["coopera", self.rendered.role, *(f"{name}:{value}" for name, value in at.items())],
            "metadata": {**at, "draw": self.at.draw, "role": self.rendered.role, "prompt_sha": self.rendered.sha},
        }

    def written(self, structure: Structure) -> list[dict[str, Any]]:
        """What was said, as it stands in the trace: pictures by name."""
        made: list[dict[str, Any]] = []
        for turn, text in zip(self.turns, self.texts(structure), strict=True):
            names = {"images": [picture.name for picture in turn.pictures]} if turn.pictures else {}
            made.append({"role": "user" if turn.seed is not None else "assistant", "content": text, **names})
        return made

    def fault(self, reason: str) -> None:
        """Note what was wrong with the latest attempt."""
        self.faults.append(f"attempt {self.attempts}: {reason}")

    def bad(self, reason: str, *, more: bool) -> None:
        """Note a reply that cannot be used; if there are more attempts it is shown to the model again."""
        self.fault(reason)
        if more:
            self.turns.append(Turn(self.reply[:SHOWN] or "(an empty answer)"))

    def _told(self, seed: int) -> dict[str, Any]:
        """What a model that answers from variables is told besides."""
        if not self.backend.reads_variables:
            return {}
        told = {
            "prompt": self.rendered.name,
            "variables": dict(self.wanted.variables),
            "seed": seed,
            "temperature": self.rendered.temperature,
        }
        return {"additional_kwargs": {"coopera": told}}
