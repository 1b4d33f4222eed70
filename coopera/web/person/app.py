"""The person's page as an application."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from coopera.core.clock import hour_label
from coopera.core.household import plain
from coopera.core.interview import MOST_STEPS, Question
from coopera.simulation import load_scene
from coopera.web.common import Door, Pages, fields, make_app
from coopera.web.person.chair import GONE
from coopera.web.person.day import FRAME, Past, past_of
from coopera.web.person.person import Now, Refused, WebPerson, said_of
from coopera.web.person.plan import Plan, plan_of


def _numbered(name: str) -> str:
    """The number in the name of one thing among several of its kind, such as " 2" of "sofa_2"."""
    tail = name.rpartition("_")[2]
    return f" {tail}" if tail.isdigit() else ""


def _step_words(line: str) -> str:
    """A step as it is shown: a choice as a sentence."""
    parts = [part.strip() for part in line.split("|")]
    if len(parts) == 2:
        return f"put the {plain(parts[0])} on or in the {plain(parts[1])}"
    return f"{parts[1]} at the {plain(parts[0])} with the {plain(parts[2])} in hand" if len(parts) == 3 else line


PAGES = Pages(Path(__file__).parent)
PAGES.environment.filters |= {"words": plain, "numbered": _numbered, "step_words": _step_words}


def make_person_app(person: WebPerson, door: Door) -> Starlette:
    """The pages by which somebody plays the person."""

    async def start(request: Request) -> Response:
        return PAGES.render(request, "person.html.j2")

    async def now(request: Request) -> Response:
        page, seen = request.query_params.get("page", ""), request.query_params.get("seen", "")
        return JSONResponse(await run_in_threadpool(_shown, person, page, seen))

    async def act(request: Request) -> Response:
        said = await fields(request)
        page = str(said.get("page", ""))
        try:
            await run_in_threadpool(_act, person, request.path_params["what"], page, said)
        except Refused as err:  # an answer like others: the page shows the sentence, and how it stands if that changed
            shown = await run_in_threadpool(_shown, person, page, "") if err.overtaken else {}
            return JSONResponse({"problem": str(err), **shown})
        return JSONResponse(await run_in_threadpool(_shown, person, page, ""))

    async def frame(request: Request) -> Response:
        path = request.path_params["path"]
        root = person.sitting.root if person.sitting else None
        if root is None or not FRAME.fullmatch(path) or not (root / path).is_file():
            raise HTTPException(404, "There is no such picture.")
        return FileResponse(root / path, media_type="image/webp")

    routes = [
        Route("/", start),
        Route("/now", now),
        Route("/do/{what}", act, methods=["POST"]),
        Route("/picture/{path:path}", frame),
    ]
    return make_app(routes, door=door, pages=PAGES)


def _act(person: WebPerson, what: str, page: str, said: dict[str, Any]) -> None:
    if what == "sit":
        person.sit(page, take=said.get("take") is True)
    elif what == "leave":
        person.leave(page)
    elif what == "agree":
        person.agree(page, str(said.get("participant", "")), said.get("agrees") is True)
    elif what == "say":
        revision = said.get("revision")
        person.say(page, str(said.get("question", "")), revision if isinstance(revision, int) else -1, said)
    else:
        raise HTTPException(404, "There is nothing of that name to do.")


def _shown(person: WebPerson, page: str, seen: str) -> dict[str, Any]:
    """How it stands for a page: the version, and what it is to show unless it shows that already."""
    now = person.now(page)
    if now.version == seen:
        return {"version": now.version}
    return {
        "version": now.version,
        "status": now.status,
        "seat": now.seat,
        "question": now.draft.question,
        "revision": now.draft.revision,
        "html": PAGES.fragment("now.html.j2", **_view(person, now)),
    }


def _view(person: WebPerson, now: Now) -> dict[str, Any]:
    question, sitting = now.question, person.sitting
    config = sitting.config if sitting else None
    past = past_of(sitting.root, question) if sitting and question else Past([], None)
    return {
        "now": now,
        "q": question,
        "config": config,
        "past": past.hours,
        "plan": _plan(person, question, past),
        "day_hours": [(hour, hour_label(hour)) for hour in config.day_hours] if config else [],
        "rooms": _by_room(question) if question else {},
        "said": [said_of(line) for line in _padded(now)],
        "most_steps": MOST_STEPS,
        "gone": GONE,
    }


def _plan(person: WebPerson, question: Question | None, past: Past) -> Plan | None:
    if question is None or question.kind == "feedback" or person.sitting is None:
        return None
    scene = load_scene(question.scene, [person.sitting.config.data_dir / "scenes", person.sitting.root / "scenes"])
    return plan_of(scene, places=question.places, things=question.things, now=past.poses)


def _by_room(question: Question) -> dict[str, list[str]]:
    """The places that may be chosen, by room; rooms and places in the order of the search, nearest first."""
    found: dict[str, list[str]] = {}
    for name, room in question.places.items():
        found.setdefault(room, []).append(name)
    return found


def _padded(now: Now) -> list[str]:
    count = len(now.question.items) if now.question else 0
    return [*now.draft.lines, *[""] * count][:count]
