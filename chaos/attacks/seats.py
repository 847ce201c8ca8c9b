"""Seats: taken and left waiting, taken at speed, and asked back with tokens that were guessed."""

from functools import partial
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire
from esplanade.protocol import VERSION
from esplanade.protocol.messages import Hello

SEATS: Final = 100
AT_ONCE: Final = 8


def _join(attacker: Attacker, stay: bool, token: bool) -> None:
    """Come in several at a time, as a tick lets them, and drop or stay."""
    attacker.start_clock()
    kept: list[Wire] = []
    while attacker.goes_on:
        coming = [wire for _ in range(AT_ONCE) if (wire := _asked(attacker, token)) is not None]
        for wire in coming:
            try:
                if wire.welcome().resumed:
                    attacker.faults.append("a token that was guessed was taken")
                attacker.counts["joined"] += 1
            except OSError:
                attacker.refused()
            if stay:
                kept.append(wire)
            else:
                wire.close()
        kept = [wire for wire in kept if _read_on(wire)]


def _asked(attacker: Attacker, token: bool) -> Wire | None:
    """A connection that has said hello, if the server takes it."""
    resume = f"{attacker.random.getrandbits(190):048x}" if token else None
    try:
        wire = Wire(attacker.port)
        wire.send(Hello(name=f"Ghost {attacker.counts['hellos']}", version=VERSION, resume=resume))
    except OSError:
        attacker.refused()
        return None
    attacker.counts["hellos"] += 1
    return wire


def _read_on(wire: Wire) -> bool:
    try:
        wire.discard()
    except OSError:
        wire.close()
        return False
    return True


ATTACKS: Final = (
    Attack(
        "ghosts",
        f"people who join and drop, in a world of {SEATS} seats",
        partial(_join, stay=False, token=False),
        by_speed=True,
        serve=("--max-clients", str(SEATS)),
    ),
    Attack(
        "joins",
        "people who join as fast as they are let in",
        partial(_join, stay=True, token=False),
        by_speed=True,
    ),
    Attack(
        "resume-tokens",
        "resumes with tokens that were guessed",
        partial(_join, stay=False, token=True),
        by_speed=True,
    ),
)
