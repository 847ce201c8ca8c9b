"""Headers of a proxy, written by somebody who is none."""

from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire


def _forged(attacker: Attacker) -> None:
    """Say of every connection that it is somebody else's; all count as the attacker's own."""
    attacker.start_clock()
    kept: list[Wire] = []
    while attacker.goes_on:
        number = attacker.random.getrandbits(24)
        address = f"10.{number >> 16}.{number >> 8 & 255}.{number & 255}"
        header = f"X-Forwarded-For: {address}, 127.0.0.1\r\n".encode()
        try:
            wire = Wire(attacker.port, headers=header)
            kept.append(wire)
            attacker.counts["connections"] += 1
        except OSError:
            attacker.refused()
    for wire in kept:
        wire.close()


ATTACKS: Final = (
    Attack(
        "forged-headers", "X-Forwarded-For names another client each time", _forged, by_speed=True
    ),
)
