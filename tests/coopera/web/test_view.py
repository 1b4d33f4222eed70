"""The viewer without a browser: what its pages say, what they refuse, and what they make of damage."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urljoin, urlsplit

import pytest
from starlette.testclient import TestClient

from coopera.core.errors import ConfigError
from coopera.evaluation.robot.error_budget import FALSE, LOST
from coopera.report.budget import read_budget
from coopera.rundir.directory import RunDir
from coopera.web.common import Door
from coopera.web.view.app import viewer
from coopera.web.view.export import export
from coopera.web.view.search import Search
from coopera.web.view.shelf import Shelf
from coopera.web.view.site import Site
from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run

HOSTILE = "<script>alert(1)</script>\x1b[2J\u202egnp.exe" + "x" * 100_000


class _Page(HTMLParser):
    """The links, ids and text of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.ids: set[str] = set()
        self.text = ""
        self.tags: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.tags.append(tag)
        self.ids |= {given["id"] or ""} if "id" in given else set()
        self.links += [value for name, value in given.items() if name in ("href", "src", "data-load") and value]

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two runs of one person and one that stopped; read them, never write them."""
    root = tmp_path_factory.mktemp("viewed") / "runs"
    fake_run(root / "first", days=2, hours=8, frames=2)
    fake_run(root / "second", days=2, hours=8, frames=1, seed=1)
    fake_run(root / "broken-off", people=("bruno",), days=1, hours=2, frames=1, finished=False)
    return root


@pytest.fixture(scope="module")
def client(folder: Path) -> TestClient:
    return TestClient(viewer(folder, Door()), base_url="http://127.0.0.1:8765")


@pytest.fixture
def one(tmp_path: Path) -> Path:
    """A run of one day to be damaged."""
    fake_run(tmp_path / "runs" / "one", days=1, hours=3, frames=1)
    return tmp_path / "runs" / "one"


def shown(root: Path, address: str) -> str:
    found = Site.of(root).answer(address)
    assert found is not None
    return found.body.decode()


def test_the_list_has_every_run_with_its_state_and_figures(client: TestClient, folder: Path) -> None:
    text = _Page(client.get("/").text).text
    for name, state in (("first", "finished"), ("second", "finished"), ("broken-off", "stopped")):
        assert name in text
        assert state in text
    need = RunDir.open(folder / "first").summary()["need"]["f1"]
    assert f"{need:.3f}" in text


def test_every_link_of_every_page_leads_somewhere(client: TestClient) -> None:
    seen, left = set(), ["/index.html"]
    while left:
        address = left.pop()
        if address in seen:
            continue
        seen.add(address)
        answer = client.get(address)
        assert answer.status_code == 200, address
        if not answer.headers["content-type"].startswith("text/html"):
            continue
        page = _Page(answer.text)
        for link in page.links:
            parts = urlsplit(urljoin(f"http://here{address}", link))
            assert parts.netloc == "here", link
            if link.startswith("#"):
                assert unquote(link[1:]) in page.ids, link
            elif "compare" not in parts.path:
                left.append(unquote(parts.path))
    assert len([one for one in seen if "/hour-" in one]) >= 34


def test_an_hour_is_complete(client: TestClient, folder: Path) -> None:
    run = RunDir.open(folder / "first")
    record = run.read_hour(1, 12)
    assert record is not None
    assert record.human is not None
    assert record.robot is not None
    page = _Page(client.get("/run/first/day-01/hour-12.html").text)
    wanted = [record.human.intention.text, *record.human.found.motions, *record.human.intention.wants]
    wanted += [task.act.describe() for task in record.human.tasks]
    wanted += [one.text for one in record.human.recalled]
    wanted += [f"{one.score:.3f}" for one in record.human.recalled]
    for candidate in record.robot.tasks:
        wanted += [candidate.act.describe(), f"{candidate.probability:.2f}"]
    for call in record.calls:
        wanted += [
            call.messages[0]["content"],
            call.reply,
            call.node,
            call.prompt,
            f"{call.tokens_in} + {call.tokens_out} tokens",
        ]
    assert [one for one in wanted if one not in page.text] == []
    assert {"del", "ins"} <= set(page.tags)  # what the reflection changed
    assert sum(link.endswith(".webp") for link in page.links) == 4


def test_every_task_without_help_says_where_it_was_lost(client: TestClient, folder: Path) -> None:
    run = RunDir.open(folder / "first")
    pages = [_Page(client.get(f"/run/first/day-{d:02d}/hour-{h:02d}.html").text).text for d, h in run.hours_done()]
    total = read_budget(run).total
    assert total.missed > 0
    assert sum(page.count("no help: ") for page in pages) == total.missed
    assert sum(page.count(f"no help: {LOST['not_imagined']}") for page in pages) == total.lost["not_imagined"]
    assert sum(page.count(FALSE["wrong_intention"]) for page in pages) == total.false["wrong_intention"]


def test_a_failed_hour_shows_its_reason_and_the_replies_that_failed(client: TestClient) -> None:
    text = _Page(client.get("/run/first/day-01/hour-16.html").text).text
    assert "This hour failed" in text
    assert "I would rather not say." in text
    assert "no JSON object found" in text


def test_two_runs_stand_side_by_side_with_what_differs(client: TestClient) -> None:
    text = _Page(client.get("/compare/first/second/index.html").text).text
    assert "seed" in text
    assert "16 of 16" not in text
    hour = _Page(client.get("/compare/first/second/day-00/hour-10.html").text)
    assert "not imagined" in hour.text
    assert "first" in hour.text
    assert "second" in hour.text


def test_texts_of_all_runs_are_searched_and_a_long_search_goes_on_later(folder: Path) -> None:
    entries = Shelf(folder).entries()
    found = Search().look(entries, "RATHER not say")
    assert [(hit.entry.name, hit.page, hit.words) for hit in found.hits] == [
        ("first", "day-01/hour-16.html", "rather not say"),
        ("second", "day-01/hour-16.html", "rather not say"),
    ]
    assert found.rest == ""
    cut = Search(seconds=-1).look(entries, "say")
    assert (cut.runs, cut.rest) == (0, "broken-off")


def test_a_run_that_runs_tells_when_it_has_grown(one: Path) -> None:
    data = json.loads((one / "run.json").read_text())
    (one / "run.json").write_text(json.dumps({**data, "state": "running", "host": "elsewhere"}))
    last = one / "trace" / "day-00" / "hour-11.json"
    kept = last.read_text()
    last.unlink()
    client = TestClient(viewer(one.parent, Door()), base_url="http://127.0.0.1")
    before = client.get("/run/one/live.json").json()
    assert (before["state"], before["hours"], before["planned"]) == ("running", 2, 3)
    assert "data-running" in client.get("/run/one/index.html").text
    last.write_text(kept)
    after = client.get("/run/one/live.json").json()
    assert after["hours"] == 3
    assert after["stamp"] != before["stamp"]
    assert "hour-11.html" in client.get("/run/one/index.html").text


def test_what_models_said_is_text_and_bounded(one: Path) -> None:
    path = one / "trace" / "day-00" / "hour-10.json"
    data = json.loads(path.read_text())
    data["human"]["intention"]["text"] = HOSTILE
    data["robot"]["tasks"][0]["thought"] = HOSTILE
    data["calls"][0]["reply"] = HOSTILE
    data["calls"][0]["messages"][0]["content"] = HOSTILE
    path.write_text(json.dumps(data))
    for address in ("run/one/index.html", "run/one/day-00/hour-10.html", "compare/one/one/day-00/hour-10.html"):
        text = shown(one.parent, address)
        assert "<script>alert" not in text
        assert "\x1b" not in text
        assert "\u202e" not in text
        assert "&lt;script&gt;alert(1)&lt;/script&gt;\\u001b[2J\\u202egnp.exe" in text
        assert len(text) < 300_000


def test_a_trace_cut_in_the_middle_is_told_and_the_rest_is_shown(one: Path) -> None:
    path = one / "trace" / "day-00" / "hour-10.json"
    path.write_text(path.read_text()[:3000])
    run = _Page(shown(one.parent, "run/one/index.html")).text
    assert "1 of 3 hours cannot be read" in run
    assert "9 am" in run
    hour = _Page(shown(one.parent, "run/one/day-00/hour-10.html")).text
    assert "hour-10.json: the file is damaged" in hour
    assert str(one) not in hour
    beside = shown(one.parent, "run/one/day-00/hour-11.html")
    assert "What the robot thought" in beside
    assert "hour-10.json: the file is damaged" in _Page(shown(one.parent, "run/one/analysis.html")).text


def test_values_that_no_trace_has_make_a_line_that_says_so(one: Path) -> None:
    path = one / "trace" / "day-00" / "hour-10.json"
    for text in (
        "[]",
        '{"status": 3}',
        "null",
        "[" * 100_000,
        '{"status":"ok","person":1,"success":{"predicate":[1]}}',
    ):
        path.write_text(text)
        assert "1 of 3 hours cannot be read" in shown(one.parent, "run/one/index.html")
        assert "hour-10.json" in shown(one.parent, "run/one/day-00/hour-10.html")


def test_a_run_of_a_newer_version_is_listed_with_the_reason_and_its_hours_are_found(one: Path) -> None:
    data = json.loads((one / "run.json").read_text())
    (one / "run.json").write_text(json.dumps({**data, "schema": 99}))
    assert "schema 99 was written by a newer coopera" in shown(one.parent, "index.html")
    text = _Page(shown(one.parent, "run/one/index.html")).text
    assert "schema 99 was written by a newer coopera" in text
    assert "11 am" in text


def test_a_missing_frame_is_told_and_the_others_are_shown(one: Path) -> None:
    (one / "frames" / "day-00" / "hour-10" / "robot-0.webp").unlink()
    text = shown(one.parent, "run/one/day-00/hour-10.html")
    assert "robot-0.webp is not in the run" in text
    assert "frames/day-00/hour-10/human-0.webp" in text


def test_pictures_of_the_robots_help_stand_beside_its_acts(one: Path) -> None:
    hour = next(record for record in RunDir.open(one).hours() if record.robot and len(record.robot.outcomes) > 1)
    frames = one / "frames" / "day-00" / f"hour-{hour.hour:02d}"
    shutil.copy(frames / "robot-0.webp", frames / "help-1-0.webp")
    text = shown(one.parent, f"run/one/day-00/hour-{hour.hour:02d}.html")
    assert hour.robot is not None
    act = hour.robot.outcomes[1].act.describe()
    assert re.search(rf"<b>{act}</b>(?:(?!<b>).)*help-1-0.webp", text, re.DOTALL)


@pytest.mark.parametrize(
    "address",
    [
        "run/one/frames/../run.json",
        "run/one/frames/out/secret.webp",
        "run/one/frames/day-00/hour-09/leak.webp",
        "run/one/trace/../config.json",
        "run/one/trace/day-00/leak.json",
        "run/../one/index.html",
        "run/one/config.yaml",
        "run/elsewhere/index.html",
        "../secret.webp",
        "run/one/frames/day-00/hour-09/\0.webp",
    ],
)
def test_nothing_outside_a_run_is_handed_out(one: Path, address: str) -> None:
    secret = one.parents[1] / "secret"
    fake_run(secret, days=1, hours=1, frames=1)
    (secret / "secret.webp").write_bytes(b"secret")
    (secret / "secret.json").write_text("{}")
    (one / "frames" / "out").symlink_to(secret)
    (one / "frames" / "day-00" / "hour-09" / "leak.webp").symlink_to(secret / "secret.webp")
    (one / "trace" / "day-00" / "leak.json").symlink_to(secret / "secret.json")
    (one.parent / "elsewhere").symlink_to(secret)
    site = Site.of(one.parent)
    assert [entry.name for entry in site.desk.shelf.entries()] == ["one"]
    assert site.answer(address) is None


def test_others_on_the_network_need_the_token_and_a_foreign_name_is_refused(folder: Path) -> None:
    door = Door.opened("0.0.0.0", 8765)
    client = TestClient(viewer(folder, door), base_url="http://127.0.0.1:8765")
    assert client.get("/index.html").status_code == 403
    assert client.get("/run/first/index.html", headers={"cookie": f"{door.cookie}={door.token}"}).status_code == 200
    opened = TestClient(viewer(folder, Door()), base_url="http://evil.example")
    assert opened.get("/index.html").status_code == 421


def test_an_empty_folder_says_what_to_do_and_none_is_refused_in_a_sentence(
    tmp_path: Path, coopera: Callable[..., Said]
) -> None:
    (tmp_path / "empty").mkdir()
    assert "coopera run --out" in shown(tmp_path / "empty", "index.html")
    (tmp_path / "file").write_text("")
    for name, what in (("none", "there is no such folder"), ("file", "this is no folder")):
        said = coopera("view", name)
        assert said.code == 2
        assert what in said.err
        assert said.err.count("\n") == 1


def test_written_as_files_every_link_leads_to_a_file(one: Path, tmp_path: Path) -> None:
    fake_run(one.parent / "other", days=1, hours=1, frames=1, seed=1)
    folder = one.parent
    made = export(folder, tmp_path / "out")
    assert (tmp_path / "out" / "compare" / "one" / "other" / "day-00" / "hour-09.html").is_file()
    assert made.start == tmp_path / "out" / "index.html"
    pages = sorted((tmp_path / "out").rglob("*.html"))
    assert len(pages) == made.pages
    for path in pages:
        for link in _Page(path.read_text(encoding="utf-8")).links:
            target = unquote(link.partition("#")[0])
            assert not re.match(r"[a-z]+:|/", target), link
            assert not target or (path.parent / target).is_file(), f"{path}: {link}"
    with pytest.raises(ConfigError, match="not empty"):
        export(folder, folder)
    assert export(folder, tmp_path / "out").pages == made.pages


def test_a_run_by_itself_can_be_viewed(one: Path) -> None:
    assert "one" in shown(one, "index.html")
    assert "9 am" in shown(one, "run/one/index.html")
