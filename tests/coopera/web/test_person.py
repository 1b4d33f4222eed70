"""The person's page: slips, reloads, two tabs, a second person, a new server; nothing that was said is lost."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from coopera.config.schema import Config
from coopera.core.errors import StoppedError
from coopera.core.people import PersonId
from coopera.people.answers import Answers
from coopera.web.common import Door
from coopera.web.person.app import make_person_app
from coopera.web.person.chair import GONE, Chair
from coopera.web.person.person import WebPerson
from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run
from tests.coopera.web.person_pages import EVENING, HOSTILE, INTENTION, TASKS, Page, asking, person_of, refused


@pytest.fixture
def run(tmp_path: Path) -> Path:
    return tmp_path / "run"


def test_an_intention_is_checked_given_and_kept(run: Path) -> None:
    with asking(run, INTENTION) as (client, asked):
        page = Page(client, "one")
        assert page.shown["seat"] == "free"
        assert page.do("sit").json()["seat"] == "yours"
        for slip in ("", "   ", "x" * 301):
            assert "one sentence" in refused(page.say("intention", text=slip))
        assert page.say("intention", text=" make  tea ").json()["status"] == "living"
        assert asked.wait() == "make tea"
    (file,) = (run / "person" / "answers").iterdir()
    kept = json.loads(file.read_text())
    assert (kept["answer"], kept["question"]["kind"], bool(kept["asked"])) == ("make tea", "intention", True)


def test_one_wrong_step_loses_nothing_and_steps_can_be_taken_back(run: Path) -> None:
    with asking(run, TASKS) as (client, asked):
        page = Page(client, "one")
        page.do("sit")
        page.say("step", text="sofa_1 | sit and read | novel")
        slip = page.say("step", text="trampoline | jump | ball")
        assert refused(slip) == 'There is no fixed object "trampoline" in the list.'
        page.say("step", text="hum a tune")
        page.say("step", text="9 | sit | x")
        page.say("step", text="drink some tea")
        assert "sit and read at the sofa with the novel in hand" in page.look()["html"]
        page.say("remove", at=1)
        assert refused(page.say("remove", at=7))
        page.say("finish")
        assert asked.wait() == ["sofa_1 | sit and read | novel", "drink some tea"]


def test_an_hour_needs_a_step_and_has_at_most_eight(run: Path) -> None:
    with asking(run, TASKS) as (client, _):
        page = Page(client, "one")
        page.do("sit")
        assert refused(page.say("finish"))
        answers = [page.say("step", text=f"step {n}") for n in range(9)]
        assert [bool(refused(one)) for one in answers] == [False] * 8 + [True]


def test_a_reload_and_a_new_server_show_what_was_said(run: Path) -> None:
    with asking(run, TASKS) as (client, _):
        page = Page(client, "one")
        page.do("sit")
        page.say("step", text="hum a tune")
        assert "hum a tune" in Page(client, "one").shown["html"]
    with asking(run, TASKS) as (client, asked):
        page = Page(client, "another device")
        page.do("sit")
        assert "hum a tune" in page.shown["html"]
        page.say("finish")
        asked.wait()
    assert person_of(run)(TASKS) == ["hum a tune"]  # the run was stopped before it had noted the answer


def test_a_second_page_must_take_over_and_the_first_then_learns_of_it(run: Path) -> None:
    with asking(run, TASKS) as (client, _):
        first = Page(client, "one")
        first.do("sit")
        second = Page(client, "two")
        assert second.shown["seat"] == "taken"
        assert "open on another page" in second.shown["html"]
        assert "Read" not in second.shown["html"]
        for what in (second.do("sit"), second.say("step", text="mine now")):
            assert "open on another page" in refused(what)
        assert second.do("sit", take=True).json()["seat"] == "yours"
        assert refused(first.say("step", text="still here"))
        assert first.look()["seat"] == "taken"
        second.do("leave")
        assert first.look()["seat"] == "free"


def test_a_tab_that_was_duplicated_does_not_say_things_twice(run: Path) -> None:
    with asking(run, TASKS) as (client, _):
        first = Page(client, "one")
        first.do("sit")
        twin = Page(client, "one")
        first.say("step", text="hum a tune")
        stale = twin.say("step", text="hum a tune")
        assert "changed on another page" in refused(stale)
        assert stale.json()["html"].count("hum a tune") == 1
        assert not refused(twin.say("step", text="sing"))  # it has seen how it stands


def test_a_page_of_an_earlier_question_cannot_answer_this_one(run: Path) -> None:
    with asking(run, INTENTION) as (client, asked):
        page = Page(client, "one")
        page.do("sit")
        old = Page(client, "one")
        page.say("intention", text="make tea")
        asked.wait()
        assert refused(old.say("intention", text="make coffee"))


def test_a_participant_agrees_before_anything_is_asked(run: Path, tmp_path: Path) -> None:
    (tmp_path / "consent.txt").write_text(f"You may stop at any time. {HOSTILE}")
    config = Config.model_validate({"played_by": "web", "real_person": {"consent": tmp_path / "consent.txt"}})
    with asking(run, INTENTION, config) as (client, asked):
        page = Page(client, "one")
        page.do("sit")
        assert page.shown["status"] == "consent"
        assert "You may stop at any time." in page.shown["html"]
        assert "<script>alert" not in page.shown["html"]
        assert refused(page.do("agree", participant="", agrees=True))
        assert refused(page.do("agree", participant="p07", agrees=False))
        assert refused(page.say("intention", text="make tea"))
        page.do("agree", participant="p07", agrees=True)
        while page.look()["status"] != "question":
            pass
        page.say("intention", text="make tea")
        assert asked.wait() == "make tea"
    participant = Answers(run).participant()
    assert (participant.id, len(participant.consent_sha256), bool(participant.agreed)) == ("p07", 64, True)
    (tmp_path / "consent.txt").unlink()  # on another machine, say
    with asking(run, TASKS, config) as (client, _):
        assert Page(client, "two").look()["status"] == "question"


def test_a_participant_of_the_study_file_need_not_be_typed(run: Path) -> None:
    config = Config.model_validate({"played_by": "web", "real_person": {"participant": "p08"}})
    with asking(run, INTENTION, config) as (client, _):
        page = Page(client, "one")
        page.do("sit")
        assert "p08" in page.shown["html"]
        page.do("agree", participant="somebody else")
    assert Answers(run).participant().id == "p08"


def test_the_evening_is_answered_in_any_order_and_needs_every_answer(run: Path) -> None:
    with asking(run, EVENING) as (client, asked):
        page = Page(client, "one")
        page.do("sit")
        assert "Read a book" in page.shown["html"]
        page.say("verdict", at=2, text="no, I had one")
        page.say("verdict", at=0, text="yes")
        assert refused(page.say("finish")) == "1 of 3 are still open."
        for slip in ("perhaps", "4"):
            assert refused(page.say("verdict", at=1, text=slip))
        assert refused(page.say("verdict", at=3, text="yes"))
        page.say("verdict", at=0, text="")  # undo
        page.say("verdict", at=0, text="no")
        page.say("verdict", at=1, text="skip")
        page.say("finish")
        assert asked.wait() == ["no", "skip", "no, I had one"]


def test_hostile_text_is_text(run: Path) -> None:
    hostile = TASKS.model_copy(update={"intention": HOSTILE, "name": HOSTILE, "problem": HOSTILE, "motions": [HOSTILE]})
    with asking(run, hostile) as (client, _):
        page = Page(client, "one")
        page.do("sit")
        page.say("step", text=HOSTILE)
        html = page.look()["html"]
        assert "<script>alert" not in html
        assert "<img src=x" not in html
        assert "&lt;script&gt;" in html
        assert refused(page.say("step", text="a" * 100_000))
        assert refused(page.do("say", do={"a": []}, at=[1], text={}))


def test_a_page_from_another_origin_cannot_answer(run: Path) -> None:
    with asking(run, INTENTION) as (client, _):
        token = client.app.state.door.form_token  # type: ignore[attr-defined]
        foreign = {"origin": "http://evil.example", "x-form-token": token}
        assert client.post("/do/sit", json={"page": "x"}, headers=foreign).status_code == 403
        assert client.post("/do/sit", json={"page": "x"}).status_code == 403


def test_only_pictures_of_the_run_are_shown(run: Path) -> None:
    folder = run / "frames" / "day-00" / "hour-09"
    folder.mkdir(parents=True)
    (folder / "human-0.webp").write_bytes(b"picture")
    (run / "config.yaml").write_text("secret")
    with asking(run, INTENTION) as (client, _):
        assert client.get("/picture/frames/day-00/hour-09/human-0.webp").content == b"picture"
        for path in ("config.yaml", "frames/../config.yaml", "frames/day-00/hour-09/..%2f..%2fconfig.yaml", "frames"):
            assert client.get(f"/picture/{path}").status_code == 404


def test_what_happened_is_shown_with_pictures_and_what_could_not_be_done(tmp_path: Path) -> None:
    run = fake_run(tmp_path / "run", days=1, hours=2, frames=4, finished=False).root
    (run / "frames" / "day-00" / "hour-09" / "help-1-0.webp").write_bytes(b"picture")
    question = INTENTION.model_copy(update={"person": PersonId("amara"), "hour": 11})
    with asking(run, question) as (client, _):
        page = Page(client, "one")
        page.do("sit")
        html = page.shown["html"]
        assert "Today so far" in html
        assert html.count("/picture/frames/day-00/hour-09/human-") == 4
        assert client.get("/picture/frames/day-00/hour-09/help-1-0.webp").content == b"picture"
        assert "/picture/frames/day-00/hour-09/help-1-0.webp" in html
        assert "<b>Robot</b>" in html


def test_the_plan_shows_the_home_and_what_may_be_chosen(run: Path) -> None:
    with asking(run, TASKS) as (client, _):
        page = Page(client, "one")
        page.do("sit")
        assert 'data-place="sofa_1"' in page.shown["html"]
        assert "living room" in page.shown["html"]
        assert 'data-place="bed_1"' not in page.shown["html"]


def test_a_run_that_is_stopped_keeps_what_was_said(run: Path) -> None:
    stop = threading.Event()

    def go_on() -> None:
        if stop.is_set():
            raise StoppedError("The run was interrupted.")

    with asking(run, TASKS, go_on=go_on) as (client, asked):
        page = Page(client, "one")
        page.do("sit")
        page.say("step", text="hum a tune")
        stop.set()
        assert asked.wait() is None
        assert isinstance(asked.error, StoppedError)
    assert Answers(run).draft(TASKS).lines == ["hum a tune"]


def test_before_the_run_has_begun_and_after_it_has_ended_the_page_says_so() -> None:
    person = WebPerson()
    client = TestClient(make_person_app(person, Door()), base_url="http://127.0.0.1:8765")
    page = Page(client, "one")
    assert page.do("sit").json()["status"] == "opening"
    assert refused(page.say("step", text="x"))
    person.end("The study is over.", patience=0.0)
    assert "The study is over." in page.look()["html"]
    assert "/static/person." in client.get("/").text


def test_a_chair_is_free_again_once_its_page_is_gone() -> None:
    now = 0.0
    chair = Chair(lambda: now)
    assert chair.sit("one")
    assert not chair.sit("two")
    now = GONE + 1
    assert chair.seat("two") == "free"
    assert chair.sit("two")
    assert chair.seat("one") == "taken"
    assert chair.sit("one", take=True)
    assert not chair.sit("")


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (("--played-by", "web", "--consent", "nowhere.txt"), "nowhere.txt: there is no such consent text."),
        (("--played-by", "web", "--consent", "empty.txt"), "empty.txt: the consent text is empty."),
        (("--consent", "empty.txt"), "nobody is asked unless played_by is me or web"),
        (("--participant", "p07"), "nobody is asked unless played_by is me or web"),
        (("--played-by", "web", "--participant", "Jo Ann"), "--participant must be up to 60 letters"),
        (("--played-by", "web", "--port", "BUSY"), "is in use; name another with --port"),
    ],
)
def test_wrong_input_is_told_in_one_sentence_and_nothing_is_written(
    coopera: Callable[..., Said], tmp_path: Path, args: tuple[str, ...], sentence: str
) -> None:
    (tmp_path / "empty.txt").write_text(" \n")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        given = [port if one == "BUSY" else one for one in args]
        told = coopera("run", "--humans", "amara", "--days", 1, "--hours", 1, "--out", "r", *given)
    assert told.code == 2
    assert sentence in told.err
    assert not (tmp_path / "r").exists()
