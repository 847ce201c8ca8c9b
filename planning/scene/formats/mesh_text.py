"""Text of mesh files, within bounds: a list of numbers takes many times the room of its text."""

from typing import Final

from esplanade.files.text import check_lines, decoded, lines_of

MOST_OF_A_LINE: Final = 2**19
"""A face of as many corners as are possible has less."""
MAX_TEXT_BYTES: Final = 208 * 2**20
"""As many as five million triangles take."""


def text_of_mesh(data: bytes) -> str:
    """The text of a mesh, in any encoding.

    Raises
    ------
    ValueError
        It is no text, or longer than may be.
    """
    if len(data) > MAX_TEXT_BYTES:
        raise ValueError(f"its text has more than {MAX_TEXT_BYTES // 2**20} MiB: save it as bytes")
    text = decoded(data, eight_bit=True).text
    check_lines(text)
    if len(text) > MOST_OF_A_LINE:
        for number, line in enumerate(lines_of(text), 1):
            if len(line) > MOST_OF_A_LINE:
                raise ValueError(f"line {number} has more than {MOST_OF_A_LINE} characters")
    return text
