"""Connections that are held open and say little or nothing."""

import socket
import time
from functools import partial
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import UPGRADE, opened

SOCKETS: Final = 1600
PAUSE_S: Final = 0.5


def _hold(attacker: Attacker, first: bytes, drip: bytes) -> None:
    """Open connections up to `SOCKETS`, begin with some bytes, and add a few to each later on."""
    attacker.start_clock()
    held: list[socket.socket] = []
    dripped_s = time.monotonic()
    while attacker.goes_on:
        try:
            if len(held) < SOCKETS:
                made = opened(attacker.port)
                attacker.counts["connections"] += 1
                if first:
                    made.sendall(first)
                held.append(made)
        except OSError:
            attacker.refused()
        if len(held) >= SOCKETS or time.monotonic() - dripped_s > PAUSE_S:
            dripped_s = time.monotonic()
            held = [each for each in held if _alive(each, drip)]
            attacker.counts["most_held"] = max(attacker.counts["most_held"], len(held))
            if len(held) >= SOCKETS:
                time.sleep(min(PAUSE_S, max(attacker.left_s, 0.0)))
    for each in held:
        each.close()


def _alive(connection: socket.socket, drip: bytes) -> bool:
    """Whether the server still holds a connection, which gets a few more bytes if so."""
    connection.setblocking(False)
    try:
        if connection.recv(1) == b"":
            connection.close()
            return False
    except BlockingIOError:
        pass
    except OSError:
        connection.close()
        return False
    try:
        if drip:
            connection.send(drip)
    except OSError:
        connection.close()
        return False
    return True


ATTACKS: Final = (
    Attack(
        "silent", f"{SOCKETS} connections that say nothing", partial(_hold, first=b"", drip=b"")
    ),
    Attack(
        "half-open",
        "handshakes of a WebSocket that stop in the middle",
        partial(_hold, first=UPGRADE, drip=b""),
    ),
    Attack(
        "slow-headers",
        "requests whose headers come by a few bytes",
        partial(_hold, first=b"GET / HTTP/1.1\r\nHost: localhost\r\n", drip=b"X-A: b\r\n"),
    ),
)
