"""The gate between operators' requests and the zones: the way to the zones' event loop."""

import asyncio
from collections.abc import Awaitable, Callable, Coroutine, Mapping
from copy import copy
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any, Final, NamedTuple, TypeVar

from pydantic import BaseModel

from esplanade.server.accounts.identity import Identity
from esplanade.server.console.brakes import Brakes
from esplanade.server.console.callers import Callers
from esplanade.server.console.console import Console
from esplanade.server.console.refusals import RefusedError
from esplanade.server.kept import Kept
from esplanade.server.live.live import Live

Result = TypeVar("Result")
MOST_UNDER_WAY: Final = 64
"""Requests that may wait for the zone at once; more are refused."""


def _no_link(host: str) -> str:
    raise RefusedError.of("busy", f"the port for people is not open yet, at {host} or elsewhere")


class ZoneFacts(BaseModel):
    """A zone: all other paths are about it behind `/api/v1/zones/NAME`."""

    name: str
    """Empty for a zone that is the whole world, whose paths name none."""
    scene: str
    people: int
    actors: int


Elsewhere = Callable[[Identity], Awaitable[list[ZoneFacts]]]
"""Tells of the zones of a world to an operator, that which newcomers enter first."""


class Operated(NamedTuple):
    """The console of a zone, and the live views of it."""

    console: Console
    live: Live


@dataclass
class _Requests:
    under_way: int = 0


class Gate:
    """Lets requests of the private port's thread through to the consoles in the zones' loop."""

    def __init__(
        self,
        callers: Callers,
        kept: Kept,
        zone: asyncio.AbstractEventLoop,
        *,
        secure_cookies: bool = False,
        brakes: Brakes,
        people_url: Callable[[str], str] = _no_link,
    ) -> None:
        self.callers = callers
        self.kept = kept
        self.audit = kept.audit
        self.brakes = brakes
        self.secure_cookies = secure_cookies
        """Whether browsers may send cookies of this port over encrypted connections only."""
        self.people_url = people_url
        """The address of people's port, as seen by whoever has reached this one by a name."""
        self.first = ""
        """The name of the zone that newcomers enter, where none of the zones is in this process."""
        self.elsewhere: Elsewhere | None = None
        """Tells of the zones of a world whose zones are in other processes."""
        self.zones: Mapping[str, Operated] = {}
        """The zones by their names, that which newcomers enter first; none until the world is
        built, and again when it ends."""
        self._loop = zone
        self._requests = _Requests()
        self._whole: Gate = self
        self._name: str | None = None

    def at(self, zone: str | None) -> "Gate":
        """The same gate for requests about one zone; without a name, that which newcomers enter.

        Raises
        ------
        RefusedError
            There is no such zone.
        """
        if zone is None:
            return self._whole
        zones = self._whole.zones
        if zones and zone not in zones:
            text = f"there is no zone {zone}; there are: {', '.join(zones)}"
            raise RefusedError.of("no_such_zone", text, zone=zone)
        view = copy(self._whole)
        view._name = zone  # noqa: SLF001 - of this class
        return view

    @property
    def name(self) -> str:
        """The name of the zone; empty for one that is the whole world, and while there is none."""
        first = next(iter(self._whole.zones), self._whole.first)
        return first if self._name is None else self._name

    @property
    def console(self) -> Console | None:
        """The console of the zone; None until the world is built, and again when it ends."""
        operated = self._whole.zones.get(self.name)
        return None if operated is None else operated.console

    @property
    def live(self) -> Live | None:
        """The live views of the zone, as `console`."""
        operated = self._whole.zones.get(self.name)
        return None if operated is None else operated.live

    @property
    def under_way(self) -> int:
        """Requests that wait for the world."""
        return self._requests.under_way

    async def call(self, work: Callable[[Console], Coroutine[Any, Any, Result]]) -> Result:
        """Do some work on the zone's loop, and return its result.

        It goes on there when the request is broken off: a command is done wholly or not at all.

        Raises
        ------
        RefusedError
            There is no world yet, or too many requests wait.
        """
        console = self.console
        if console is None:
            raise RefusedError.of("busy", "the world is not ready")
        if self.under_way >= MOST_UNDER_WAY:
            raise RefusedError.of("busy", f"{MOST_UNDER_WAY} requests wait already")
        self._requests.under_way += 1
        running = asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work(console), self._loop))
        running.add_done_callback(self._ended)
        return await asyncio.shield(running)

    def _ended(self, running: "asyncio.Future[Any]") -> None:
        self._requests.under_way -= 1
        if not running.cancelled():
            running.exception()  # whoever asked may be gone


STATUS: Final = {
    "unauthorized": HTTPStatus.UNAUTHORIZED,
    "forbidden": HTTPStatus.FORBIDDEN,
    "header_missing": HTTPStatus.FORBIDDEN,
    "foreign_host": HTTPStatus.FORBIDDEN,
    "foreign_origin": HTTPStatus.FORBIDDEN,
    "beyond_reach": HTTPStatus.FORBIDDEN,
    "link": HTTPStatus.FORBIDDEN,
    "ambiguous": HTTPStatus.BAD_REQUEST,
    "wrong_password": HTTPStatus.UNAUTHORIZED,
    "locked": HTTPStatus.TOO_MANY_REQUESTS,
    "too_many": HTTPStatus.TOO_MANY_REQUESTS,
    "last_admin": HTTPStatus.CONFLICT,
    "unknown_account": HTTPStatus.NOT_FOUND,
    "unknown_token": HTTPStatus.NOT_FOUND,
    "no_such_zone": HTTPStatus.NOT_FOUND,
    "unknown": HTTPStatus.NOT_FOUND,
    "conflict": HTTPStatus.CONFLICT,
    "taken": HTTPStatus.CONFLICT,
    "superseded": HTTPStatus.CONFLICT,
    "not_kept": HTTPStatus.CONFLICT,
    "unknown_change": HTTPStatus.NOT_FOUND,
    "unknown_preset": HTTPStatus.NOT_FOUND,
    "unknown_schedule": HTTPStatus.NOT_FOUND,
    "busy": HTTPStatus.SERVICE_UNAVAILABLE,
    "not_known": HTTPStatus.GATEWAY_TIMEOUT,
    "failed": HTTPStatus.INTERNAL_SERVER_ERROR,
}
"""The HTTP status for the code of a refusal's first fault; all others are 422."""


def status_of(refusal: RefusedError) -> int:
    """The status of the answer to a refused request."""
    code = refusal.faults[0].code
    return int(STATUS.get(code, HTTPStatus.UNPROCESSABLE_ENTITY))
