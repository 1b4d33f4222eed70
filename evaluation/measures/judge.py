"""Success by the judge: a language model, told the truth, says which candidates help (PAPER §4.3)."""

from __future__ import annotations

from dataclasses import replace

from coopera.core.errors import ModelOutputError
from coopera.core.replies import VerdictsReply
from coopera.evaluation.measuring import MeasuredHour, by_counts


def _verdicts(hour: MeasuredHour) -> list[bool | None]:
    """Ask about all candidates at once; a reply that cannot be read leaves all of them unscored."""
    if not hour.candidates:
        return []
    unread: list[bool | None] = [None] * len(hour.candidates)
    try:
        reply = hour.ask(
            "judge/tasks",
            VerdictsReply,
            at=hour.at,
            variables={
                "time": f"{hour.at.hour}:00",
                "intention": hour.intention.text,
                "tasks": [{"id": t.id, "thought": t.thought, "text": t.act.describe()} for t in hour.remaining],
                "offers": [{"thought": c.thought, "text": c.act.describe()} for c in hour.candidates],
            },
        )
    except ModelOutputError:
        return unread
    verdicts: list[bool | None] = [verdict.yes for verdict in reply.verdicts]
    return verdicts if len(verdicts) == len(hour.candidates) else unread


MEASURE = replace(
    by_counts(
        "judge",
        "F1 over the robot's candidates; a language model that knows the truth says which of them help",
        _verdicts,
        short="judge",
        order=2,
    ),
    asks="judge",
)
