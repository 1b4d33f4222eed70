"""The rating page as an application: each rater has an address of their own, and sees nothing of the others."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from coopera.core.errors import ConfigError
from coopera.evaluation.rating.planning import RaterId, Unit
from coopera.web.common import Door, Pages, fields, make_app
from coopera.web.rating.store import Rating

PAGES = Pages(Path(__file__).parent)
_SAYS = {"yes": True, "no": False, "skip": None}


class Choice(NamedTuple):
    """An item as it is shown, with what was said of it: yes, no, skip or nothing."""

    id: str
    text: str
    said: str


def make_rating_app(rating: Rating, door: Door) -> Starlette:
    """The pages by which raters rate."""

    async def start(request: Request) -> Response:
        return PAGES.render(request, "rating_start.html.j2")

    async def rate(request: Request) -> Response:
        rater = _rater(rating, request)
        units, given = rating.units(rater), rating.given(rater)
        at = _at(request, units, given)
        answered, of = rating.progress(rater)
        unit = units[at] if at < len(units) else None
        return PAGES.render(
            request,
            "rating.html.j2",
            unit=unit,
            choices=_choices(unit, given) if unit else [],
            at=at,
            units=len(units),
            answered=answered,
            of=of,
            address=f"/r/{request.path_params['token']}",
        )

    async def say(request: Request) -> Response:
        rater = _rater(rating, request)
        given = await fields(request)
        item, said = str(given.get("item", "")), str(given.get("said", ""))
        if said not in _SAYS and said != "undo":
            raise HTTPException(400, "An answer is yes, no, skip or undo.")
        try:
            await run_in_threadpool(rating.say, rater, item, _SAYS.get(said), undo=said == "undo")
        except ConfigError as err:
            raise HTTPException(403, str(err)) from err
        answered, of = rating.progress(rater)
        return JSONResponse({"answered": answered, "of": of})

    async def picture(request: Request) -> Response:
        rater, given = _rater(rating, request), request.path_params
        path = rating.picture(rater, given["unit"], given["number"])
        if path is None:
            raise HTTPException(404, "There is no such picture.")
        return FileResponse(path, media_type="image/webp")

    routes = [
        Route("/", start),
        Route("/r/{token}", rate),
        Route("/r/{token}/say", say, methods=["POST"]),
        Route("/r/{token}/picture/{unit}/{number:int}", picture),
    ]
    return make_app(routes, door=door, pages=PAGES)


def _rater(rating: Rating, request: Request) -> RaterId:
    rater = rating.rater(request.path_params["token"])
    if rater is None:
        raise HTTPException(403, "This is no rater's address; please open the one that you were given.")
    return rater


def _at(request: Request, units: list[Unit], given: dict[str, bool | None]) -> int:
    """Which unit is shown: the one asked for, or the first with something open; past the last is the end."""
    asked = request.query_params.get("at", "")
    if asked.isdecimal() and len(asked) < 6:
        return min(int(asked), len(units))
    return next((n for n, unit in enumerate(units) if any(one.id not in given for one in unit.items)), len(units))


def _choices(unit: Unit, given: dict[str, bool | None]) -> list[Choice]:
    words = {True: "yes", False: "no", None: "skip"}
    return [Choice(one.id, one.text, words[given[one.id]] if one.id in given else "") for one in unit.items]
