"""Success tells a robot that answers well from one that answers in the right form and badly: nobody judges blindly."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from coopera import Config, run_study
from coopera.config.schema import Models
from coopera.evaluation.measuring import told_in_the_evening
from coopera.evaluation.robot.differences import Offer, offers_of, patterns_of
from coopera.models.settings import CallSettings
from coopera.rundir.directory import RunDir
from tests.roles import roles

Lived = dict[str, RunDir]


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory, data_dir: Path) -> Lived:
    """The same person's day of two hours, once with each robot; judged by the same judge, both behind a server."""
    folder, runs = tmp_path_factory.mktemp("robots"), {}
    with roles() as url:
        for name in ("good", "bad"):
            run_study(
                Config(
                    models=Models(human="offline", robot=f"openai:{name}", judge="openai:judge"),
                    base_url=url,
                    calls=CallSettings(timeout=5.0, backoff=0.01, max_tokens=2000),
                    **{"hours": 2, "days": 1, "pictures": "none", "out": folder / name, "data_dir": data_dir},
                )
            )
            runs[name] = RunDir.open(folder / name)
    return runs


def day_of(run: RunDir) -> dict[str, Any]:
    (day,) = run.summary()["days"]
    return day


def offers(run: RunDir) -> list[Offer]:
    return offers_of(told_in_the_evening(run.hours(), run.evenings()))


def test_both_robots_answered_in_the_right_form(lived: Lived) -> None:
    for run in lived.values():
        summary = run.summary()
        assert (summary["failed_hours"], summary["judge_unscored"], summary["calls_with_faults"]) == (0, 0, 0)
        assert any(offer.accepted for offer in offers(run)), "it was its own offers that were judged"


def test_the_judge_finds_the_good_robot_clearly_better(lived: Lived) -> None:
    good, bad = (day_of(lived[name])["judge"] for name in ("good", "bad"))
    assert good["tp"] > 0 == bad["tp"]
    assert good["precision"] >= bad["precision"] + 0.3
    assert good["f1"] >= (bad["f1"] or 0.0) + 0.3


def test_the_person_and_the_matchers_agree_with_the_judge_about_which_is_better(lived: Lived) -> None:
    good, bad = day_of(lived["good"]), day_of(lived["bad"])
    for measure in ("people", "predicate", "similar"):
        assert good[measure]["tp"] > bad[measure]["tp"], measure
    assert good["need"]["f1"] > bad["need"]["f1"]


def test_the_judges_verdicts_are_about_each_offer(lived: Lived) -> None:
    said = [offer.said["judge"] for offer in offers(lived["good"])]
    assert {True, False} == set(said), "neither all yes nor all no"
    assert {offer.said["judge"] for offer in offers(lived["bad"])} == {False}


def test_what_the_measures_differ_about_can_be_named(lived: Lived) -> None:
    found = [offer for pattern in patterns_of(offers(lived["good"])) for offer in pattern.offers]
    assert found
    assert all(offer.wanted and offer.offer.startswith("bring the ") for offer in found)
    assert patterns_of(offers(lived["bad"])) == []
