"""A run's recorded calls in place of its models: the same questions get the same answers, and the same trace."""

from __future__ import annotations

from collections import defaultdict, deque
from pathlib import Path

from coopera.core.asks import ASKS
from coopera.core.errors import ConfigError, ModelCallError
from coopera.core.foreign.files import read_json
from coopera.core.hour import ModelCall
from coopera.core.protocols import Role
from coopera.core.randomness import Address

ASKED_FOR = "\n\nAnswer with one JSON object and nothing else."
"""What the door writes after a prompt, and before the schema of its reply where that is shown."""

PREFIXES = ("recorded", "replay")
"""What a spec of this kind begins with; `replay` is the older word."""

_Key = tuple[str, int, str, str, str]


def recorded_run(spec: str) -> Path | None:
    """The run that a model's spec names to answer from its record, if it names one."""
    kind, _, folder = spec.partition(":")
    return Path(folder) if kind in PREFIXES else None


class Past:
    """The calls of a run, found by person, day, node, prompt and what the prompt said."""

    def __init__(self, run: Path) -> None:
        """Read a run's trace.

        Raises:
            ConfigError: If there is none, or it is damaged.
        """
        self._run = run
        self._calls: dict[_Key, deque[ModelCall]] = defaultdict(deque)
        self._seeing: set[Role] = set()
        self._instant: set[Role] = set()
        files = [path for path in sorted((run / "trace").glob("day-*/*.json")) if path.stem != "seal"]
        if not files:
            raise ConfigError(f"the model recorded:{run} cannot be opened: this folder holds no run with a trace")
        for path in files:
            try:
                record = read_json(path)
                person, day = str(record["person"]), int(record["episode_day"])
                calls = [ModelCall.model_validate(call) for call in record["calls"]]
                roles = [ASKS[call.prompt].role for call in calls]
                texts = [str(call.messages[0]["content"]).partition(ASKED_FOR)[0] for call in calls]
            except (ConfigError, ValueError, LookupError, TypeError, OverflowError) as err:
                raise ConfigError(f"the model recorded:{run} cannot be opened: {path} is damaged") from err
            for call, role, said in zip(calls, roles, texts, strict=True):
                self._calls[person, day, call.node, call.prompt, said].append(call)
                if call.messages[0].get("images"):
                    self._seeing.add(role)
                if path.stem.startswith("hour") and not call.late:
                    self._instant.add(role)

    def sees(self, role: Role) -> bool:
        """Whether a role's model looked at pictures."""
        return role in self._seeing

    def was_instant(self, role: Role) -> bool:
        """Whether a role's model was asked in an hour itself, and not in the evening, which may be missing yet."""
        return role in self._instant

    def find(self, prompt: str, text: str, at: Address) -> ModelCall:
        """The record of a call; of several alike, each in its turn.

        Raises:
            ModelCallError: If there was none.
        """
        alike = self._calls.get((at.person, at.day, at.node, prompt, text))
        if not alike:
            raise ModelCallError(
                f"{prompt}: the run {self._run} never asked this (day {at.day}, {at.hour}:00, {at.node}); it can only "
                "answer for the same people, homes, prompts, seed and program"
            )
        alike.rotate(-1)
        return alike[-1].model_copy(update={"seconds": 0.0})
