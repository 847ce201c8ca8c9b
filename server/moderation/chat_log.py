"""The last lines of chat with who was sent them, where a server keeps chat."""

from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

MOST_LINES: Final = 500
"""Of more lines the oldest are forgotten here; the store keeps them for some days if it is told."""
MOST_HIDDEN: Final = 256
"""Numbers of hidden lines that are told to whoever comes back."""


@dataclass(frozen=True, slots=True)
class KeptLine:
    """A line that was said."""

    line: int
    at_us: int
    tick: int
    id: int
    """The avatar that said it."""
    name: str
    text: str
    seen: tuple[int, ...] = ()
    """The avatars whose people were sent it."""
    hidden: bool = False


class ChatLog:
    """The last lines, and the numbers of those that were hidden."""

    def __init__(self, *, keeps: bool) -> None:
        self.keeps = keeps
        self._lines: OrderedDict[int, KeptLine] = OrderedDict()
        self._hidden: OrderedDict[int, None] = OrderedDict()

    def __iter__(self) -> Iterator[KeptLine]:
        return iter(self._lines.values())

    @property
    def hidden(self) -> list[int]:
        """Numbers of the lines that were hidden last."""
        return list(self._hidden)

    def get(self, line: int) -> KeptLine | None:
        return self._lines.get(line)

    def is_hidden(self, line: int) -> bool:
        return line in self._hidden

    def add(self, line: KeptLine) -> None:
        """Keep a line, unless this server keeps none."""
        if not self.keeps:
            return
        self._lines[line.line] = line
        if len(self._lines) > MOST_LINES:
            self._lines.popitem(last=False)

    def hide(self, line: int) -> None:
        """Note that a line is to be shown no more."""
        self._hidden[line] = None
        if len(self._hidden) > MOST_HIDDEN:
            self._hidden.popitem(last=False)
        found = self._lines.get(line)
        if found is not None:
            self._lines[line] = replace(found, hidden=True)

    def drop(self, line: int) -> None:
        """Forget a line."""
        self._lines.pop(line, None)
