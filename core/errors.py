"""Every error that coopera raises on purpose.

Each class answers one decision of its caller; the command line turns `ConfigError` into
exit code 2 (the input is wrong) and every other `CooperaError` into 1 (the work failed).
"""

from __future__ import annotations

import warnings
from typing import Any

LONGEST = 2000
"""Characters of an error's text."""


class CooperaError(Exception):
    """Root of all errors that coopera raises on purpose; its text is one clear sentence.

    What a file holds may stand in it, so that it is shown on one line, and a long one without its middle.
    """

    def __str__(self) -> str:
        """Return the sentence, of at most `LONGEST` characters, on one line."""
        text = " ".join(super().__str__().splitlines())
        return text if len(text) <= LONGEST else f"{text[: LONGEST - 300]} … {text[-290:]}"

    def __reduce__(self) -> tuple[Any, ...]:
        """Cross to another process whole, whatever the constructor of the class asks for."""
        return _rebuilt, (type(self), self.args, self.__dict__)


def _rebuilt(kind: type[CooperaError], args: tuple[Any, ...], attributes: dict[str, Any]) -> CooperaError:
    err = kind.__new__(kind, *args)
    err.__dict__.update(attributes)
    return err


class ConfigError(CooperaError):
    """The input is wrong: the text names the file or flag, the field and what was expected."""


class PromptError(ConfigError):
    """A prompt file cannot be used: the text names the file and, where known, the line."""


class ModelCallError(CooperaError):
    """A language model could not be reached or refused to answer after bounded retries."""


class HourError(CooperaError):
    """An hour cannot be lived to its end; it is recorded as failed, with this sentence, and the day goes on."""


class ModelOutputError(HourError):
    """A language model answered, but not with what the prompt asks for, after bounded repairs.

    The hour that needed the reply is unscored, never counted as a "no".

    Attributes:
        prompt: Name of the prompt, such as `robot/intentions`.
        reply: The last raw reply.
    """

    def __init__(self, prompt: str, reply: str, reason: str) -> None:
        """Keep the evidence beside the sentence."""
        super().__init__(f"{prompt}: the model's reply cannot be used: {reason}")
        self.prompt = prompt
        self.reply = reply


class BudgetError(CooperaError):
    """What the run may spend on models is spent; it stops, and goes on when it is resumed with a larger budget."""


class MemoryStoreError(CooperaError):
    """A memory store is damaged, locked by another process, or of another kind than asked for."""


class SimulationError(CooperaError):
    """The world cannot do what was asked of it; a failed grasp or walk is an `Outcome`, not this."""


class LearningError(CooperaError):
    """A classifier could not learn from an evening; what it knew before is kept, and the run goes on."""


class WaitingError(CooperaError):
    """A run waits for a real person's answer; it is stopped, not failed, and resuming it asks again."""


class ConformanceError(CooperaError):
    """A method breaks a rule; the text says which, and where it showed."""


class RunError(CooperaError):
    """A run directory cannot be written, continued or read."""


class StoppedError(RunError):
    """A run was told to end, by Ctrl-C or `kill`; it is stopped, not failed, and resuming it goes on."""


class OldWordWarning(FutureWarning):
    """An old word was used; its text is one sentence for the person who used it."""


def deprecated(old: str, new: str, gone: str) -> None:
    """Warn that a word goes.

    Args:
        old: The word that was used, such as "--who".
        new: What takes its place.
        gone: The version in which the old word is no longer known.
    """
    warnings.warn(f"{old} is deprecated and goes in version {gone}: use {new}.", OldWordWarning, stacklevel=3)
