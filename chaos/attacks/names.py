"""Names that deceive: of actors and of the server, look-alikes, invisible and stacked ones."""

from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire
from esplanade.protocol.messages import Enter

REFUSED: Final = {
    "reserved": "server",
    "reserved in capitals": "SERVER",
    "reserved with look-alikes": "ѕеrvеr",
    "Hangul filler": "\u3164",
    "Braille blank": "\u2800",
    "Hangul initial filler": "\u115f",
    "zero width": "\u200b\u200c\u2060",
    "a filler within": "Al\u3164der",
    "right to left": "Al\u202eder",
    "a line break": "Al\nder",
    "a null": "Al\0der",
    "an escape": "Al\x1b[31mder",
    "only accents": "\u0301" * 20,
    "31 stacked accents": "a" + "\u0301" * 31,
    "tags": "Ann\U000e0041\U000e0042",
    "a lone surrogate in bytes": "\ufdd0\ufffe",
}
"""Names that nobody may have, by what is wrong with them."""

_CYRILLIC: Final = str.maketrans("AaBCceEHiKMopPTxy", "АаВСсеЕНіКМорРТху")


def _names(attacker: Attacker) -> None:
    attacker.start_clock()
    actor = _actor_name(attacker)
    hostile = {
        **REFUSED,
        "of an actor": actor,
        "look-alike of an actor": actor.translate(_CYRILLIC),
    }
    for kind, name in hostile.items():
        try:
            with Wire(attacker.port) as wire:
                attacker.counts["tried"] += 1
                taken = wire.join(name).name
                wire.leave()
        except OSError:
            attacker.counts["refused"] += 1
            continue
        if taken == name.strip():
            attacker.faults.append(f"a name was taken as it came: {kind} ({ascii(name)[:40]})")
    with Wire(attacker.port) as one, Wire(attacker.port) as other:
        if one.join("Twin").name == other.join("Twin").name:
            attacker.faults.append("two people have one name")


def _actor_name(attacker: Attacker) -> str:
    """The name of some actor in view; `Alder` if none comes into view."""
    with Wire(attacker.port) as wire:
        wire.join("Reader of names")
        for _ in range(50):
            message = wire.receive()
            if isinstance(message, Enter):
                for each in message.entities:
                    if each.kind == "actor":
                        return each.name
    return "Alder"


ATTACKS: Final = (Attack("names", "names that deceive", _names, breaks_limit=False),)
