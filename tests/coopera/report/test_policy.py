"""What pages may do: every script and style that stands in one is let in by its hash, and nothing else is."""

from __future__ import annotations

import base64
import hashlib
from html.parser import HTMLParser
from pathlib import Path

import pytest

from coopera.benchmark.results_files import _page
from coopera.evaluation.people.studies import Choice, DayShown, HourShown, Study, Trait
from coopera.evaluation.results import Card
from coopera.evaluation.tables import Table
from coopera.report.page import fill, frames_of, texts
from coopera.report.pictures import embed, frames_by_view
from coopera.report.policy import content_policy
from coopera.report.study_forms import render as render_study
from coopera.rundir.directory import RunDir


class _Elements(HTMLParser):
    """The texts of a page's scripts and styles, its policy, the attributes of all elements, and what comes first."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.texts: dict[str, list[str]] = {"script": [], "style": []}
        self.policies: list[str] = []
        self.names: set[str] = set()
        self.tags: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag == "meta" and given.get("http-equiv") == "Content-Security-Policy":
            self.policies.append(given["content"] or "")
        if tag in self.texts:
            self.texts[tag].append("")
        self.names |= set(given)
        self.tags.append("policy" if "http-equiv" in given else tag)

    def handle_data(self, data: str) -> None:
        if self.tags and self.tags[-1] in self.texts and self.lasttag == self.tags[-1]:
            self.texts[self.tags[-1]][-1] += data

    def handle_endtag(self, tag: str) -> None:
        if tag in self.texts:
            self.tags.append("")


def _study() -> Study:
    day = DayShown(letter="A", hours=[HourShown(time="9 am", intention="<b>Bake</b>", tasks=["get flour"])])
    choice = Choice(id="C1", profile="</script><script>alert(1)</script>", traits="open", options=[day])
    return Study(id="s", choices=[choice], descriptions=[Trait(id="M1", traits="calm", profile="p")], days=[day])


def _benchmark() -> str:
    card = Card.model_construct(
        name="b<script>", coopera="1", format=1, sha256="0" * 64, models={"human": "offline"}, methods=["ours"]
    )
    table = Table("late", "Late <days>", ["method", "need"], [["ours", "<b>0.5"]])
    return _page(card, "all", [], [table], ["need"])


@pytest.fixture(scope="module")
def pages(small_run: RunDir) -> dict[str, str]:
    report = fill(texts(small_run), embed(frames_of(small_run), 10**6))
    return {"report": report, "study": render_study(_study()), "benchmark": _benchmark()}


@pytest.mark.parametrize("name", ["report", "study", "benchmark"])
def test_a_page_lets_in_its_own_scripts_and_styles_by_their_hash_and_nothing_else(
    name: str, pages: dict[str, str]
) -> None:
    page = _Elements(pages[name])
    assert len(page.policies) == 1
    parts = dict(part.split(" ", 1) for part in page.policies[0].split("; "))
    assert parts["default-src"] == parts["base-uri"] == parts["form-action"] == "'none'"
    assert parts["img-src"] == "data:"
    for tag, directive in (("script", "script-src"), ("style", "style-src")):
        texts = dict.fromkeys(page.texts[tag])
        hashes = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in texts]
        assert parts[directive] == (" ".join(f"'sha256-{one}'" for one in hashes) or "'none'")
    assert parts["style-src-attr"] == ("'unsafe-inline'" if "style" in page.names else "'none'")
    assert not [attribute for attribute in page.names if attribute.startswith("on")]
    before = page.tags[: page.tags.index("policy")]
    assert not {"script", "style", "link"} & set(before)  # it holds only for what comes after it


def test_what_a_page_shows_cannot_widen_its_policy() -> None:
    assert "alert" not in content_policy(styles=["a"], scripts=["alert(1)"])
    assert content_policy(styles=[]).count("'none'") == 6


def test_a_frame_that_is_a_link_out_of_the_run_stays_out_of_the_page(tmp_path: Path) -> None:
    root = tmp_path / "run"
    (root / "frames").mkdir(parents=True)
    (tmp_path / "elsewhere").mkdir()
    for place in (tmp_path / "secret.png", tmp_path / "elsewhere" / "robot-1.png"):
        place.write_bytes(b"secret")
    (root / "frames" / "robot-0.png").symlink_to(tmp_path / "secret.png")
    (root / "frames" / "out").symlink_to(tmp_path / "elsewhere")
    (root / "frames" / "robot-2.png").symlink_to("robot-2.png")
    (root / "frames" / "robot-3.png").write_bytes(b"own")
    (root / "frames" / "robot-4.png").symlink_to("robot-3.png")
    names = [
        "robot-0.png",
        "out/robot-1.png",
        "robot-2.png",
        "robot-3.png",
        "robot-4.png",
        "x" * 300 + ".png",
        "\0.png",
    ]
    found = embed(frames_by_view(root, {(0, 9): [f"frames/{name}" for name in names]}), 10**6)
    own = f"data:image/png;base64,{base64.b64encode(b'own').decode()}"
    assert found.views == {(0, 9): {"robot": [own, own]}}  # a link within the run is no way out of it


def test_a_frame_that_is_no_picture_is_left_out_where_it_should_be_made_smaller(tmp_path: Path) -> None:
    (tmp_path / "robot-0.png").write_bytes(b"no picture" * 1000)
    found = embed(frames_by_view(tmp_path, {(0, 9): ["robot-0.png"]}), 5000)
    assert found.small
    assert found.views == {(0, 9): {}}
