"""Decoding that cannot leave a JSON schema: at each step only tokens that keep the reply valid can be drawn.

llguidance says which tokens are valid, and which are the only ones: signs and names of fields need no model. A reply
near the length limit is closed by the shortest way. So even a model without knowledge, or without an end, answers
with valid JSON.
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import torch
from llguidance import LLMatcher, LLTokenizer
from llguidance.hf import from_tokenizer
from transformers import LogitsProcessor

from coopera.core.errors import ModelCallError
from coopera.models.small.free_text import FreeText, nucleus
from coopera.models.small.manner import PLAIN, Manner

_COMPILED = 256  # schemas kept: one differs from another by the objects that it names
_ESCAPES = 'nt"\\'  # no \uXXXX: half a surrogate pair would be no text
_CLOSERS = (b'"', b"}", b"]", b",")
"""What to draw near the limit, first choice first: end the text, the object, the list; of numbers, the number."""
_SLACK = 8
_FREE = 0.25  # a text is free where at least this share of all tokens may come next


class Grammars:
    """A tokenizer's view of schemas; compiled ones are kept."""

    def __init__(self, tokenizer: Any, vocabulary: int, ends: Sequence[int]) -> None:
        """Read a Hugging Face tokenizer (about a second for 128,000 tokens).

        Raises:
            ValueError: If it is a slow tokenizer, for which nothing can be constrained.
        """
        size = max(vocabulary, len(tokenizer))
        self._tokenizer: LLTokenizer = from_tokenizer(tokenizer, n_vocab=size, eos_token=list(ends))
        self._compiled: dict[str, LLMatcher] = {}
        pieces = [self._tokenizer.tokenize_bytes(closer) for closer in _CLOSERS]
        self.closers = [ids[0] for ids in pieces if len(ids) == 1]
        words = tokenizer.convert_ids_to_tokens(range(len(tokenizer)))
        self.quotes = frozenset(token for token, word in enumerate(words) if word and '"' in word)

    def matcher(self, schema: Mapping[str, Any]) -> LLMatcher:
        """A fresh matcher at the start of a reply.

        Raises:
            ModelCallError: If the schema cannot be compiled.
        """
        text = json.dumps(schema, ensure_ascii=False)
        if text not in self._compiled:
            grammar = LLMatcher.grammar_from_json_schema(
                text,
                overrides={
                    "whitespace_flexible": False,
                    "item_separator": ", ",
                    "key_separator": ": ",
                    "json_allowed_escapes": _ESCAPES,
                },
            )
            made = LLMatcher(self._tokenizer, grammar, log_level=0)
            if made.is_error():
                raise ModelCallError(f"the reply's schema cannot be enforced: {' '.join(made.get_error().split())}")
            if len(self._compiled) >= _COMPILED:
                self._compiled.pop(next(iter(self._compiled)))
            self._compiled[text] = made
        return self._compiled[text].deep_copy()


class HeldReply:
    """One reply of a batch as it grows."""

    def __init__(
        self, *, temperature: float, seed: int, limit: int, ends: Sequence[int], manner: Manner = PLAIN
    ) -> None:
        """Start a reply of at most `limit` tokens; a temperature of 0 takes the likeliest token."""
        self.temperature = temperature
        self.limit = limit
        self.closed = False
        self._ends = list(ends)
        self._noise = torch.Generator().manual_seed(seed)
        self._matcher: LLMatcher | None = None
        self._closers: Sequence[int] = ()
        self._reserve = 0
        self._drawn = 0
        self._done = False
        self._manner = manner
        self._text = FreeText(manner, frozenset())
        self._forced: deque[int] = deque()

    @property
    def done(self) -> bool:
        """Whether the reply has ended."""
        return self._done

    def hold_to(self, grammars: Grammars, schema: Mapping[str, Any], room: int) -> None:
        """Keep the reply to a schema; the limit is raised, up to `room`, to what the shortest reply may need."""
        self._matcher, self._closers = grammars.matcher(schema), grammars.closers
        self._reserve = shortest(schema, schema.get("$defs", {})) + _SLACK
        self.limit = min(max(self.limit, self._reserve), room)
        self._text = FreeText(self._manner, grammars.quotes)
        self._foresee(self._matcher)

    def forced(self) -> list[int]:
        """The next tokens as far as nothing else may come: they need no scores, and count as drawn."""
        taken = [self._forced.popleft() for _ in range(min(len(self._forced), self.limit - self._drawn))]
        self._drawn += len(taken)
        self._done = self._done or self._drawn >= self.limit
        return taken

    def draw(self, scores: torch.Tensor) -> int:
        """Choose the next token from scores of shape (V,)."""
        if self._done:
            return self._ends[0]
        if self._drawn >= self.limit:
            return self._end()
        if self._forced:
            self._drawn += 1
            return self._forced.popleft()
        free = True
        if self._matcher is not None:
            scores, free = self._allowed(self._matcher, scores)
        token = self._sample(scores, free=free)
        self._drawn += 1
        if token in self._ends:
            return self._end(token)
        self._text.add(token, free=free)
        if self._matcher is not None:
            if not self._matcher.consume_token(token):
                raise ModelCallError(f"constrained decoding lost its way: {self._matcher.get_error()}")
            self._foresee(self._matcher)
        return token

    def _foresee(self, matcher: LLMatcher) -> None:
        """Take along the tokens that must come next."""
        ahead = matcher.compute_ff_tokens()
        if ahead and matcher.consume_tokens(ahead):
            self._forced.extend(ahead)
            self._text.end()

    def _end(self, token: int | None = None) -> int:
        self._done = True
        return self._ends[0] if token is None else token

    def _allowed(self, matcher: LLMatcher, scores: torch.Tensor) -> tuple[torch.Tensor, bool]:
        """Scores that leave only what may come next, and whether that is free text."""
        bits = np.unpackbits(np.frombuffer(matcher.compute_bitmask(), np.uint8), bitorder="little")[: len(scores)]
        if self.limit - self._drawn <= self._reserve and not matcher.is_accepting():
            closer = next((token for token in self._closers if bits[token]), None)
            if closer is not None:
                self.closed = True
                bits = np.zeros_like(bits)
                bits[closer] = 1
        mask = torch.from_numpy(bits).to(scores.device, torch.bool)
        if len(mask) < len(scores):
            mask = torch.nn.functional.pad(mask, (0, len(scores) - len(mask)))
        return scores.masked_fill(~mask, -torch.inf), bool(bits.sum() >= _FREE * len(bits))

    def _sample(self, scores: torch.Tensor, *, free: bool) -> int:
        """Invert the cumulative distribution at one seeded number; no global random state is used."""
        temperature, manner = self.temperature, self._manner if free else PLAIN
        if manner != PLAIN:
            held = self._text.held_back(scores)
            scores = held if bool((held > -torch.inf).any()) else scores
            temperature = max(temperature, manner.least_temperature)
        if temperature == 0:
            return int(scores.argmax())
        shares = torch.softmax(scores.to(torch.float64) / temperature, dim=-1)
        shares = (shares if manner.top_p == 1.0 else nucleus(shares, manner.top_p)).cumsum(dim=-1)
        point = torch.rand((), generator=self._noise, dtype=torch.float64).to(shares.device) * shares[-1]
        return min(int(torch.searchsorted(shares, point, right=True)), _last(shares))


class Drawing(LogitsProcessor):
    """Chooses each row's next token, so that `generate` only has to take the highest score."""

    def __init__(self, rows: Sequence[HeldReply]) -> None:
        """Draw for the rows of one batch, in order."""
        self._rows = rows

    def __call__(self, input_ids: torch.Tensor, scores: torch.Tensor) -> torch.Tensor:
        """Return scores of shape (B, V) that are 0 at each row's token and -inf elsewhere."""
        chosen = torch.full_like(scores, -torch.inf)
        for n, row in enumerate(self._rows):
            chosen[n, row.draw(scores[n])] = 0.0
        return chosen


def shortest(schema: Mapping[str, Any], definitions: Mapping[str, Any]) -> int:
    """Bound the bytes of the shortest reply that fits a schema, wherever it is broken off.

    A token is a byte at least. An enumeration counts by its longest value, since it may have been begun.
    """
    if "$ref" in schema:
        return shortest(definitions[schema["$ref"].rpartition("/")[2]], definitions)
    if "const" in schema or "enum" in schema:
        values: list[object] = schema.get("enum", [schema.get("const")])
        return max(len(json.dumps(value).encode()) for value in values)
    if options := [*schema.get("anyOf", ()), *schema.get("oneOf", ())]:
        return max(shortest(option, definitions) for option in options)
    kind = schema.get("type")
    if kind == "object":
        return 2 + sum(len(json.dumps(name)) + 4 + length for name, length in _fields(schema, definitions))
    if kind == "array":
        return 2 + max(1, int(schema.get("minItems", 0))) * (2 + shortest(schema["items"], definitions))
    return 8 + 4 * int(schema.get("minLength", 0))


def _fields(schema: Mapping[str, Any], definitions: Mapping[str, Any]) -> Iterator[tuple[str, int]]:
    for name, part in schema["properties"].items():
        yield name, shortest(part, definitions)


def _last(reached: torch.Tensor) -> int:
    """The last token that may be drawn at all, given cumulative shares; rounding must not lead beyond it."""
    return int(torch.searchsorted(reached, reached[-1]))
