"""A person at a gateway: a seat of the cluster, and the session that has it."""

from dataclasses import dataclass, field

from esplanade.protocol.looks import Look
from esplanade.server.cluster.person_record import PersonRecord
from esplanade.server.net.session import Session


@dataclass(eq=False)
class Occupant:
    """One occupation of a seat, from the moment at which it was written."""

    person: int
    generation: int
    session: Session
    record: PersonRecord
    resumed: bool
    since_s: float
    """When the seat was taken, or the person was seen last in the zone; seconds of the loop."""
    is_known: bool = False
    """Whether the zone has told that it lets nobody steer who has had the seat before."""
    is_in: bool = False
    """Whether the client has been welcomed to any zone on this connection."""
    moves: bool = False
    """Whether the client has last asked to walk."""
    mutes: bool = False
    """Whether the client has said whom it does not want to hear."""
    away: bool | None = None
    """Whether the client has said that its person is away; None while it has said nothing."""
    look: Look | None = None
    """The look that the client has asked for since; None where the record says it."""
    told: list[bytes] = field(default_factory=list)
    """Frames from the host that wait until the client has been welcomed to its zone."""
    lines: list[str] = field(default_factory=list)
    """Lines of chat that are said once the client has been welcomed."""
