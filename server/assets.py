"""Serves the built web client, and the data that a world adds to it, from memory.

People have one port for pages and WebSocket, and the library behind it answers requests without
routing or files; so the few rules of HTTP that static files need stand here.
"""

import gzip
import hashlib
import mimetypes
import re
from collections.abc import Mapping
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path, PurePosixPath
from typing import Final
from urllib.parse import unquote

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

CLIENT_ASSETS: Final = Path(__file__).parent / "client_assets"

SECURITY_HEADERS: Final = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; "
        "img-src 'self' data: blob:; font-src 'self'; connect-src 'self'; worker-src 'self' blob:; "
        "manifest-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
}

_TYPES: Final = {
    ".bin": "application/octet-stream",
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".map": "application/json",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
    ".webmanifest": "application/manifest+json",
    ".woff2": "font/woff2",
}
_COMPRESSED: Final = {*_TYPES} - {".woff2"}
_HASHED_PATH: Final = re.compile(r"/assets/[^/]+-[A-Za-z0-9_-]{8}\.\w+")
"""These names hold the content's hash, as Vite makes them; a changed file is another file."""

_MISSING_PAGE: Final = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Esplanade</title>
<meta name="viewport" content="width=device-width">
</head><body><h1>The world is running, its web client is not built</h1>
<p>This server was started from sources without a built client. Build it with</p>
<pre>make client</pre>
<p>or install the package (<code>pip install .</code>), then start the server again.
Bots can come in already, at <code>/ws</code>.</p></body></html>
"""


@dataclass(frozen=True)
class Asset:
    """One file: its bytes, plain and, where it pays, compressed."""

    body: bytes
    compressed: bytes | None
    headers: Mapping[str, str]


@dataclass(frozen=True)
class Found:
    """The answer to a client who asks for an asset."""

    status: HTTPStatus
    body: bytes
    headers: Mapping[str, str]


class Assets:
    """A table from URL path to asset. Nothing outside the table can be reached."""

    def __init__(self, table: Mapping[str, Asset]) -> None:
        self._table = table

    @classmethod
    def load(cls, folder: Path = CLIENT_ASSETS) -> "Assets":
        """Read a built client; without one, a page that says how to build it."""
        if not (folder / "index.html").is_file():
            page = _asset("/index.html", _MISSING_PAGE.encode())
            return cls({"/": page, "/index.html": page})
        table: dict[str, Asset] = {}
        for file in sorted(file for file in folder.rglob("*") if file.is_file()):
            path = "/" + file.relative_to(folder).as_posix()
            table[path] = _asset(path, file.read_bytes())
        table["/"] = table["/index.html"]
        return cls(table)

    def with_data(self, name: str, body: bytes) -> tuple["Assets", str]:
        """Binary data added to the table, and its address as seen from the page.

        The address holds a hash of the data, so that browsers may keep it for ever.
        """
        address = _address(name, body)
        path = f"/{address}"
        return Assets({**self._table, path: _asset(path, body)}), address

    def add_mesh(self, triangles: bytes) -> None:
        """Add the triangles of a mesh to this table, at `mesh_address`."""
        path = f"/{mesh_address(triangles)}"
        if path not in self._table:
            self._table = {**self._table, path: _asset(path, triangles)}

    def has(self, address: str) -> bool:
        """Whether there is an asset at an address as seen from the page."""
        return f"/{address}" in self._table

    def answer(self, request: Request) -> Response:
        """The response to a GET, whose body is left out where the request is a HEAD."""
        answer = self._found(request)
        if request.method == "HEAD":
            answer.body = b""  # the headers stay those of the answer to a GET
        return answer

    def _found(self, request: Request) -> Response:
        found = self.found(
            unquote(path_of(request)),
            request.headers.get_all("If-None-Match"),
            request.headers.get_all("Accept-Encoding"),
        )
        if found is None:
            return respond(HTTPStatus.NOT_FOUND, b"there is nothing here\n")
        return respond(found.status, found.body, found.headers)

    def found(self, path: str, known: list[str], codings: list[str]) -> "Found | None":
        """The asset at a path, for a client that sends these lines of `If-None-Match` and of
        `Accept-Encoding`; None if there is none."""
        asset = self._table.get(path)
        if asset is None:
            return None
        if _is_known(asset.headers["ETag"], _listed(known)):
            return Found(HTTPStatus.NOT_MODIFIED, b"", asset.headers)
        if asset.compressed is not None and _accepts_gzip(_listed(codings)):
            headers = {**asset.headers, "Content-Encoding": "gzip"}
            return Found(HTTPStatus.OK, asset.compressed, headers)
        return Found(HTTPStatus.OK, asset.body, asset.headers)


def mesh_address(triangles: bytes) -> str:
    """The address of the triangles of a mesh, as seen from the page."""
    return _address("mesh", triangles)


def _address(name: str, body: bytes) -> str:
    return f"assets/{name}-{hashlib.sha256(body).hexdigest()[:8]}.bin"


def _listed(lines: list[str]) -> list[str]:
    """The items of a header that holds a list, from all lines that have it."""
    return [item.strip() for item in ",".join(lines).split(",") if item.strip()]


def _is_known(tag: str, known: list[str]) -> bool:
    """Whether a client has the content with this tag (RFC 9110, section 13.1.2).

    Our tags hold no comma, so that a list of tags may be split at each.
    """
    return "*" in known or tag in (item.removeprefix("W/") for item in known)


def _accepts_gzip(codings: list[str]) -> bool:
    """Whether a client takes gzip (RFC 9110, section 12.5.3); q=0 forbids it."""
    qualities: dict[str, float] = {}
    for item in codings:
        coding, *parameters = (part.strip().lower() for part in item.split(";"))
        qualities[coding] = _quality(parameters)
    return qualities.get("gzip", qualities.get("*", 0.0)) > 0.0


def _quality(parameters: list[str]) -> float:
    for parameter in parameters:
        name, _, value = parameter.partition("=")
        if name.strip() == "q":
            try:
                return float(value)
            except ValueError:
                return 0.0
    return 1.0


def path_of(request: Request) -> str:
    """The path of a request without query and fragment; it is taken as it comes, URL or not."""
    return request.path.partition("#")[0].partition("?")[0]


def respond(status: HTTPStatus, body: bytes, headers: Mapping[str, str] | None = None) -> Response:
    """A complete HTTP response that ends its connection."""
    fields = {
        "Content-Type": "text/plain; charset=utf-8",
        "Cache-Control": "no-cache",
        **SECURITY_HEADERS,
        **(headers or {}),
        "Content-Length": str(len(body)),
        "Connection": "close",
    }
    return Response(status.value, status.phrase, Headers(fields), body)


def _asset(path: str, body: bytes) -> Asset:
    suffix = PurePosixPath(path).suffix
    compressed = gzip.compress(body, mtime=0) if suffix in _COMPRESSED else None
    if compressed is not None and len(compressed) >= len(body):
        compressed = None
    guessed = mimetypes.guess_type(path)[0] or "application/octet-stream"
    immutable = _HASHED_PATH.fullmatch(path)
    headers = {
        "Content-Type": _TYPES.get(suffix, guessed),
        "Cache-Control": "public, max-age=31536000, immutable" if immutable else "no-cache",
        "ETag": f'"{hashlib.sha256(body).hexdigest()[:20]}"',
        "Vary": "Accept-Encoding",
    }
    return Asset(body, compressed, headers)
