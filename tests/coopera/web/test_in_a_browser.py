"""A whole short day lived on the person's page, and a rating by two raters, in a real browser."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from coopera.evaluation.rating.planning import Sizes
from coopera.rundir.directory import RunDir
from coopera.web.common import Door, served
from coopera.web.rating.app import make_rating_app
from coopera.web.rating.store import Rating
from tests.coopera.web.browser import browser, needs_browser

pytestmark = [pytest.mark.slow, needs_browser]
PATIENCE = 240_000  # milliseconds
_COOPERA = "import sys; from coopera.cli import main; sys.exit(main())"


@contextmanager
def running(folder: Path, *args: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A command of coopera that serves a page; gives the address that it says."""
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "COOPERA_DATA_DIR": str(folder / "data")}
    done = subprocess.Popen(
        [sys.executable, "-c", _COOPERA, *args], cwd=folder, env=env, stderr=subprocess.PIPE, text=True
    )
    assert done.stderr is not None
    try:
        for line in done.stderr:
            if found := re.search(r"http://\S+", line):
                yield done, found[0]
                break
    finally:
        if done.poll() is None:
            done.terminate()
        done.communicate(timeout=60)


def wait(page: Any, what: str) -> None:
    page.wait_for_selector(what, timeout=PATIENCE)


def intend(page: Any, text: str) -> None:
    wait(page, "#intend")
    page.fill("#text", text)
    page.click("#intend button[type=submit]")
    wait(page, "#step")


def add(page: Any, motion: str, hand: str) -> None:
    steps = page.locator(".steps li").count()
    place = page.locator("#place option").nth(1).get_attribute("value")
    page.locator(f'.plan [data-place="{place}"]').dispatch_event("click")
    assert page.input_value("#place") == place
    page.fill("#motion", motion)
    page.fill("#hand", hand)
    page.click("#step button[type=submit]")
    page.wait_for_function(
        "n => document.querySelectorAll('.steps li').length > n || document.getElementById('line-problem').textContent",
        arg=steps,
    )


def answer_evening(page: Any) -> None:
    wait(page, ".evening-top")
    for n in range(page.locator(".choices").count()):
        choice = "yes" if n % 2 else "no"
        page.click(f"#v{n}-{choice}")
        wait(page, f"#v{n}-{choice}[aria-pressed=true]")
    page.click("#undo-verdict")
    last = page.locator(".choices").count() - 1
    wait(page, f"#v{last}-yes[aria-pressed=false]")
    page.click(f"#v{last}-skip")
    wait(page, f"#v{last}-skip[aria-pressed=true]")
    page.click("#finish")


def begin(page: Any) -> None:
    wait(page, "#consent")
    page.fill("#participant", "p07")
    page.check("#agrees")
    page.click("#consent button[type=submit]")
    intend(page, "read a book on the sofa")


def slip_and_reload(page: Any) -> None:
    add(page, "sit and read", "novel")
    add(page, "qwertz uiop", "mug")
    assert "comes near to" in page.inner_text("#line-problem")
    assert page.locator(".steps li").count() == 1
    page.fill("#words", "drink a glass of water")
    page.reload()
    wait(page, "#step")
    assert page.locator(".steps li").count() == 1
    assert page.input_value("#words") == "drink a glass of water"  # typed, and not yet given


def lose_the_line(page: Any, context: Any) -> None:
    context.set_offline(True)
    page.click("#step button[type=submit]")
    wait(page, "#line:not([hidden])")
    context.set_offline(False)
    page.wait_for_function("() => document.querySelectorAll('.steps li').length === 2", timeout=PATIENCE)


def take_over(tab: Any, page: Any) -> None:
    wait(tab, "text=This day is open on another page")
    tab.click("#take")
    wait(tab, "#step")
    wait(page, "text=This day is open on another page")
    page.close()


def finish_and_pause(tab: Any) -> None:
    tab.click("#undo")
    tab.wait_for_function("() => document.querySelectorAll('.steps li').length === 1")
    tab.click("#finish")
    wait(tab, "#intend")
    tab.click("#pause")
    wait(tab, "text=Paused")


def test_a_day_is_lived_on_the_page_with_slips_a_reload_a_lost_line_and_two_tabs(tmp_path: Path) -> None:
    (tmp_path / "consent.txt").write_text("You may stop at any time.")
    run = "run --humans amara --days 1 --hours 2 --pictures none --played-by web --port 0 --consent consent.txt --out r"
    with browser() as chromium:
        with running(tmp_path, *run.split()) as (_, address):
            context = chromium.context()
            page = chromium.page(address, context)
            begin(page)
            slip_and_reload(page)
            lose_the_line(page, context)
            tab = chromium.page(address, context)
            take_over(tab, page)
            finish_and_pause(tab)
            tab.close()
        with running(tmp_path, "resume", "r", "--port", "0") as (done, address):  # another device, another server
            phone = chromium.page(address, width=390, height=844)
            intend(phone, "make some tea")
            assert phone.evaluate("() => document.documentElement.scrollWidth") <= 390
            add(phone, "drink from a cup", "mug")
            phone.click("#finish")
            answer_evening(phone)
            wait(phone, "text=Thank you")
            assert done.wait(60) == 0
        # what the browser itself notes of the line that was cut
        assert [text for text in chromium.errors if "ERR_INTERNET_DISCONNECTED" not in text] == []
        assert chromium.left == []
    record = json.loads((tmp_path / "r" / "trace" / "day-00" / "hour-09.json").read_text())
    assert record["human"]["intention"]["text"] == "read a book on the sofa"
    assert [task["act"]["motion"] for task in record["human"]["tasks"]] == ["sit and read"]
    feedback = json.loads((tmp_path / "r" / "trace" / "day-00" / "evening.json").read_text())["feedback"]
    assert {item["helpful"] for item in feedback} == {True, False, None}


def test_two_raters_rate_and_one_is_interrupted(tmp_path: Path, small_run: RunDir) -> None:
    rating = Rating.begin(tmp_path / "rating", [small_run.root], Sizes(2, share=2, hours=3), seed=0)
    one, other = rating.plan.tokens.values()

    def rate(page: Any, key: str) -> None:
        for _ in range(page.locator(".ask").count()):
            page.keyboard.press(key)
        page.wait_for_selector("#next[aria-disabled=false]")
        before = page.url, page.inner_text("main")
        page.click("#next")
        page.wait_for_function("text => document.querySelector('main').innerText !== text", arg=before[1])

    with browser() as chromium:
        with served(lambda door: make_rating_app(rating, door), Door(port=0)) as server:
            first = chromium.page(server.door.address(f"/r/{one}"))
            rate(first, "y")
            first.locator(".ask .c-no").first.click()
            first.wait_for_selector(".ask .c-no[aria-pressed=true]")
            first.wait_for_load_state("networkidle")
            first.close()
        again = Rating.open(rating.folder)
        with served(lambda door: make_rating_app(again, door), Door(port=0)) as server:
            first = chromium.page(server.door.address(f"/r/{one}"))
            assert "Hour 2 of 3" in first.inner_text("main")
            second = chromium.page(server.door.address(f"/r/{other}"), width=390, height=844)
            for page, hours in ((first, 2), (second, 3)):
                for _ in range(hours):
                    rate(page, "n")
                page.wait_for_selector("text=Thank you")
        assert (chromium.errors, chromium.left) == ([], [])
    answers = again.answers()
    assert {len(given) for given in answers.values()} == {again.progress("rater-01")[1]}
    assert True in answers["rater-01"].values()
