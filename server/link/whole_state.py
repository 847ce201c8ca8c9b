"""All that frames have said of a zone: a gateway that has missed some begins anew with it."""

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.protocol.snapshot import RECORD
from esplanade.protocol.steps import STEP
from esplanade.server.link.line_numbers import tick_of
from esplanade.server.world.frame import Entered, Events, Frame, Line, Reshaped
from esplanade.server.world.routes import Point

LINES_TICKS: Final = 200
"""Lines of so many ticks are kept for those who have missed them."""
LINES_KEPT: Final = 256
"""Of more lines in that time the oldest are forgotten."""
BLOCKS: Final = 64
"""The most blocks of records that are kept before they are reduced to the newest of each avatar."""


class WholeState:
    """The state of a zone as its frames tell it. It grows with those who are there.

    The end of a host keeps one to make whole states of, and the end of a gateway one to find what
    is new in them.
    """

    def __init__(self) -> None:
        self._entered: dict[int, Entered] = {}
        self._reshaped: dict[int, Reshaped] = {}
        self._points_at: dict[int, Point] = {}
        self._away: set[int] = set()
        self._doors: dict[str, bool] = {}
        self._acks: dict[int, int] = {}
        self._records = _Newest(RECORD)
        self._steps = _Newest(STEP)
        self._lines: deque[Line] = deque(maxlen=LINES_KEPT)
        """Lines with numbers that were said lately."""
        self._numbers = (0, 0, 0)
        self._rate = 1.0

    def __contains__(self, avatar_id: int) -> bool:
        return avatar_id in self._entered

    @property
    def doors(self) -> dict[str, bool]:
        """Whether each door stands open that anything was said of, by name."""
        return dict(self._doors)

    @property
    def people(self) -> int:
        """Number of people in the zone."""
        return self._numbers[1]

    def begin_with_doors(self, doors: Mapping[str, bool]) -> None:
        """Take in how all doors stand before the first frame."""
        self._doors.update(doors)

    def take(self, frame: Frame) -> None:
        """Take in the next frame, or a whole one as the first."""
        self._forget(frame.left)
        self._entered.update((each.id, each) for each in frame.entered)
        self._reshaped.update((each.id, each) for each in frame.reshaped)
        self._acks.update(frame.acks)
        self._doors.update(frame.events.doors)
        for avatar_id, target in frame.events.pointing.items():
            if target is None:
                self._points_at.pop(avatar_id, None)
            else:
                self._points_at[avatar_id] = target
        for avatar_id, is_away in frame.events.away.items():
            (self._away.add if is_away else self._away.discard)(avatar_id)
        self._records.add(frame.records)
        self._steps.add(frame.steps)
        self._lines.extend(line for line in frame.events.chat if line.number)
        while self._lines and tick_of(self._lines[0].number) < frame.tick - LINES_TICKS:
            self._lines.popleft()
        self._numbers = (frame.tick, frame.people, frame.actors)
        self._rate = frame.rate

    def whole(self) -> Frame:
        """A frame that says all of this to somebody who knows nothing.

        It attaches nobody: whose viewers are where is for each gateway to say. It has the lines of
        the last seconds.
        """
        tick, people, actors = self._numbers
        here = self._entered.keys()
        return Frame(
            tick=tick,
            people=people,
            actors=actors,
            left=[],
            entered=list(self._entered.values()),
            joined=[],
            attached=[],
            detached=[],
            acks=dict(self._acks),
            records=self._records.of(here),
            steps=self._steps.of(here),
            events=Events(
                doors=dict(self._doors),
                pointing=dict(self._points_at),
                chat=list(self._lines),
                away=dict.fromkeys(sorted(self._away), True),
            ),
            reshaped=list(self._reshaped.values()),
            rate=self._rate,
        )

    def difference(self, whole: Frame, *, heard: int | None = None) -> Frame:
        """The frame that leads from here to a whole state, whatever was missed in between.

        Viewers go on looking. An avatar that has come to be somebody else leaves and enters. Lines
        of ticks after `heard` are said, the tick whose frame was the last that was taken in; none
        where nothing was taken in before.
        """
        now = {each.id: each for each in whole.entered}
        bodies = {each.id: each for each in whole.reshaped}
        left = [
            one
            for one, known in self._entered.items()
            if now.get(one) != known or (one in self._reshaped and one not in bodies)
        ]
        gone = set(left)
        stopped = dict.fromkeys(self._points_at.keys() - whole.events.pointing.keys() - gone)
        pointing: dict[int, Point | None] = {**stopped, **whole.events.pointing}
        back = dict.fromkeys(sorted(self._away - whole.events.away.keys() - gone), False)
        away = {
            one: is_away
            for one, is_away in whole.events.away.items()
            if one in gone or one not in self._away
        }
        doors = {
            name: is_open
            for name, is_open in whole.events.doors.items()
            if self._doors.get(name) != is_open
        }
        return replace(
            whole,
            left=left,
            entered=[each for each in whole.entered if self._is_new(each.id, gone)],
            reshaped=[
                each
                for each in whole.reshaped
                if self._is_new(each.id, gone) or self._reshaped.get(each.id) != each
            ],
            events=replace(
                whole.events,
                pointing=pointing,
                doors=doors,
                away=back | away,
                chat=[
                    line
                    for line in whole.events.chat
                    if heard is not None and tick_of(line.number) > heard
                ],
            ),
        )

    def _is_new(self, avatar_id: int, gone: set[int]) -> bool:
        return avatar_id in gone or avatar_id not in self._entered

    def _forget(self, left: Iterable[int]) -> None:
        for one in left:
            self._entered.pop(one, None)
            self._reshaped.pop(one, None)
            self._points_at.pop(one, None)
            self._away.discard(one)
            self._acks.pop(one, None)


class _Newest:
    """The newest packed record of each avatar."""

    def __init__(self, kind: np.dtype[Any]) -> None:
        self._blocks: list[NDArray[np.void]] = [np.zeros(0, dtype=kind)]

    def add(self, block: NDArray[np.void]) -> None:
        """Take in newer records."""
        if len(block):
            self._blocks.append(block)
        if len(self._blocks) > BLOCKS:
            self._blocks = [self._newest()]

    def of(self, ids: Iterable[int]) -> NDArray[np.void]:
        """The newest records of these avatars, by their ids."""
        newest = self._newest()
        kept = newest[np.isin(newest["id"], np.fromiter(ids, dtype=np.int64))]
        self._blocks = [kept]
        return kept

    def _newest(self) -> NDArray[np.void]:
        # The first of equal ids is kept, so the newest come first.
        records = np.concatenate(self._blocks[::-1])
        return records[np.unique(records["id"], return_index=True)[1]]
