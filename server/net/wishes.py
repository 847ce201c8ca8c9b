"""Wishes of people who are in: to move, to talk, to watch, gestures, looks, doors, reports."""

import asyncio
from collections.abc import Mapping, Sequence

import structlog

from esplanade.planning import MovedEnd
from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.protocol.looks import Look
from esplanade.protocol.messages import Move, MutePerson, Report, SetDoor, WalkTo
from esplanade.server.net import frames
from esplanade.server.net.departures import Departures
from esplanade.server.net.door_commands import DoorCommands
from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.ground_work import DOOR_PAUSE_S
from esplanade.server.net.lines import MOST_MUTED
from esplanade.server.net.moderation import PeopleModeration
from esplanade.server.net.moved_goals import notice_of, refusal_of
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.reporting import Reporting
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.session import Session
from esplanade.server.net.waiting_lines import WaitingLines
from esplanade.server.net.walk_outs import WalkOuts
from esplanade.server.world.audience import Audience
from esplanade.server.world.inputs import (
    Follow,
    MakeGesture,
    MoveDoor,
    Movement,
    SetAway,
    SetLook,
    Steer,
    Watch,
)
from esplanade.server.world.routes import Route
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)


class Wishes:
    """Takes the wishes of sessions: what comes of one waits for the next tick, or it is refused."""

    def __init__(
        self,
        world: Zone,
        audience: Audience,
        route_requests: RouteRequests,
        pending: PendingInputs,
        sessions: Mapping[int, Session],
        moderation: PeopleModeration,
        walk_outs: WalkOuts,
        departures: Departures[Session],
        lines: WaitingLines[Session],
        reporting: Reporting,
    ) -> None:
        self.by_commands: DoorCommands | None = None
        """Carries out what operators want who have walked in by a pass."""
        self._world = world
        self._audience = audience
        self._routes = route_requests
        self._pending = pending
        self._sessions = sessions
        self._moderation = moderation
        self._walk_outs = walk_outs
        self._departures = departures
        self._lines = lines
        self._reporting = reporting
        self._door_lines: dict[str, float] = {}
        """Wishes for a door are logged as often as it may move: from when on, by its name."""

    def want(self, movement: Movement) -> None:
        """Let a movement take the place of all that the person has wanted before."""
        self._pending.move(movement)
        self._routes.forget(movement.id)

    def move(self, session: Session, wish: Move | WalkTo) -> None:
        """Keep the wish for the next tick; it takes the place of an earlier one."""
        avatar_id = session.avatar_id
        if avatar_id is None or avatar_id in self._walk_outs or avatar_id in self._departures:
            return
        if isinstance(wish, Move):
            self.want(Steer(avatar_id, wish.seq, wish.direction, wish.speed))
            return
        try:
            self._routes.ask(Asker(session.address, avatar_id), wish)
        except ProtocolError as refusal:
            session.tell(refusal)

    def moved(
        self,
        avatar_ids: Sequence[int],
        numbers: Sequence[int],
        directions_rad: Sequence[float],
        speeds_mps: Sequence[float],
    ) -> None:
        """Keep movements of many people for the next tick, the latest of each."""
        all_of_each = zip(numbers, directions_rad, speeds_mps, strict=True)
        wishes = dict(zip(avatar_ids, all_of_each, strict=True))
        for avatar_id, number in zip(avatar_ids, numbers, strict=True):
            session = self._sessions.get(avatar_id)
            if session is None:
                wishes.pop(avatar_id, None)
            else:
                session.last_seq = number
        led = self._walk_outs.among(wishes.keys()) | self._departures.among(wishes.keys())
        for avatar_id in led:
            del wishes[avatar_id]
        self._pending.steer(wishes)
        self._routes.forget_all(wishes.keys())

    def route_found(
        self, avatar_id: int, wish: WalkTo, route: Route | None, moved: MovedEnd | None
    ) -> None:
        """Send a person along the route that was found, or tell them that there is none.

        They are also told where it leads instead, if nobody can stand where they wanted to go.
        """
        session = self._sessions.get(avatar_id)
        if session is None:
            return
        if avatar_id in self._walk_outs:
            self._walk_outs.route_found(avatar_id, route)
        elif route is not None:
            self.want(Follow(avatar_id, wish.seq, route))
            if moved is not None:
                session.outbox.post(frames.message(notice_of(wish, moved)))
        elif moved is not None and wish.strict:
            session.tell(refusal_of(wish, moved))
        else:
            text = f"no way leads to ({wish.x:.2f}, {wish.y:.2f}, {wish.z:.2f})"
            session.tell(ProtocolError(ErrorCode.NO_PATH, text, None))

    def say(self, session: Session, text: str) -> None:
        """Say a line in the next tick; that of somebody at the door waits until they are in."""
        self._lines.put(session, text)

    def watch(self, session: Session, actor_id: int | None) -> None:
        """Send the plans of an actor from now on, or of none."""
        if actor_id is not None and not (
            session.avatar_id is not None
            and self._audience.is_actor(actor_id)
            and self._audience.sees(session.avatar_id, actor_id)
        ):
            session.tell(
                ProtocolError(ErrorCode.INVALID, f"watch: {actor_id} is no actor in view", None)
            )
            actor_id = None
        self._watch(session, actor_id)

    def stop_watching(self, session: Session) -> None:
        """Send no more plans: the actor is out of view."""
        self._watch(session, None)

    def _watch(self, session: Session, actor_id: int | None) -> None:
        session.watching = actor_id
        if session.avatar_id is not None:
            self._pending.watch(Watch(session.avatar_id, actor_id))

    def set_door(self, session: Session, wish: SetDoor) -> None:
        """Open or close a door soon, if the session may; the latest wish for a door wins."""
        if not session.is_operator:
            fault = ErrorCode.FORBIDDEN, "only operators open and close doors"
        elif wish.name not in self._world.doors.states():
            fault = ErrorCode.INVALID, f"set_door: the scene has no door {wish.name!r}"
        else:
            if self.by_commands:
                self.by_commands.ask(session, wish)
                return
            now = asyncio.get_running_loop().time()
            if now >= self._door_lines.get(wish.name, now):
                self._door_lines[wish.name] = now + DOOR_PAUSE_S
                log.info("door", name=wish.name, open=wish.open, id=session.avatar_id)
            self._pending.move_door(MoveDoor(wish.name, wish.open))
            return
        session.tell(ProtocolError(*fault, None))

    def report(self, session: Session, report: Report) -> None:
        """Put a report about somebody before moderators, and tell the person so."""
        self._reporting.take(session, report, asyncio.get_running_loop().time())

    def mute(self, session: Session, wish: MutePerson) -> None:
        """Send no lines of somebody to the session any more, or send them again."""
        avatar_id = session.avatar_id
        if avatar_id is None:
            return
        if not self._moderation.lines.mute(avatar_id, wish.id, muted=wish.muted):
            text = f"you have muted {MOST_MUTED} people, no more can be at once"
            session.tell(ProtocolError(ErrorCode.FLOODING, text, None))

    def presence(self, session: Session, away: bool) -> None:
        """Let everyone who has the person in view know that they are away, or there again."""
        if session.avatar_id is not None:
            self._pending.be_away(SetAway(session.avatar_id, away))

    def gesture(self, session: Session, gesture: int) -> None:
        """Let the person's avatar make a gesture in the next tick."""
        if session.avatar_id is not None:
            self._pending.make_gesture(MakeGesture(session.avatar_id, gesture))

    def look(self, session: Session, look: Look) -> None:
        """Let the person's avatar look otherwise from the next tick on."""
        if session.avatar_id is not None:
            self._pending.wear(SetLook(session.avatar_id, look))
