"""Serves the operators' page at /console, from the files of the built client."""

from collections.abc import Mapping
from http import HTTPStatus
from typing import Final, Protocol
from urllib.parse import quote

from fastapi import FastAPI, Request, Response
from starlette.responses import RedirectResponse

from esplanade.server.console.zone_paths import zone_of


class Found(Protocol):
    """The answer to a client who asks for a file."""

    @property
    def status(self) -> int:
        """200, or 304 for what the client has already."""

    @property
    def body(self) -> bytes:
        """The file, or nothing."""

    @property
    def headers(self) -> Mapping[str, str]:
        """Those of the file."""


class Files(Protocol):
    """The files of the built client."""

    def found(self, path: str, known: list[str], codings: list[str]) -> Found | None:
        """The file at a path, for a client that sends these lines of `If-None-Match` and of
        `Accept-Encoding`; None if there is none."""


PAGE: Final = "/console/"
_NOT_BUILT: Final = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Esplanade</title>
<meta name="viewport" content="width=device-width">
</head><body><h1>The page for operators is not built</h1>
<p>This server was started from sources without it. Build it with</p>
<pre>make client</pre>
<p>or install the package (<code>pip install .</code>), then start the server again. Until
then there are <code>esplanade op</code> and, for programs, <code>/openapi.json</code>.</p>
</body></html>
"""


def add_pages(app: FastAPI, files: Files) -> None:
    """Let an application serve the page and its assets, and no other file of the client.

    Nobody needs to be logged in to load them: there is nothing secret in them.
    """

    async def to_page(request: Request) -> Response:
        # Without the last slash the page would look for its files one level above.
        zone = zone_of(request.scope)
        before = "" if zone is None else f"/zones/{quote(zone)}"
        return RedirectResponse(before + PAGE, HTTPStatus.PERMANENT_REDIRECT)

    async def page(request: Request) -> Response:
        rest = request.path_params.get("rest", "")
        if rest and rest != "licences.txt" and not rest.startswith("assets/"):
            return _nothing()
        path = f"/{rest or 'console.html'}"
        found = files.found(
            path,
            request.headers.getlist("If-None-Match"),
            request.headers.getlist("Accept-Encoding"),
        )
        if found is not None:
            return Response(found.body, found.status, found.headers)
        if rest:
            return _nothing()
        headers = {"Cache-Control": "no-cache"}
        return Response(_NOT_BUILT, HTTPStatus.SERVICE_UNAVAILABLE, headers, "text/html")

    app.add_route("/console", to_page, include_in_schema=False)
    app.add_route(f"{PAGE}{{rest:path}}", page, include_in_schema=False)


def _nothing() -> Response:
    return Response("there is nothing here\n", HTTPStatus.NOT_FOUND, media_type="text/plain")
