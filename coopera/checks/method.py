"""Does a method keep to the rules? A test that anybody can run on theirs, in the shipped home with the shipped people.

>>> from coopera import check_method
>>> from coopera.evaluation import METHODS
>>> check_method(METHODS["random"], collabs=(2,), hours=1)
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

from coopera.checks.leaks import alike, check_no_leak, decided, reached
from coopera.config.at_most import VARIABLE
from coopera.config.schema import Config
from coopera.core.errors import ConfigError, ConformanceError, CooperaError
from coopera.core.hour import CandidateKind, DayAccount, DayPlan, FeedbackItem, HourAccount, HourRecord
from coopera.core.household import Collab
from coopera.core.people import Belief
from coopera.evaluation.methods import METHODS, register
from coopera.graphs import Method, Services, build_day_graph, first_day
from coopera.graphs.day import DayInput
from coopera.graphs.robots.learning import account_of
from coopera.rundir.directory import RunDir
from coopera.studies.assemble import open_services
from coopera.studies.catalogues import resolve
from coopera.studies.study import new_run, plan_days

_HANDED_ON = ("worlds", "beliefs", "learned")


def check_method(method: Method, *, collabs: Sequence[Collab] = (1, 2), hours: int = 2) -> None:
    """Run a method for two short days and check what makes its results worth comparing.

    Every hour is scored and every candidate has a verdict of the right kind. The same seed gives the same results when
    the run is stopped between the days, and within the second, and goes on with a new robot. Evenings with no hours,
    without any readable answer, and with nothing but yes or no are learned from without harm. In two lives that look
    alike the method gets the same and does the same, unless it declares that it is given the truth.

    Args:
        method: With a robot; its other parts are the classifier `kernel` and the offline model.
        collabs: Collaboration types to check.
        hours: Hours of each day.

    Raises:
        ConformanceError: Naming the rule that is broken.
        CooperaError: What the method itself raised.
    """
    before = dict(METHODS)
    register(method)
    try:
        for collab in collabs:
            with tempfile.TemporaryDirectory() as folder:
                config = Config(days=2, hours=hours, collab=collab, method=method.name, pictures="none")
                _check(resolve(config.model_copy(update={"out": Path(folder) / "whole"})))
    finally:
        METHODS.clear()
        METHODS.update(before)


def _check(config: Config) -> None:
    assert config.out is not None
    name = f"method {config.method}, collaboration type {config.collab}"
    days = plan_days(config)
    if len(days) < 2:
        raise ConfigError(f"{VARIABLE}: a method is checked on two days; leave days out of it, or give days=2.")
    with new_run(config) as (run, services):
        _live(services, days[0], then=days[1])
        whole = run.hours()
        _check_odd_evenings(services, days, name)
    for hour in whole:
        _check_hour(hour, name)
    stopped = config.model_copy(update={"out": config.out.parent / "stopped"})
    with new_run(stopped) as (_, services):
        state = _live(services, days[0])
    with _reopened(cast(Path, stopped.out)) as (run, services):
        next(_first_hour(services, days[1], state))
    with _reopened(cast(Path, stopped.out)) as (run, services):
        _live(services, days[1], after=state)
        again = run.hours()
    for one, two in zip(whole, again, strict=True):
        if (what := _difference(one, two)) is not None:
            raise ConformanceError(
                f"{name}: a run that was stopped and went on must equal one that was not, and {what} differs on day "
                f"{one.day} at {one.hour}:00. Keep what is learned in save and load, or let learn alone decide it; "
                "draw from coopera.core.randomness."
            )
    if not METHODS[config.method].told_the_truth:
        _check_leaks(config, name)


def _check_leaks(config: Config, name: str) -> None:
    """Compare two lives that look alike, of two days of two hours each."""
    assert config.out is not None
    short = config.model_copy(update={"hours": 2})
    days = plan_days(short)
    with new_run(short.model_copy(update={"out": config.out.parent / "decided"})) as (_, services):
        usual = decided(services, days)
    found = []
    for life, hidden in (("one", usual), ("other", alike(usual))):
        with new_run(short.model_copy(update={"out": config.out.parent / life})) as (_, services):
            found.append(reached(services, days, usual, hidden))
    one, other = found
    check_no_leak(one, other, name)


def _live(services: Services, plan: DayPlan, *, after: DayInput | None = None, then: DayPlan | None = None) -> DayInput:
    """Live a day, and perhaps the next; returns what that hands on."""
    given = _start(plan, after)
    done = build_day_graph().invoke(given, context=services)
    handed = cast(DayInput, {"plan": plan, **{key: done[key] for key in _HANDED_ON}})
    return handed if then is None else _live(services, then, after=handed)


def _first_hour(services: Services, plan: DayPlan, after: DayInput) -> Iterator[Any]:
    """Yield once a day's first hour is done; the rest of the day is never lived."""
    for update in build_day_graph().stream(_start(plan, after), context=services, stream_mode="updates"):
        if "hour" in update:
            yield update


def _start(plan: DayPlan, after: DayInput | None) -> DayInput:
    return first_day(plan) if after is None else cast(DayInput, {**after, "plan": plan})


@contextmanager
def _reopened(root: Path) -> Iterator[tuple[RunDir, Services]]:
    """Open a stopped run as another process would."""
    with RunDir.resume(root) as run, open_services(run.config, run, run.people()) as services:
        yield run, services


def _check_hour(hour: HourRecord, name: str) -> None:
    where = f"{name}: day {hour.day} at {hour.hour}:00"
    if hour.status != "ok" or hour.robot is None:
        raise ConformanceError(f"{where} failed: {hour.reason}")
    for text, accepted in [
        *((c.text, c.accepted) for c in hour.robot.intentions),
        *((t.act.describe(), t.accepted) for t in hour.robot.tasks),
    ]:
        if accepted is None:
            raise ConformanceError(f'{where}: "{text}" has no verdict.')


def _difference(one: HourRecord, two: HourRecord) -> str | None:
    """Name the first part of the robot's hour that differs."""
    if one.robot is None or two.robot is None:
        return None if one.robot is two.robot else "whether the robot took part"
    parts = ("recalled", "intentions", "tasks", "outcomes", "fallbacks")
    return next((part for part in parts if getattr(one.robot, part) != getattr(two.robot, part)), None)


def _check_odd_evenings(services: Services, days: Sequence[DayPlan], name: str) -> None:
    """Teach evenings that real people give now and then."""
    if not services.method.learns:
        return
    plan = days[0]
    usual = account_of(plan, services.recorder.read_day(plan.day), [], Belief())
    odd: dict[str, DayAccount] = {
        "without any hour": usual.model_copy(update={"hours": []}),
        "without a readable answer": _answered(usual, None),
        "with nothing but yes": _answered(usual, True),
        "with nothing but no": _answered(usual, False),
    }
    for what, account in odd.items():
        services.pupil.be_at([])
        try:
            services.pupil.learn(plan.day, [], account)
        except (CooperaError, ValueError, ArithmeticError, LookupError) as err:
            raise ConformanceError(f"{name}: an evening {what} must be learned from without harm: {err}") from err


def _answered(account: DayAccount, yes: bool | None) -> DayAccount:
    """The same day with one answer to everything."""

    def answers(hour: HourAccount) -> list[FeedbackItem]:
        asked: list[tuple[CandidateKind, str, bool | None]] = [
            ("intention", c.text, c.accepted) for c in hour.robot.intentions
        ]
        asked += [("task", t.act.describe(), t.accepted) for t in hour.robot.tasks]
        return [
            FeedbackItem(hour=hour.hour, kind=kind, text=text, accepted=bool(accepted), helpful=yes)
            for kind, text, accepted in asked
        ]

    return account.model_copy(update={"hours": [h.model_copy(update={"feedback": answers(h)}) for h in account.hours]})
