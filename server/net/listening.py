"""Bound sockets at all addresses of a host, the same port at each of them.

A loop's own server takes another free port at each address when it is asked for any, and does not
start on a machine without IPv6 when it is asked for both kinds of addresses.
"""

import asyncio
import errno
import os
import socket
from typing import Any, Final

_ABSENT: Final = {errno.EAFNOSUPPORT, errno.EADDRNOTAVAIL, errno.EPROTONOSUPPORT}
"""The machine has no such kind of addresses, or not this one."""

_Place = tuple[socket.AddressFamily, tuple[Any, ...]]
"""A family of addresses, and an address of it as sockets have it."""

_TRIES: Final = 20
"""A port that is free at one address may be taken at the next; then others are tried."""


async def bound_sockets(host: str, port: int) -> list[socket.socket]:
    """Sockets bound at all addresses of a host, one at least; they do not listen yet.

    An empty host means all addresses of the machine, of IPv4 and of IPv6. Addresses that the
    machine does not have are left out where there are others. The sockets do not block.

    Raises
    ------
    OSError
        The host has no address here, or its port is taken at one of them; the message says which.
    """
    found = await asyncio.get_running_loop().getaddrinfo(
        host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
    )
    # Their order depends on the resolver; nothing else here does.
    places: list[_Place] = sorted({(family, address) for family, *_, address in found})
    for _ in range(_TRIES):
        try:
            return _bound(places, port)
        except OSError as error:
            if port or error.errno != errno.EADDRINUSE:
                raise
            last = error
    raise last


def _bound(places: list[_Place], port: int) -> list[socket.socket]:
    sockets: list[socket.socket] = []
    absent: OSError | None = None
    try:
        for family, address in places:
            try:
                sockets.append(_bound_at(family, (address[0], port, *address[2:])))
            except OSError as error:
                if error.errno not in _ABSENT:
                    raise
                absent = error
            else:
                port = sockets[0].getsockname()[1]
    except OSError:
        for each in sockets:
            each.close()
        raise
    if not sockets:
        raise absent or OSError(errno.EADDRNOTAVAIL, os.strerror(errno.EADDRNOTAVAIL))
    return sockets


def _bound_at(family: socket.AddressFamily, address: tuple[Any, ...]) -> socket.socket:
    try:
        made = socket.socket(family, socket.SOCK_STREAM)
    except OSError as error:
        raise _named(error, address) from None
    try:
        # A port whose last connections are ending may be had again at once.
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if family == socket.AF_INET6:
            # IPv4 has a socket of its own: a client's address then has one form only.
            made.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
        made.setblocking(False)
        made.bind(address)
    except OSError as error:
        made.close()
        raise _named(error, address) from None
    return made


def _named(error: OSError, address: tuple[Any, ...]) -> OSError:
    return OSError(error.errno, f"{address[0]} port {address[1]}: {error.strerror}")
