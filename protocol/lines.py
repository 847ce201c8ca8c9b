"""Lines of chat as others see them: one visible line, without what cannot be seen.

People paste text from anywhere, so what is merely invisible is taken out and not refused; blanks of
a width become spaces. What breaks lines or turns the direction of writing is refused by name.
"""

import unicodedata
from typing import Final

from esplanade.protocol.codes import MAX_CHAT_CHARS
from esplanade.protocol.visible import JOINER, MAX_MARKS, excess_marks, hidden, is_picture

_DIRECTION_MARKS: Final = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
_BLANKS: Final = str.maketrans("\u1680\u2800", "  ")
_NON_JOINER: Final = "\u200c"
_EMOJI_STYLES: Final = "\ufe0e\ufe0f"
_KEYCAP: Final = "\u20e3"
_VIRAMA: Final = 9
"""The combining class of marks that join consonants in the scripts of India."""


def plain_line(text: str) -> str:
    """Return a line of chat without what cannot be seen; a plain line comes back as it is.

    Raises
    ------
    ValueError
        The text has nothing to see, would break the line or turn it around, or is too long.
    """
    if (
        text.isascii()
        and text.isprintable()
        and 0 < len(stripped := text.strip()) <= MAX_CHAT_CHARS
    ):
        return stripped
    for char in text:
        if unicodedata.category(char) in {"Cc", "Zl", "Zp"} or char in _DIRECTION_MARKS:
            raise ValueError(f"character U+{ord(char):04X} is not allowed, expected one plain line")
    line = unicodedata.normalize("NFC", _seen(text.translate(_BLANKS)))
    excess = {place for place, _ in excess_marks(line, MAX_MARKS, MAX_MARKS)}
    line = "".join(char for place, char in enumerate(line) if place not in excess)
    line = _seen(line).strip()  # a joiner whose mark has gone goes too
    if not any(char.isprintable() and not char.isspace() for char in line):
        raise ValueError("expected at least one visible character")
    if len(line) > MAX_CHAT_CHARS:  # normalising may lengthen a text
        raise ValueError(f"a line has at most {MAX_CHAT_CHARS} characters, this one {len(line)}")
    return line


def _seen(text: str) -> str:
    return "".join(char for place, char in enumerate(text) if _stays(text, place))


def _stays(text: str, place: int) -> bool:
    """Whether a character can be seen, or changes how its neighbours look."""
    if hidden(text, place) is None:
        return True
    char, before, after = text[place], text[place - 1 : place], text[place + 1 : place + 2]
    if not before:
        return False
    if char in _EMOJI_STYLES:
        return is_picture(before) or after == _KEYCAP
    if char not in {JOINER, _NON_JOINER} or not after or unicodedata.category(after)[0] != "L":
        return False
    # Within words of Arabic script and after a virama they choose the shapes of letters.
    if unicodedata.combining(before) == _VIRAMA:
        return True
    return unicodedata.bidirectional(before) == unicodedata.bidirectional(after) == "AL"
