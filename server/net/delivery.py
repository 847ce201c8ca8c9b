"""Delivery tells everyone the news of a tick, in one pass that never waits."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from esplanade.protocol.messages import Away, Census, Doors, GestureMade, Point, Reshape
from esplanade.server.net import frames
from esplanade.server.net.lines import Lines
from esplanade.server.net.outbox import Outbox
from esplanade.server.net.packing import Packing
from esplanade.server.net.session import Session
from esplanade.server.net.sockets.sending import send_to_all
from esplanade.server.net.sockets.system import NONE
from esplanade.server.world.audience import Audience, News, Snapshots


class Delivery:
    """Writes one tick's news into the outboxes of the sessions that are there."""

    def __init__(
        self,
        audience: Audience,
        sessions: Mapping[int, Session],
        tick_rate: int,
        stop_watching: Callable[[Session], None],
        lines: Lines | None = None,
    ) -> None:
        """`stop_watching` is called for those who watch an actor that went out of view."""
        self._lines = lines or Lines()
        self._audience = audience
        self._sessions = sessions
        self._census_period = tick_rate
        self._stop_watching = stop_watching
        self._packing = Packing()
        self._found: list[Session | None] = []
        """The sessions of the viewers of the latest tick, by place."""
        self._outboxes: dict[int, Outbox] = {}
        self._flags = bytearray()
        """Whether each of them may be sent a snapshot past its transport; outboxes keep it."""
        self._descriptors = np.empty(0, dtype=np.int64)

    def deliver(self, news: News, now: float) -> None:
        """Write doors first, then the census, changes of view, snapshots, and then plans."""
        if news.doors:
            self._post_to_all(frames.message(Doors(doors=news.doors)))
        self._snapshots(news.snapshots, self._changes(news), self._census(news), now)
        self._plans(news)

    def _census(self, news: News) -> bytes:
        """The frame of a census, if it is time for one."""
        if news.tick % self._census_period:
            return b""
        return frames.message(Census(people=news.people, actors=news.actors))

    def _post_to_all(self, frame: bytes) -> None:
        for session in self._sessions.values():
            session.outbox.post(frame)

    def _changes(self, news: News) -> dict[int, list[bytes]]:
        """The frames that no viewer must miss, by its id: views, bodies, gestures, chat."""
        first: dict[int, list[bytes]] = {}
        for viewer, ids in news.left.items():
            first[viewer] = [frames.leave(news.tick, ids)]
        for viewer, entities in news.entered.items():
            first.setdefault(viewer, []).append(frames.enter(news.tick, entities))
        for frame, viewers in _seen(news):
            for viewer in viewers:
                first.setdefault(viewer, []).append(frame)
        for heard in news.chat:
            frame, viewers = self._lines.take(heard)
            for viewer in viewers:
                first.setdefault(viewer, []).append(frame)
        return first

    def _snapshots(
        self, snapshots: Snapshots, first: Mapping[int, list[bytes]], census: bytes, now: float
    ) -> None:
        """Write to every viewer the census, what else comes first, and then its snapshot."""
        packed, ends = self._packing.pack(snapshots)
        begins, step_begins = _begins(ends), _begins(snapshots.step_ends)
        steps = snapshots.step_ends - step_begins
        self._find_sessions(snapshots.viewers)
        written: list[int] = []
        for place in np.flatnonzero(~self._clear()).tolist():
            outbox = self._outboxes.get(place)
            if outbox is None or outbox.look():
                continue
            if census:
                outbox.offer(census)
            block = packed[begins[place] : ends[place]].tobytes()
            before = first.get(snapshots.viewers[place], ())
            if outbox.snapshot(block, int(steps[place]), now, before):
                written.append(place)
        free = np.flatnonzero(self._clear())
        if len(free):
            heads = self._heads(snapshots.viewers, first)
            number = len(free) + int(np.count_nonzero(steps[free])) + sum(map(len, heads.values()))
            joined = dict.fromkeys(range(len(free)), census) if census else {}
            for k, parts in heads.items():
                joined[k] = b"".join((census, *parts))
            size, left = send_to_all(
                self._descriptors[free], packed, begins[free], ends[free], joined
            )
            for k, rest in left.items():
                self._outboxes[int(free[k])].send_rest(rest)
            if census:
                number += len(free)
            self._outboxes[int(free[0])].count(number, size, int(steps[free].sum()))
        self._audience.wrote(snapshots, [*written, *free.tolist()])

    def _find_sessions(self, viewers: Sequence[int]) -> None:
        """Find the sessions of these viewers, and have their outboxes tell which are clear.

        Viewers are mostly those of the tick before: then no session is touched.
        """
        found = list(map(self._sessions.get, viewers))
        if found == self._found:
            return
        self._found, self._flags = found, bytearray(len(found))
        self._descriptors = np.full(len(found), NONE, dtype=np.int64)
        self._outboxes = {
            place: session.outbox for place, session in enumerate(found) if session is not None
        }
        for place, outbox in self._outboxes.items():
            self._descriptors[place] = outbox.report_to(self._flags, place)

    def _clear(self) -> npt.NDArray[np.bool_]:
        """Whether the viewer at each place is sent its snapshot past its transport."""
        return np.frombuffer(self._flags, dtype=np.bool_)

    def _heads(
        self, viewers: Sequence[int], first: Mapping[int, list[bytes]]
    ) -> dict[int, list[bytes]]:
        """Of those who are clear, by their place among these, what comes before the snapshot."""
        rank = self._clear().cumsum() - 1
        places = [place for place, viewer in enumerate(viewers) if viewer in first]
        return {int(rank[place]): first[viewers[place]] for place in places if self._flags[place]}

    def _plans(self, news: News) -> None:
        """Offer the plans in the news, each packed once, to those who watch and see the actor."""
        plans = news.events.plans
        if not plans:
            return
        packed: dict[int, bytes] = {}
        for viewer, session in self._sessions.items():
            actor = session.watching
            if actor is None or actor not in plans:
                continue
            if not self._audience.sees(viewer, actor):
                self._stop_watching(session)
                continue
            if actor not in packed:
                packed[actor] = frames.frame(plans[actor])
            session.outbox.offer(packed[actor])


def _seen(news: News) -> Iterator[tuple[bytes, list[int]]]:
    """Frames of what avatars do and are, each with the viewers who see it."""
    for actor, (target, viewers) in news.pointing.items():
        yield frames.message(Point(id=actor, target=target)), viewers
    for body, viewers in news.reshaped:
        reshape = Reshape(
            id=body.id,
            radius=body.radius_m,
            leg_m=body.leg_m,
            stature_m=body.stature_m,
            look=body.look,
        )
        yield frames.message(reshape), viewers
    for avatar, (is_away, viewers) in news.away.items():
        yield frames.message(Away(id=avatar, away=is_away)), viewers
    for avatar, (gesture, viewers) in news.gestures.items():
        yield frames.message(GestureMade(id=avatar, gesture=gesture)), viewers


def _begins(ends: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Where parts begin that end there, one after the other."""
    begins = np.zeros_like(ends)
    begins[1:] = ends[:-1]
    return begins
