"""The looks of visitors: drawn by chance, the same for the same seed."""

import random

from esplanade.protocol.looks import MOST, SHORTEST_CM, Look


def look_of(seed: int, index: int) -> Look:
    """The look of visitor number `index`; the same pair looks the same."""
    chance = random.Random(f"look {seed} {index}")
    stature_cm = round(chance.gauss(171.0, 9.0))
    return Look(
        shirt=chance.randint(1, MOST.shirt),
        trousers=chance.randint(1, MOST.trousers),
        hair=chance.randint(1, MOST.hair),
        hair_colour=chance.randint(1, MOST.hair_colour),
        skin=chance.randint(1, MOST.skin),
        stature_cm=min(max(stature_cm, SHORTEST_CM), MOST.stature_cm),
    )
