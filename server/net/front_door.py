"""The front door of a world: lets people in, each to the zone where they have a seat."""

from collections.abc import Callable, Sequence

from esplanade.protocol import CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import Hello
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.hops import Doorway
from esplanade.server.net.hub import Hub
from esplanade.server.net.session import Session
from esplanade.server.net.sockets.reading import Reading
from esplanade.server.net.wishes import Wishes


class FrontDoor:
    """Hands each session on to a hub. Who has no seat enters the first of the zones, or one of its
    copies."""

    def __init__(self, entrance: Entrance, most_people: int) -> None:
        """In a world of several zones, no more than `most_people` are in all of them together."""
        self._hubs: list[Hub] = []
        self._doorway: Doorway | None = None
        self._entrance = entrance
        self._most_people = most_people
        self._reading: Reading | None = None

    def lead_to(self, doorway: Doorway, hubs: Sequence[Hub], *, and_no_more: bool = False) -> None:
        """Let newcomers in by a doorway to one or some of these hubs; people may still be in those
        of before, unless `and_no_more` is said."""
        self._doorway = doorway
        before = [] if and_no_more else [hub for hub in self._hubs if hub not in hubs]
        self._hubs = [*hubs, *before]
        self.read_by(self._reading)

    @property
    def _first(self) -> Hub:
        return self._hubs[0]

    @property
    def server_time(self) -> Callable[[], float]:
        """Returns the seconds of the clock of the zone that newcomers enter."""
        return self._first.server_time

    @property
    def wishes(self) -> Wishes:
        """The wishes of those who are in the zone that newcomers enter."""
        return self._first.wishes

    def read_by(self, reading: Reading | None) -> None:
        """Let what people send be looked for there too, before each tick."""
        self._reading = reading
        for hub in self._hubs:
            hub.reading = reading

    async def receive(self, session: Session, hello: Hello) -> None:
        """Find out whether a client may come in, and hand it on to a hub.

        Raises
        ------
        ProtocolError
            It may not, or there is no room.
        """
        session.admitted = admitted = await self._entrance.check(
            hello.admission, session.address, session.identity, self._zone_of(hello) is not None
        )
        session.operator = admitted.operator
        # Asked again, since the person may have gone to another zone meanwhile.
        hub = self._zone_of(hello)
        try:
            if hub is None:
                self._check_room()
                hub = self._entered(session.wished_zone)
            session.enter(hub)
            hub.admit(session, hello)
        except ProtocolError:
            await self._entrance.turn_away(admitted)
            raise

    def confirm(self, session: Session) -> None:
        """Nobody has a token before they are handed on to a hub."""

    def depart(self, session: Session, comes_back: bool) -> None:  # noqa: ARG002 - as of a hub
        """Let go of a session that was not let in."""
        self._entrance.end(session.admitted)

    def moved(
        self,
        avatar_ids: Sequence[int],
        numbers: Sequence[int],
        directions_rad: Sequence[float],
        speeds_mps: Sequence[float],
    ) -> None:
        """Keep movements of many people for the next ticks of the zones where they are."""
        if len(self._hubs) == 1:
            self._first.wishes.moved(avatar_ids, numbers, directions_rad, speeds_mps)
            return
        for hub in self._hubs:
            there = [place for place, one in enumerate(avatar_ids) if one in hub.sessions]
            if there:
                hub.wishes.moved(
                    [avatar_ids[place] for place in there],
                    [numbers[place] for place in there],
                    [directions_rad[place] for place in there],
                    [speeds_mps[place] for place in there],
                )

    def _zone_of(self, hello: Hello) -> Hub | None:
        """The hub in which the token of a hello takes a seat."""
        token = hello.resume
        return next((hub for hub in self._hubs if token and hub.has_seat(token)), None)

    def _entered(self, wished: str | None) -> Hub:
        """The hub of the zone, or of its copy, that a newcomer enters."""
        return self._first if self._doorway is None else self._doorway.entered(wished)[1]

    def _check_room(self) -> None:
        if len(self._hubs) > 1 and sum(hub.people for hub in self._hubs) >= self._most_people:
            text = f"there is room for {self._most_people} people, all taken"
            raise ProtocolError(ErrorCode.SERVER_FULL, text, CloseCode.SERVER_FULL)
