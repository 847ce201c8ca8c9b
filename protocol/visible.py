"""Characters that nobody can see, and marks piled on one letter: the same in names and in chat."""

import unicodedata
from collections.abc import Iterator
from typing import Final

MAX_MARKS: Final = 4
"""Marks of any kind in a row, vowels of South-East Asian scripts among them."""

JOINER: Final = "\u200d"
"""It makes one emoji of two."""

INVISIBLE: Final = frozenset(
    chr(code)
    for begin, end in (
        (0x034F, 0x034F),  # combining grapheme joiner
        (0x115F, 0x1160),  # fillers of Korean letters
        (0x1680, 0x1680),  # the space of Ogham, which some fonts draw
        (0x17B4, 0x17B5),  # inherent vowels of Khmer
        (0x180B, 0x180F),  # variation selectors of Mongolian
        (0x2065, 0x2065),  # ignorable, and not given out
        (0x2800, 0x2800),  # a Braille pattern without dots
        (0x3164, 0x3164),  # filler of Korean letters
        (0xFE00, 0xFE0F),  # variation selectors
        (0xFFA0, 0xFFA0),  # filler of Korean letters, of half width
        (0xFFFC, 0xFFFC),  # place of an object
        (0x13441, 0x13446),  # blanks of hieroglyphs
        (0xFFF0, 0xFFF8),  # ignorable, and not given out
        (0x16FE4, 0x16FE4),  # filler of Khitan
        (0x1D159, 0x1D159),  # a note without a head
        (0xE0000, 0xE0FFF),  # tags and further variation selectors
    )
    for code in range(begin, end + 1)
)
"""Characters of other categories that most fonts draw as nothing (Default_Ignorable_Code_Point of
Unicode's DerivedCoreProperties, and blanks of a width)."""


def hidden(text: str, place: int) -> str | None:
    """Name the kind of the character at a place if nobody can see it, None if it is seen.

    A joiner between two emoji counts as seen: it makes one picture of them.
    """
    char = text[place]
    within = char == JOINER and 0 < place < len(text) - 1
    if within and is_picture(text[place - 1]) and is_picture(text[place + 1]):
        return None
    if char in INVISIBLE:
        return "an invisible character"
    return "an invisible format character" if unicodedata.category(char) == "Cf" else None


def is_picture(char: str) -> bool:
    """Whether a character is a picture, or the colour of a skin that belongs to one."""
    return unicodedata.category(char) in {"So", "Sk"}


def excess_marks(text: str, accents: int, marks: int) -> Iterator[tuple[int, bool]]:
    """The places of marks that are too many on their letter, or have none.

    A letter may bear so many `accents`, which stand above or below it, and so many `marks` of any
    kind. With each place comes whether there is a letter.
    """
    above = every = 0
    based = False
    for place, char in enumerate(text):
        if unicodedata.category(char)[0] != "M":
            above, every, based = 0, 0, not char.isspace()
            continue
        every += 1
        above += unicodedata.combining(char) != 0
        if not based or above > accents or every > marks:
            yield place, based
