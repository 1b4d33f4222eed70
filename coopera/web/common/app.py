"""An application made of routes, behind a door."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from contextlib import AbstractAsyncContextManager
from http import HTTPStatus
from typing import Any
from urllib.parse import parse_qs

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from coopera.core.errors import ConfigError, CooperaError
from coopera.web.common.door import Door, Guard
from coopera.web.common.pages import STATIC, Pages

FORM_TOKEN = "/form-token"


def make_app(
    routes: Sequence[BaseRoute],
    *,
    door: Door,
    pages: Pages,
    lifespan: Callable[[Starlette], AbstractAsyncContextManager[None]] | None = None,
) -> Starlette:
    """Put routes behind a door; the files of `pages` are handed out, and what is wrong is told as a page.

    A `CooperaError` of a route becomes a page with its sentence (400 for wrong input, else 500).
    """
    own = [Route(STATIC + "{name}", pages.file), Route(FORM_TOKEN, _form_token), Route("/favicon.ico", _icon(pages))]

    async def told(request: Request, err: Exception) -> Response:
        status, sentence = _what(err)
        if "application/json" in request.headers.get("accept", ""):
            return JSONResponse({"problem": sentence}, status)
        return pages.render(
            request, "problem.html.j2", status=status, what=HTTPStatus(status).phrase, sentence=sentence
        )

    app = Starlette(
        routes=[*own, *routes],
        middleware=[Middleware(Guard, door=door)],
        exception_handlers={HTTPException: told, CooperaError: told},
        lifespan=lifespan,
    )
    app.state.door = door
    return app


def paths_of(app: Starlette) -> list[str]:
    """The addresses of an application, for a test that goes through all of them."""
    return [route.path for route in app.routes if isinstance(route, Route)]


async def fields(request: Request) -> dict[str, Any]:
    """What was posted: a form (each field's texts are joined by line ends if there are several) or a JSON object.

    Raises:
        HTTPException: If it is neither.
    """
    body = await request.body()
    try:
        if request.headers.get("content-type", "").split(";")[0] == "application/json":
            found = json.loads(body)
            if isinstance(found, dict):
                return found
        else:
            text = body.decode("utf-8")
            return {name: "\n".join(values) for name, values in parse_qs(text, keep_blank_values=True).items()}
    except (ValueError, RecursionError):
        pass
    raise HTTPException(400, "What was sent is neither a form nor a JSON object.")


async def _form_token(request: Request) -> Response:
    return JSONResponse({"form_token": request.app.state.door.form_token})


def _icon(pages: Pages) -> Callable[[Request], Any]:
    async def icon(request: Request) -> Response:
        request.path_params["name"] = pages.static("icon.svg").removeprefix(STATIC)
        return await pages.file(request)

    return icon


def _what(err: Exception) -> tuple[int, str]:
    if isinstance(err, HTTPException):
        plain = err.detail == HTTPStatus(err.status_code).phrase
        return err.status_code, "There is no such page." if plain and err.status_code == 404 else err.detail
    return (400 if isinstance(err, ConfigError) else 500), str(err)
