"""Live views of a zone: takes its ticks in, beat by beat, and tells subscribers what is new."""

import asyncio
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final

import structlog

from esplanade.actors import ActorSpec
from esplanade.server.accounts.identity import Identity
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.live.encounters import NewContacts
from esplanade.server.live.events import Events
from esplanade.server.live.ground_plan import ground_plan
from esplanade.server.live.happenings import Happenings
from esplanade.server.live.heat import Heat
from esplanade.server.live.history import History
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.measures import FIGURES, NEAR_EVERY, Measures
from esplanade.server.live.moments import Moments
from esplanade.server.live.names import sees_names
from esplanade.server.live.reasons import Reasons
from esplanade.server.live.series import Series
from esplanade.server.live.subscriber import Subscriber
from esplanade.server.live.subscriptions import BEATS_A_SECOND
from esplanade.server.live.tap import Tap, Tick
from esplanade.server.live.telling import Telling
from esplanade.server.metrics import Traffic
from esplanade.server.world.zone import Zone

MOST_SUBSCRIBERS: Final = 32
"""Consoles with an open socket or stream; more are refused."""
MOST_MARKS: Final = 10_000

log = structlog.get_logger(__name__)


class Live:
    """All live views of one zone. Only `tap` and `bulletin` belong to other threads too."""

    def __init__(
        self,
        zone: Zone,
        storeys_m: Sequence[float],
        bulletin: Bulletin,
        traffic: Traffic,
        *,
        hide_names: bool,
        groups: Callable[[ActorSpec], Iterable[str]] = lambda spec: spec.tags,
    ) -> None:
        """`groups` tells the groups of an actor, in any thread."""
        self.zone = zone
        self.storeys_m = list(storeys_m)
        self.hide_names = hide_names
        self.bulletin = bulletin
        self.tap = Tap(zone)
        self.map = MapFeed(zone.origin_m, zone.tick_s, groups)
        self.moments = Moments()
        self.reasons = Reasons(self.map, self.tap, zone.tick_s)
        self.events = Events()
        self.series = Series(FIGURES)
        self.history = History(self.map)
        self.heat = Heat(self.map, zone.scene.bounds, storeys_m)
        self.marks: deque[dict[str, Any]] = deque(maxlen=MOST_MARKS)
        """Lines in all series: every change of an operator, and what was marked."""
        self.subscribers: set[Subscriber] = set()
        self.map_frames_dropped = 0
        """Of subscribers that are gone."""
        self.too_slow = 0
        """Subscribers that were closed since they did not read."""
        self._happenings = Happenings(self.map, self.reasons, self.events)
        self._measures = Measures(self.map, self.series, traffic, zone.tick_s)
        self._contacts = NewContacts()
        self._telling = Telling(self)
        self._beats = 0
        self._plan: dict[str, Any] | None = None

    def sees_names(self, by: Identity) -> bool:
        """Whether an operator is told the names of people."""
        return sees_names(by, self.hide_names)

    def plan(self) -> dict[str, Any]:
        """The plan of the scene, without the states of doors."""
        if self._plan is None:
            self._plan = ground_plan(self.zone.scene, self.zone.grid, self.storeys_m)
        return self._plan

    def hello(self, subscriber: Subscriber) -> None:
        """Take a new subscriber in."""
        self.subscribers.add(subscriber)
        subscriber.tell(
            {
                "channel": "hello",
                "tick": self.map.tick,
                "tick_s": self.zone.tick_s,
                "names": subscriber.names,
                "storeys": self.storeys_m,
            }
        )

    def dismiss(self) -> None:
        """Close all subscribers, who come again: another zone has taken the place of this one."""
        for subscriber in self.subscribers:
            subscriber.too_slow.set()

    def goodbye(self, subscriber: Subscriber) -> None:
        """Let a subscriber go."""
        self.subscribers.discard(subscriber)
        self.map_frames_dropped += subscriber.map_frames_dropped
        self.too_slow += subscriber.too_slow.is_set()

    def beat(self) -> None:
        """Take in what has happened since the last beat, and tell it."""
        self._beats += 1
        self.tap.traces.watched = bool(self.subscribers)
        ticks = self.tap.fetch()
        for tick in ticks:
            self._take(tick)
        for notice in self.bulletin.fetch():
            self._happenings.notice(notice)
            self._telling.notice(notice)
            if notice.change is not None:
                self.map.tell_again(regrouped(notice.change))
        if ticks:
            self._happenings.stops(ticks[-1].at_us)
            self.reasons.ask()
        found: dict[str, Any] = {}
        for results in (*self.tap.fetch_found(), *(tick.found for tick in ticks)):
            found |= results
        self._telling.beat(self._beats, found)

    def _take(self, tick: Tick) -> None:
        self._happenings.before(tick)
        self.map.take(tick)
        self.moments.take(tick.frame.tick, tick.at_us)
        contacts = self._contacts.take(tick.touching)
        self.reasons.take(tick)
        self._happenings.after(tick, contacts)
        self._telling.contacts(contacts)
        second = tick.at_us // 1_000_000
        for actor, _ in contacts:
            self.heat.contact(second, actor)
        over = self._measures.take(tick, contacts, self.zone.trips)
        if tick.frame.tick % NEAR_EVERY == 0 and len(self._measures.near.near):
            seconds = NEAR_EVERY * self.zone.tick_s
            self.heat.near(second, self._measures.near.actors, seconds)
        if over:
            self.heat.add(second)
            self.history.add(second)
            self._telling.second(self.map.tick)


def regrouped(change: Mapping[str, Any]) -> list[str]:
    """The actors whose groups are others after a change."""
    return [
        subject.partition(":")[2]
        for subject, fields in (change.get("after") or {}).items()
        if subject.startswith("actor:") and any(name.startswith("group:") for name in fields)
    ]


async def beating(views: Callable[[], Sequence[Live]]) -> None:
    """Beat for as long as a server runs; `views` gives those of its zones, once there are any."""
    loop = asyncio.get_running_loop()
    due = loop.time()
    before: Sequence[Live] = ()
    while True:
        # Beats that cannot be had in time are left out.
        due = max(due + 1.0 / BEATS_A_SECOND, loop.time())
        await asyncio.sleep(due - loop.time())
        now = views()
        if not now:
            continue
        for live in before:
            if live not in now:
                live.dismiss()
        before = now
        for live in now:
            try:
                live.beat()
            except Exception:
                # The view of operators may lack something then; the world is not touched by it.
                log.exception("live views failed")
                live.tap.begin_anew()
