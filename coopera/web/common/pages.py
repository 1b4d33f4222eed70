"""Pages made of templates, and the files they load: all are ours, and lie beside the code."""

from __future__ import annotations

import hashlib
import mimetypes
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response

HERE = Path(__file__).parent
SHARED = HERE.parents[1] / "templates"
"""The templates that the report and the benchmark's page are made of; `look.css` is there."""
STATIC = "/static/"
_FOREVER = {"cache-control": "public, max-age=31536000, immutable"}
_PICTURES = {".webp": "image/webp", ".js": "text/javascript", ".css": "text/css"}


class Pages:
    """Makes pages of the templates in `FOLDER/templates` and of the shared ones; hands out `FOLDER/static`.

    In a template, `static("name.css")` is the address of a file, which has the hash of its content in it, so that a
    browser keeps it for good; every text is escaped, and an unknown name is an error.
    """

    def __init__(self, folder: Path) -> None:
        homes = [folder / "templates", HERE / "templates", SHARED]
        self.environment = Environment(
            loader=FileSystemLoader(homes),
            autoescape=True,
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
        )
        self._files = _files(folder / "static", HERE / "static", SHARED)
        self.environment.globals["static"] = self.static

    def static(self, name: str) -> str:
        """The address of a file.

        Raises:
            KeyError: If there is no such file.
        """
        return STATIC + self._hashed(name)

    def contents(self) -> Iterator[tuple[str, bytes]]:
        """All files, each with its address, for pages that are written as files themselves."""
        yield from ((self.static(name), path.read_bytes()) for name, path in self._files.items())

    def render(self, request: Request, template: str, /, *, status: int = 200, **given: Any) -> HTMLResponse:
        """A page as it is answered; templates also have `form_token` and `path`."""
        door = request.app.state.door
        text = self.environment.get_template(template).render(
            **{"form_token": door.form_token, "path": request.url.path, **given}
        )
        return HTMLResponse(text, status)

    def fragment(self, template: str, /, **given: Any) -> str:
        """A piece of a page."""
        return self.environment.get_template(template).render(**given)

    async def file(self, request: Request) -> Response:
        """Answer the request for a file."""
        name = request.path_params["name"]
        known: Mapping[str, Path] = {self._hashed(one): path for one, path in self._files.items()}
        if name not in known:
            raise HTTPException(404, "There is no such file.")
        kind = _PICTURES.get(known[name].suffix) or mimetypes.guess_type(name)[0] or "application/octet-stream"
        return Response(known[name].read_bytes(), media_type=kind, headers=_FOREVER)

    def _hashed(self, name: str) -> str:
        path = self._files[name]
        return f"{path.stem}.{hashlib.sha256(path.read_bytes()).hexdigest()[:12]}{path.suffix}"


def _files(*folders: Path) -> dict[str, Path]:
    """The files to hand out, by name; the first folder that has one gives it."""
    found: dict[str, Path] = {}
    for folder in folders:
        for path in sorted(folder.iterdir()) if folder.is_dir() else ():
            if path.is_file() and path.suffix in {".css", ".js", ".svg", ".webp", ".png"}:
                found.setdefault(path.name, path)
    return found
