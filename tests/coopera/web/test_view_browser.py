"""The viewer in a real browser: keys, two runs side by side, a run that grows, prompts, and pages from files."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from coopera.report.page import write_report
from coopera.rundir.directory import RunDir
from coopera.web.common import Door, served
from coopera.web.view.app import viewer
from coopera.web.view.export import export
from tests.coopera.fake_run import fake_run
from tests.coopera.web.browser import browsing, needs_browser

pytestmark = [needs_browser, pytest.mark.slow]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Ten runs of one person; in each an hour of day 1 failed."""
    root = tmp_path_factory.mktemp("browsed") / "runs"
    for number in range(10):
        fake_run(root / f"run-{number}", days=2, hours=8, frames=1, seed=number)
    return root


@pytest.fixture(scope="module")
def address(folder: Path) -> Iterator[str]:
    with served(lambda door: viewer(folder, door), Door(port=0)) as server:
        yield server.address


def test_a_failed_hour_is_reached_by_keys_alone(address: str) -> None:
    with browsing() as seen:
        page = seen.page
        page.goto(address)
        assert page.locator("#runs tbody tr").count() == 10
        page.keyboard.press("/")
        page.keyboard.type("run-7")
        assert page.locator("#runs tbody tr:visible").count() == 1
        page.locator("#runs tbody tr:visible a").focus()
        page.keyboard.press("Enter")
        page.wait_for_url("**/run/run-7/index.html")
        page.keyboard.press("6")  # the filter of failed hours
        assert page.locator("a.hour:visible").count() == 1
        page.keyboard.press("j")
        page.keyboard.press("Enter")
        page.wait_for_url("**/day-01/hour-16.html")
        assert "This hour failed" in page.locator("main").inner_text()
        assert "Failed" in page.locator("#walk").inner_text()
        page.keyboard.press("c")
        assert page.locator(".calls").first.get_attribute("open") is not None
        page.keyboard.press("?")
        assert page.locator("#keys").is_visible()
        page.keyboard.press("Escape")
        page.keyboard.press("K")
        page.wait_for_url("**/day-00/hour-09.html")
        page.keyboard.press("u")
        page.wait_for_url("**/run/run-7/index.html")


def test_two_runs_are_chosen_and_stand_side_by_side(address: str) -> None:
    with browsing() as seen:
        page = seen.page
        page.goto(address)
        page.locator("#runs .sort", has_text="need F1").click()
        figures = page.locator("#runs tbody tr td:nth-child(11)").all_inner_texts()
        assert figures == sorted(figures, reverse=True)
        for name in ("run-1", "run-2"):
            page.locator(f"input[value={name}]").check()
        page.get_by_role("button", name="Compare two").click()
        page.wait_for_url("**/compare/*/*/index.html")
        page.locator("a.hour").nth(2).click()
        page.wait_for_url("**/day-00/hour-11.html")
        assert page.locator("tr.differs").count() > 0
        page.locator(".call summary").first.click()
        assert page.locator(".call pre").first.is_visible()


def test_prompts_and_replies_open_and_pictures_play(address: str) -> None:
    with browsing() as seen:
        page = seen.page
        page.goto(f"{address}run/run-3/day-00/hour-10.html")
        page.locator(".calls > summary").click()
        page.locator(".call > summary").first.click()
        assert "It is time for human/intention." in page.locator(".call pre").first.inner_text()
        assert page.locator(".screen .big").first.evaluate("image => image.complete && image.naturalWidth") == 320
        page.locator(".strip img").first.click()
        assert page.locator("#light").is_visible()


def test_the_page_of_a_run_grows_while_it_runs(folder: Path, tmp_path: Path) -> None:
    root = tmp_path / "runs" / "growing"
    fake_run(root, days=1, hours=4, frames=1)
    info = json.loads((root / "run.json").read_text())
    (root / "run.json").write_text(json.dumps({**info, "state": "running", "host": "elsewhere"}))
    kept = {path: path.read_text() for path in sorted(root.glob("trace/day-00/hour-1[12].json"))}
    for path in kept:
        path.unlink()
    with served(lambda door: viewer(root.parent, door), Door(port=0)) as server, browsing() as seen:
        page = seen.page
        page.goto(f"{server.address}run/growing/index.html")
        assert page.locator("a.hour").count() == 2
        for number, (path, text) in enumerate(kept.items(), 3):
            path.write_text(text)
            page.locator("a.hour").nth(number - 1).wait_for()
        assert "4 of 4 hours" in page.locator(".progress").inner_text()
        (root / "run.json").write_text(json.dumps(info))
        page.locator("#live:not([data-running])").wait_for()


@pytest.mark.parametrize("width", [390, 1280])
def test_no_page_is_wider_than_the_screen(address: str, width: int) -> None:
    pages = ["", "run/run-3/index.html", "run/run-3/day-01/hour-16.html", "run/run-3/day-00/hour-10.html",
             "run/run-3/day-00/evening.html", "compare/run-1/run-2/index.html",
             "compare/run-1/run-2/day-00/hour-10.html", "search.html?q=breakfast"]  # fmt: skip
    with browsing(viewport={"width": width, "height": 800}) as seen:
        for one in pages:
            seen.page.goto(address + one)
            assert seen.page.evaluate("document.documentElement.scrollWidth") <= width, one


def test_the_report_of_a_run_and_the_written_pages_open_from_files(tmp_path: Path) -> None:
    root = tmp_path / "runs" / "one"
    fake_run(root, days=1, hours=3, frames=2)
    report = write_report(RunDir.open(root))
    index = export(root.parent, tmp_path / "out").start
    with browsing() as seen:
        page = seen.page
        page.goto(report.as_uri())
        page.keyboard.press("j")
        page.keyboard.press("Enter")
        hour = page.locator("details.hour[open]")
        assert hour.locator(".big").first.evaluate("image => image.naturalWidth") == 320
        hour.locator(".calls > summary").click()
        hour.locator(".call > summary").first.click()
        hour.locator(".call pre").first.wait_for()
        assert "It is time for human/intention." in hour.locator(".call pre").first.inner_text()
        page.goto(index.as_uri())
        page.get_by_role("link", name="one", exact=True).click()
        page.locator("a.hour").first.click()
        assert "What the robot thought" in page.locator("main").inner_text() or page.locator(".guesses").count()
        page.keyboard.press("j")
        page.wait_for_url("**/hour-10.html")
        assert page.evaluate("getComputedStyle(document.querySelector('.card')).borderTopLeftRadius") == "12px"


def test_a_report_of_five_days_opens_in_a_moment(tmp_path: Path) -> None:
    """Its size is bounded; the time is measured and printed, not asserted, for it is this machine's."""
    fake_run(tmp_path / "run", days=5, hours=13, frames=8)
    report = write_report(RunDir.open(tmp_path / "run"))
    assert report.stat().st_size < 5_000_000
    with browsing() as seen:
        before = time.monotonic()
        seen.page.goto(report.as_uri())
        print(f"{report.stat().st_size / 1e6:.1f} MB opened in {time.monotonic() - before:.2f} s")  # noqa: T201
