"""Everyone's steps as one client sees them, kept for judging."""

from collections import defaultdict
from dataclasses import dataclass, field
from typing import Final

import numpy as np
import numpy.typing as npt

from esplanade.bots import Bot, SnapshotEvent, StepsEvent
from esplanade.protocol.codec import STEPS_HEAD_BYTES
from esplanade.protocol.messages import Enter, Leave
from esplanade.protocol.steps import STEP, StepRecords, landing_footprints

Floats = npt.NDArray[np.float64]

WALKS_ON_S: Final = 2.0
"""A walker that begins no other step for this long stands."""


@dataclass
class Seen:
    """One avatar from its coming into view to its leaving it."""

    leg_m: float
    stature_m: float
    records: list[np.void] = field(default_factory=list)
    """Its steps in the order in which they came."""
    heard: list[int] = field(default_factory=list)
    """Ticks of the messages in which the steps came."""
    places: list[tuple[int, float, float]] = field(default_factory=list)
    """(tick, x, y) of the snapshots that have it."""
    until: int = 0
    """Tick at which it went out of view, or the last tick of all."""

    @property
    def steps(self) -> StepRecords:
        """STEP (N,), in the order in which they came."""
        return np.array(self.records, dtype=STEP)

    @property
    def goes_on(self) -> npt.NDArray[np.bool_]:
        """Whether each record joins the one before, (N,).

        The others come when an avatar comes near again, or stands anew after it was moved.
        """
        steps = self.steps
        before, now = steps[:-1], steps[1:]
        linked = (now["standing"] == landing_footprints(before)) | (
            now["standing"] == before["standing"]
        )
        return np.append(False, linked & (now["ticks"] > 0))

    @property
    def shown_ticks(self) -> int:
        """Number of ticks for which it was near, without those before it came near again."""
        steps, heard = self.steps, np.array(self.heard)
        ends = np.minimum(steps["tick"][:-1] + steps["ticks"][:-1].astype(np.int64), heard[1:])
        away = np.where(self.goes_on[1:], 0, heard[1:] - ends)
        return int(self.until - heard[0] - away.sum())

    def place_at(self, ticks: Floats) -> Floats:
        """Its places (N, 2), metres, by snapshots at ticks (N,)."""
        known = np.array(self.places)
        row = np.searchsorted(known[:, 0], ticks, side="right") - 1
        after = np.minimum(row + 1, len(known) - 1)
        row = np.maximum(row, 0)
        # An avatar absent from a snapshot has not moved, so only neighbouring ticks are joined.
        way = known[after, 0] - known[row, 0] == 1.0
        share = np.where(way, ticks - known[row, 0], 0.0)[:, None]
        return np.asarray((1.0 - share) * known[row, 1:] + share * known[after, 1:])


class StepLog:
    """Collects what a bot sees, while the bot's events are passed to it."""

    def __init__(self, bot: Bot) -> None:
        self.tick_rate = bot.welcome.tick_rate
        self.step_bytes = 0
        self.step_messages = 0
        self.skipped_ticks = 0
        """Number of ticks whose snapshot never came, because this client was too slow."""
        self.left_view: list[Seen] = []
        self._own_id = bot.id
        self._seen: dict[int, Seen] = {
            i: Seen(other.leg_m, other.stature_m) for i, other in bot.others.items()
        }
        self._tick: int | None = None

    def take(self, event: object) -> None:
        """Keep what an event says of the feet of others."""
        match event:
            case Enter():
                for entity in event.entities:
                    if entity.id != self._own_id:
                        seen = Seen(entity.leg_m, entity.stature_m)
                        self._seen.setdefault(entity.id, seen)
            case Leave():
                for avatar_id in event.ids:
                    self._leave(avatar_id, event.tick)
            case StepsEvent():
                self._take_steps(event)
            case SnapshotEvent():
                self._take_places(event)

    def end(self) -> list[Seen]:
        """Everyone whose steps were seen, those still in view included."""
        for avatar_id in list(self._seen):
            self._leave(avatar_id, self._tick or 0)
        return [seen for seen in self.left_view if seen.records]

    def _take_steps(self, event: StepsEvent) -> None:
        self.step_messages += 1
        self.step_bytes += STEPS_HEAD_BYTES + event.records.nbytes
        for record in event.records:
            seen = self._seen.get(int(record["id"]))
            if seen is not None:
                seen.records.append(record.copy())
                seen.heard.append(event.tick)

    def _take_places(self, event: SnapshotEvent) -> None:
        if self._tick is not None:
            self.skipped_ticks += event.tick - self._tick - 1
        self._tick = event.tick
        rows = zip(event.records["id"].tolist(), event.positions.tolist(), strict=True)
        for avatar_id, (x, y) in rows:
            if avatar_id in self._seen:
                self._seen[avatar_id].places.append((event.tick, x, y))

    def _leave(self, avatar_id: int, tick: int) -> None:
        seen = self._seen.pop(avatar_id, None)
        if seen is not None:
            seen.until = tick
            self.left_view.append(seen)


@dataclass(frozen=True)
class Cost:
    """Costs of steps for one viewer."""

    step_bytes: int
    steps: int
    for_each_visible: float
    """Bytes a second for each avatar whose steps it is shown, standing or walking."""
    for_each_walking: float
    """Bytes a second for each avatar that walks: it begins its next step within 2 s."""
    visible_at_once: float
    """Mean number of avatars whose steps it is shown."""


def cost_of(log: StepLog, everyone: list[Seen], seconds: float) -> Cost:
    visible = walking = 0.0
    for seen in everyone:
        visible += seen.shown_ticks / log.tick_rate
        between = np.diff(seen.steps["tick"].astype(np.int64)) / log.tick_rate
        walking += float(between[(between > 0.0) & (between <= WALKS_ON_S)].sum())
    return Cost(
        log.step_bytes,
        sum(len(seen.records) for seen in everyone),
        log.step_bytes / max(visible, 1e-9),
        log.step_bytes / max(walking, 1e-9),
        visible / seconds,
    )


def kinds_of(everyone: list[Seen]) -> dict[str, int]:
    """Numbers of records that are whole steps, re-aimed ones, and of avatars that just stand."""
    counts: dict[str, int] = defaultdict(int)
    for seen in everyone:
        for record in seen.records:
            kind = "standing" if record["ticks"] == 0 else "re-aimed" if record["flags"] & 2 else ""
            counts[kind or "steps"] += 1
    return dict(counts)
