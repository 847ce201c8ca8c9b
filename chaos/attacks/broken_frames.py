"""Frames that are not whole, too large, or changed at random."""

import time
from contextlib import suppress
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.mutations import Mutations
from chaos.wire import RefusedError, Wire, frame

_CLIENTS: Final = 20
_TOO_LARGE: Final = (2049, 16 * 1024, 16 * 1024 + 1, 1 << 20)


def _half_frames(attacker: Attacker) -> None:
    """Begin frames, and add a byte a second to each without ever ending one."""
    wires = attacker.wires(_CLIENTS, "Half")
    attacker.start_clock()
    beginning = frame(bytes(2000))[:8]
    for wire in wires:
        with suppress(OSError):
            wire.socket.sendall(beginning)
    while attacker.goes_on:
        for wire in list(wires):
            try:
                wire.discard()
                wire.socket.send(b"\0")
                attacker.counts["bytes"] += 1
            except OSError:
                wires.remove(wire)
                attacker.counts["closed"] += 1
        time.sleep(min(1.0, max(attacker.left_s, 0.0)))


def _oversize(attacker: Attacker) -> None:
    """Send frames that are too large, of several sizes."""
    attacker.start_clock()
    while attacker.goes_on:
        for size in _TOO_LARGE:
            try:
                with Wire(attacker.port) as wire:
                    wire.join("Large")
                    attacker.counts["frames"] += 1
                    wire.socket.sendall(frame(bytes(size)))
                    while attacker.goes_on:
                        wire.receive()
            except RefusedError:
                attacker.counts["closed"] += 1
            except OSError:
                attacker.refused()


def _mutated(attacker: Attacker) -> None:
    """Send changed frames, each on a connection of its own, as often as that is granted."""
    attacker.start_clock()
    mutations = Mutations(attacker.target.seed)
    number = 0
    while attacker.goes_on:
        try:
            wire = Wire(attacker.port)
        except OSError:
            attacker.refused()
            continue
        with wire, suppress(OSError):
            if number % 2:
                wire.join("Mutant")
            wire.socket.sendall(mutations.framed(number))
            number += 1
            attacker.counts["frames"] += 1
            wire.receive(0.1)


ATTACKS: Final = (
    Attack(
        "half-frames",
        "frames that never end, a byte a second; the server waits 15 s for one",
        _half_frames,
        least_s=18.0,
    ),
    Attack("oversize", "frames of 2049 bytes to 1 MiB", _oversize),
    Attack("mutated", "frames changed at random, as many as are let in", _mutated, by_speed=True),
)
