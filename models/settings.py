"""How models are called: patience, pace, and how their replies are held to their form. Nothing here names a model."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from coopera.core.people import Frozen

Seconds = Annotated[float, Field(gt=0, le=86_400, allow_inf_nan=False)]
Structure: TypeAlias = Literal["auto", "json_schema", "tools", "json_object", "text"]


class CallSettings(Frozen):
    """How models are called.

    Attributes:
        timeout: Seconds that one request may take.
        retries: How often a request that failed on its way is sent again.
        backoff: Seconds before the first of these; each next pause is twice as long. A server's Retry-After is obeyed
            where it asks for more.
        max_pause: The longest pause in seconds; a server that asks for more is given up.
        per_minute: Requests that may be begun in a minute; None sets no limit.
        at_once: Requests that may be under way at the same time, over all studies of this process.
        attempts: Answers asked for before a bad one is an error; the model is shown what was wrong with the last.
        max_tokens: Most tokens of one reply.
        structure: How a server is held to the reply's form; auto takes the first that it does not refuse of
            json_schema, tools and text (the prompt alone).
        device: Where weights of this process go; auto takes a GPU if there is one.
        dtype: Their number format; auto takes the repository's own on a GPU, else float32.
        batch: Most prompts that a model of this process answers together. None is 16 on a GPU and 1 elsewhere, where
            nothing is gained by more, and a reply's bits then do not depend on its neighbours.
    """

    timeout: Seconds = 120.0
    retries: Annotated[int, Field(strict=True, ge=0, le=20)] = 5
    backoff: Seconds = 1.0
    max_pause: Seconds = 120.0
    per_minute: Annotated[int, Field(strict=True, ge=1, le=1_000_000)] | None = None
    at_once: Annotated[int, Field(strict=True, ge=1, le=1024)] = 16
    attempts: Annotated[int, Field(strict=True, ge=1, le=10)] = 3
    max_tokens: Annotated[int, Field(strict=True, ge=64, le=1_000_000)] = 2048
    structure: Structure = "auto"
    device: Annotated[str, Field(pattern=r"^(auto|cpu|mps|cuda(:\d+)?)$")] = "auto"
    dtype: Literal["auto", "float32", "bfloat16", "float16"] = "auto"
    batch: Annotated[int, Field(strict=True, ge=1, le=256)] | None = None


class Budget(Frozen):
    """What a run may spend before it stops, to be resumed with more; None sets no limit."""

    calls: Annotated[int, Field(strict=True, ge=1)] | None = None
    tokens: Annotated[int, Field(strict=True, ge=1)] | None = None


class Spent(Frozen):
    """What models were asked for, prompts and replies together, without what came from a cache."""

    calls: int = 0
    tokens: int = 0
