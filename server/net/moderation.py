"""Moderates people for operators: words to them, mutes, bans, and the way out."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

import structlog

from esplanade.protocol import ByeCode, CloseCode, ErrorCode, NoticeCode, ProtocolError
from esplanade.protocol.messages import Bye, Hide, Notice
from esplanade.server.moderation.bans import Ban, Bans
from esplanade.server.moderation.chat_log import KeptLine
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net import frames
from esplanade.server.net.known_people import KnownPerson
from esplanade.server.net.lines import Lines
from esplanade.server.net.mutes import Mutes
from esplanade.server.net.people_here import PeopleHere
from esplanade.server.net.seats import Seats, digest_of
from esplanade.server.net.session import Session
from esplanade.server.world.audience import Heard
from esplanade.server.world.zone import Zone

Listener = Callable[[str, dict[str, Any]], None]
log = structlog.get_logger(__name__)


class PeopleModeration(PeopleHere):
    """Moderates the people of a hub, by their avatars' ids. A mute outlives a lost connection."""

    def __init__(
        self,
        state: ModerationState,
        world: Zone,
        storeys: Sequence[float],
        sessions: Mapping[int, Session],
        seats: Seats[Session],
        kick: Callable[[Session], None],
        now_s: Callable[[], float],
        first_line: int = 0,
    ) -> None:
        """`kick` gives up the seat of a session, so that its token opens nothing any more. Numbers
        of lines begin with the milliseconds of now, and so many more."""
        super().__init__(world, storeys, sessions, seats, now_s)
        self.state = state
        self.lines = Lines(state.now_us() // 1000 + first_line, self._said)
        self.mutes = Mutes(state.now_us)
        self.listeners: list[Listener] = []
        """Are told of reports and, where chat is kept, of lines: the kind, and plain data."""
        self._kick = kick

    # --- what operators want --------------------------------------------------------------------

    def announce(self, text: str, people: Iterable[int]) -> int:
        """Say something to these people; returns to how many."""
        notice = _notice(text, NoticeCode.ANNOUNCEMENT)
        there = [self._sessions[one] for one in people if one in self._sessions]
        for session in there:
            session.outbox.post(notice)
        return len(there)

    def warn(self, person: int, text: str) -> None:
        """Say something to one person, as a warning."""
        self._tell(person, _notice(text, NoticeCode.WARNED))

    def kick(self, person: int, text: str) -> None:
        """End a person's connection, and say why; the avatar is gone, and its token void."""
        self._dismiss(person, text, ByeCode.KICKED, CloseCode.KICKED, {"text": text})

    def walk_out(self, person: int, text: str) -> None:
        """Let a person's avatar walk to a place of arrival, and then go."""
        session = self._sessions.get(person)
        if session is None or self.walk_outs is None:
            return
        goal = self.walk_outs.way_out(person)
        if goal is None:
            self.has_walked_out(session, text)
            return
        x, y, z = goal
        self._tell(person, _notice(text, NoticeCode.WALKED_OUT, {"x": x, "y": y, "z": z}))
        self.walk_outs.begin(session, text, goal, self._now_s())

    def has_walked_out(self, session: Session, text: str) -> None:
        """Let somebody go who has arrived at the way out."""
        if session.avatar_id is not None:
            arguments = {"text": text}
            self._dismiss(session.avatar_id, text, ByeCode.WALKED_OUT, CloseCode.KICKED, arguments)

    def turn_out(self, ban: Ban, person: int | None = None) -> int:
        """Send out whoever a ban is of, and this person; returns how many."""
        only = Bans()
        only.put(ban)
        found = [
            avatar_id
            for avatar_id, session in self._sessions.items()
            if avatar_id == person or self._keeps_out(only, self._of(session))
        ]
        arguments = _of_ban(ban)
        for avatar_id in found:
            self._dismiss(avatar_id, _farewell(ban), ByeCode.BANNED, CloseCode.BANNED, arguments)
        return len(found)

    def check_ban(self, name: str, address: str, resume: str | None) -> None:
        """Check that no ban keeps a newcomer out.

        Raises
        ------
        ProtocolError
            One does, and why and until when.
        """
        digest = None if resume is None else digest_of(resume).hex()
        ban = self.state.bans.against(name, address, digest, self.state.now_us())
        if ban is not None:
            code, close = ErrorCode.BANNED, CloseCode.BANNED
            raise ProtocolError(code, _farewell(ban), close, _of_ban(ban))

    def hide(self, line: int) -> None:
        """Let a line be shown no more by anybody's client."""
        self._tell_all(frames.message(Hide(lines=[line])))

    def greet(self, session: Session) -> None:
        """Tell somebody who comes back what was hidden meanwhile."""
        hidden = self.state.chat.hidden
        if hidden:
            session.outbox.post(frames.message(Hide(lines=hidden)))

    # --- mutes ----------------------------------------------------------------------------------

    def muted_s(self, person: int) -> float:
        """For how many seconds nobody hears a person yet."""
        return self.mutes.left_s(person)

    def mute(self, person: int, seconds: float, text: str) -> None:
        """Let nobody hear a person for a time, and say so; 0 ends it."""
        self.mutes.put(person, seconds)
        code = NoticeCode.MUTED if seconds > 0.0 else NoticeCode.UNMUTED
        arguments = {"seconds": seconds} if seconds > 0.0 else {}
        self._tell(person, _notice(text, code, arguments))

    # --- parts ----------------------------------------------------------------------------------

    def happened(self, kind: str, about: dict[str, Any]) -> None:
        """Tell the console of something that people did."""
        for listener in self.listeners:
            listener(kind, about)

    def _said(self, number: int, heard: Heard, viewers: list[int]) -> None:
        if not self.state.chat.keeps:
            return
        line = heard.line
        self.state.said(
            KeptLine(
                line=number,
                at_us=self.state.now_us(),
                tick=self._world.tick,
                id=line.id,
                name=heard.name,
                text=line.text,
                seen=tuple(viewers),
            )
        )
        about = {"line": number, "who": line.id, "name": heard.name, "text": line.text}
        self.happened("chat", {**about, "place": self.where(line.id)})

    def _keeps_out(self, bans: Bans, person: KnownPerson) -> bool:
        now_us = self.state.now_us()
        return any(
            bans.against(name, person.address, digest, now_us) is not None
            for name in (person.wished, person.name)
            for digest in person.digests or (None,)
        )

    def _dismiss(
        self,
        person: int,
        text: str,
        reason: ByeCode,
        close: CloseCode,
        arguments: dict[str, Any],
    ) -> None:
        session = self._sessions.get(person)
        if session is None:
            return
        farewell = frames.message(Bye(reason=reason, text=text, arguments=arguments))
        self._kick(session)
        session.dismiss(farewell, close, reason.value)
        log.info("person sent out", id=person, why=reason.value)

    def _tell(self, person: int, frame: bytes) -> None:
        session = self._sessions.get(person)
        if session is not None:
            session.outbox.post(frame)

    def _tell_all(self, frame: bytes) -> None:
        for session in self._sessions.values():
            session.outbox.post(frame)


def _notice(text: str, code: NoticeCode, more: Mapping[str, Any] | None = None) -> bytes:
    return frames.message(Notice(text=text, notice=code, arguments={"text": text, **(more or {})}))


def _of_ban(ban: Ban) -> dict[str, Any]:
    """The arguments of what somebody is told whom a ban keeps out."""
    until_s = None if ban.until_us is None else ban.until_us / 1e6
    return {"text": ban.text, "until_s": until_s}


def _farewell(ban: Ban) -> str:
    if ban.until_us is None:
        return ban.text
    end = datetime.fromtimestamp(ban.until_us / 1e6, UTC)
    return f"{ban.text} (until {end:%Y-%m-%d %H:%M} UTC)"
