"""Delivery tells everyone the news of a tick, in one pass that never waits."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from esplanade.actors import Explanation
from esplanade.protocol import Reason
from esplanade.protocol.messages import Census, Circle, Doors, Plan, Point
from esplanade.server.net import frames
from esplanade.server.net.outbox import Outbox
from esplanade.server.net.session import Session
from esplanade.server.world.world import World, WorldUpdate

PLANS_PER_SECOND: Final = 5


class Delivery:
    """Writes one tick's news into the outboxes of the sessions that are there."""

    def __init__(self, world: World, sessions: Mapping[int, Session], tick_rate: int) -> None:
        self._world = world
        self._sessions = sessions
        self._plan_period = max(1, tick_rate // PLANS_PER_SECOND)
        self._census_period = tick_rate

    def deliver(self, update: WorldUpdate, now: float) -> None:
        """Write doors and changes of view first, then snapshots, then plans and the census."""
        if update.doors:
            doors = frames.message(Doors(doors=update.doors))
            for session in self._sessions.values():
                session.outbox.post(doors)
        self._changes(update)
        self._pointing(update)
        self._snapshots(update, now)
        self._plans()
        if self._world.tick % self._census_period == 0:
            people, actors = self._world.count()
            census = frames.message(Census(people=people, actors=actors))
            for session in self._sessions.values():
                session.outbox.offer(census)

    def _changes(self, update: WorldUpdate) -> None:
        tick = self._world.tick
        for viewer, ids in update.changes.left.items():
            if (outbox := self._outbox(viewer)) is not None:
                outbox.post(frames.leave(tick, ids))
        packed: dict[int, bytes] = {}
        for viewer, slots in update.changes.entered.items():
            if (outbox := self._outbox(viewer)) is None:
                continue
            for slot in slots:
                if slot not in packed:
                    packed[slot] = frames.entity(self._world.describe(slot))
            outbox.post(frames.enter(tick, [packed[slot] for slot in slots]))

    def _pointing(self, update: WorldUpdate) -> None:
        for actor, target in update.pointing.items():
            frame = frames.message(Point(id=actor, target=target))
            for viewer in self._world.seen_by(actor):
                if (outbox := self._outbox(viewer)) is not None:
                    outbox.post(frame)

    def _snapshots(self, update: WorldUpdate, now: float) -> None:
        snapshots = update.snapshots
        sessions, tick, data = self._sessions, snapshots.tick, snapshots.data
        written: list[int] = []
        begin = 0
        begin_steps = 0
        places = zip(
            snapshots.viewers, snapshots.ends, snapshots.acks, update.steps.ends, strict=True
        )
        for place, (viewer, end, ack, end_steps) in enumerate(places):
            session = sessions.get(viewer)
            steps = update.steps.data[begin_steps:end_steps]
            if session is not None and session.outbox.snapshot(
                tick, ack, data[begin:end], steps, now
            ):
                written.append(place)
            begin, begin_steps = end, end_steps
        self._world.wrote(snapshots, written)

    def _plans(self) -> None:
        """Offer the plans of the actors whose turn it is, each packed once, to their watchers."""
        tick = self._world.tick
        packed: dict[int, bytes] = {}
        for viewer, session in self._sessions.items():
            actor = session.watching
            if actor is None or (tick + actor) % self._plan_period:
                continue
            if not self._world.sees(viewer, actor):
                session.watching = None
                continue
            if actor not in packed:
                packed[actor] = frames.message(plan(tick, actor, self._world.explain(actor)))
            session.outbox.offer(packed[actor])

    def _outbox(self, viewer: int) -> Outbox | None:
        session = self._sessions.get(viewer)
        return session.outbox if session else None


def plan(tick: int, actor: int, explanation: Explanation) -> Plan:
    """An actor's explanation as it goes over the wire, to the millimetre."""
    goal = explanation.goal
    return Plan(
        tick=tick,
        id=actor,
        reason=Reason(explanation.reason),
        behaviour=explanation.behaviour,
        goal=None if goal is None else tuple(np.round(goal, 3).tolist()),
        path=np.round(explanation.path, 3).tolist(),
        people=[
            [
                Circle(x=x, y=y, z=z, radius=radius)
                for x, y, z, radius in np.round(circles, 3).tolist()
            ]
            for circles in explanation.people
        ],
    )
