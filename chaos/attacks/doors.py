"""Doors: moved without end by somebody who may, and by somebody who may not."""

import time
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire
from esplanade.protocol.messages import SetDoor

RATE: Final = 25.0
DOORS: Final = ("Sculpture door", "Archive door")


def _right_key(attacker: Attacker) -> None:
    """Move both doors 25 times a second."""
    with Wire(attacker.port) as wire:
        if not wire.join("Porter", operator=attacker.target.operator_key).operator:
            attacker.faults.append("the operator key was not taken")
        attacker.start_clock()
        state, next_s = False, time.monotonic()
        while attacker.goes_on:
            state = not state
            wire.discard()
            for door in DOORS:
                wire.send(SetDoor(name=door, open=state))
                attacker.counts["wishes"] += 1
            next_s += 1.0 / RATE
            time.sleep(max(0.0, next_s - time.monotonic()))


def _wrong_keys(attacker: Attacker) -> None:
    """Try keys, one each time that a connection is granted, and a door with each."""
    attacker.start_clock()
    while attacker.goes_on:
        try:
            with Wire(attacker.port) as wire:
                key = f"{attacker.random.getrandbits(128):032x}"
                if wire.join("Burglar", operator=key).operator:
                    attacker.faults.append("a wrong key was taken")
                attacker.counts["keys"] += 1
                wire.send(SetDoor(name=DOORS[0], open=True))
                wire.leave()
        except OSError:
            attacker.refused()


ATTACKS: Final = (
    Attack(
        "doors",
        f"an operator moves two doors {RATE:g} times a second",
        _right_key,
        breaks_limit=False,
    ),
    Attack("wrong-keys", "wrong operator keys, as many as are let in", _wrong_keys),
)
