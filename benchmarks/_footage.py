"""What one client sees of everyone's steps, kept for judging: all that came over its connection."""

from collections import defaultdict
from dataclasses import dataclass, field
from typing import Final

import numpy as np
import numpy.typing as npt

from esplanade.bots import Bot, SnapshotEvent, StepsEvent
from esplanade.protocol.codec import STEPS_HEAD_BYTES
from esplanade.protocol.messages import Enter, Leave
from esplanade.protocol.steps import STEP, StepRecords

Floats = npt.NDArray[np.float64]

WALKS_ON_S: Final = 2.0
"""Whoever begins no other step for so long stands."""


@dataclass
class Seen:
    """One avatar from its coming into view to its leaving it."""

    leg_m: float
    stature_m: float
    records: list[np.void] = field(default_factory=list)
    """Its steps in the order in which they came."""
    heard: list[int] = field(default_factory=list)
    """Ticks of the messages in which they came."""
    places: list[tuple[int, float, float]] = field(default_factory=list)
    """(tick, x, y) of the snapshots that have it."""
    until: int = 0
    """Tick at which it went out of view, or the last of all."""

    @property
    def steps(self) -> StepRecords:
        """STEP (N,), in the order in which they came."""
        return np.array(self.records, dtype=STEP)

    @property
    def goes_on(self) -> npt.NDArray[np.bool_]:
        """Which records go on from the one before, (N,).

        The others come when somebody comes near again, or stands anew after having been moved.
        """
        steps = self.steps
        before, now = steps[:-1], steps[1:]
        linked = (now["standing"] == before["landing"]) | (now["standing"] == before["standing"])
        return np.append(False, linked & (now["ticks"] > 0))

    @property
    def shown_ticks(self) -> int:
        """For how long it was near: without the time before it came near again."""
        steps, heard = self.steps, np.array(self.heard)
        ends = np.minimum(steps["tick"][:-1] + steps["ticks"][:-1].astype(np.int64), heard[1:])
        away = np.where(self.goes_on[1:], 0, heard[1:] - ends)
        return int(self.until - heard[0] - away.sum())

    def place_at(self, ticks: Floats) -> Floats:
        """Where it was according to snapshots, (N, 2); who is in none stands still."""
        known = np.array(self.places)
        row = np.searchsorted(known[:, 0], ticks, side="right") - 1
        after = np.minimum(row + 1, len(known) - 1)
        row = np.maximum(row, 0)
        # Absent from a snapshot means unchanged, so only neighbouring ticks are a way between.
        way = known[after, 0] - known[row, 0] == 1.0
        share = np.where(way, ticks - known[row, 0], 0.0)[:, None]
        return np.asarray((1.0 - share) * known[row, 1:] + share * known[after, 1:])


class Footage:
    """Fills up while a bot's events are passed to it."""

    def __init__(self, bot: Bot) -> None:
        self.tick_rate = bot.welcome.tick_rate
        self.step_bytes = 0
        self.step_messages = 0
        self.skipped_ticks = 0
        """Ticks whose snapshot never came: this client was too slow."""
        self.gone: list[Seen] = []
        self._own_id = bot.id
        self._seen: dict[int, Seen] = {
            i: Seen(other.leg_m, other.stature_m) for i, other in bot.others.items()
        }
        self._tick: int | None = None

    def take(self, event: object) -> None:
        """Note what an event says of others' feet."""
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
        """Everyone whose steps were seen, those included who are still in view."""
        for avatar_id in list(self._seen):
            self._leave(avatar_id, self._tick or 0)
        return [seen for seen in self.gone if seen.records]

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
            self.gone.append(seen)


@dataclass(frozen=True)
class Cost:
    """What steps cost one viewer, bytes of messages a second."""

    step_bytes: int
    steps: int
    for_each_visible: float
    """Of everyone whose steps it is shown, standing or walking."""
    for_each_walking: float
    """Of who walks: from step to step, no more than 2 s between them."""
    visible_at_once: float
    """How many it is shown, on average over the time."""


def cost_of(footage: Footage, everyone: list[Seen], seconds: float) -> Cost:
    visible = walking = 0.0
    for seen in everyone:
        visible += seen.shown_ticks / footage.tick_rate
        between = np.diff(seen.steps["tick"].astype(np.int64)) / footage.tick_rate
        walking += float(between[(between > 0.0) & (between <= WALKS_ON_S)].sum())
    return Cost(
        footage.step_bytes,
        sum(len(seen.records) for seen in everyone),
        footage.step_bytes / max(visible, 1e-9),
        footage.step_bytes / max(walking, 1e-9),
        visible / seconds,
    )


def kinds_of(everyone: list[Seen]) -> dict[str, int]:
    """How many records are whole steps, re-aimed ones, and of somebody who just stands."""
    counts: dict[str, int] = defaultdict(int)
    for seen in everyone:
        for record in seen.records:
            kind = "standing" if record["ticks"] == 0 else "re-aimed" if record["flags"] & 2 else ""
            counts[kind or "steps"] += 1
    return dict(counts)
