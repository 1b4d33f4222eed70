"""What the tests of the person's page share: questions, a tab, and a run that asks."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from starlette.testclient import TestClient

from coopera.config.schema import Config
from coopera.core.errors import CooperaError, StoppedError
from coopera.core.interview import Answer, Card, Entry, Question
from coopera.core.people import PersonId
from coopera.graphs.players.real_person import read_step
from coopera.people.answers import Sitting
from coopera.web.common import Door
from coopera.web.person.app import make_person_app
from coopera.web.person.person import WebPerson

HOSTILE = '<script>alert(1)</script>"><img src=x onerror=alert(2)>\u202e\x1b[2J'
ABOUT: dict[str, Any] = {
    "person": PersonId("joan"),
    "name": "Joan",
    "day": 0,
    "hour": 9,
    "time": "9 am",
    "weekday": "Monday",
    "collab": 2,
    "scene": "maple",
}
INTENTION = Question(kind="intention", rooms=["kitchen"], **ABOUT)
TASKS = Question(
    kind="tasks",
    intention="Read",
    places={"sofa_1": "living room", "coffee_table_1": "living room"},
    motions=["sit and read"],
    can={"sofa_1": ["sit and read"]},
    n_tasks=5,
    **ABOUT,
)
EVENING = Question(
    kind="feedback",
    items=["Read", "bring the novel", "bring the mug"],
    of=4,
    cards=[
        Card(
            hour=9,
            time="9 am",
            intention="Read",
            tasks=["sit and read"],
            robot=["bring the novel"],
            entries=[
                Entry(item=0, kind="intention", also=["Read a book"]),
                Entry(item=1, kind="task", under="Read"),
                Entry(item=2, kind="task", under="Read"),
            ],
        )
    ],
    **ABOUT,
)


class Page:
    """What a tab does: it names itself, and shows what the server says."""

    def __init__(self, client: TestClient, name: str) -> None:
        self.client, self.name, self.shown = client, name, {}  # type: ignore[var-annotated]
        self.look()

    def look(self) -> dict[str, Any]:
        self.shown = self.client.get("/now", params={"page": self.name}).json()
        return self.shown

    def do(self, what: str, **given: Any) -> Any:
        state = {"page": self.name, "question": self.shown.get("question"), "revision": self.shown.get("revision")}
        headers = {"x-form-token": self.client.app.state.door.form_token}  # type: ignore[attr-defined]
        answer = self.client.post(f"/do/{what}", json={**state, **given}, headers=headers)
        if "html" in answer.json():
            self.shown = answer.json()
        return answer

    def say(self, do: str, **given: Any) -> Any:
        return self.do("say", do=do, **given)


def refused(answer: Any) -> str:
    """Why a page was refused what it wanted; empty if it was not."""
    assert answer.status_code == 200
    return str(answer.json().get("problem", ""))


class Asked:
    """A run that asks one question, in a thread of its own."""

    def __init__(self, person: WebPerson, question: Question) -> None:
        self.answer: Answer | None = None
        self.error: CooperaError | None = None
        self._thread = threading.Thread(target=self._ask, args=(person, question))
        self._thread.start()

    def _ask(self, person: WebPerson, question: Question) -> None:
        try:
            self.answer = person(question)
        except CooperaError as err:
            self.error = err

    def wait(self) -> Answer | None:
        self._thread.join(30)
        assert not self._thread.is_alive()
        return self.answer


def checks(question: Question, step: str) -> str:
    return read_step(step, question)


@contextmanager
def asking(
    run: Path, question: Question, config: Config | None = None, go_on: Callable[[], None] = lambda: None
) -> Iterator[tuple[TestClient, Asked]]:
    """A run that asks, and the pages' server; a question that is still open in the end is stopped."""
    stopped = threading.Event()

    def may_go_on() -> None:
        go_on()
        if stopped.is_set():
            raise StoppedError("The run was interrupted.")

    person = WebPerson()
    person.attend(Sitting(run, config or Config(played_by="web"), checks, may_go_on))
    asked = Asked(person, question)
    client = TestClient(make_person_app(person, Door()), base_url="http://127.0.0.1:8765")
    for _ in range(2000):
        if client.get("/now", params={"page": ""}).json()["status"] != "living":
            break
    try:
        yield client, asked
    finally:
        stopped.set()
        asked.wait()


def person_of(run: Path) -> WebPerson:
    """The same run in another process."""
    person = WebPerson()
    person.attend(Sitting(run, Config(played_by="web"), checks, lambda: None))
    return person
