"""Paths about one zone of a world: as they are without, and /zones/NAME in them.

It stands before the path of a page, and within that of the interface: the cookie of a session is
for /api/v1 and nothing else.
"""

import re
from collections.abc import Mapping
from typing import Any, Final

from starlette.types import ASGIApp, Receive, Scope, Send

_OF_ZONE: Final = re.compile(r"(?P<before>/api/v1)?/zones/(?P<zone>[^/]+)(?P<rest>/.*)")
_ZONE: Final = "esplanade.zone"


class ZonePaths:
    """Lets an application find its paths without the name of a zone, which `zone_of` tells then."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hand a request on."""
        if scope["type"] in {"http", "websocket"}:
            found = _OF_ZONE.fullmatch(scope["path"])
            if found is not None:
                path = (found["before"] or "") + found["rest"]
                scope = about_zone(
                    {**scope, "path": path, "raw_path": path.encode()}, found["zone"]
                )
        await self._app(scope, receive, send)


def about_zone(scope: Mapping[str, Any], zone: str) -> dict[str, Any]:
    """The scope of a request, as one about that zone."""
    return {**scope, _ZONE: zone}


def zone_of(scope: Mapping[str, Any]) -> str | None:
    """The name of the zone that a request is about; None if it names none."""
    zone: str | None = scope.get(_ZONE)
    return zone
