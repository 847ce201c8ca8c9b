"""The port of a gateway for operators: accounts and the audit are answered here, zones by hosts."""

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Final

import structlog
from fastapi import FastAPI
from sqlalchemy import Connection

from esplanade.server.accounts.identity import Identity
from esplanade.server.assets import Assets
from esplanade.server.cluster.ownership import ownerships
from esplanade.server.cluster.seats import people_by_zone
from esplanade.server.console.api import is_about_zone
from esplanade.server.console.gate import Gate, ZoneFacts
from esplanade.server.console.routing import PREFIX
from esplanade.server.entrances import make_gate, people_url, private_certificate
from esplanade.server.gateway.calls_out import CallLostError, CallsOut, NoHostError, OpenCall
from esplanade.server.gateway.forwarding import ForwardedToHosts, caller_of
from esplanade.server.kept import Kept
from esplanade.server.link.broker import BrokerError, Connecting
from esplanade.server.link.calls import Begun, Call, Part
from esplanade.server.link.subjects import Subjects
from esplanade.server.metrics import Metrics
from esplanade.server.net.private import Ready, private_port
from esplanade.server.net.tls import Tls, renewed
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import Store

KNOWN_S: Final = 1.0
"""Owners of zones are looked up anew after so long."""
ANSWER_S: Final = 2.0
"""A host that has not told of its zone by then is not waited for."""
RETRY_S: Final = 1.0

log = structlog.get_logger(__name__)


@asynccontextmanager
async def operators_port(
    settings: ServerSettings,
    kept: Kept,
    metrics: Metrics,
    assets: Assets,
    ready: Ready,
    zones: "ClusterZones",
    port_of_people: int,
    tls: Tls | None,
) -> AsyncIterator[int]:
    """Listen for operators, and yield the number of the port; `tls` is the certificate of people's
    port.

    Raises
    ------
    TlsError
        The certificate and its key cannot be used.
    OSError
        The address cannot be had.
    """
    own_tls = private_certificate(settings, tls)
    loop = asyncio.get_running_loop()
    gate = make_gate(settings, kept, loop, encrypted=own_tls is not None)
    gate.people_url = people_url(settings, port_of_people)
    zones.let_in_by(gate)
    with renewed(tls, own_tls):
        async with private_port(settings, metrics, ready, gate, assets, own_tls, zones) as port:
            yield port


class ClusterZones:
    """The zones of a cluster as a gateway reaches them for operators."""

    def __init__(
        self,
        gateway: str,
        start: str,
        store: Store,
        subjects: Subjects,
        broker_of: Callable[[], Connecting],
    ) -> None:
        """`start` is the zone that newcomers enter, and `broker_of` connects to the broker."""
        self._start = start
        self._store = store
        self._gate: Gate | None = None
        self._broker_of = broker_of
        self._calls = CallsOut(gateway, subjects, self._owner)
        self._epochs: dict[str, int | None] = {}
        self._looked_s: float | None = None

    def let_in_by(self, gate: Gate) -> None:
        """Have those let in by a gate who ask about zones."""
        self._gate = gate
        gate.first, gate.elsewhere = self._start, self.facts

    def add_to(self, app: FastAPI) -> None:
        """Have requests about zones answered by their hosts; the gate must be known."""
        if self._gate is None:
            raise RuntimeError("nobody is let in yet")
        app.add_middleware(
            ForwardedToHosts,
            gate=self._gate,
            calls=self._calls,
            zones=self.names,
            start=self._start,
            is_forwarded=is_about_zone,
        )

    async def run(self) -> None:
        """Keep up a connection to the broker until cancelled."""
        while True:
            try:
                async with self._broker_of() as broker, self._calls.over(broker):
                    await asyncio.Event().wait()
            except BrokerError as error:
                log.warning("operators reach no zone", why=str(error))
            await asyncio.sleep(RETRY_S)

    async def names(self) -> list[str]:
        """All zones, that which newcomers enter first.

        Raises
        ------
        StoreError
            The database does not answer.
        """
        await self._look(anew=False)
        return sorted(self._epochs, key=lambda zone: (zone != self._start, zone))

    async def facts(self, identity: Identity) -> list[ZoneFacts]:
        """The zones as an operator is told of them.

        Raises
        ------
        StoreError
            The database does not answer.
        """
        people = await self._store.read(people_by_zone)
        names = await self.names()
        return await asyncio.gather(
            *(self._facts(identity, zone, people.get(zone, 0)) for zone in names)
        )

    async def _facts(self, identity: Identity, zone: str, seats: int) -> ZoneFacts:
        """The facts of a zone, as its host tells them; without a host only the seats are known."""
        call = Call(
            name=self._calls.new_name(),
            gateway=self._calls.gateway,
            caller=caller_of(identity),
            kind="http",
            method="GET",
            path=f"{PREFIX}/zones",
            query=b"",
        )
        try:
            async with asyncio.timeout(ANSWER_S), self._calls.begun(zone, call) as opened:
                return ZoneFacts.model_validate(json.loads(await _whole(opened))["zones"][0])
        except (NoHostError, CallLostError, TimeoutError):
            return ZoneFacts(name=zone, scene=zone, people=seats, actors=0)

    async def _owner(self, zone: str, anew: bool) -> int | None:
        await self._look(anew=anew)
        return self._epochs.get(zone)

    async def _look(self, *, anew: bool) -> None:
        now_s = asyncio.get_running_loop().time()
        if anew or self._looked_s is None or now_s - self._looked_s > KNOWN_S:
            self._epochs = await self._store.read(_epochs)
            self._looked_s = now_s


async def _whole(opened: OpenCall) -> bytes:
    """The body of an answer.

    Raises
    ------
    CallLostError
        It is not whole, or none of success.
    """
    body = b""
    while True:
        match await opened.next():
            case Begun(status, _) if status != 200:
                raise CallLostError(f"the host answers {status}")
            case Begun():
                pass
            case Part(bytes() as data, more):
                body += data
                if not more:
                    opened.ended()
                    return body
            case _:
                raise CallLostError("the zone has another host now")
        await opened.written()


def _epochs(connection: Connection) -> dict[str, int | None]:
    """The epoch of the owner of each zone; None where it has none."""
    return {each.zone: None if each.host is None else each.epoch for each in ownerships(connection)}
