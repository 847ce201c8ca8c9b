"""Floods: frames as fast as one connection takes them."""

from functools import partial
from itertools import cycle
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire, frame

_AT_ONCE: Final = 2000

PING: Final = frame(b"", 0x89)
PONG: Final = frame(b"", 0x8A)
CLOSE: Final = frame(b"", 0x88)
FIRST_FRAGMENT: Final = frame(b"", 0x02)
EMPTY_FRAGMENT: Final = frame(b"", 0x00)


def _flood(attacker: Attacker, first: bytes, repeated: bytes) -> None:
    """Write one frame for ever, and come again whenever the connection is closed."""
    attacker.start_clock()
    many = repeated * _AT_ONCE
    while attacker.goes_on:
        try:
            with Wire(attacker.port) as wire:
                wire.join("Flood")
                attacker.counts["joined"] += 1
                wire.socket.settimeout(max(attacker.left_s, 0.001))
                wire.socket.sendall(first)
                while attacker.goes_on:
                    wire.socket.sendall(many)
                    attacker.counts["frames"] += _AT_ONCE
        except OSError:
            attacker.refused()


def _single_bytes(attacker: Attacker) -> None:
    """Write whole pings, but each byte by itself."""
    attacker.start_clock()
    while attacker.goes_on:
        try:
            with Wire(attacker.port) as wire:
                wire.join("Drip")
                wire.socket.settimeout(max(attacker.left_s, 0.001))
                for byte in cycle(PING):
                    if not attacker.goes_on:
                        break
                    wire.socket.send(bytes([byte]))
                    attacker.counts["bytes"] += 1
        except OSError:
            attacker.refused()


def _kind(name: str, about: str, first: bytes, repeated: bytes) -> Attack:
    return Attack(name, about, partial(_flood, first=first, repeated=repeated))


ATTACKS: Final = (
    _kind("pings", "pings as fast as one connection takes them", b"", PING),
    _kind("pongs", "pongs that nobody has asked for", b"", PONG),
    _kind("closes", "frames behind a close", CLOSE, CLOSE + PING),
    _kind("fragments", "a message of empty fragments without end", FIRST_FRAGMENT, EMPTY_FRAGMENT),
    Attack("single-bytes", "pings, each byte in a packet of its own", _single_bytes),
)
