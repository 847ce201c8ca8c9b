"""The dialect of a table in text: what separates cells, the decimal point, what is comment."""

import csv
import re
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

from esplanade.files.text import lines_of

_SAMPLE_LINES: Final = 60
_NUMBER: Final = re.compile(
    r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?(nan|inf|infinity)", re.IGNORECASE
)
_COMMA_NUMBER: Final = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?")
_THOUSANDS: Final = re.compile(r"[-+]?\d{1,3}(?:\.\d{3})+(,\d+)?")
_SEPARATOR_LINE: Final = re.compile(r"sep=(.)", re.IGNORECASE)
_RULE: Final = frozenset("|-+:= \t")
_MINUS: Final = "\N{MINUS SIGN}"
MOST_COMMENTS: Final = 1000
MOST_OF_A_COMMENT: Final = 2000
COMMENTS: Final = ("#", "//", "%", "*")


class Line(NamedTuple):
    """A line of the file that is not blank; lines count from 1."""

    number: int
    text: str


class Dialect(NamedTuple):
    """The way in which lines become cells; `delimiter` is None for white space."""

    delimiter: str | None
    decimal_comma: bool

    @property
    def cells(self) -> Callable[[str], list[str]]:
        """The cells of a line, without quotes and white space around them."""
        if self.delimiter is None:
            return _by_space
        return lambda text: _by(text, str(self.delimiter))

    def plain(self, cell: str) -> str:
        """The cell with a decimal point and the minus of ASCII."""
        if cell.startswith(_MINUS):
            cell = f"-{cell[1:]}"
        if self.decimal_comma and "," in cell:
            grouped = _THOUSANDS.fullmatch(cell)
            if grouped is not None or _COMMA_NUMBER.fullmatch(cell):
                return cell.replace(".", "").replace(",", ".")
        return cell

    def is_doubtful(self, cell: str) -> bool:
        """Whether nobody can tell if the points in a cell stand before thousands or decimals."""
        return self.decimal_comma and "," not in cell and bool(_THOUSANDS.fullmatch(cell))

    def is_number(self, cell: str) -> bool:
        """Whether the cell holds a number."""
        return bool(_NUMBER.fullmatch(self.plain(cell)))


class Table(NamedTuple):
    """The lines of a table, its comments apart; `separator` is what a line `sep=` names."""

    lines: list[Line]
    comments: list[Line]
    separator: str | None = None


def table_of(text: str) -> Table:
    """Divide a text into content and comments."""
    lines: list[Line] = []
    comments: list[Line] = []
    separator = None
    for number, line in enumerate(lines_of(text), start=1):
        stripped = line.strip(" \f\v\0") if "\t" in line else line.strip()
        if not stripped.strip():
            continue
        is_section = stripped.startswith("$") and ":" not in stripped  # of PTV's programs
        is_rule = "--" in stripped and set(stripped) <= _RULE
        if is_section or is_rule or stripped.lstrip("\"'").startswith(COMMENTS):
            if len(comments) < MOST_COMMENTS:
                comments.append(Line(number, stripped[:MOST_OF_A_COMMENT].strip().strip("\"'")))
        elif not lines and (found := _SEPARATOR_LINE.fullmatch(stripped.strip().strip('"'))):
            separator = found[1]
        else:
            lines.append(Line(number, stripped))
    return Table(lines, comments, separator)


def dialect_of(table: Table) -> Dialect:
    """Find the dialect from the first lines."""
    sample = [line.text for line in table.lines[:_SAMPLE_LINES]]
    if table.separator is not None:
        return _with_decimals(table.separator, sample)
    spaced = [_by_space(text) for text in sample[1:] or sample]
    for delimiter in (";", "\t", "|"):
        if sample and sum(delimiter in text for text in sample) >= 0.9 * len(sample):
            return _with_decimals(delimiter, sample)
    if sample and sum("," in text for text in sample) >= 0.5 * len(sample):
        is_decimal = all(
            len(cells) >= 4
            and all(_NUMBER.fullmatch(c) or _COMMA_NUMBER.fullmatch(c) for c in cells)
            for cells in spaced
        )
        return Dialect(None, decimal_comma=True) if is_decimal else _with_decimals(",", sample)
    return Dialect(None, decimal_comma=False)


def _with_decimals(delimiter: str, sample: Sequence[str]) -> Dialect:
    cells = [cell for text in sample for cell in _by(text, delimiter)]
    commas = any(_COMMA_NUMBER.fullmatch(cell) for cell in cells)
    # Between commas, numbers with commas stand in quotes: there they may be grouped in thousands.
    grouped = delimiter == "," and any("." in c and _NUMBER.fullmatch(c) for c in cells)
    return Dialect(delimiter, decimal_comma=commas and not grouped)


def _by(text: str, delimiter: str) -> list[str]:
    quote = next((mark for mark in "\"'" if mark in text), None)
    return [cell.strip() for cell in _quoted(text, delimiter, quote)]


def _by_space(text: str) -> list[str]:
    if '"' not in text:
        return text.split()
    return [cell for cell in _quoted(" ".join(text.split()), " ", '"') if cell.strip()]


def _quoted(text: str, delimiter: str, quote: str | None) -> list[str]:
    if quote is None:
        return text.split(delimiter)
    try:
        rows = csv.reader([text], delimiter=delimiter, quotechar=quote, skipinitialspace=True)
        return next(rows, [])
    except csv.Error:  # a cell longer than any that is meant
        return text.split(delimiter)
