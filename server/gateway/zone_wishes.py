"""Wishes of a gateway's people in one zone: what can be judged here is, the rest goes upward."""

from collections.abc import Mapping, Sequence
from typing import Final

from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.protocol.looks import Look
from esplanade.protocol.messages import Move, MutePerson, Report, SetDoor, WalkTo
from esplanade.server.gateway.occupant import Occupant
from esplanade.server.gateway.upward import Upward
from esplanade.server.link.whole_state import WholeState
from esplanade.server.net.lines import MOST_MUTED, Lines
from esplanade.server.net.session import Session
from esplanade.server.world.audience import Audience

MOST_WAITING_LINES: Final = 5
"""Lines that wait until somebody is in."""


class ZoneWishes:
    """Takes the wishes of sessions whose seats are in the zone."""

    def __init__(
        self,
        occupants: Mapping[int, Occupant],
        audience: Audience,
        known: WholeState,
        lines: Lines,
        upward: Upward,
    ) -> None:
        self._occupants = occupants
        self._audience = audience
        self._known = known
        self._lines = lines
        self._upward = upward

    def move(self, session: Session, wish: Move | WalkTo) -> None:
        """Move the person's avatar in the next tick."""
        who = self._of(session)
        if who is None:
            return
        if isinstance(wish, Move):
            who.moves = wish.speed > 0.0
            self._upward.steer(who, wish.seq, wish.direction, wish.speed)
        else:
            who.moves = True
            self._upward.walk(who, wish)

    def moved(
        self,
        persons: Sequence[int],
        numbers: Sequence[int],
        directions_rad: Sequence[float],
        speeds_mps: Sequence[float],
    ) -> None:
        """Take the movements of many people, the latest of each; those of others are left out."""
        for person, number, direction_rad, speed_mps in zip(
            persons, numbers, directions_rad, speeds_mps, strict=True
        ):
            who = self._occupants.get(person)
            if who is not None:
                who.session.last_seq = number
                who.moves = speed_mps > 0.0
                self._upward.steer(who, number, direction_rad, speed_mps)

    def say(self, session: Session, text: str) -> None:
        """Pass a line of chat on; that of somebody who is not in yet is said when they are."""
        who = self._of(session)
        if who is None:
            return
        if not who.is_in:
            if len(who.lines) < MOST_WAITING_LINES:
                who.lines.append(text)
        elif not self._upward.say(who, text):
            fault = ErrorCode.FLOODING, "too much is said while the place does not answer"
            session.tell(ProtocolError(*fault, None))

    def watch(self, session: Session, actor_id: int | None) -> None:
        """Send the plans of an actor from now on, or of none."""
        who = self._of(session)
        if who is None:
            return
        if actor_id is not None and not (
            self._audience.is_actor(actor_id) and self._audience.sees(who.person, actor_id)
        ):
            session.tell(
                ProtocolError(ErrorCode.INVALID, f"watch: {actor_id} is no actor in view", None)
            )
            actor_id = None
        session.watching = actor_id
        self._upward.watch(who, actor_id)

    def stop_watching(self, session: Session) -> None:
        """Send no more plans: the actor is out of view."""
        session.watching = None
        who = self._of(session)
        if who is not None:
            self._upward.watch(who, None)

    def set_door(self, session: Session, wish: SetDoor) -> None:
        """Open or close a door soon, if the session may."""
        who = self._of(session)
        if not session.is_operator:
            fault = ErrorCode.FORBIDDEN, "only operators open and close doors"
        elif wish.name not in self._known.doors:
            fault = ErrorCode.INVALID, f"set_door: the scene has no door {wish.name!r}"
        else:
            if who is not None:
                self._upward.move_door(who, wish.name, is_open=wish.open)
            return
        session.tell(ProtocolError(*fault, None))

    def report(self, session: Session, report: Report) -> None:
        """Put a report before moderators, who are at the zone."""
        who = self._of(session)
        if who is not None and not self._upward.report(who, report):
            text = "too many reports wait for the place, which does not answer"
            session.tell(ProtocolError(ErrorCode.FLOODING, text, None))

    def mute(self, session: Session, wish: MutePerson) -> None:
        """Send no lines of somebody to the session any more, or send them again."""
        who = self._of(session)
        if who is None:
            return
        if self._lines.mute(who.person, wish.id, muted=wish.muted):
            who.mutes = True
            self._upward.mute(who, self._lines.muted_by(who.person))
        else:
            text = f"you have muted {MOST_MUTED} people, no more can be at once"
            session.tell(ProtocolError(ErrorCode.FLOODING, text, None))

    def presence(self, session: Session, away: bool) -> None:
        """Let everyone who has the person in view know that they are away, or there again."""
        who = self._of(session)
        if who is not None:
            who.away = away
            self._upward.be_away(who, away)

    def gesture(self, session: Session, gesture: int) -> None:
        """Let the person's avatar make a gesture in the next tick."""
        who = self._of(session)
        if who is not None:
            self._upward.make_gesture(who, gesture)

    def look(self, session: Session, look: Look) -> None:
        """Let the person's avatar look otherwise from the next tick on."""
        who = self._of(session)
        if who is not None:
            who.look = look
            self._upward.wear(who, look)

    def _of(self, session: Session) -> Occupant | None:
        """The occupation of a session whose seat is in the zone."""
        if session.avatar_id is None:
            return None
        who = self._occupants.get(session.avatar_id)
        return who if who is not None and who.session is session else None
