"""Everything of sockets that is compiled is called once before anybody may come in."""

import select
import socket

import numpy as np

from esplanade.server.net.sockets.receiving import Receiving
from esplanade.server.net.sockets.sending import send_to_all
from esplanade.server.net.sockets.system import AVAILABLE


def rehearse_sockets() -> None:
    """Send to a socket of our own, and receive from it."""
    if not AVAILABLE:
        return
    block, ends = np.zeros(2, dtype=np.uint8), np.array([2])
    here, there = socket.socketpair()
    with here, there, select.epoll() as epoll:
        for each in (here, there):
            each.setblocking(False)
        epoll.register(there.fileno(), select.EPOLLIN)
        send_to_all(np.array([here.fileno()]), block, ends - 2, ends, {0: b"first"})
        Receiving(epoll).receive()
