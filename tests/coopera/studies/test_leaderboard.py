"""Boards rank what can be ranked, and their keeper can check a submission on seeds that nobody else knows."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from coopera.benchmark.checked import (
    Check,
    compare_hidden,
    hidden_seeds,
    read_check,
    read_secret,
    write_check,
)
from coopera.benchmark.leaderboard import entries
from coopera.benchmark.recheck import plan_again
from coopera.core.errors import ConfigError
from coopera.evaluation.results import Card, Row, to_csv
from tests.coopera.conftest import Said
from tests.evaluation.test_results import card, life

MARKS = {name: name * 8 for name in ("person", "judge", "household", "robot", "prompts", "code")}
SECRET = b"known to the keeper alone"


def rows(gain: int = 0, *, seeds: tuple[int, ...] = (0, 1), method: str = "ours") -> list[Row]:
    """Three people, three days of one hour; by the seed one task more is helped or not."""
    return [
        one.model_copy(update={"seed": seed, "episode": episode, "human": f"{one.human}{seed}"})
        for seed in seeds
        for episode, who in enumerate(("amara", "bruno", "chen"))
        for one in life(method, who, 0, 1 + gain, 1 + gain + seed % 2)
    ]


def submit(folder: Path, table: list[Row], **over: Any) -> Card:
    folder.mkdir(parents=True)
    models = {"human": "offline", "judge": "offline", "robot": "offline"}
    made = Card.model_validate(
        card(table, name=folder.name, models=models, seeds=[0, 1])
        | {"fingerprints": MARKS | over.pop("marks", {}), "config": {}}
        | over
    )
    (folder / "hours.csv").write_text(to_csv(table))
    (folder / "results.json").write_text(made.model_dump_json())
    return made


def rankings(folder: Path) -> list[list[str]]:
    found = entries(folder)
    return [[one.results for one in found if one.terms == terms] for terms in dict.fromkeys(one.terms for one in found)]


def test_one_person_one_judge_one_household_and_one_model_make_a_ranking(tmp_path: Path) -> None:
    submit(tmp_path / "a", rows())
    submit(tmp_path / "b", rows(1), marks={"code": "other", "prompts": "other"})
    assert rankings(tmp_path) == [["b", "a"]]


@pytest.mark.parametrize(
    "over",
    [
        {"marks": {"person": "other"}},
        {"marks": {"judge": "other"}},
        {"marks": {"household": "other"}},
        {"models": {"human": "offline", "judge": "offline", "robot": "openai:a-model"}},
        {"grid": {"late_days": 1}},
    ],
)
def test_what_is_of_another_model_household_or_endpoint_is_ranked_apart(tmp_path: Path, over: dict[str, Any]) -> None:
    submit(tmp_path / "a", rows())
    submit(tmp_path / "b", rows(1), **over)
    assert sorted(rankings(tmp_path)) == [["a"], ["b"]]


def test_shared_common_sense_is_another_household(tmp_path: Path) -> None:
    submit(tmp_path / "a", [*rows(), *rows(1, method="ours+shared")])
    found = {one.method: one.terms.household for one in entries(tmp_path)}
    assert found == {"ours": "own (househol)", "ours+shared": "shared"}


def test_results_of_before_fingerprints_are_ranked_among_themselves(tmp_path: Path) -> None:
    submit(tmp_path / "a", rows(), fingerprints=None, config=None)
    submit(tmp_path / "b", rows())
    assert sorted(rankings(tmp_path)) == [["a"], ["b"]]


def test_what_is_within_the_noise_of_the_one_before_is_tied(tmp_path: Path) -> None:
    """Seeds make a quarter of a task's difference on the last of two late days; two tasks more are no noise."""
    submit(tmp_path / "a", rows(), name="a")
    noisy = [one.model_copy(update={"helped": 2}) if (one.person, one.day) == ("chen", 2) else one for one in rows()]
    submit(tmp_path / "b", noisy)
    submit(tmp_path / "c", rows(2))
    assert [(one.results, one.tied) for one in entries(tmp_path)] == [("c", False), ("b", False), ("a", True)]


def test_hidden_seeds_follow_from_secret_and_table_and_are_no_seeds_of_the_submission(tmp_path: Path) -> None:
    mine, other = submit(tmp_path / "a", rows()), submit(tmp_path / "b", rows(1))
    seeds = hidden_seeds(SECRET, mine, 3)
    assert seeds == hidden_seeds(SECRET, mine, 3)
    assert len({*seeds, *mine.seeds}) == 5
    assert not {*seeds} & {*hidden_seeds(SECRET, other, 3)}
    assert not {*seeds} & {*hidden_seeds(b"another secret of some length", mine, 3)}


def test_a_submission_that_seeds_bear_out_agrees_and_one_that_they_do_not_differs(tmp_path: Path) -> None:
    table = rows()
    mine = submit(tmp_path / "a", table)
    hidden = submit(tmp_path / "hidden", rows(seeds=(7, 8)), marks={"code": "of the keeper"})
    honest = compare_hidden(mine, table, rows(seeds=(7, 8)), hidden)
    assert (honest.agrees, honest.differ) == (True, ["code"])
    fitted = compare_hidden(mine, rows(2), rows(seeds=(7, 8)), hidden)
    assert not fitted.agrees
    assert fitted.of("ours", "1", 2) == "DIFFERS"


def test_a_check_is_the_keepers_and_of_one_table(tmp_path: Path) -> None:
    table = rows()
    mine = submit(tmp_path / "a", table)
    check = compare_hidden(mine, table, rows(seeds=(7, 8)), submit(tmp_path / "hidden", rows(seeds=(7, 8))))
    path = write_check(tmp_path / "a", check, SECRET)
    assert not {str(seed) for seed in hidden_seeds(SECRET, mine, 2)} & set(path.read_text().split())
    found = read_check(tmp_path / "a", mine.sha256, SECRET)
    assert isinstance(found, Check)
    assert found.compared == check.compared
    with pytest.raises(ConfigError, match="was not made with this secret"):
        read_check(tmp_path / "a", mine.sha256, b"another secret of some length")
    with pytest.raises(ConfigError, match="of another table"):
        read_check(tmp_path / "a", "0" * 64)
    better = json.loads(path.read_text())
    better["compared"][0]["submitted"] = 0.9
    path.write_text(json.dumps(better))
    with pytest.raises(ConfigError, match="was not made with this secret"):
        entries(tmp_path, SECRET)


def test_the_board_says_who_was_checked(tmp_path: Path, coopera: Callable[..., Said]) -> None:
    table = rows()
    mine = submit(tmp_path / "board" / "a", table)
    hidden = submit(tmp_path / "hidden", rows(seeds=(7, 8)))
    write_check(tmp_path / "board" / "a", compare_hidden(mine, table, rows(seeds=(7, 8)), hidden), SECRET)
    submit(tmp_path / "board" / "b", rows(2))
    (tmp_path / "secret").write_bytes(SECRET)
    said = coopera("leaderboard", tmp_path / "board", "--secret", tmp_path / "secret").out
    assert "household own (househol)" in said
    assert [line.split()[1] for line in said.splitlines() if " agrees " in line] == ["a"]
    assert "agrees (claimed)" in coopera("leaderboard", tmp_path / "board").out
    said = coopera("leaderboard", tmp_path / "board", "--json").json
    assert [(one["results"], one["hidden"]) for one in said] == [("b", "not checked"), ("a", "agrees")]


def test_a_secret_that_could_be_guessed_is_refused(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("1234")
    with pytest.raises(ConfigError, match="4 bytes, and must have 16 or more"):
        read_secret(tmp_path / "secret")
    with pytest.raises(ConfigError, match="the secret cannot be read"):
        read_secret(tmp_path / "nowhere")


def test_a_submission_is_planned_again_as_its_card_says(tmp_path: Path, data_dir: Path) -> None:
    grid = {"methods": ["ours"], "humans": ["amara", "bruno", "chen"], "scenes": ["maple"], "days": 3, "hours": 1}
    table = rows()
    mine = submit(tmp_path / "a", table, grid=grid, config={"intentions": "hourly", "pictures": "none"})
    flags = {"data_dir": data_dir}
    bench = plan_again(mine, table, tmp_path / "out", SECRET, seeds=2, flags=flags)
    assert {job.config.seed for job in bench.jobs} == {*hidden_seeds(SECRET, mine, 2)}
    assert {job.config.intentions for job in bench.jobs} == {"hourly"}
    assert {job.labels["method"] for job in bench.jobs} == {"none", "ours"}
    others = [one.model_copy(update={"scene": "oak"}) for one in table]
    with pytest.raises(ConfigError, match="is of amara in maple, not of amara in oak"):
        plan_again(mine, others, tmp_path / "out", SECRET, seeds=2, flags=flags)
    old = mine.model_copy(update={"config": None})
    with pytest.raises(ConfigError, match="older than the check"):
        plan_again(old, table, tmp_path / "out", SECRET, seeds=2, flags=flags)
