"""Changes of operators in a hosted zone, which goes on from owner to owner."""

from concurrent.futures import Executor
from typing import Final, NamedTuple

import structlog

from esplanade.server.checkpoint.errors import CheckpointError
from esplanade.server.checkpoint.parts import Parts
from esplanade.server.console.audit_tail import Tail
from esplanade.server.console.console import Console
from esplanade.server.host.hosted_people import HostedPeople
from esplanade.server.host.zone_recovery import Found
from esplanade.server.kept import Kept
from esplanade.server.net.mutes import Mutes
from esplanade.server.recovery import tail_after
from esplanade.server.resuming import make_true, operated_parts

CONSOLE: Final = "console"
"""The part of a checkpoint without which it has nothing of operators."""

log = structlog.get_logger(__name__)


class Recovered(NamedTuple):
    """The parts of what operators have set, and the commands after the checkpoint."""

    parts: Parts
    tail: Tail


async def recovered(
    console: Console, mutes: Mutes, found: Found, kept: Kept, thread: Executor
) -> Recovered:
    """Let operators' changes be as the owner before has left them.

    What was acknowledged after its last checkpoint is made true again by the audit. Where the
    checkpoint has nothing of operators, or is one of another scene, nothing is set.

    Raises
    ------
    StoreError
        The database does not answer, or the zone is another host's already.
    """
    console.begun = kept.started
    parts, tail = Parts(found.parts or None), Tail()
    try:
        operated_parts(parts, console, mutes)
        if CONSOLE in found.parts:
            tail = await tail_after(kept, found.parts[CONSOLE])
            await make_true(console, tail, kept, thread)
    except CheckpointError as error:
        log.error("what operators have set is lost", why=str(error))  # noqa: TRY400
    return Recovered(parts, tail)


def send_out_the_kicked(people: HostedPeople, tail: Tail) -> None:
    """Give up the seats of those whom the owner before was sending out when it ended."""
    for person in tail.kicked:
        if people.seat_of(person) is not None:
            people.expel(person)
