from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from coopera.evaluation.measuring import told_in_the_evening
from coopera.evaluation.robot.differences import offers_of
from coopera.evaluation.robot.error_budget import LOST, by_day
from coopera.report import charts
from coopera.report.budget import read_budget
from coopera.report.hours import hour_view
from coopera.report.page import fill, frames_of, texts, write_report
from coopera.report.pictures import embed, frames_by_view, thin
from coopera.rundir.directory import RunDir
from tests.coopera.fake_run import fake_run

VOID = {"meta", "img", "br", "input", "link", "hr"}


class Page(HTMLParser):
    """Collects ids, references and texts, and fails on tags that do not close."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.references: list[str] = []
        self.open: list[str] = []
        self.tags: list[str] = []
        self.text = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        given = dict(attrs)
        self.ids += [given["id"]] if "id" in given else []
        self.references += [value for name, value in given.items() if name in ("href", "src") and value]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.fixture(scope="module")
def html(small_run: RunDir) -> str:
    return fill(texts(small_run), embed(frames_of(small_run), 10**9))


@pytest.fixture(scope="module")
def page(html: str) -> Page:
    return Page(html)


def test_the_page_is_well_formed_and_every_link_has_its_place(page: Page, small_run: RunDir) -> None:
    assert page.open == []
    assert len(set(page.ids)) == len(page.ids)
    links = [one for one in page.references if not one.startswith("data:")]
    inner = {one[1:] for one in links if one.startswith("#")}
    assert inner <= set(page.ids)
    assert {f"d{record.day}h{record.hour}" for record in small_run.hours()} <= inner
    assert all((small_run.root / one).is_file() for one in links if not one.startswith("#"))


def test_the_page_needs_no_network(html: str) -> None:
    assert not re.search(r"""(https?:)?//[a-z0-9.-]+\.[a-z]{2,}""", re.sub(r"data:[^\"]+", "", html))
    assert "@import" not in html
    assert "url(" not in html


def test_every_hour_shows_candidates_scores_verdicts_and_what_was_right(page: Page, small_run: RunDir) -> None:
    for record in small_run.hours():
        if record.status == "failed":
            assert record.reason in page.text
            continue
        assert record.human.intention.text in page.text
        for task in record.robot.tasks:
            assert task.act.describe() in page.text
            assert f"{task.probability:.2f}" in page.text
    for word in ("wrong accept", "missed", "rightly declined", "right", "watched by the robot"):
        assert word in page.text


def test_the_curve_and_the_map_carry_their_figures(page: Page, small_run: RunDir) -> None:
    for day in small_run.summary()["days"]:
        assert f"{day['predicate']['f1']:.3f}" in page.text
        assert f"{day['need']['f1']:.3f}" in page.text
    assert "svg" in page.tags


def test_need_f1_is_the_headline_with_its_precision_and_recall(page: Page, small_run: RunDir) -> None:
    need = small_run.summary()["need"]
    said = f"need F1, all days{need['f1']:.3f}precision {need['precision']:.3f} · recall {need['recall']:.3f}"
    assert said.replace(" ", "") in "".join(page.text.split())


def test_the_page_says_where_help_was_lost_over_all_days_and_by_day(page: Page, small_run: RunDir) -> None:
    found, text = read_budget(small_run), "".join(page.text.split())
    for name, words in LOST.items():
        count = found.total.lost[name]
        assert f"{words}{count}{100 * count / found.total.missed:.1f}%".replace(" ", "") in text
    for day, budget in by_day(found.days).items():
        assert f"{day}{budget.missed}{100 * budget.lost['not_imagined'] / budget.missed:.1f}" in text


def test_the_page_says_plainly_that_no_language_model_was_used(page: Page) -> None:
    assert "No language model was used for the person, the robot and the judge." in page.text


def test_text_from_models_is_never_markup(html: str) -> None:
    assert "rest &lt;b&gt;early&lt;/b&gt;" in html
    assert "<b>early</b>" not in html


def test_flags_say_what_the_filters_ask_for(small_run: RunDir) -> None:
    for record in small_run.hours():
        flags = hour_view(record, small_run.read_evening(record.day)).flags
        if record.status == "failed":
            assert flags == ["failed"]
            continue
        counts = record.success.predicate
        assert ("wrong" in flags) == (counts.fp > 0)
        assert ("miss" in flags) == (counts.fn > 0)
        imagined = record.human.intention.text in {guess.text for guess in record.robot.intentions}
        assert ("unimagined" in flags) == (not imagined)


def test_an_unfinished_run_and_an_empty_one_have_a_page_too(tmp_path: Path) -> None:
    stopped = fake_run(tmp_path / "stopped", days=1, hours=2, frames=1, finished=False)
    assert "stopped: the work ended before it was complete" in write_report(stopped).read_text()
    empty = fake_run(tmp_path / "empty", lived=False, finished=False)
    assert "No hour has been lived yet." in write_report(empty).read_text()


def test_pictures_are_thinned_evenly_until_they_fit(small_run: RunDir) -> None:
    frames = frames_of(small_run)
    everything = embed(frames, 10**9)
    assert (everything.kept, everything.taken, everything.small) == (2, 2, False)
    fewer = embed(frames, everything.size * 2 // 3)
    assert (fewer.kept, fewer.small) == (1, False)
    assert embed(frames, 0).views == {}
    files = [Path(str(n)) for n in range(8)]
    assert [path.name for path in thin(files, 3)] == ["0", "4", "7"]
    assert [path.name for path in thin(files, 1)] == ["4"]


def test_a_page_with_more_text_than_expected_carries_fewer_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = fake_run(tmp_path / "run", days=1, hours=3, frames=4)
    whole = write_report(run).stat().st_size
    monkeypatch.setattr("coopera.report.page.HOUR_BYTES", 0)
    monkeypatch.setattr("coopera.report.page.SMALL_BYTES", whole - 1000)
    assert write_report(run).stat().st_size <= whole - 1000
    assert "pictures per view 3 are shown here" in (run.root / "report.html").read_text()


def test_the_page_shows_the_robot_at_work_beside_the_words_of_its_act(tmp_path: Path) -> None:
    run = fake_run(tmp_path / "run", days=1, hours=3, frames=1)
    hour = next(one for one in run.hours() if one.robot and one.robot.outcomes)
    folder = run.root / f"frames/day-00/hour-{hour.hour:02d}"
    assert "the robot at work" not in write_report(run).read_text()
    for name in ("help-0-0.webp", "help-0-1.webp", "help-x-1.webp"):
        (folder / name).write_bytes((folder / "human-0.webp").read_bytes())
    page = write_report(run).read_text()
    assert page.count("the robot at work, moment") == 2
    assert hour.robot is not None
    before = page[: page.index("the robot at work, moment 1")]
    assert hour.robot.outcomes[0].act.describe() in before[before.rindex("<li>") :]


def test_curves_leave_out_what_has_no_figure() -> None:
    curve = charts.lines([charts.Series("predicate", "predicate", [0.25, None, 1.0], True)], ["a", "b", "<c>"])
    assert curve.count("<circle") == 2
    assert ">0.25</text>" in curve
    assert ">1.00</text>" in curve
    assert "&lt;c&gt;" in curve
    assert "<c>" not in curve
    assert charts.bars([None, 0.5], ["9am", "10am"]).count("<rect") == 1
    assert charts.lines([], []).startswith("<svg")
    assert charts.traits(None, None).count("<circle") == 0


def test_a_trace_cannot_make_the_page_read_files_outside_the_run(small_run: RunDir, tmp_path: Path) -> None:
    (tmp_path / "secret.png").write_bytes(b"secret")
    frames = {(0, 9): [str(tmp_path / "secret.png"), "../" * 20 + f"{tmp_path}/secret.png", "run.json"]}
    assert embed(frames_by_view(small_run.root, frames), 10**9).views == {}


def test_it_shows_where_the_measures_differ_and_escapes_what_was_said(small_run: RunDir, page: Page) -> None:
    assert "differing" in page.ids
    assert "Where the measures differ" in page.text
    nasty = offers_of(told_in_the_evening(small_run.hours(), small_run.evenings()))
    said: dict[str, bool | None] = {"predicate": True, "judge": False}
    shown = [one._replace(thought="<script>alert(1)</script>", said=said) for one in nasty]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("coopera.report.page.offers_of", lambda _: shown)
        html = fill(texts(small_run), embed(frames_of(small_run), 0))
    assert "<script>alert(1)" not in html
    assert "&lt;script&gt;alert(1)" in html
