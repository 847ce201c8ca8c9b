"""The list of all attacks, in the order in which they are made."""

from typing import Final

from chaos.attack import Attack
from chaos.attacks import (
    broken_frames,
    connections,
    doors,
    floods,
    forged_headers,
    movement,
    names,
    pages,
    places,
    readers,
    seats,
    talk,
)

ATTACKS: Final[dict[str, Attack]] = {
    attack.name: attack
    for kind in (
        *(floods, broken_frames, movement, doors, connections, pages, seats),
        *(readers, talk, names, places, forged_headers),
    )
    for attack in kind.ATTACKS
}
