"""Lines of chat and watching, faster than anybody needs them."""

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
    attacker.send_at(RATE, wires, lambda *_: message(attacker))


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
