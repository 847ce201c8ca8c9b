"""Rows of a grid's arrays by kind of body, and how many use each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

from esplanade.planning.scene.bodies import MOST_BODIES, Body


class BodyRows:
    """The rows of the kinds of body that are known; a row without users may become another's."""

    def __init__(self, rows: Mapping[Body, int] | None = None) -> None:
        self._rows: dict[Body, int] = dict(rows or {})
        self._users: Counter[Body] = Counter()

    def __iter__(self) -> Iterator[Body]:
        return iter(self._rows)

    def __contains__(self, kind: object) -> bool:
        return kind in self._rows

    def get(self, kind: Body) -> int | None:
        """The row of a kind, None if it is not known."""
        return self._rows.get(kind)

    def all(self) -> dict[Body, int]:
        """The rows of all kinds that are known, the longest known one first; a copy."""
        return dict(self._rows)

    def add(self, kind: Body, row: int) -> None:
        """Note the row of a kind that is new."""
        self._rows[kind] = row

    def fork(self) -> BodyRows:
        """A copy."""
        fork = BodyRows(self._rows)
        fork._users = Counter(self._users)
        return fork

    def take_over(self, rows: Mapping[Body, int]) -> bool:
        """Have these rows from now on, if none is left out that is in use; whether that is so."""
        if any(self._users[kind] > 0 for kind in self._rows.keys() - rows.keys()):
            return False
        self._rows = dict(rows)
        return True

    def claim(self, kind: Body, users: int = 1) -> None:
        """Note so many users more of a kind that is known, or fewer if below zero."""
        self._users[kind] += users

    def free_row(self, kind: Body) -> int:
        """A row for a new kind: one more, or that of the longest known one without users.

        Raises
        ------
        ValueError
            All kinds that there can be are in use.
        """
        if len(self._rows) < MOST_BODIES:
            return len(self._rows)
        for known in self._rows:
            if self._users[known] <= 0:
                return self._rows.pop(known)
        raise ValueError(
            f"bodies of {MOST_BODIES} kinds walk in the zone already, and none is like {kind}"
        )
