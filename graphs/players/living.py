"""How people live, whoever plays them: whether things last, whether they leave the home, and what becomes different."""

from __future__ import annotations

from dataclasses import dataclass

from coopera.graphs.players.changes import Changes, no_changes


@dataclass(frozen=True, slots=True)
class Living:
    """A way of living; as it stands here, the paper's.

    Attributes:
        lasting: Whether an intention may go on for hours; else each hour has one of its own (PAPER §3.2).
        absence: Whether people are away from home at times; those hours have neither tasks nor a robot.
        remembers_days: Whether people know what they did on earlier days; else only what they did today (PAPER §3.2).
        changes: What is different for a person on a day of theirs.
    """

    lasting: bool = False
    absence: bool = False
    remembers_days: bool = False
    changes: Changes = no_changes
