"""Bytes that are sent at once are those that transports would have written."""

import os
import socket
from collections.abc import Iterator
from contextlib import ExitStack

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.server.net.sockets.sending import send_to_all
from esplanade.server.net.sockets.system import AVAILABLE

pytestmark = pytest.mark.skipif(not AVAILABLE, reason="kernels call the system on Linux only")

Pair = tuple[socket.socket, socket.socket]


@pytest.fixture(scope="module")
def pairs() -> Iterator[list[Pair]]:
    with ExitStack() as stack:
        made = [socket.socketpair() for _ in range(6)]
        for each in made:
            for end in each:
                stack.enter_context(end)
                end.setblocking(False)
        yield made


def received(sock: socket.socket) -> bytes:
    got = bytearray()
    while True:
        try:
            more = sock.recv(1 << 16)
        except BlockingIOError:
            return bytes(got)
        if not more:
            return bytes(got)
        got += more


@given(
    st.lists(st.tuples(st.binary(max_size=50), st.binary(min_size=1, max_size=900)), max_size=6),
    st.binary(max_size=20),
)
def test_each_client_gets_its_own_bytes_in_order(
    pairs: list[Pair], wanted: list[tuple[bytes, bytes]], before: bytes
) -> None:
    ends = np.cumsum([len(before), *(len(body) for _, body in wanted)])
    block = np.frombuffer(before + b"".join(body for _, body in wanted) + b"end", np.uint8)
    size, left = send_to_all(
        np.array([pairs[k][0].fileno() for k in range(len(wanted))], dtype=np.int64),
        block,
        ends[:-1],
        ends[1:],
        {k: head for k, (head, _) in enumerate(wanted) if head},
    )
    assert size == sum(len(head) + len(body) for head, body in wanted)
    assert left == {}
    for (_, there), (head, body) in zip(pairs, wanted, strict=False):
        assert received(there) == head + body


@pytest.mark.parametrize("head", [b"", b"first"])
def test_what_the_system_does_not_take_is_left_for_the_transport(head: bytes) -> None:
    body = os.urandom(1 << 20)
    with ExitStack() as stack:
        ends = [stack.enter_context(end) for _ in range(3) for end in socket.socketpair()]
        for each in ends:
            each.setblocking(False)
        here, there = ends[::2], ends[1::2]
        there[1].close()
        where = np.array([0, 0, 0]), np.array([len(body), 3, 3])
        size, left = send_to_all(
            np.array([each.fileno() for each in here]),
            np.frombuffer(body, np.uint8),
            *where,
            dict.fromkeys(range(3), head),
        )
        assert size == 3 * len(head) + len(body) + 6
        assert set(left) == {0, 1}
        assert received(there[0]) + left[0] == head + body
        assert len(left[0]) > 0
        assert left[1] == head + body[:3]
        assert received(there[2]) == head + body[:3]
