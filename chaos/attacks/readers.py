"""Readers that never read what the server sends, or that read it too slowly.

They walk about on one spot, so that each is told of all the others as much as its budget allows.
"""

import time
from contextlib import suppress
from functools import partial
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire
from esplanade.protocol.messages import Move

CLIENTS: Final = 40
_SMALL_BUFFER: Final = 4096


def _read(attacker: Attacker, bytes_per_s: int) -> None:
    """Join and come again when dropped; read so many bytes a second on each connection."""
    attacker.start_clock()
    wires: list[Wire] = []
    turns = 0
    while attacker.goes_on:
        try:
            if len(wires) < CLIENTS:
                wire = Wire(attacker.port, receive_bytes=_SMALL_BUFFER)
                wires.append(wire)
                wire.join("Reader")
                attacker.counts["joined"] += 1
        except OSError:
            attacker.refused()
        if len(wires) >= CLIENTS or not attacker.counts["joined"]:
            time.sleep(0.2)
        turns += 1
        for number, each in enumerate(wires):
            _walk(each, turns, number + 2.0 * turns)
        wires = [each for each in wires if _open(each, round(0.2 * bytes_per_s))]
    for each in wires:
        each.close()


def _walk(wire: Wire, seq: int, direction: float) -> None:
    with suppress(OSError):
        wire.send(Move(seq=seq, direction=direction, speed=1.0))


def _open(wire: Wire, most: int) -> bool:
    """Read so many bytes at most; whether the connection is still there."""
    wire.socket.setblocking(False)
    try:
        if most and not wire.socket.recv(most):
            return False
        wire.socket.send(b"")
    except BlockingIOError:
        return True
    except OSError:
        return False
    return True


ATTACKS: Final = (
    Attack(
        "never-read",
        f"{CLIENTS} clients that read nothing",
        partial(_read, bytes_per_s=0),
        least_s=24.0,
    ),
    Attack(
        "read-slowly",
        f"{CLIENTS} clients that read 500 bytes a second",
        partial(_read, bytes_per_s=500),
        least_s=24.0,
    ),
)
