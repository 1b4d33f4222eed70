"""Two runs side by side: what they were run with, their figures, every hour of both, and one hour of both in full."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from markupsafe import Markup

from coopera.core.hour import HourRecord, ModelCall
from coopera.evaluation.measures.help import Need
from coopera.report.changes import marked
from coopera.report.hours import CandidateView, HourView, TaskView
from coopera.rundir.directory import RunDir
from coopera.web.view.desk import Desk
from coopera.web.view.hour import read_hour
from coopera.web.view.lines import Line, f1_of, need_of
from coopera.web.view.shelf import Shelved

MOST_MARKED = 40_000
"""Characters of a prompt that are compared with another's."""
_OF_THE_RUN = {"out", "data_dir", "cache", "earlier_life", "files", "budget", "schedule"}


class Side(NamedTuple):
    """One of the two runs with its figures."""

    entry: Shelved
    need: Need
    f1: float | None
    judged: float | None
    hours: int
    failed: int
    tokens: int
    seconds: float


class Row(NamedTuple):
    """An hour of both runs."""

    day: int
    hour: int
    left: Line | None
    right: Line | None

    @property
    def label(self) -> str:
        """The hour in words."""
        return (self.left or self.right or Line(self.day, self.hour)).label

    @property
    def same(self) -> bool:
        """Whether the person was up to the same in both."""
        return bool(self.left and self.right and self.left.intention == self.right.intention)

    @property
    def gap(self) -> float | None:
        """How much more of the person's tasks the second helped with, as a share; None where one has no figure."""
        shares = [_share(line) for line in (self.left, self.right)]
        return None if shares[0] is None or shares[1] is None else shares[1] - shares[0]

    @property
    def flags(self) -> str:
        """What the row can be filtered by."""
        names = ["better"] if (self.gap or 0) > 0 else ["worse"] if (self.gap or 0) < 0 else []
        names += [] if self.same else ["other"]
        return " ".join([*names, *(["lone"] if self.left is None or self.right is None else [])])


class Both(NamedTuple):
    """A candidate of both robots, or of one: an intention, or a task."""

    text: str
    left: CandidateView | TaskView | None
    right: CandidateView | TaskView | None

    @property
    def differs(self) -> bool:
        """Whether only one has it, or one accepted it and the other did not."""
        return self.left is None or self.right is None or _accepted(self.left) != _accepted(self.right)


class Asked(NamedTuple):
    """A model call of both runs: the prompt of one against that of the other, and the replies."""

    node: str
    left: ModelCall | None
    right: ModelCall | None
    prompt: Markup | None
    reply: Markup | None


def page(desk: Desk, left: Shelved, right: Shelved) -> dict[str, Any]:
    """What two runs side by side show."""
    lines = [{(line.day, line.hour): line for line in desk.lines_of(one)} for one in (left, right)]
    rows = [Row(*key, lines[0].get(key), lines[1].get(key)) for key in sorted({*lines[0], *lines[1]})]
    days: dict[int, list[Row]] = {}
    for row in rows:
        days.setdefault(row.day, []).append(row)
    return {
        "sides": [_side(one, list(of.values())) for one, of in zip((left, right), lines, strict=True)],
        "days": days,
        "rows": rows,
        "differing": _differing(desk, left, right),
        "need_by_day": {
            day: [need_of([one for one in of if one]).f1 for of in _columns(some)] for day, some in days.items()
        },
        "counts": Counter(name for row in rows for name in row.flags.split()),
    }


def hour_page(desk: Desk, left: Shelved, right: Shelved, day: int, hour: int) -> dict[str, Any] | None:
    """What an hour of both runs shows; None where neither has it."""
    lines = [desk.lines_of(one) for one in (left, right)]
    found = [next((one for one in some if (one.day, one.hour) == (day, hour)), None) for some in lines]
    if not any(found):
        return None
    problems: list[str] = []
    views: list[HourView | None] = []
    homes: list[Markup] = []
    for entry, some, line in zip((left, right), lines, found, strict=True):
        run, problem = desk.opened(entry)
        problems += [problem] if problem else []
        view, home = read_hour(run, some, line, problems) if run and line else (None, None)
        views.append(view)
        homes += [home] if home is not None else []
    order = [(one.day, one.hour) for one in sorted({(a.day, a.hour): a for b in lines for a in b}.values(), key=_place)]
    at = order.index((day, hour))
    return {
        "entries": (left, right),
        "there": [one is not None for one in found],
        "day": day,
        "hour": hour,
        "line": found[0] or found[1],
        "views": views,
        "homes": list(dict.fromkeys(homes)),
        "problems": problems,
        "intentions": _candidates(views),
        "asked": _asked([view.record if view else None for view in views]),
        "before": order[at - 1] if at else None,
        "after": order[at + 1] if at + 1 < len(order) else None,
        "person_same": _same_person(views),
    }


def _place(line: Line) -> tuple[int, int]:
    return line.day, line.hour


def _columns(rows: Sequence[Row]) -> tuple[list[Line | None], list[Line | None]]:
    return [row.left for row in rows], [row.right for row in rows]


def _side(entry: Shelved, lines: Sequence[Line]) -> Side:
    return Side(
        entry=entry,
        need=need_of(lines),
        f1=f1_of([line.counts for line in lines]),
        judged=f1_of([line.judged for line in lines]),
        hours=len(lines),
        failed=sum(line.state == "failed" for line in lines),
        tokens=sum(line.tokens for line in lines),
        seconds=sum(line.seconds for line in lines),
    )


def _share(line: Line | None) -> float | None:
    given = line.help if line else None
    return given.helped / given.remaining if given and given.remaining else None


def _differing(desk: Desk, left: Shelved, right: Shelved) -> list[tuple[str, str, str]]:
    """What the two were run with that is not the same: settings, models, and prompts of other wording."""
    runs = [desk.opened(one)[0] for one in (left, right)]
    told = [_told(run) if run else {} for run in runs]
    names = dict.fromkeys([*told[0], *told[1]])
    return [(name, a, b) for name in names if (a := told[0].get(name, "–")) != (b := told[1].get(name, "–"))]


def _told(run: RunDir) -> dict[str, str]:
    found = dict(_flat(run.config.model_dump(mode="json", exclude=_OF_THE_RUN), ""))
    found |= {f"prompt {name}": str(sha)[:12] for name, sha in run.info.get("prompts", {}).items()}
    return found | {f"version of {name}": str(one) for name, one in run.info.get("versions", {}).items()}


def _flat(data: Mapping[str, Any], head: str) -> list[tuple[str, str]]:
    found: list[tuple[str, str]] = []
    for name, value in data.items():
        found += _flat(value, f"{head}{name}.") if isinstance(value, Mapping) else [(f"{head}{name}", str(value))]
    return found


def _same_person(views: Sequence[HourView | None]) -> bool:
    """Whether the person wanted and did the very same in both."""
    one, other = (view.record.human if view else None for view in views)
    return bool(one and other and one.intention.text == other.intention.text and one.tasks == other.tasks)


def _candidates(views: Sequence[HourView | None]) -> list[tuple[Both, list[Both]]]:
    """The intentions of both robots in the order of the first, each with the tasks of both."""
    sides = [{one.candidate.text: one for one in view.candidates} if view else {} for view in views]
    found = []
    for text in dict.fromkeys([*sides[0], *sides[1]]):
        pair = [side.get(text) for side in sides]
        tasks = [{one.task.act.describe(): one for one in guess.tasks} if guess else {} for guess in pair]
        names = dict.fromkeys([*tasks[0], *tasks[1]])
        both = [Both(name, tasks[0].get(name), tasks[1].get(name)) for name in names]
        found.append((Both(text, pair[0], pair[1]), both))
    return found


def _accepted(one: CandidateView | TaskView) -> bool | None:
    return one.candidate.accepted if isinstance(one, CandidateView) else one.task.accepted


def _asked(records: Sequence[HourRecord | None]) -> list[Asked]:
    """The calls of both in order, each with its like: the same node and prompt, asked for the same time in the hour."""
    sides = [_numbered(record.calls) if record else {} for record in records]
    found = []
    for key in dict.fromkeys([*sides[0], *sides[1]]):
        one, other = (side.get(key) for side in sides)
        texts = [_text(call) for call in (one, other) if call]
        prompt = marked(*texts) if len(texts) == 2 and texts[0] != texts[1] else None
        reply = (
            marked(one.reply[:MOST_MARKED], other.reply[:MOST_MARKED])
            if one and other and one.reply != other.reply
            else None
        )
        found.append(Asked(key[0], one, other, prompt, reply))
    return found


def _numbered(calls: Sequence[ModelCall]) -> dict[tuple[str, str, int], ModelCall]:
    seen: Counter[tuple[str, str]] = Counter()
    found = {}
    for call in calls:
        place = (call.node, call.prompt)
        found[*place, seen[place]] = call
        seen[place] += 1
    return found


def _text(call: ModelCall) -> str:
    return "\n\n".join(str(one.get("content", "")) for one in call.messages)[:MOST_MARKED]
