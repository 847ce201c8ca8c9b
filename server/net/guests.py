"""A person in a zone as those who look after people know them, wherever the connection is.

In one process it is the session; a host of a cluster knows a person by the seat, and tells them
everything by their gateway.
"""

from typing import Protocol

from esplanade.protocol import CloseCode, ProtocolError
from esplanade.server.accounts.identity import Identity


class Posts(Protocol):
    """The way of frames to one person."""

    def post(self, frame: bytes) -> None:
        """Send a frame that must not be lost."""

    def unsent(self) -> int:
        """Bytes that wait for the client, as far as they are known here."""


class Guest(Protocol):
    """A person who is connected, and may be in the zone."""

    operator: Identity | None
    """The operator as whom the person walks about, with the rights from then."""

    @property
    def avatar_id(self) -> int | None: ...

    @property
    def ticket(self) -> int:
        """The number of the person among those at the door; 0 for who is in."""

    @property
    def name(self) -> str: ...

    @property
    def wished(self) -> str:
        """The name that they asked for."""

    @property
    def address(self) -> str: ...

    @property
    def since_us(self) -> int:
        """When they came, microseconds since 1970."""

    @property
    def last_seq(self) -> int:
        """The number of the latest movement that came."""

    @property
    def is_operator(self) -> bool:
        """Whether they may move doors."""

    @property
    def outbox(self) -> Posts: ...

    def tell(self, fault: ProtocolError) -> None:
        """Tell them of a fault in something that they sent."""

    def refuse_line(self, why: str, text: str) -> None:
        """Tell them that nobody hears their line of chat."""

    def dismiss(self, farewell: bytes, code: CloseCode, reason: str) -> object:
        """End the connection in good order, with a last frame."""
