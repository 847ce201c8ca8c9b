"""Moderates people for operators: words to them, mutes, bans, and the way out."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import structlog

from esplanade.protocol import ByeCode, CloseCode, NoticeCode
from esplanade.protocol.messages import Bye, Hide, Notice
from esplanade.server.moderation.bans import Ban, Bans
from esplanade.server.moderation.chat_log import KeptLine
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net import frames
from esplanade.server.net.banned import arguments_of, check_ban, is_banned, only, said_of
from esplanade.server.net.guests import Guest
from esplanade.server.net.known_people import KnownPerson
from esplanade.server.net.lines import Lines
from esplanade.server.net.mutes import Mutes
from esplanade.server.net.people_here import PeopleHere, SeatsHere
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
        sessions: Mapping[int, Guest],
        seats: SeatsHere,
        kick: Callable[[int], None],
        now_s: Callable[[], float],
        first_line: int = 0,
    ) -> None:
        """`kick` gives up the seat of a person, so that its token opens nothing any more. Numbers
        of lines begin with the milliseconds of now, and so many more."""
        super().__init__(world, storeys, sessions, seats, now_s)
        self.state = state
        self.lines = Lines(state.now_us() // 1000 + first_line, self._said)
        self.mutes = Mutes(state.now_us)
        self.listeners: list[Listener] = []
        """Are told of reports and, where chat is kept, of lines: the kind, and plain data."""
        self._kick = kick
        state.turns_out.append(self._turn_out)

    def close(self) -> None:
        """Send nobody out any more: nobody is here."""
        self.state.turns_out.remove(self._turn_out)

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
            self.has_walked_out(person, text)
            return
        x, y, z = goal
        self._tell(person, _notice(text, NoticeCode.WALKED_OUT, {"x": x, "y": y, "z": z}))
        self.walk_outs.begin(session, text, goal, self._now_s())

    def has_walked_out(self, person: int, text: str) -> None:
        """Let somebody go who has arrived at the way out."""
        self._dismiss(person, text, ByeCode.WALKED_OUT, CloseCode.KICKED, {"text": text})

    def turn_out(self, ban: Ban, person: int | None = None) -> int:
        """Send out whoever a ban is of, in all zones of the process, and this person; how many."""
        return sum(turn_out(ban, person) for turn_out in self.state.turns_out)

    def _turn_out(self, ban: Ban, person: int | None) -> int:
        alone = only(ban)
        found = [
            avatar_id
            for avatar_id, session in self._sessions.items()
            if avatar_id == person or self._keeps_out(alone, self._of(session))
        ]
        said, arguments = said_of(ban), arguments_of(ban)
        for avatar_id in found:
            self._dismiss(avatar_id, said, ByeCode.BANNED, CloseCode.BANNED, arguments)
        return len(found)

    def check_ban(self, name: str, address: str, resume: str | None) -> None:
        """Check that no ban keeps a newcomer out.

        Raises
        ------
        ProtocolError
            One does, and why and until when.
        """
        check_ban(self.state.bans, self.state.now_us(), name, address, resume)

    def hide(self, line: int) -> None:
        """Let a line be shown no more by anybody's client."""
        self._tell_all(frames.message(Hide(lines=[line])))

    def greet(self, session: Guest) -> None:
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
        names = person.wished, person.name
        return is_banned(bans, self.state.now_us(), names, person.address, person.digests)

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
        session.dismiss(farewell, close, reason.value)
        self._kick(person)
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
