"""Places: a newcomer wishes to begin where no door lets anybody in."""

import math
import time
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire
from esplanade.protocol.messages import Doors, Enter, SetDoor

DOOR: Final = "Archive door"
INSIDE: Final = (5.5, 17.25, 3.5)
"""The archive of the gallery, which has only this door."""

_NEAR_M: Final = 2.0


def _inside(attacker: Attacker) -> None:
    with Wire(attacker.port) as porter:
        welcome = porter.join("Porter", operator=attacker.target.operator_key)
        if welcome.doors[DOOR]:
            porter.send(SetDoor(name=DOOR, open=False))
            while not isinstance(porter.receive(), Doors):
                pass
        attacker.start_clock()
        while attacker.goes_on and not attacker.faults:
            try:
                with Wire(attacker.port) as wire:
                    own = wire.join("Intruder", at=INSIDE).id
                    attacker.counts["joined"] += 1
                    while not isinstance(message := wire.receive(), Enter):
                        pass
                    (place,) = [(e.x, e.y, e.z) for e in message.entities if e.id == own]
                    if math.dist(place, INSIDE) < _NEAR_M:
                        attacker.faults.append("a newcomer was put into a closed room")
                    wire.leave()
            except OSError:
                attacker.refused()
            porter.discard()
            time.sleep(0.2)


ATTACKS: Final = (
    Attack("closed-room", "newcomers wish to begin in a closed room", _inside, breaks_limit=False),
)
