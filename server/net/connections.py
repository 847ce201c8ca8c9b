"""All connections of a port from their first moment on: bounded in number, cut off at the end.

Places are shared fairly. When the port is full, a newcomer takes the place of a connection that
has not said hello yet, of the address that has the most of these: silent connections keep out
only others from where they come themselves.
"""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Final

from websockets.asyncio.server import Server

from esplanade.server.net.address_limits import AddressLimits
from esplanade.server.net.addresses import TrustedProxies, address_key
from esplanade.server.net.refusals import Refusals

SHUT_S: Final = 2.0
"""Connections that are still open this long after a port was closed are cut off."""


class Place:
    """The place of one connection among those of its port, from its first moment to its end."""

    __slots__ = ("_connections", "address", "charged", "cut", "peer", "present", "settled")

    def __init__(self, connections: "Connections", peer: str, address: str, charged: bool) -> None:
        self._connections = connections
        self.peer = peer
        """The address of the socket's other end, as text."""
        self.address = address
        """The key of the client's address; the proxy's until a request says who is behind it."""
        self.charged = charged
        """Whether the connection is counted among those of its address."""
        self.present = True
        self.settled = False
        """Whether the client has said hello; until then others may be given the place."""
        self.cut: Callable[[], object] = _nothing
        """Ends the connection at once."""

    def attribute(self, forwarded: list[str]) -> str | None:
        """Find the client behind a trusted proxy, and count the connection as the client's.

        The result is the name of the limit that the client's address is over, or None.
        """
        return self._connections.attribute(self, forwarded)

    def delay(self, frames: int, now: float) -> float:
        """Seconds to wait with frames that came; they are counted where the result is 0."""
        return self._connections.delay(self, frames, now)

    def prepay(self, frames: int, now: float) -> bool:
        """Count frames that are to come; False if each has to wait for its turn."""
        return self._connections.prepay(self, frames, now)

    def pay_back(self, frames: int, now: float) -> None:
        """Take back frames that have not come."""
        self._connections.pay_back(self, frames, now)

    def settle(self) -> None:
        """Keep the place from now on, whoever comes."""
        if self.present and not self.settled:
            self._connections.settle(self)

    def leave(self) -> None:
        """Give the place back; it may be called more than once."""
        if self.present:
            self._connections.leave(self)


class Connections:
    """The connections of one port, `most` of them."""

    def __init__(
        self, most: int, limits: AddressLimits, proxies: TrustedProxies, refusals: Refusals
    ) -> None:
        self._most = most
        self._limits = limits
        self._proxies = proxies
        self._refusals = refusals
        self._loop = asyncio.get_running_loop()
        self._open: set[Place] = set()
        self._unsettled: dict[str, dict[Place, None]] = {}
        self._gone = asyncio.Event()
        self._gone.set()

    def __len__(self) -> int:
        return len(self._open)

    def enter(self, peer: str) -> Place | None:
        """Give a new connection a place; None if it must be refused."""
        key = address_key(peer)
        charged = not self._proxies.trusts(peer)
        why = self._limits.connect(key, self._loop.time()) if charged else None
        if why is None and len(self._open) >= self._most and not self.make_room(key):
            why = "port_full"
            if charged:
                self._limits.disconnect(key)
        if why is not None:
            self._refusals.socket(why, key)
            return None
        place = Place(self, peer, key, charged)
        self._open.add(place)
        self._gone.clear()
        self._unsettled.setdefault(key, {})[place] = None
        return place

    def no_descriptor(self) -> None:
        """Note that connections have to wait, because the process has no descriptor for them."""
        self._refusals.socket("no_descriptor", "unknown")

    def make_room(self, key: str) -> bool:
        """Cut off the oldest unsettled connection of the address that has the most of them.

        Nobody is cut off, and the result is False, if no address has more than the given one.
        """
        most = max(self._unsettled, key=lambda each: len(self._unsettled[each]), default=key)
        crowd = self._unsettled.get(most, {})
        if len(crowd) <= len(self._unsettled.get(key, {})):
            return False
        place = next(iter(crowd))
        self._refusals.socket("port_full", most)
        place.leave()
        place.cut()
        return True

    def attribute(self, place: Place, forwarded: list[str]) -> str | None:
        """See `Place.attribute`."""
        if place.charged or not place.present or not forwarded:
            return None
        key = self._proxies.client_key(place.peer, forwarded)
        why = self._limits.connect(key, self._loop.time())
        if why is None:
            self._forget_unsettled(place)
            place.address, place.charged = key, True
            self._unsettled.setdefault(key, {})[place] = None
        else:
            self._refusals.socket(why, key)
        return why

    def delay(self, place: Place, frames: int, now: float) -> float:
        """See `Place.delay`."""
        return self._limits.delay(place.address, frames, now) if place.charged else 0.0

    def prepay(self, place: Place, frames: int, now: float) -> bool:
        """See `Place.prepay`."""
        return not place.charged or self._limits.prepay(place.address, frames, now)

    def pay_back(self, place: Place, frames: int, now: float) -> None:
        """See `Place.pay_back`."""
        if place.charged and place.present:
            self._limits.pay_back(place.address, frames, now)

    def settle(self, place: Place) -> None:
        """See `Place.settle`."""
        place.settled = True
        self._forget_unsettled(place)

    def leave(self, place: Place) -> None:
        """See `Place.leave`."""
        place.present = False
        self._open.discard(place)
        if not self._open:
            self._gone.set()
        if not place.settled:
            self._forget_unsettled(place)
        if place.charged:
            self._limits.disconnect(place.address)

    async def all_gone(self) -> None:
        """Wait until no connection is open."""
        await self._gone.wait()

    async def shut(self, server: Server) -> None:
        """Close the port, wait a moment for its connections to end, cut off the others."""
        server.close()
        with suppress(TimeoutError):
            async with asyncio.timeout(SHUT_S):
                await server.wait_closed()
        for place in list(self._open):
            place.cut()
        await server.wait_closed()

    def _forget_unsettled(self, place: Place) -> None:
        crowd = self._unsettled[place.address]
        del crowd[place]
        if not crowd:
            del self._unsettled[place.address]


def _nothing() -> None:
    """Nothing is to be ended yet."""
