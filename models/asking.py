"""One chat model as the door sees it: what it can do, how it is asked, and what its server was seen to do."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from langchain_core.language_models import BaseChatModel
from langchain_core.messages import AIMessage, BaseMessage
from langchain_core.runnables import RunnableConfig

from coopera.core.errors import ModelCallError
from coopera.models.cache import CachedReply
from coopera.models.recorded import Past
from coopera.models.servers.saying import one_line
from coopera.models.servers.tokens import Count, believe
from coopera.models.settings import Structure
from coopera.models.transport import Line, RefusedError


@dataclass(frozen=True, slots=True)
class Request:
    """What the door asks of a model: messages, how to draw the reply, and the schema it should be held to.

    The messages depend on the structure: where nothing else holds the reply to its schema they show it. What `traced`
    says goes to whoever listens to the call (callbacks, tracers), not to the model.
    """

    messages: Callable[[Structure], Sequence[BaseMessage]]
    temperature: float
    seed: int
    max_tokens: int
    schema: Mapping[str, Any] | None = None
    name: str = "reply"
    traced: RunnableConfig | None = None


ENFORCED = frozenset[Structure](("json_schema", "tools"))
"""Structures by which a server, or a decoder, that keeps its word holds a reply to its schema."""
Options = Callable[[Request, Structure], dict[str, Any]]
"""A backend's way to say a request to its client, besides the messages."""
Note = Callable[[str], None]


def _no_options(request: Request, structure: Structure) -> dict[str, Any]:
    return {}


class Answer(NamedTuple):
    """A model's reply, the structure by which it was held to its schema, and how many counts of tokens are ours."""

    reply: CachedReply
    structure: Structure
    estimated: int = 0


@dataclass(slots=True)
class _Seen:
    """What was noticed of a server: which structures it refused, and how many replies kept to the schema unseen."""

    refused: list[Structure] = field(default_factory=list)
    kept: int = 0
    strayed: int = 0


@dataclass(frozen=True, slots=True)
class Backend:
    """A chat model, and what the door must know of it.

    Attributes:
        name: As it stands in the trace and in the cache's keys.
        sees: Whether it looks at pictures.
        reads_variables: Whether it answers from the prompt's variables rather than from its text.
        options: Turns a request into the client's arguments.
        structures: Ways to hold it to a schema, best first; after a refusal the next one is tried.
        line: The way to its server, if it has one.
        address: Its server's address, if it differs from the provider's.
        weights: A mark of its weights, for the cache: other weights of the same name have another mark.
        past: The run with the recorded replies, if the model is a recorded one.
        brief: Whether its replies are held to be short.
    """

    name: str
    model: BaseChatModel | None
    sees: bool = False
    reads_variables: bool = False
    options: Options = _no_options
    structures: Sequence[Structure] = ("text",)
    line: Line | None = None
    address: str | None = None
    weights: str = ""
    past: Past | None = None
    brief: bool = False
    _seen: _Seen = field(default_factory=_Seen)

    def __str__(self) -> str:
        """The model as error messages call it."""
        return f"{self.name} at {self.address}" if self.address else self.name

    @property
    def structure(self) -> Structure:
        """How it is held to a schema now."""
        return self.ways[0]

    @property
    def ways(self) -> Sequence[Structure]:
        """The structures that may do, best first."""
        first = next((one for one in self.structures if one not in self._seen.refused), self.structures[-1])
        return self.structures[self.structures.index(first) :]

    @property
    def ignores(self) -> bool:
        """Whether the server was seen to ignore the schemas that it was given: in two replies more than it kept to."""
        return self._seen.strayed > self._seen.kept + 1

    def notice(self, *, kept: bool) -> None:
        """Note whether a reply whose prompt did not show the schema kept to it."""
        if kept:
            self._seen.kept += 1
        else:
            self._seen.strayed += 1

    def ask(self, request: Request, note: Note) -> Answer:
        """Get an answer, patiently.

        Args:
            request: What is asked.
            note: Is told of each failure on the way.

        Raises:
            ModelCallError: If there is none.
        """
        refused: list[Structure] = []
        problem = ""
        for structure in self.ways:
            try:
                reply, estimated = self._ask(request, structure, note)
            except RefusedError as err:
                problem = str(err)
                refused.append(structure)
                if structure != self.structures[-1]:
                    note(f"{problem}; asked again without {structure}")
            else:
                self._seen.refused.extend(refused)
                return Answer(reply, structure, estimated)
        raise ModelCallError(problem)

    def _ask(self, request: Request, structure: Structure, note: Note) -> tuple[CachedReply, int]:
        """A reply, and how many of its counts of tokens are estimates."""
        given, messages = self.options(request, structure), list(request.messages(structure))
        model, line = self.model, self.line
        assert model is not None  # a past is never asked
        if line is None:
            return _read(model.invoke(messages, request.traced, **given))
        told = sum(len(message.text) for message in messages)

        def once() -> tuple[CachedReply, int]:
            reply, estimated = _read(model.invoke(messages, request.traced, **given), told)
            if len(reply.text) > line.settings.max_bytes:
                raise ValueError(f"it has more than {line.settings.max_bytes} characters (calls.max_bytes)")
            return reply, estimated

        return line.send(once, note, one_line)


def _read(message: AIMessage, told: int | None = None) -> tuple[CachedReply, int]:
    """A model's reply as text: its words, or the arguments of its tool call.

    Args:
        message: The reply.
        told: How many characters the model was told, where its counts of tokens are not to be trusted.

    Returns:
        The reply, and how many of its two counts of tokens are estimates.
    """
    text = str(message.text)
    if message.tool_calls:
        text = json.dumps(message.tool_calls[0]["args"], ensure_ascii=False)
    elif message.invalid_tool_calls:
        text = message.invalid_tool_calls[0]["args"] or ""
    usage: Mapping[str, Any] = message.usage_metadata or {}
    said = usage.get("input_tokens"), usage.get("output_tokens")
    if told is None:
        counts = [Count(int(one or 0)) for one in said]
    else:
        counts = [believe(one, length) for one, length in zip(said, (told, len(text)), strict=True)]
    reply = CachedReply(
        text=text.encode("utf-8", "replace").decode(),
        tokens_in=counts[0].tokens,
        tokens_out=counts[1].tokens,
        cut=message.response_metadata.get("finish_reason") in {"length", "max_tokens"},
    )
    return reply, sum(count.estimated for count in counts)
