"""The one door to language models: prompt name and variables in, a validated reply out, and a record of the call.

Every call renders a prompt file, says which JSON is wanted, reads the answer leniently in form and strictly in meaning,
shows the model what is wrong with a bad one and asks again, a bounded number of times. Nothing else in coopera touches
a chat model.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from langchain_core.embeddings import Embeddings

from coopera.core.asks import ASKS
from coopera.core.errors import ModelCallError, ModelOutputError, RunError
from coopera.core.hour import ModelCall
from coopera.core.protocols import Prompts, Rendered, Reply, Role
from coopera.core.randomness import Address, seed_at
from coopera.models.asking import Answer, Backend, Request
from coopera.models.backends import open_backends
from coopera.models.budget import Meter
from coopera.models.cache import CachedReply, ReplyCache, key_of
from coopera.models.given import Chosen
from coopera.models.parsing import BadReplyError, Wanted, read_reply
from coopera.models.recorded import Past
from coopera.models.servers.tokens import TOKENS
from coopera.models.servers.waiting import Check, go_on
from coopera.models.settings import OWN, CallSettings, Structure
from coopera.models.talk import Picture, Talk, Turn

SEEDS = 2**31  # servers take seeds of 31 bits
_AGAIN = "This answer cannot be used: {reason}.\nAnswer again with one whole JSON object, put right, and nothing else."
_ORDER = {prompt: n for n, prompt in enumerate(ASKS)}
_PICTURES = {".webp": "image/webp", ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}


def open_door(  # noqa: PLR0913 - one parameter for each thing that a run decides
    *,
    prompts: Prompts,
    seed: int,
    embeddings: Embeddings,
    model: Chosen | Mapping[Role, Chosen] = "offline",
    base_url: str | None = None,
    cache: Path | None = None,
    shared: Path | None = None,
    meter: Meter | None = None,
    settings: CallSettings | None = None,
    check: Check = go_on,
    root: Path | None = None,
    household: str = OWN,
) -> Door:
    """Open the models of all roles, and the door before them.

    Args:
        prompts: The prompt folder.
        seed: The run's seed; each call's seed derives from it and the call's address.
        embeddings: What the offline model compares texts with.
        model: The model of all roles, or of each; one is a spec (`coopera.models.backends`) or a chat model of
            LangChain. A role that is not there is played by the offline model.
        base_url: Where an OpenAI-compatible server listens.
        cache: SQLite file of replies by content; None keeps none. The offline model is faster than any cache.
        shared: Another such file, which runs have in common: looked into where the first has no answer.
        meter: Counts what is spent; without it nothing is counted.
        settings: How models are called.
        check: Called while one waits for a server; raises where the run is asked to stop.
        root: The run directory, relative to which the record names pictures; without it, by their file names.
        household: What an offline robot and judge know of life at home: `own`, `shared` or a file.

    Raises:
        ConfigError: If a model cannot be opened.
    """
    chosen = settings or CallSettings()
    backends = open_backends(model, embeddings, base_url, chosen, check, household)
    cacheable = any(not backend.reads_variables and backend.past is None for backend in backends.values())
    replies = ReplyCache(cache, shared) if cache is not None and cacheable else None
    seed = seed_at(seed, "sample", chosen.sample) if chosen.sample else seed
    return Door(prompts=prompts, backends=backends, seed=seed, cache=replies, meter=meter, settings=chosen, root=root)


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
            return self._relive(backend.past, rendered, Wanted(reply, variables), at)
        if images and not backend.sees:
            raise ModelCallError(f"{prompt}: the model {backend.name} cannot look at pictures")
        pictures = [self._picture(path) for path in images]
        wanted = Wanted(reply, variables, held=not backend.reads_variables, brief=backend.brief)
        talk = Talk(rendered, backend, wanted, self.settings, at, way=backend.structure)
        started = time.perf_counter()
        try:
            return self._converse(talk, pictures, wanted, at)
        except ModelCallError as err:
            talk.fault(str(err))
            raise
        finally:
            self._record(at, talk, time.perf_counter() - started)

    def sees(self, role: Role) -> bool:
        """Whether this role's model looks at pictures itself."""
        return self.backends[role].sees

    def instant(self, role: Role) -> bool:
        """Whether this role's model answers in this process, from variables; a recorded one is as it was then."""
        backend = self.backends[role]
        return backend.reads_variables if backend.past is None else backend.past.was_instant(role)

    def take_calls(self, at: Address | None = None) -> list[ModelCall]:
        """Return the calls made since the last time, or only those made at an address, and forget them.

        They come by the hour, then in the order of `ASKS` and of their draws, since parallel calls end in any order.
        """
        with self._lock:
            taken = [entry for entry in self._calls if at is None or entry[0] == at]
            self._calls = [entry for entry in self._calls if at is not None and entry[0] != at]
        return [call for _, call in sorted(taken, key=_place)]

    def close(self) -> None:
        """Close the cache file, if there is one."""
        if self.cache is not None:
            self.cache.close()

    def _relive(self, past: Past, rendered: Rendered, wanted: Wanted[Reply], at: Address) -> Reply:
        """Answer as it was answered in an earlier run, well or badly."""
        call = past.find(rendered.name, rendered.text, at)
        with self._lock:
            self._calls.append((at, call))
        try:
            return read_reply(call.reply, wanted).reply
        except BadReplyError as err:
            reason = call.faults[-1].partition(": ")[2] if call.faults else str(err)
            raise ModelOutputError(rendered.name, call.reply, reason) from err

    def _converse(self, talk: Talk, pictures: list[Picture], wanted: Wanted[Reply], at: Address) -> Reply:
        """Ask until an answer is valid, showing the model what was wrong with the one before."""
        name, reason = talk.rendered.name, ""
        for attempt in range(self.settings.attempts):
            talk.attempts = attempt + 1
            last = talk.attempts == self.settings.attempts
            seed = seed_at(self.seed, *at, name, *([attempt] if attempt else []))
            if attempt == 0:
                talk.turns.append(Turn(talk.rendered.text, seed, pictures))
            else:
                talk.turns.append(Turn(_AGAIN.format(reason=reason), seed))
            answer = self._send(talk, seed)
            talk.reply = answer.text
            unseen = not talk.shows_schema(talk.way)
            try:
                read = read_reply(answer.text, wanted)
            except BadReplyError as err:
                reason = f"it was cut off at the length limit; {err}" if answer.cut else str(err)
                talk.bad(reason, more=not last)
                if unseen and not answer.cut:
                    talk.shown = True
                    talk.backend.notice(kept=False)
                continue
            if unseen:
                talk.backend.notice(kept=True)
            if read.strays:
                reason = read.strays
                talk.bad(reason, more=not last)
                if not last:
                    continue
            if answer.cut:
                talk.fault("the reply reached the length limit and ends early, though it can be used")
            talk.leniencies |= read.leniencies
            if self.cache is not None:
                self.cache.put(talk.fresh)
            return read.reply
        raise ModelOutputError(name, talk.reply, reason)

    def _send(self, talk: Talk, seed: int) -> CachedReply:
        """Get one answer, from the cache or from the model.

        Raises:
            ModelCallError: If the model could not be reached, or its server gave no reply at all.
        """
        found = self._remembered(talk, seed)
        if found is not None:
            talk.cached += 1
        else:
            found = self._ask(talk, seed)
        answer, talk.way = found.reply, found.structure
        if found.estimated:
            talk.leniencies[TOKENS] = talk.leniencies.get(TOKENS, 0) + found.estimated
        talk.tokens_in += answer.tokens_in
        talk.tokens_out += answer.tokens_out
        return answer

    def _remembered(self, talk: Talk, seed: int) -> Answer | None:
        """The answer that the cache has, however the model was held to the schema, or shown it at first, for it."""
        if self.cache is None or talk.backend.reads_variables:
            return None
        chosen = talk.shown
        for shown in (chosen, not chosen) if len(talk.turns) == 1 else (chosen,):
            talk.shown = shown
            for structure in talk.backend.ways:
                reply = self.cache.get(self._key(talk, structure, seed))
                if reply is not None:
                    return Answer(reply, structure)
        talk.shown = chosen
        return None

    def _ask(self, talk: Talk, seed: int) -> Answer:
        request = Request(
            talk.messages,
            temperature=talk.rendered.temperature,
            seed=seed % SEEDS,
            max_tokens=self.settings.max_tokens,
            schema=talk.wanted.enforced,
            name=talk.rendered.reply,
            traced=talk.traced(),
        )
        if self.meter is not None:
            self.meter.begin()
        try:
            answer = talk.backend.ask(request, talk.fault)
        except ModelCallError as err:
            raise type(err)(f"{talk.rendered.name}: {talk.backend} cannot be asked: {err}") from err
        if self.meter is not None:
            self.meter.end(talk.backend.name, answer.reply.tokens_in, answer.reply.tokens_out)
        if self.cache is not None and not talk.backend.reads_variables:
            talk.fresh.append((self._key(talk, answer.structure, seed), answer.reply))
        return answer

    def _key(self, talk: Talk, structure: Structure, seed: int) -> str:
        """What tells an answer from all others in the cache."""
        roles = ["assistant" if turn.seed is None else "user" for turn in talk.turns]
        said = [list(turn) for turn in zip(roles, talk.texts(structure), strict=True)]
        seen = [picture.data for turn in talk.turns for picture in turn.pictures]
        chosen = [self.settings.max_tokens, self.settings.structure, structure]
        form = [talk.rendered.temperature, *chosen, talk.wanted.enforced]
        return key_of(f"{talk.backend} {talk.backend.weights}", said, seen, form, seed)

    def _record(self, at: Address, talk: Talk, seconds: float) -> None:
        call = ModelCall(
            node=at.node,
            prompt=talk.rendered.name,
            prompt_sha=talk.rendered.sha,
            model=talk.backend.name,
            messages=talk.written(talk.way),
            reply=talk.reply,
            seconds=round(seconds, 6),
            tokens_in=talk.tokens_in,
            tokens_out=talk.tokens_out,
            attempts=max(1, talk.attempts),
            cached=0 < talk.attempts == talk.cached,
            faults=talk.faults,
            leniencies=talk.leniencies,
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


def _place(entry: tuple[Address, ModelCall]) -> tuple[int, int, int]:
    """The place of a call among those of a day."""
    at, call = entry
    return at.hour, _ORDER.get(call.prompt, len(_ORDER)), at.draw
