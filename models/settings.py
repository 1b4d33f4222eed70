"""How models are called: patience, pace, and how their replies are held to their form. Nothing here names a model."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from coopera.core.people import Frozen
from coopera.core.setting import Setting
from coopera.models.servers.saying import LOGIN
from coopera.models.small.manner import PLAIN, Manner

OWN, SHARED = "own", "shared"
"""Household files that the setting `household` names by a word: the robot's own, and the person's."""
Seconds = Annotated[float, Field(gt=0, le=86_400, allow_inf_nan=False)]
Count = Annotated[int, Field(strict=True, ge=1)]
Structure: TypeAlias = Literal["auto", "json_schema", "tools", "json_object", "text"]
_SECONDS = "a number of seconds above 0"
ADDRESS = r"^https?://[^\s@?#]+$"
"""A server's address: nothing in it is secret, since it stands in files and messages."""
AN_ADDRESS = (
    "an address such as http://localhost:8000/v1, without user and password (the environment variable "
    f"{LOGIN} takes them, as USER:PASSWORD) and without ? and #"
)


class CallSettings(Frozen):
    """How models are called."""

    timeout: Annotated[Seconds, Setting("Seconds that one request may take, to its last byte.", _SECONDS)] = 120.0
    retries: Annotated[
        int,
        Field(strict=True, ge=0, le=20),
        Setting("How often a request that failed on its way is sent again."),
    ] = 5
    backoff: Annotated[
        Seconds,
        Setting(
            "Seconds before a request is sent again; each next pause is twice as long, or what the server asks for.",
            _SECONDS,
        ),
    ] = 1.0
    max_pause: Annotated[
        Seconds, Setting("Longest pause in seconds; a server that asks for more is given up.", _SECONDS)
    ] = 120.0
    per_minute: Annotated[
        Annotated[int, Field(strict=True, ge=1, le=1_000_000)] | None,
        Setting(
            "Requests that may be begun in a minute.", "a whole number of requests from 1 to 1000000", unset="no limit"
        ),
    ] = None
    at_once: Annotated[
        int,
        Field(strict=True, ge=1, le=1024),
        Setting("Requests that may be under way at the same time, over all studies of this process."),
    ] = 16
    attempts: Annotated[
        int,
        Field(strict=True, ge=1, le=10),
        Setting("Answers asked for before a bad one is an error; the model is shown what was wrong with the last."),
    ] = 3
    sample: Annotated[
        int,
        Field(strict=True, ge=0, le=1_000_000),
        Setting("Which of repeated samples: another number asks for all replies anew, with nothing else changed."),
    ] = 0
    max_tokens: Annotated[int, Field(strict=True, ge=64, le=1_000_000), Setting("Most tokens of one reply.")] = 2048
    max_bytes: Annotated[
        int,
        Field(strict=True, ge=1024, le=1_000_000_000),
        Setting("Most bytes of a server's answer to one request; a longer one is broken off."),
    ] = 1_000_000
    structure: Annotated[
        Structure,
        Setting(
            "How a server is held to the reply's form; auto takes the first that it does not refuse of json_schema, "
            "tools and text (the prompt alone)."
        ),
    ] = "auto"
    show_schema: Annotated[
        Literal["auto", "always", "never"],
        Setting(
            "Whether prompts end with the reply's JSON schema; auto leaves it out where the server, or the decoder of "
            "this process, holds replies to it."
        ),
    ] = "auto"
    device: Annotated[
        str,
        Field(pattern=r"^(auto|cpu|mps|cuda(:\d+)?)$"),
        Setting(
            "Where weights of this process go; auto takes a GPU if there is one.", "auto, cpu, mps, cuda or cuda:N"
        ),
    ] = "auto"
    dtype: Annotated[
        Literal["auto", "float32", "bfloat16", "float16"],
        Setting("Number format of these weights; auto takes the repository's own on a GPU, else float32."),
    ] = "auto"
    batch: Annotated[
        Annotated[int, Field(strict=True, ge=1, le=256)] | None,
        Setting(
            "Most prompts that a model of this process answers together; with 1, no reply's bits depend on others.",
            unset="16 on a GPU, else 1",
        ),
    ] = None
    brief: Annotated[
        Annotated[bool, Field(strict=True)] | None,
        Setting(
            "Replies that are held to a schema have no reasons, and short texts.",
            "true or false",
            unset="false; true for smol",
        ),
    ] = None
    least_temperature: Annotated[
        Annotated[float, Field(ge=0, le=2, allow_inf_nan=False)] | None,
        Setting(
            "Temperature at which weights of this process draw free text, where the prompt's own is lower.",
            "a number from 0 to 2",
            unset="0; 0.7 for smol",
        ),
    ] = None
    top_p: Annotated[
        Annotated[float, Field(gt=0, le=1, allow_inf_nan=False)] | None,
        Setting(
            "These weights draw free text from the likeliest tokens that together have this share.",
            "a number above 0, at most 1",
            unset="1; 0.9 for smol",
        ),
    ] = None
    repetition_penalty: Annotated[
        Annotated[float, Field(ge=1, le=10, allow_inf_nan=False)] | None,
        Setting(
            "What these weights' logits of tokens that a reply's free text has said are divided by.",
            "a number from 1 to 10",
            unset="1; 1.15 for smol",
        ),
    ] = None
    no_repeat: Annotated[
        Annotated[int, Field(strict=True, ge=0, le=64)] | None,
        Setting(
            "So many tokens in a row are not said twice in a reply's free text; 0 allows it.",
            unset="0; 4 for smol",
        ),
    ] = None

    def manner(self, otherwise: Manner = PLAIN) -> Manner:
        """How free text is drawn: as said here, and where nothing is said in the model's own manner."""
        given = {name: value for name in Manner._fields if (value := getattr(self, name)) is not None}
        return otherwise._replace(**given)


class Budget(Frozen):
    """What a run may spend before it stops, to be resumed with more."""

    calls: Annotated[
        Count | None,
        Setting("Stop, to be resumed, after N calls to models.", flag="--budget-calls", unset="no limit"),
    ] = None
    tokens: Annotated[
        Count | None,
        Setting("Stop, to be resumed, after N tokens.", flag="--budget-tokens", unset="no limit"),
    ] = None
    money: Annotated[
        Annotated[float, Field(gt=0, allow_inf_nan=False)] | None,
        Setting(
            "Stop, to be resumed, after so much money, in the currency of `prices`.",
            "a number above 0",
            flag="--budget-money",
            unset="no limit",
        ),
    ] = None
    prices: Annotated[
        Path | None,
        Setting(
            "What models cost, by a million tokens (docs/models.md): the run then says what it has cost.",
            "the path of a file of prices",
            flag="--prices",
            metavar="FILE",
            unset="no money is counted",
        ),
    ] = None


class Spent(Frozen):
    """What models were asked for, prompts and replies together, without what came from a cache."""

    calls: int = 0
    tokens: int = 0
    money: float = 0.0

    def at_least(self, other: Spent) -> Spent:
        """The larger of the two, figure by figure."""
        return Spent(
            calls=max(self.calls, other.calls),
            tokens=max(self.tokens, other.tokens),
            money=max(self.money, other.money),
        )
