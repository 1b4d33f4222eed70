"""What success of an hour is counted in: confusion counts, the effect of the help, and all measures together."""

from __future__ import annotations

from typing import TypeAlias

from pydantic import ConfigDict, Field

from coopera.core.people import Frozen, is_empty

Figure: TypeAlias = int | float | list[bool | None] | None
"""What a measure keeps of an hour under a name."""


class Counts(Frozen):
    """A confusion count over one task superset; `unscored` candidates are in none of the others.

    f1, precision and recall are None where nothing could be scored. PAPER §4.3: accepted tasks are predicted positives.
    `verdicts` says of each candidate of one hour, in the robot's order, whether it was right; None is unscored. Added
    up over hours there are none.
    """

    tp: int = Field(0, ge=0)
    fp: int = Field(0, ge=0)
    fn: int = Field(0, ge=0)
    tn: int = Field(0, ge=0)
    unscored: int = Field(0, ge=0)
    f1: float | None = None
    precision: float | None = None
    recall: float | None = None
    verdicts: list[bool | None] = Field([], exclude_if=is_empty)


class Help(Frozen):
    """The effect of the robot's help by the predicate, whatever the robot proposed.

    Attributes:
        remaining: Number of the person's tasks after the first.
        helped: Number of these tasks with help by an act of the robot.
        accepted: Number of the acts that the robot accepted, failed ones included.
        done: Number of the robot's successful acts.
        useless: Number of successful acts without help for any task.
        metres: The robot's way, failed acts included.
        saved_metres: The robot's way for acts with help for a new task; a second act for the same task saves nothing.
    """

    remaining: int = Field(0, ge=0)
    helped: int = Field(0, ge=0)
    accepted: int = Field(0, ge=0)
    done: int = Field(0, ge=0)
    useless: int = Field(0, ge=0)
    metres: float = Field(0.0, ge=0)
    saved_metres: float = Field(0.0, ge=0)


class Success(Frozen):
    """The hour's success by each measure; `help` is None in traces of before it was measured.

    A measure that asks a language model may come in the evening (`coopera.evaluation.success`): until then `judge` is
    None, and a further measure is not there. The figures of further measures stand beside these, each under its own
    name (`coopera.evaluation.measuring`).
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, dict[str, Figure]] = Field(init=False)

    predicate: Counts
    judge: Counts | None = None
    help: Help | None = None

    def of(self, measure: str) -> Counts | Help | dict[str, Figure] | None:
        """The figures by a measure; None where it was not taken."""
        shipped = {"predicate": self.predicate, "judge": self.judge, "help": self.help}
        return shipped[measure] if measure in shipped else self.__pydantic_extra__.get(measure)
