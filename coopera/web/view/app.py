"""The viewer's server: every address is answered by the site, in a thread, so that one slow page holds up no other."""

from __future__ import annotations

from pathlib import Path

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from coopera.web.common import Door, make_app
from coopera.web.view.site import Site

_KEPT = {"image/webp", "image/png", "image/jpeg"}


def viewer(root: Path, door: Door) -> Starlette:
    """The viewer of a folder, behind a door.

    Raises:
        ConfigError: If it is no folder.
    """
    site = Site.of(root)

    def page(request: Request) -> Response:
        found = site.answer(request.path_params["address"], dict(request.query_params))
        if found is None:
            raise HTTPException(404, "There is no such run, hour or page here; the list shows what there is.")
        headers = {"cache-control": "private, max-age=3600"} if found.kind in _KEPT else {}
        return Response(found.body, media_type=found.kind, headers=headers)

    return make_app([Route("/{address:path}", page)], door=door, pages=site.pages)
