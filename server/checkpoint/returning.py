"""The seats of people who may come back after a restart."""

from collections.abc import Mapping, Sequence, Set
from typing import Any, NamedTuple

from esplanade.server.checkpoint.rows import KeptSeat


class Left(NamedTuple):
    """The seats that wait, each with its seconds of waiting so far, and avatars that are gone."""

    waiting: Sequence[tuple[KeptSeat, float]] = ()
    gone: Sequence[int] = ()


def those_left(
    seats: list[KeptSeat],
    saved: Mapping[str, Any] | None,
    *,
    sent_out: Set[int],
    resume_s: float,
    most: int,
) -> Left:
    """The seats of the store that are still somebody's, those that have waited longest first.

    `saved` is what the hub knew of seats at the checkpoint: those that were given up, though the
    store did not know that yet, and for how long others had waited. The time that the server was
    down does not count.

    Raises
    ------
    ValueError, KeyError, TypeError
        `saved` is not what the hub saves.
    """
    given_up, vacant = ((), {}) if saved is None else (saved.get("given_up", ()), saved["vacant_s"])
    waiting: list[tuple[KeptSeat, float]] = []
    gone = []
    for seat in seats:
        waited_s = float(vacant.get(seat.avatar) or 0.0)
        is_gone = seat.avatar in given_up or seat.avatar in sent_out
        if is_gone or not 0.0 <= waited_s < resume_s:
            gone.append(seat.avatar)
        else:
            waiting.append((seat, waited_s))
    waiting.sort(key=lambda each: -each[1])
    too_many = max(0, len(waiting) - most)
    gone += [seat.avatar for seat, _ in waiting[:too_many]]
    return Left(waiting[too_many:], gone)
