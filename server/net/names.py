"""Names that people have in a world: no two look alike, and nobody is taken for the server.

What looking alike means is said in `esplanade.server.moderation.skeletons`.
"""

from collections.abc import Iterable, Iterator
from itertools import count
from typing import Final, NamedTuple

from esplanade.protocol.codes import MAX_NAME_CHARS
from esplanade.server.moderation.skeletons import skeleton

RESERVED: Final = ("admin", "administrator", "moderator", "operator", "server", "system")
"""These names are refused, with any digits and signs around or between the letters."""


class ReservedNameError(ValueError):
    """The name is one that nobody may bear, or looks like one."""


_RESERVED_SKELETONS: Final = frozenset(skeleton(name) for name in RESERVED)


class _Given(NamedTuple):
    """The entry that has to be given back with a name."""

    skeleton: str
    wished: str
    """The skeleton of the name that was asked for."""
    number: int


def check_reserved(wished: str) -> str:
    """The skeleton of a name that somebody wishes.

    Raises
    ------
    ReservedNameError
        Nobody may bear that name.
    """
    letters = "".join(char for char in wished if char.isalpha())
    wished_skeleton = skeleton(wished)
    if {wished_skeleton, skeleton(letters)} & _RESERVED_SKELETONS:
        raise ReservedNameError(f"the name {wished!r} is kept for the world itself")
    return wished_skeleton


def like(wished: str) -> Iterator[tuple[str, str]]:
    """The name that somebody wishes, and then that with " 2" and so on; each with its skeleton."""
    yield wished, skeleton(wished)
    for number in count(2):
        name = _numbered(wished, number)
        yield name, skeleton(name)


class Names:
    """The names that are taken in one world."""

    def __init__(self, fixed: Iterable[str] = ()) -> None:
        """`fixed` holds the names of actors, which are taken for as long as the world lasts."""
        self._taken: set[str] = set()
        self.reserve(fixed)
        self._given: dict[str, _Given] = {}
        self._numbers: dict[str, set[int]] = {}

    def reserve(self, fixed: Iterable[str]) -> None:
        """Let nobody have the names of these actors."""
        self._taken |= {skeleton(name) for name in fixed}

    def take(self, wished: str) -> str:
        """Give somebody the name they wish, or with " 2" and so on if another has one like it.

        Raises
        ------
        ReservedNameError
            Nobody may bear that name.
        """
        wished_skeleton = check_reserved(wished)
        numbers = self._numbers.setdefault(wished_skeleton, set())
        number, name, key = 1, wished, wished_skeleton
        while number in numbers or key in self._taken:
            number += 1
            if number not in numbers:
                name = _numbered(wished, number)
                key = skeleton(name)
        numbers.add(number)
        self._taken.add(key)
        self._given[name] = _Given(key, wished_skeleton, number)
        return name

    def give_back(self, name: str) -> None:
        """Let others have a name again."""
        given = self._given.pop(name)
        self._taken.discard(given.skeleton)
        numbers = self._numbers[given.wished]
        numbers.discard(given.number)
        if not numbers:
            del self._numbers[given.wished]


def _numbered(name: str, number: int) -> str:
    """The name with a number, cut to fit."""
    suffix = f" {number}"
    return name[: MAX_NAME_CHARS - len(suffix)].rstrip() + suffix
