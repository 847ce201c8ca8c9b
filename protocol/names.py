"""Names as people may give them to themselves: one visible line, written in one way.

A name is normalised (NFKC of Unicode Annex 15), so that full-width letters, ligatures and the
like are the letters that they stand for. What is invisible is refused by name, and so are marks
piled on one letter. Which names look alike is decided by the server.
"""

import unicodedata
from typing import Final

from esplanade.protocol.codes import MAX_NAME_CHARS
from esplanade.protocol.visible import MAX_MARKS, excess_marks, hidden

MAX_ACCENTS: Final = 2
"""Marks above or below one letter: Vietnamese and Hebrew need two."""

_EMOJI_STYLES: Final = str.maketrans("", "", "\ufe0e\ufe0f")
"""Keyboards send these with an emoji, to say how it is to be drawn; they are left out."""

_REFUSED_CATEGORIES: Final = {
    "Cc": "a control character",
    "Cn": "not a character that is known here",
    "Co": "a private character",
    "Cs": "half a character",
    "Zl": "a line separator",
    "Zp": "a paragraph separator",
}


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
        what = hidden(text, place) or _REFUSED_CATEGORIES.get(unicodedata.category(char))
        if what is not None:
            raise ValueError(f"character U+{ord(char):04X} is not allowed in a name: it is {what}")


def _check_marks(name: str) -> None:
    for place, has_letter in excess_marks(name, MAX_ACCENTS, MAX_MARKS):
        mark = f"the mark U+{ord(name[place]):04X}"
        if not has_letter:
            raise ValueError(f"{mark} is not allowed in a name without a letter")
        raise ValueError(
            f"a name may hold {MAX_ACCENTS} accents and {MAX_MARKS} marks in a row, "
            f"not {mark} as well"
        )
