"""A movement is a lease that signs of life renew: whoever falls silent while walking stands.

Whatever comes from a client is a sign, pongs of the WebSocket layer among them: these come from a
browser even while it holds back the timers of a hidden tab. One pass a few times a second looks
at all connections. A silent one is sent a single ping until a sign comes, so that pings need no
bound of their own, and nothing here waits for a client that does not read.

Silence is counted only while the server listens: after a pause of its own (a long tick, a process
that was stopped) it reads what has come before anybody can be taken for silent.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Final

from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

CHECK_S: Final = 0.2
"""Connections are looked at this often."""

PING_S: Final = 1.0
"""A client whose avatar moves is pinged after this long without a sign."""

ANSWER_S: Final = 1.0
"""Its avatar stands after this long without an answer: two seconds after the last sign."""

END_S: Final = 8.0
"""The connection of a client that lost its movement ends after this long without a sign."""

IDLE_PING_S: Final = 20.0
"""A client whose avatar stands is pinged after this long without a sign."""

IDLE_END_S: Final = 40.0
"""Its connection ends after this long: a thin line may hold an answer back for a while."""


class HeardConnection(ServerConnection):
    """A connection that can ask its client for a sign of life."""

    heard = True
    """Whether anything has come since this was last set to False; who reads the socket sets it."""

    def ask_for_sign(self) -> None:
        """Send a ping, waiting for nothing; whatever comes next is the answer."""
        if self.state is State.OPEN:
            self.protocol.send_ping(b"")
            self.send_data()


@dataclass(eq=False, slots=True)
class Lease:
    """The silence of one client, and what was done about it."""

    connection: HeardConnection = field(repr=False)
    silent_s: float = 0.0
    pinged_s: float | None = None
    """The silence at which the client was pinged; None if it was not, since the last sign."""
    lapsed: bool = False
    """Whether the avatar was made to stand since the last sign."""


class Leases:
    """Looks at all clients now and then; `moves` tells whether an avatar means to move."""

    def __init__(
        self, moves: Callable[[int], bool], listen: Callable[[], None] = lambda: None
    ) -> None:
        """`listen` is called before a pass; connections know then what was heard of them."""
        self._moves = moves
        self._listen = listen
        self._checked_s: float | None = None

    def check(self, leases: Iterable[tuple[int, Lease]], now: float) -> tuple[list[int], list[int]]:
        """Ids of the avatars that must stand from now on, and of those whose client is gone."""
        lapsed: list[int] = []
        gone: list[int] = []
        if self._checked_s is None:
            self._checked_s = now
        elapsed_s = now - self._checked_s
        if elapsed_s < CHECK_S:
            return lapsed, gone
        self._checked_s = now
        listened_s = min(elapsed_s, 2.0 * CHECK_S)
        self._listen()
        for avatar_id, lease in leases:
            connection = lease.connection
            if connection.heard:
                connection.heard = False
                if lease.silent_s:
                    lease.silent_s, lease.pinged_s, lease.lapsed = 0.0, None, False
                continue
            lease.silent_s += listened_s
            if lease.silent_s < PING_S:
                continue
            if self._lapses(avatar_id, lease):
                lease.lapsed = True
                lapsed.append(avatar_id)
            elif lease.silent_s >= (END_S if lease.lapsed else IDLE_END_S):
                gone.append(avatar_id)
        return lapsed, gone

    def _lapses(self, avatar_id: int, lease: Lease) -> bool:
        """Ping a silent client when it is time; whether its movement ends now."""
        moves = not lease.lapsed and self._moves(avatar_id)
        if lease.pinged_s is None:
            if moves or lease.silent_s >= IDLE_PING_S:
                lease.pinged_s = lease.silent_s
                lease.connection.ask_for_sign()
            return False
        return moves and lease.silent_s - lease.pinged_s >= ANSWER_S
