"""Numbers of lines of chat in a world on several machines: they tell when and where one was said.

So no two lines of a world have one number, whichever hosts the zones have had, and a gateway that
has missed frames knows which of the lines that it is told anew it has had before.
"""

from typing import Final

TICKS: Final = 2**31
"""Ticks that are told apart; no world runs for longer."""
LINES: Final = 2**10
"""Lines of one tick that have numbers of their own."""


def line_number(place: int, tick: int, line: int) -> int:
    """The number of a line: the place of its zone among all, the tick, and its place in the tick.

    It is less than 2**53 for up to 4095 zones, so that clients read it exactly.
    """
    return (place * TICKS + tick) * LINES + line + 1


def tick_of(number: int) -> int:
    """The tick in which a line of this number was said."""
    return (number - 1) // LINES % TICKS
