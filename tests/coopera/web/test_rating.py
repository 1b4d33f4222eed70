"""The rating: blind, balanced, each rater behind an address of their own, and what comes of it."""

from __future__ import annotations

import csv
import json
import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from coopera.core.errors import ConfigError
from coopera.evaluation.rating.planning import Sizes, shown_to
from coopera.evaluation.rating.verified import agreement, verified
from coopera.rundir.directory import RunDir
from coopera.web.common import Door
from coopera.web.rating.app import make_rating_app
from coopera.web.rating.store import Rating
from tests.coopera.conftest import Said

HERE = "http://127.0.0.1:8765"


@pytest.fixture
def rating(tmp_path: Path, small_run: RunDir) -> Rating:
    return Rating.begin(tmp_path / "rating", [small_run.root], Sizes(3, share=2, hours=9, checks=3), seed=4)


def served(rating: Rating) -> tuple[TestClient, dict[str, str]]:
    door = Door()
    return TestClient(make_rating_app(rating, door), base_url=HERE), {"x-form-token": door.form_token}


def test_each_hour_has_its_raters_and_each_rater_as_many_hours_as_the_others(rating: Rating) -> None:
    times = Counter(id for ids in rating.plan.order.values() for id in ids)
    assert set(times.values()) == {2}
    assert [len(ids) for ids in rating.plan.order.values()] == [6, 6, 6]
    assert all(len(set(ids)) == len(ids) for ids in rating.plan.order.values())


def test_every_rater_has_an_order_of_their_own_that_the_seed_decides(
    rating: Rating, tmp_path: Path, small_run: RunDir
) -> None:
    again = Rating.begin(tmp_path / "again", [small_run.root], Sizes(3, share=2, hours=9, checks=3), seed=4)
    assert again.plan.order == rating.plan.order
    assert again.plan.tokens != rating.plan.tokens
    one, other = (shown_to(rating.plan, rater) for rater in ("rater-01", "rater-02"))
    orders = [{unit.id: [item.id for item in unit.items] for unit in units} for units in (one, other)]
    assert any(orders[0][id] != orders[1][id] for id in orders[0].keys() & orders[1].keys())


def test_attention_checks_are_right_and_wrong_in_turns_and_count_for_no_robot(rating: Rating) -> None:
    checks = [item for unit in rating.plan.units for item in unit.items if item.truth is not None]
    assert sorted(item.truth for item in checks if item.truth is not None) == [False, True, True]
    assert all(item.places == [] for item in checks)


def test_a_rater_sees_neither_method_nor_run_nor_what_the_robot_decided(rating: Rating, small_run: RunDir) -> None:
    client, _ = served(rating)
    page = client.get(f"/r/{rating.plan.tokens['rater-01']}").text
    main = page[page.index("<main") :]
    for secret in (small_run.config.method, str(small_run.root), "rater-02", "accepted", "probability", "predicate"):
        assert secret not in main
    first = rating.units("rater-01")[0]
    assert first.intention in main
    assert all(item.text in main for item in first.items)


def test_answers_are_kept_at_once_and_the_address_leads_back_to_the_first_open_hour(rating: Rating) -> None:
    client, headers = served(rating)
    token = rating.plan.tokens["rater-01"]
    first, second = rating.units("rater-01")[:2]
    for item in first.items:
        answer = client.post(f"/r/{token}/say", json={"item": item.id, "said": "yes"}, headers=headers)
    assert answer.json()["answered"] == len(first.items)
    client, headers = served(Rating.open(rating.folder))  # another server, another day
    page = client.get(f"/r/{token}").text
    assert all(item.id in page for item in second.items)
    assert "Hour 2 of 6" in page
    back = client.get(f"/r/{token}?at=0").text
    assert back.count('aria-pressed="true"') == len(first.items)
    client.post(f"/r/{token}/say", json={"item": first.items[0].id, "said": "undo"}, headers=headers)
    assert "Hour 1 of 6" in client.get(f"/r/{token}").text


def test_another_raters_token_and_task_are_refused(rating: Rating) -> None:
    client, headers = served(rating)
    tokens = rating.plan.tokens
    assert client.get("/r/guessed-guessed-guessed").status_code == 403
    mine = {item.id for unit in rating.units("rater-01") for item in unit.items}
    theirs = next(item.id for unit in rating.units("rater-02") for item in unit.items if item.id not in mine)
    for token, item in (("guessed", theirs), (tokens["rater-01"], theirs), (tokens["rater-01"], "../plan")):
        answer = client.post(f"/r/{token}/say", json={"item": item, "said": "yes"}, headers=headers)
        assert answer.status_code == 403
    assert rating.answers() == {rater: {} for rater in tokens}
    sound = {"item": next(iter(mine)), "said": "yes"}
    address = f"/r/{tokens['rater-01']}/say"
    assert client.post(address, json=sound, headers={**headers, "origin": "http://evil.example"}).status_code == 403
    assert client.post(address, json=sound).status_code == 403
    assert client.post(address, json={**sound, "said": "maybe"}, headers=headers).status_code == 400


def test_pictures_are_those_of_the_raters_own_hours(rating: Rating) -> None:
    client, _ = served(rating)
    one, other = rating.plan.tokens["rater-01"], rating.plan.tokens["rater-02"]
    mine = rating.units("rater-01")
    shown = next(unit for unit in mine if unit.frames)
    assert client.get(f"/r/{one}/picture/{shown.id}/0").headers["content-type"] == "image/webp"
    assert client.get(f"/r/{one}/picture/{shown.id}/99").status_code == 404
    foreign = next(unit for unit in mine if unit.id not in rating.plan.order["rater-02"])
    assert client.get(f"/r/{other}/picture/{foreign.id}/0").status_code == 404


def test_hostile_text_of_a_run_is_text(rating: Rating) -> None:
    bad = "<script>alert(1)</script>"
    units = [unit.model_copy(update={"intention": bad, "did": [bad]}) for unit in rating.plan.units]
    client, _ = served(Rating(rating.folder, rating.plan.model_copy(update={"units": units})))
    page = client.get(f"/r/{rating.plan.tokens['rater-01']}").text
    assert bad not in page
    assert "&lt;script&gt;" in page


def test_what_comes_of_it_is_f1_by_the_raters_and_its_distance_from_the_automatic_measures(
    rating: Rating, small_run: RunDir
) -> None:
    hours = {(hour.day, hour.hour): hour for hour in small_run.hours()}

    def record(run: int, day: int, hour: int) -> Any:
        return hours.get((day, hour))

    for rater in rating.plan.order:
        for unit in rating.units(rater):
            for item in unit.items:
                truth = item.truth if item.truth is not None else len(item.text) % 2 == 0
                rating.say(rater, item.id, truth if rater != "rater-03" or item.truth is None else not truth)
    found = verified(rating.plan, record, rating.answers())
    assert found["runs"][0]["hours"] == 9
    assert found["agreement"]["krippendorff"] == 1.0
    assert [one["paper"] for one in found["l1"]] == [0.091, 0.077]
    assert found["raters"]["rater-01"]["checks_passed"] == found["raters"]["rater-01"]["checks"]
    assert found["raters"]["rater-03"]["checks_passed"] == 0
    assert all(0 <= hour["people"] <= 1 for hour in found["hours"] if hour["people"] is not None)


def test_where_raters_are_divided_or_skip_a_task_is_unscored(rating: Rating) -> None:
    unit = rating.plan.units[0]
    (one, other) = [rater for rater, ids in rating.plan.order.items() if unit.id in ids]
    item = next(item for item in unit.items if item.truth is None)
    rating.say(one, item.id, True)
    rating.say(other, item.id, False)
    assert verified(rating.plan, lambda *_: None, rating.answers())["hours"] == []
    assert agreement(rating.plan, rating.answers())["items"] == 1
    rating.say(other, item.id, None)
    assert agreement(rating.plan, rating.answers())["krippendorff"] is None


def test_a_rating_is_begun_and_its_results_are_told_on_the_command_line(
    coopera: Callable[..., Said], small_run: RunDir, tmp_path: Path
) -> None:
    begun = coopera("rate", "begin", small_run.root, "--raters", 2, "--hours", 4, "--out", "r")
    assert "4 hours of 1 runs for 2 raters" in begun.out
    assert (tmp_path / "r").stat().st_mode & 0o077 == 0
    rating = Rating.open(tmp_path / "r")
    for item in rating.units("rater-01")[0].items:
        rating.say("rater-01", item.id, True)
    told = coopera("rate", "results", "r", "--out", "export")
    assert re.search(r"predicate\s+ours\s+1\s+1", told.out)
    rows = list(csv.DictReader((tmp_path / "export" / "ratings.csv").read_text().splitlines()))
    assert {row["yes"] for row in rows} == {"True"}
    assert json.loads((tmp_path / "export" / "human_verification.json").read_text())["raters"]
    assert coopera("rate", "results", "r", "--json").json["runs"][0]["method"] == "ours"


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (("rate", "begin", "nowhere", "--raters", 2, "--out", "r"), "nowhere"),
        (("rate", "begin", "RUN", "RUN", "--raters", 2, "--out", "r"), "a run stands twice"),
        (("rate", "begin", "RUN", "--raters", 2, "--out", "full"), "full is not empty"),
        (("rate", "open", "empty"), "there is no rating here"),
        (("rate", "results", "empty"), "there is no rating here"),
    ],
)
def test_wrong_input_is_told_in_one_sentence(
    coopera: Callable[..., Said], small_run: RunDir, tmp_path: Path, args: tuple[object, ...], sentence: str
) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    told = coopera(*(small_run.root if arg == "RUN" else arg for arg in args))
    assert told.code == 2
    assert sentence in told.err


def test_answers_that_are_none_are_refused(rating: Rating) -> None:
    (rating.folder / "answers").mkdir()
    (rating.folder / "answers" / "rater-01.json").write_text('{"answers": 3}')
    with pytest.raises(ConfigError, match="no answers of a rater"):
        Rating.open(rating.folder)
