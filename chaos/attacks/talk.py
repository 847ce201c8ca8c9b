"""Lines of chat and watching, faster than anybody needs them."""

import time
from collections.abc import Callable
from functools import partial
from typing import Final

from chaos.attack import Attack, Attacker
from esplanade.protocol.messages import ChatLine, FromClient, Watch

CLIENTS: Final = 20
RATE: Final = 50.0


def _talk(attacker: Attacker, message: Callable[[Attacker], FromClient]) -> None:
    """Send messages of one kind just below the rate of all messages."""
    wires = attacker.wires(CLIENTS, "Talker")
    attacker.start_clock()
    next_s = time.monotonic()
    while attacker.goes_on:
        for wire in list(wires):
            try:
                wire.discard()
                wire.send(message(attacker))
                attacker.counts["sent"] += 1
            except OSError:
                wires.remove(wire)
                attacker.counts["closed"] += 1
        next_s += 1.0 / RATE
        time.sleep(max(0.0, next_s - time.monotonic()))


def _line(attacker: Attacker) -> FromClient:
    return ChatLine(text=f"{attacker.random.getrandbits(64):x} " * 15)


def _watch(attacker: Attacker) -> FromClient:
    return Watch(id=attacker.random.randrange(40))


ATTACKS: Final = (
    Attack(
        "chat", f"{CLIENTS} clients talk {RATE:g} times a second", partial(_talk, message=_line)
    ),
    Attack(
        "watch",
        f"{CLIENTS} clients watch another actor {RATE:g} times a second",
        partial(_talk, message=_watch),
        breaks_limit=False,
    ),
)
