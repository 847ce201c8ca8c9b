"""Sockets of both kinds of addresses, with one number of a port."""

import errno
import socket
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
from websockets.asyncio.client import connect

from esplanade.server.net import listening
from esplanade.server.net.listening import bound_sockets
from tests.server.conftest import Serving


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


async def bound(stack: ExitStack, host: str, port: int = 0) -> list[tuple[str, int]]:
    """The addresses at which sockets of a host are bound until the end of the test."""
    sockets = await bound_sockets(host, port)
    for each in sockets:
        stack.callback(each.close)
        each.listen()
    return [each.getsockname()[:2] for each in sockets]


async def test_without_a_host_both_kinds_of_addresses_have_one_port(stack: ExitStack) -> None:
    (four, port), (six, other_port) = await bound(stack, "")
    assert (four, six) == ("0.0.0.0", "::")
    assert port == other_port != 0


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "0.0.0.0", "::"])
async def test_a_given_address_is_the_only_one(stack: ExitStack, host: str) -> None:
    assert [name for name, _ in await bound(stack, host)] == [host]


async def test_a_port_that_is_taken_at_one_address_is_refused(stack: ExitStack) -> None:
    ((_, port),) = await bound(stack, "::1")
    with pytest.raises(OSError, match=f":: port {port}: ") as refused:
        await bound(stack, "", port)
    assert refused.value.errno == errno.EADDRINUSE
    # The address that was bound until then is free again.
    assert await bound(stack, "127.0.0.1", port) == [("127.0.0.1", port)]


async def test_another_free_port_is_tried_when_one_is_taken_at_the_other_kind(
    stack: ExitStack, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken: list[int] = []
    real = listening._bound_at

    def bound_at(family: socket.AddressFamily, address: tuple[Any, ...]) -> socket.socket:
        if family == socket.AF_INET6 and len(taken) < 3:
            taken.append(address[1])
            raise OSError(errno.EADDRINUSE, "taken")
        return real(family, address)

    monkeypatch.setattr(listening, "_bound_at", bound_at)
    (_, port), (_, other_port) = await bound(stack, "")
    assert len(taken) == 3
    assert port == other_port


async def test_a_machine_without_ipv6_has_the_other_kind(
    stack: ExitStack, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = socket.socket

    def made(family: int, kind: int) -> socket.socket:
        if family == socket.AF_INET6:
            raise OSError(errno.EAFNOSUPPORT, "Address family not supported by protocol")
        return real(family, kind)

    monkeypatch.setattr(listening.socket, "socket", made)
    assert [name for name, _ in await bound(stack, "")] == ["0.0.0.0"]
    with pytest.raises(OSError, match="::1 port 0: Address family not supported"):
        await bound(stack, "::1")


async def test_a_world_is_reached_by_both_kinds_of_addresses(serving: Serving) -> None:
    async with serving(host="") as server:
        for host in ("127.0.0.1", "[::1]", "localhost"):
            async with connect(f"ws://{host}:{server.port}/ws", proxy=None):
                pass
