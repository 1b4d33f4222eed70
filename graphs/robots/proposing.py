"""Which told hours an hour's proposals rest on, how many tasks are imagined, and what speaks for each of them."""

from __future__ import annotations

from collections.abc import Sequence

from typing_extensions import TypedDict

from coopera.core.hour import IntentionCandidate, TaskCandidate
from coopera.core.household import use_of
from coopera.core.replies import ImaginedIntention
from coopera.graphs.robots.evidence import of_intentions, of_task
from coopera.graphs.robots.method import Method, Numbers
from coopera.graphs.robots.robot_view import RobotView
from coopera.graphs.robots.told import ToldHour, best_hours, held, same, shares, uses_of

WORTH_A_TRY = 0.15
"""The share of like told hours from which a thing adds to the number of tasks that are imagined."""


class Imagined(TypedDict):
    """The tasks imagined for one accepted intention."""

    rank: int
    tasks: list[TaskCandidate]
    weights: list[float]  # how much each told hour counts for it


def most_telling(method: Method, told: Sequence[ToldHour]) -> list[tuple[ToldHour, float]]:
    """The told hours that looked most like this one; none where the prompts go without."""
    weights = [hour.speaks for hour in told]
    return best_hours(told, weights, Numbers.TOLD_HOURS["intention"]) if method.told else []


def like_hours(method: Method, told: Sequence[ToldHour], weights: Sequence[float]) -> list[tuple[ToldHour, float]]:
    """The told hours of intentions like one of now; none where the prompts go without."""
    return best_hours(told, weights, Numbers.TOLD_HOURS["task"]) if method.told else []


def evidence_of(
    method: Method, told: Sequence[ToldHour], alike: Sequence[Sequence[float]], replies: Sequence[ImaginedIntention]
) -> list[dict[str, float]]:
    """What speaks for each imagined intention, given how like each is to those told; nothing where nobody counts."""
    if not method.evidence:
        return [{} for _ in replies]
    return of_intentions(told, alike, [item.probability for item in replies])


def how_many(method: Method, view: RobotView, told: Sequence[ToldHour], weights: Sequence[float]) -> int:
    """How many tasks to imagine: the paper's number, or more where more were often told."""
    usual = Numbers.ROBOT_TASKS[view.collab]
    if not method.told:
        return usual
    used = shares(told, weights, held(view.observation), places=view.collab == 1)
    often = sum(one >= WORTH_A_TRY for one in used.values())
    return min(max(usual, often), Numbers.MOST_TASKS[view.collab])


def superset_of(method: Method, view: RobotView, imagined: Sequence[Imagined]) -> tuple[list[TaskCandidate], list[str]]:
    """All tasks that can be done, each once and for the likeliest of its intentions, and why others were dropped."""
    found: dict[str, TaskCandidate] = {}
    dropped: list[str] = []
    has = held(view.observation) if method.skips_held else None
    for task in (task for batch in imagined for task in batch["tasks"]):
        said = task.act.describe()
        wrong = view.home.misfit(task.act)
        if not wrong and has and same(use_of(said), has):
            wrong = "The person has it already."
        if wrong:
            dropped.append(f'"{said}" was dropped: {wrong}')
        else:
            found.setdefault(said, task)
    return list(found.values()), dropped


def with_evidence(
    view: RobotView,
    told: Sequence[ToldHour],
    intentions: Sequence[IntentionCandidate],
    imagined: Sequence[Imagined],
    superset: Sequence[TaskCandidate],
) -> list[TaskCandidate]:
    """The tasks with what speaks for each, over all intentions that tasks were imagined for."""
    chance = {one.text: one.probability or 0.0 for one in intentions}
    of = {batch["tasks"][0].intention: batch["weights"] for batch in imagined if batch["tasks"]}
    weighed, texts, uses = [(chance[text], weights) for text, weights in of.items()], list(of), uses_of(told)
    looked, near = [hour.speaks for hour in told], [hour.near for hour in told]
    found = [
        of_task(task.act, uses, looked, near, weighed, texts.index(task.intention), view.collab) for task in superset
    ]
    return [task.model_copy(update={"evidence": one}) for task, one in zip(superset, found, strict=True)]
