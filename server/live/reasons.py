"""The reasons of each actor over the last minutes, span by span, and who or what held it."""

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from esplanade.actors import InTheWay
from esplanade.actors.blockers import Blocker
from esplanade.actors.state import Reason
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.tap import Probe, Tap, Tick
from esplanade.server.world.zone import Zone

KEPT_S: Final = 600.0
"""Spans that ended longer ago than this are forgotten."""
MOST_SPANS: Final = 1024
"""Of one actor; of more the oldest are forgotten."""
HELD: Final = frozenset({Reason.GIVING_WAY, Reason.WAITING, Reason.REPLANNING, Reason.NO_PATH})
ASKED_AFTER_S: Final = 0.3
"""A stop that is shorter than this has nobody named; most are, in a crowd."""
ASKED_AGAIN_S: Final = 2.0
MOST_ASKED: Final = 2
"""Actors whose blocker is asked for at once; the others wait for their turn."""
PROBE: Final = "blockers"


@dataclass(slots=True)
class Span:
    """A time in which an actor had one reason, and was held by one thing or by none known."""

    begin: int
    reason: Reason
    blocker: Blocker | None = None
    name: str = ""
    """The name of the one who held it, when that was found."""


@dataclass(slots=True)
class Timeline:
    """The spans of one actor: those that have ended, each with the tick of its end, and now's."""

    now: Span
    held_since: int | None = None
    """The tick in which it was held first, of those without a pause."""
    asked: int = 0
    """The tick in which its blocker was asked for last."""
    told_of_stop: bool = False
    ended: deque[tuple[Span, int]] = field(default_factory=lambda: deque(maxlen=MOST_SPANS))


class Reasons:
    """Timelines of all actors by their avatars' ids."""

    def __init__(self, feed: MapFeed, tap: Tap, tick_s: float) -> None:
        self._feed = feed
        self._tap = tap
        self._tick_s = tick_s
        self.tick = 0
        self.timelines: dict[int, Timeline] = {}
        self._held: set[int] = set()

    def take(self, tick: Tick) -> None:
        """Take in a tick that the map has taken in."""
        self.tick = tick.frame.tick
        for gone in tick.frame.left:
            self.timelines.pop(gone, None)
            self._held.discard(gone)
        for who, code in self._feed.turned:
            avatar = self._feed.avatars.get(who)
            if avatar is not None and avatar.actor is not None:
                self._turn(who, Reason(code))
        found = tick.found.get(PROBE)
        if found:
            for who, blocker in found.items():
                self._name(who, blocker)

    def ask(self) -> None:
        """Let the zone be asked who holds some of those who are held; call it at each beat."""
        before_s = self._tick_s
        due = [
            (timeline.asked, who)
            for who in self._held
            if (timeline := self.timelines[who]).held_since is not None
            and (self.tick - timeline.held_since) * before_s >= ASKED_AFTER_S
            and (self.tick - timeline.asked) * before_s >= ASKED_AGAIN_S
        ]
        if not due:
            return
        chosen = [who for _, who in sorted(due)[:MOST_ASKED]]
        for who in chosen:
            self.timelines[who].asked = self.tick
        probe = Probe(blockers_of(chosen), every=1, once=True)
        self._tap.probes = {**self._tap.probes, PROBE: probe}

    def long_stops(self, seconds: float) -> list[tuple[int, Timeline]]:
        """Actors that have been held for as long as that without a pause, each told once."""
        found = []
        for who in self._held:
            timeline = self.timelines[who]
            since = timeline.held_since
            if since is None or timeline.told_of_stop:
                continue
            if (self.tick - since) * self._tick_s >= seconds:
                timeline.told_of_stop = True
                found.append((who, timeline))
        return found

    def seconds(self, timeline: Timeline) -> float:
        """For how long an actor has been held without a pause; 0 if it is not."""
        since = timeline.held_since
        return 0.0 if since is None else (self.tick - since) * self._tick_s

    def told(self, who: int, from_tick: int, *, names: bool) -> list[dict[str, Any]]:
        """The spans of an actor that end after a tick, the oldest first."""
        timeline = self.timelines.get(who)
        if timeline is None:
            return []
        oldest = max(from_tick, self.tick - round(KEPT_S / self._tick_s))
        spans = [*timeline.ended, (timeline.now, self.tick)]
        return [
            {
                "from_tick": span.begin,
                "to_tick": end,
                "reason": span.reason.name.lower(),
                "blocker": self.told_blocker(span.blocker, span.name, names=names),
                "seconds": round((end - span.begin) * self._tick_s, 3),
            }
            for span, end in spans
            if end > oldest
        ]

    def told_blocker(
        self, blocker: Blocker | None, name: str | None = None, *, names: bool
    ) -> dict[str, Any] | None:
        """A blocker as it is told: the id of a person or an actor, the name of a door."""
        if blocker is None:
            return None
        found: dict[str, Any] = {"kind": blocker.kind, "id": blocker.id, "away_m": blocker.away_m}
        if blocker.kind in {"person", "actor"} and isinstance(blocker.id, int):
            avatar = self._feed.avatars.get(blocker.id)
            hidden = blocker.kind == "person" and not names
            found["name"] = (
                self._feed.name_of(blocker.id, names=names) if hidden or not name else name
            )
            if avatar is not None and avatar.actor is not None:
                found["actor"] = avatar.actor
        return found

    def told_in_the_way(self, by: InTheWay | None, *, names: bool) -> dict[str, Any] | None:
        """The body that kept a trip from its goal, told as a blocker at no known distance."""
        if by is None:
            return None
        return self.told_blocker(Blocker(by.kind, by.id), names=names)

    def _turn(self, who: int, reason: Reason) -> None:
        timeline = self.timelines.get(who)
        if timeline is None:
            timeline = self.timelines[who] = Timeline(Span(self.tick, reason))
        else:
            self._end(timeline, Span(self.tick, reason))
        if reason not in HELD:
            timeline.held_since = None
            timeline.told_of_stop = False
            self._held.discard(who)
        elif timeline.held_since is None:
            timeline.held_since = self.tick
            timeline.asked = 0
            self._held.add(who)

    def _name(self, who: int, blocker: Blocker | None) -> None:
        """Note who holds an actor; another one than before begins a span of its own."""
        timeline = self.timelines.get(who)
        if timeline is None or blocker is None or timeline.now.reason not in HELD:
            return
        span, known = timeline.now, timeline.now.blocker
        if known is not None and (known.kind, known.id) != (blocker.kind, blocker.id):
            span = Span(self.tick, timeline.now.reason)
            self._end(timeline, span)
        span.blocker = blocker
        if isinstance(blocker.id, int):
            span.name = self._feed.name_of(blocker.id, names=True)

    def _end(self, timeline: Timeline, span: Span) -> None:
        if timeline.now.begin < self.tick:
            timeline.ended.append((timeline.now, self.tick))
        timeline.now = span
        oldest = self.tick - KEPT_S / self._tick_s
        while timeline.ended and timeline.ended[0][1] < oldest:
            timeline.ended.popleft()


def blockers_of(avatars: Sequence[int]) -> Callable[[Zone], dict[int, Blocker | None]]:
    """A question to a zone: who holds these actors?"""
    return lambda zone: {who: zone.blocker(who) for who in avatars}
