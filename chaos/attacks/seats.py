"""Seats: taken and left waiting, taken at speed, and asked back with tokens that were guessed."""

from functools import partial
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire

SEATS: Final = 100


def _join(attacker: Attacker, stay: bool, token: bool) -> None:
    attacker.start_clock()
    kept: list[Wire] = []
    while attacker.goes_on:
        try:
            wire = Wire(attacker.port)
            kept.append(wire)
            resume = f"{attacker.random.getrandbits(190):032x}" if token else None
            welcome = wire.join(f"Ghost {attacker.counts['joined']}", resume=resume)
            attacker.counts["joined"] += 1
            if welcome.resumed:
                attacker.faults.append("a token that was guessed was taken")
            if not stay:
                kept.pop().close()
        except OSError as refused:
            attacker.refused(refused)
        for each in list(kept):
            try:
                each.discard()
            except OSError:
                kept.remove(each)
                each.close()


ATTACKS: Final = (
    Attack(
        "ghosts",
        f"people who join and drop, in a world of {SEATS} seats",
        partial(_join, stay=False, token=False),
        serve=("--max-clients", str(SEATS)),
    ),
    Attack("joins", "people who join as fast as they are let in", partial(_join, stay=True, token=False)),
    Attack(
        "resume-tokens",
        "resumes with tokens that were guessed",
        partial(_join, stay=False, token=True),
    ),
)
