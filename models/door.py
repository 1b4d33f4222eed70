"""The one door to language models: prompt name and variables in, a validated reply out, and a record of the call.

Every call renders a prompt file, says which JSON is wanted, parses the answer strictly, shows the model what is wrong
with a bad one and asks again, a bounded number of times. Nothing else in coopera touches a chat model.
"""

from __future__ import annotations

import base64
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from langchain_core.embeddings import Embeddings
from langchain_core.messages import AIMessage, BaseMessage, HumanMessage

from coopera.core.errors import ModelCallError, ModelOutputError, RunError
from coopera.core.hour import ModelCall
from coopera.core.protocols import Prompts, Rendered, Reply, Role
from coopera.core.randomness import Address, seed_at
from coopera.models.backends import Backend, Request, open_backends
from coopera.models.budget import Meter
from coopera.models.cache import CachedReply, ReplyCache, key_of
from coopera.models.parsing import BadReplyError, read_reply
from coopera.models.recorded import SCHEMA_FOLLOWS, Past
from coopera.models.schemas import enforced_schema, schema_of, strays
from coopera.models.settings import OWN, CallSettings
from coopera.models.transport import Sleep, wait

SHOWN = 4000  # characters of a bad reply that the model is shown again
STRAYS = 5  # things out of place that a model is told of at once
SEEDS = 2**31  # servers take seeds of 31 bits
_AGAIN = (
    "This answer cannot be used: {reason}.\nAnswer again with one JSON object that fits the schema, and nothing else."
)
_PICTURES = {".webp": "image/webp", ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}


def open_door(  # noqa: PLR0913 - one parameter for each thing that a run decides
    *,
    prompts: Prompts,
    specs: Mapping[Role, str],
    seed: int,
    embeddings: Embeddings,
    base_url: str | None = None,
    cache: Path | None = None,
    shared: Path | None = None,
    meter: Meter | None = None,
    settings: CallSettings | None = None,
    sleep: Sleep = wait,
    root: Path | None = None,
    household: str = OWN,
) -> Door:
    """Open the models of all roles, and the door before them.

    Args:
        prompts: The prompt folder.
        specs: Model of each role (`coopera.models.backends`); a role that is not there is played by the offline model.
        seed: The run's seed; each call's seed derives from it and the call's address.
        embeddings: What the offline model compares texts with.
        base_url: Where an OpenAI-compatible server listens.
        cache: SQLite file of replies by content; None keeps none. The offline model is faster than any cache.
        shared: Another such file, which runs have in common: looked into where the first has no answer.
        meter: Counts what is spent; without it nothing is counted.
        settings: How models are called.
        sleep: Waits for so many seconds before a request is sent again.
        root: The run directory, relative to which the record names pictures; without it, by their file names.
        household: What an offline robot and judge know of life at home: `own`, `shared` or a file.

    Raises:
        ConfigError: If a model cannot be opened.
    """
    chosen = settings or CallSettings()
    backends = open_backends(specs, embeddings, base_url, chosen, sleep, household)
    cacheable = any(not backend.reads_variables and backend.past is None for backend in backends.values())
    replies = ReplyCache(cache, shared) if cache is not None and cacheable else None
    return Door(prompts=prompts, backends=backends, seed=seed, cache=replies, meter=meter, settings=chosen, root=root)


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture to be shown to a model."""

    name: str
    mime: str
    data: bytes


@dataclass(slots=True)
class _Talk:
    """One call as it goes: what was said so far, and what it took."""

    rendered: Rendered
    backend: Backend
    schema: dict[str, Any]
    messages: list[BaseMessage] = field(default_factory=list)
    written: list[dict[str, Any]] = field(default_factory=list)
    reply: str = ""
    tokens_in: int = 0
    tokens_out: int = 0
    attempts: int = 0
    cached: int = 0
    faults: list[str] = field(default_factory=list)
    fresh: list[tuple[str, CachedReply]] = field(default_factory=list)

    def fault(self, reason: str) -> None:
        """Note what was wrong with the latest attempt."""
        self.faults.append(f"attempt {self.attempts}: {reason}")

    def bad(self, reason: str, *, more: bool) -> None:
        """Note a reply that cannot be used; if there are more attempts it is shown to the model again."""
        self.fault(reason)
        if more:
            shown = self.reply[:SHOWN] or "(an empty answer)"
            self.messages.append(AIMessage(content=shown))
            self.written.append({"role": "assistant", "content": shown})


@dataclass(slots=True)
class Door:
    """The one door; implements `coopera.core.protocols.Ask`. Threads may call it at the same time."""

    prompts: Prompts
    backends: Mapping[Role, Backend]
    seed: int
    cache: ReplyCache | None = None
    meter: Meter | None = None
    settings: CallSettings = CallSettings()
    root: Path | None = None
    _calls: list[tuple[Address, ModelCall]] = field(init=False, default_factory=list)
    _lock: threading.Lock = field(init=False, default_factory=threading.Lock)

    def __call__(
        self,
        prompt: str,
        reply: type[Reply],
        /,
        *,
        at: Address,
        variables: Mapping[str, Any],
        images: Sequence[Path] = (),
    ) -> Reply:
        """Ask the model of the prompt's role.

        Args:
            prompt: Name of the prompt, such as "human/intention".
            reply: Type of the answer.
            at: Where the call happens; its seed derives from it.
            variables: What the prompt is filled with.
            images: Pictures to show; only for roles whose model `sees`.

        Raises:
            ModelOutputError: If no attempt gave a valid reply.
            ModelCallError: If the model could not be reached, or the server gave no reply at all.
            PromptError: If the prompt cannot be filled.
            BudgetError: If what may be spent is spent.
        """
        rendered = self.prompts.render(prompt, variables)
        backend = self.backends[rendered.role]
        if backend.past is not None:
            return self._relive(backend.past, rendered, reply, at)
        if images and not backend.sees:
            raise ModelCallError(f"{prompt}: the model {backend.name} cannot look at pictures")
        pictures = [self._picture(path) for path in images]
        text = rendered.text if backend.reads_variables else f"{rendered.text}{SCHEMA_FOLLOWS}\n{schema_of(reply)}"
        talk = _Talk(
            rendered, backend, {} if backend.reads_variables else enforced_schema(reply, variables, brief=backend.brief)
        )
        started = time.perf_counter()
        try:
            return self._converse(talk, text, pictures, reply, at, dict(variables))
        except ModelCallError as err:
            talk.fault(str(err))
            raise
        finally:
            self._record(at, talk, time.perf_counter() - started)

    def sees(self, role: Role) -> bool:
        """Whether this role's model looks at pictures itself."""
        return self.backends[role].sees

    def take_calls(self) -> list[ModelCall]:
        """Return the calls made since the last time, and forget them.

        Nodes come in the order of their first calls. Within a node calls come in the order of their draws, since
        parallel calls end in any order.
        """
        with self._lock:
            calls, self._calls = self._calls, []
        first: dict[tuple[object, ...], int] = {}
        for n, (at, _) in enumerate(calls):
            first.setdefault(at[:4], n)
        return [call for at, call in sorted(calls, key=lambda entry: (first[entry[0][:4]], entry[0].draw))]

    def close(self) -> None:
        """Close the cache file, if there is one."""
        if self.cache is not None:
            self.cache.close()

    def _relive(self, past: Past, rendered: Rendered, reply: type[Reply], at: Address) -> Reply:
        """Answer as it was answered in an earlier run, well or badly."""
        call = past.find(rendered.name, rendered.text, at)
        with self._lock:
            self._calls.append((at, call))
        try:
            return read_reply(call.reply, reply)
        except BadReplyError as err:
            reason = call.faults[-1].partition(": ")[2] if call.faults else str(err)
            raise ModelOutputError(rendered.name, call.reply, reason) from err

    def _converse(
        self,
        talk: _Talk,
        text: str,
        pictures: list[Picture],
        reply: type[Reply],
        at: Address,
        variables: dict[str, Any],
    ) -> Reply:
        """Ask until an answer is valid, showing the model what was wrong with the one before."""
        name, reason = talk.rendered.name, ""
        for attempt in range(self.settings.attempts):
            talk.attempts = attempt + 1
            seed = seed_at(self.seed, *at, name, *([attempt] if attempt else []))
            if attempt == 0:
                self._say(talk, text, pictures, variables, seed)
            else:
                self._say(talk, _AGAIN.format(reason=reason), [], variables, seed)
            answer = self._send(talk, seed, pictures)
            talk.reply = answer.text
            try:
                valid = read_reply(answer.text, reply)
            except BadReplyError as err:
                reason = f"it was cut off at the length limit; {err}" if answer.cut else str(err)
                talk.bad(reason, more=attempt + 1 < self.settings.attempts)
                continue
            last = attempt + 1 == self.settings.attempts
            if stray := "; ".join(strays(valid.model_dump(), talk.schema)[:STRAYS]):
                reason = stray
                talk.bad(reason, more=not last)
                if not last:
                    continue
            if answer.cut:
                talk.fault("the reply reached the length limit and ends early, though it can be used")
            if self.cache is not None:
                self.cache.put(talk.fresh)
            return valid
        raise ModelOutputError(name, talk.reply, reason)

    def _say(self, talk: _Talk, text: str, pictures: list[Picture], variables: dict[str, Any], seed: int) -> None:
        extra: dict[str, Any] = {}
        if talk.backend.reads_variables:
            temperature = talk.rendered.temperature
            told = {"prompt": talk.rendered.name, "variables": variables, "seed": seed, "temperature": temperature}
            extra = {"additional_kwargs": {"coopera": told}}
        shown = [{"type": "image", "base64": base64.b64encode(p.data).decode(), "mime_type": p.mime} for p in pictures]
        content: Any = [*shown, {"type": "text", "text": text}] if shown else text
        talk.messages.append(HumanMessage(content=content, **extra))
        names = {"images": [p.name for p in pictures]} if pictures else {}
        talk.written.append({"role": "user", "content": text, **names})

    def _send(self, talk: _Talk, seed: int, pictures: list[Picture]) -> CachedReply:
        """Get one answer, from the cache or from the model.

        Raises:
            ModelCallError: If the model could not be reached, or its server gave no reply at all.
        """
        backend, temperature = talk.backend, talk.rendered.temperature
        key = None
        if self.cache is not None and not backend.reads_variables:
            said = [[m["role"], m["content"]] for m in talk.written]
            form = [temperature, self.settings.max_tokens, self.settings.structure, talk.schema]
            key = key_of(f"{backend} {backend.weights}", said, [p.data for p in pictures], form, seed)
        answer = self.cache.get(key) if self.cache is not None and key is not None else None
        if answer is not None:
            talk.cached += 1
        else:
            request = Request(
                talk.messages,
                temperature=temperature,
                seed=seed % SEEDS,
                max_tokens=self.settings.max_tokens,
                schema=talk.schema,
                name=talk.rendered.reply,
            )
            if self.meter is not None:
                self.meter.begin()
            try:
                answer = backend.ask(request, talk.fault)
            except ModelCallError as err:
                raise type(err)(f"{talk.rendered.name}: {backend} cannot be asked: {err}") from err
            if self.meter is not None:
                self.meter.end(answer.tokens_in + answer.tokens_out)
            if key is not None:
                talk.fresh.append((key, answer))
        talk.tokens_in += answer.tokens_in
        talk.tokens_out += answer.tokens_out
        return answer

    def _record(self, at: Address, talk: _Talk, seconds: float) -> None:
        call = ModelCall(
            node=at.node,
            prompt=talk.rendered.name,
            prompt_sha=talk.rendered.sha,
            model=talk.backend.name,
            messages=talk.written,
            reply=talk.reply,
            seconds=round(seconds, 6),
            tokens_in=talk.tokens_in,
            tokens_out=talk.tokens_out,
            attempts=max(1, talk.attempts),
            cached=0 < talk.attempts == talk.cached,
            faults=talk.faults,
        )
        with self._lock:
            self._calls.append((at, call))

    def _picture(self, path: Path) -> Picture:
        mime = _PICTURES.get(path.suffix.lower())
        if mime is None:
            raise RunError(f"{path}: a picture for a model must end in one of {', '.join(_PICTURES)}")
        inside = self.root is not None and path.is_relative_to(self.root)
        name = path.relative_to(self.root).as_posix() if self.root is not None and inside else path.name
        try:
            return Picture(name, mime, path.read_bytes())
        except OSError as err:
            raise RunError(f"{path}: the picture cannot be read: {err.strerror}") from err
