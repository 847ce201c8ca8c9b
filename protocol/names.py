"""Names as people may give them to themselves: one visible line, written in one way.

A name is normalised (NFKC of Unicode Annex 15), so that full-width letters, ligatures and the
like are the letters that they stand for. What is invisible is refused by name, and so are marks
piled on one letter. Which names look alike is decided by the server.
"""

import unicodedata
from typing import Final

from esplanade.protocol.codes import MAX_NAME_CHARS

MAX_ACCENTS: Final = 2
"""Marks above or below one letter: Vietnamese and Hebrew need two."""

MAX_MARKS: Final = 4
"""Marks of any kind in a row, vowels of South-East Asian scripts among them."""

_EMOJI_STYLES: Final = str.maketrans("", "", "\ufe0e\ufe0f")
"""Keyboards send these with an emoji, to say how it is to be drawn; they are left out."""

_REFUSED_CATEGORIES: Final = {
    "Cc": "a control character",
    "Cf": "an invisible format character",
    "Cn": "not a character that is known here",
    "Co": "a private character",
    "Cs": "half a character",
    "Zl": "a line separator",
    "Zp": "a paragraph separator",
}

_JOINER: Final = "\u200d"
"""It makes one emoji of two, and is allowed for nothing else."""

_INVISIBLE: Final = frozenset(
    chr(code)
    for begin, end in (
        (0x034F, 0x034F),  # combining grapheme joiner
        (0x115F, 0x1160),  # fillers of Korean letters
        (0x1680, 0x1680),  # the space of Ogham, which some fonts draw
        (0x17B4, 0x17B5),  # inherent vowels of Khmer
        (0x180B, 0x180F),  # variation selectors of Mongolian
        (0x2800, 0x2800),  # a Braille pattern without dots
        (0x3164, 0x3164),  # filler of Korean letters
        (0xFE00, 0xFE0F),  # variation selectors
        (0xFFA0, 0xFFA0),  # filler of Korean letters, of half width
        (0xFFFC, 0xFFFC),  # place of an object
        (0x13441, 0x13446),  # blanks of hieroglyphs
        (0x16FE4, 0x16FE4),  # filler of Khitan
        (0x1D159, 0x1D159),  # a note without a head
        (0xE0000, 0xE0FFF),  # tags and further variation selectors
    )
    for code in range(begin, end + 1)
)
"""Characters of other categories that most fonts draw as nothing (Default_Ignorable_Code_Point of
Unicode's DerivedCoreProperties, and blanks of a width)."""


def plain_name(text: str) -> str:
    """Return a name in its one way of writing; a plain name comes back as it is.

    Raises
    ------
    ValueError
        The text has nothing to see, something invisible, too many marks or too many characters;
        the message says which.
    """
    written = text.strip().translate(_EMOJI_STYLES)
    _check_visible(written)
    name = " ".join(unicodedata.normalize("NFKC", written).split())
    _check_visible(name)
    if not name:
        raise ValueError("a name needs at least one visible character")
    for length in (len(written), len(name)):  # normalising may lengthen a name
        if length > MAX_NAME_CHARS:
            raise ValueError(f"a name has at most {MAX_NAME_CHARS} characters, this one {length}")
    _check_marks(name)
    return name


def _check_visible(text: str) -> None:
    for place, char in enumerate(text):
        if char == _JOINER and _is_emoji(text[place - 1 : place]) and _is_emoji(text[place + 1 :]):
            continue
        category = unicodedata.category(char)
        what = "an invisible character" if char in _INVISIBLE else _REFUSED_CATEGORIES.get(category)
        if what is not None:
            raise ValueError(f"character U+{ord(char):04X} is not allowed in a name: it is {what}")


def _is_emoji(text: str) -> bool:
    """Whether a text begins with a picture, or with the colour of a skin that belongs to one."""
    return bool(text) and unicodedata.category(text[0]) in {"So", "Sk"}


def _check_marks(name: str) -> None:
    accents = marks = 0
    based = False
    for char in name:
        if unicodedata.category(char)[0] != "M":
            accents, marks, based = 0, 0, not char.isspace()
            continue
        if not based:
            raise ValueError(
                f"the mark U+{ord(char):04X} is not allowed in a name without a letter"
            )
        marks += 1
        accents += unicodedata.combining(char) != 0
        if accents > MAX_ACCENTS or marks > MAX_MARKS:
            raise ValueError(
                f"a name may hold {MAX_ACCENTS} accents and {MAX_MARKS} marks in a row, "
                f"not the further U+{ord(char):04X}"
            )
