"""Heat maps of a world: where people and actors are, how fast, where they wait and touch."""

import base64
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.protocol.snapshot import POSITION_M, SPEED_MPS
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.measures import STANDING

CELL_M: Final = 0.5
CHUNK_S: Final = 10
"""Seconds that are kept together; windows are whole numbers of them."""
WINDOWS_S: Final = (60, 600, 3600)
KINDS: Final = ("density", "speed", "waiting", "contacts")
BELOW_M: Final = 1.0
"""Whoever stands lower than a storey by no more than this counts as on it."""

Ints = npt.NDArray[np.int64]


class _Chunk(NamedTuple):
    """Some seconds in the cells where somebody was, each cell once."""

    chunk: int
    cells: Ints
    sums: npt.NDArray[np.float32]
    """(4, C): samples of somebody, their speeds m/s, samples of waiting, contacts."""


class Heat:
    """Sums in cells of 0.5 m, storey by storey, of the last hour."""

    def __init__(
        self,
        feed: MapFeed,
        bounds: tuple[float, float, float, float],
        storeys_m: Sequence[float],
    ) -> None:
        self._feed = feed
        self._storeys_m = np.array(list(storeys_m) or [0.0])
        self.origin_m = bounds[:2]
        self.width = max(1, int(np.ceil((bounds[2] - bounds[0]) / CELL_M)))
        self.height = max(1, int(np.ceil((bounds[3] - bounds[1]) / CELL_M)))
        self._chunks: deque[_Chunk] = deque(maxlen=WINDOWS_S[-1] // CHUNK_S)
        self._chunk = 0
        self._parts: list[tuple[Ints, npt.NDArray[np.float32]]] = []

    def add(self, second: int) -> None:
        """Take in everybody as of a second since 1970."""
        self._turn(second // CHUNK_S)
        records = self._feed.records
        speeds = records["speed"].astype(np.float32) * SPEED_MPS
        held = np.isin(records["reason"], STANDING).astype(np.float32)
        ones, none = np.ones_like(speeds), np.zeros_like(speeds)
        self._parts.append((self._cells(records), np.stack([ones, speeds, held, none])))

    def contact(self, second: int, avatar_id: int) -> None:
        """Take in a contact, where one of those who touch is."""
        self._turn(second // CHUNK_S)
        row = int(np.searchsorted(self._feed.ids, avatar_id))
        cells = self._cells(self._feed.records[row : row + 1])
        sums = np.zeros((4, len(cells)), dtype=np.float32)
        sums[3] = 1.0
        self._parts.append((cells, sums))

    def told(self, kind: str, window_s: int) -> Iterator[dict[str, Any] | None]:
        """Sum a window up: None again and again, so that others have a turn, then the answer."""
        total = np.zeros((4, len(self._storeys_m) * self.width * self.height), dtype=np.float32)
        first = self._chunk - window_s // CHUNK_S + 1
        chunks = [each for each in self._chunks if each.chunk >= first]
        if self._parts:
            chunks.append(self._together())
        for each in chunks:
            total[:, each.cells] += each.sums
            yield None
        seconds = float(min(window_s, max(1, len(chunks) * CHUNK_S)))
        samples, speeds, held, contacts = total
        match kind:
            case "density":
                values = samples / (seconds * CELL_M**2)
            case "speed":
                with np.errstate(invalid="ignore"):
                    values = speeds / samples
            case "waiting":
                values = held
            case _:
                values = contacts
        each_storey = values.reshape(len(self._storeys_m), self.height, self.width)
        yield {
            "kind": kind,
            "window_s": window_s,
            "storeys": [
                {
                    "z_m": float(z_m),
                    "width": self.width,
                    "height": self.height,
                    "cell_m": CELL_M,
                    "origin_m": list(self.origin_m),
                    "values": base64.b64encode(storey.astype("<f4").tobytes()).decode(),
                }
                for z_m, storey in zip(self._storeys_m, each_storey, strict=True)
            ],
        }

    def _cells(self, records: npt.NDArray[np.void]) -> Ints:
        step = CELL_M / POSITION_M
        columns = np.minimum((records["x"] / step).astype(np.int64), self.width - 1)
        rows = np.minimum((records["y"] / step).astype(np.int64), self.height - 1)
        z_m = records["z"] * POSITION_M + BELOW_M
        storeys = np.maximum(np.searchsorted(self._storeys_m, z_m, side="right") - 1, 0)
        cells: Ints = (storeys * self.height + rows) * self.width + columns
        return cells

    def _turn(self, chunk: int) -> None:
        """Begin another chunk if its time has come."""
        if chunk == self._chunk:
            return
        if self._parts:
            self._chunks.append(self._together())
        self._chunk, self._parts = chunk, []

    def _together(self) -> _Chunk:
        cells = np.concatenate([each for each, _ in self._parts])
        sums = np.concatenate([each for _, each in self._parts], axis=1)
        found, places = np.unique(cells, return_inverse=True)
        together = np.stack([np.bincount(places, row, len(found)) for row in sums])
        return _Chunk(self._chunk, found, together.astype(np.float32))
