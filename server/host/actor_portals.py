"""The portals of a hosted zone for actors: they go to zones of other hosts, and come from there.

The destination says whether it would take the actor in, then the one statement lets it go
(`travellers.send`), and then the destination finds it in the database. Whoever dies meanwhile, the
rows and the checkpoints say where the actor is.
"""

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

import msgpack
import structlog
from nats.aio.client import Client
from nats.aio.msg import Msg
from nats.errors import Error as NatsError
from pydantic import ValidationError

from esplanade.actors import ActorParameters, ActorSpec
from esplanade.planning import Portal
from esplanade.server.checkpoint.errors import CheckpointError
from esplanade.server.checkpoint.parts import Parts
from esplanade.server.cluster import travellers
from esplanade.server.cluster.ownership import NotOwnerError
from esplanade.server.cluster.tenure import Tenure
from esplanade.server.cluster.travellers import TravellerRow
from esplanade.server.link.subjects import Subjects
from esplanade.server.store.store import Store, StoreError
from esplanade.server.world.actor_travel import ActorTravel, Traveller
from esplanade.server.world.inputs import ActorCommand
from esplanade.server.world.outcomes import Fault, FaultCode
from esplanade.server.world.zone import Zone

LOOK_S: Final = 1.0
"""The actors who are to come are read so often, and at once where another host says so."""
ASK_S: Final = 1.0
"""A question without an answer is asked again after so long."""
ASKED_TIMES: Final = 5
RETRY_S: Final = 0.3
QUESTIONS: Final = 64
"""The most questions of other hosts that wait for the next tick; further ones are left out, and
asked again."""
ACTOR: Final = "actor"
ACTOR_SENT: Final = "actor_sent"

log = structlog.get_logger(__name__)

Exits = Mapping[str, tuple[str, Portal]]
"""The zone and the portal there that each portal leads to, by its name."""


class ActorPortals:
    """Lets actors go through the portals of a zone, and takes in those who come."""

    def __init__(
        self,
        world: Zone,
        exits: Exits,
        broker: Client,
        subjects: Subjects,
        store: Store,
        tenure: Tenure,
    ) -> None:
        """`exits` are those by which actors may leave."""
        self.travel = ActorTravel(world)
        self._broker = broker
        self._subjects = subjects
        self._store = store
        self._tenure = tenure
        self._expected: set[str] = set()
        self._gone: set[str] = set()
        self._came: set[str] = set()
        """Actors who have gone and come, until no row tells of it."""
        self._waiting: set[str] = set()
        """Actors whom the zone cannot take in yet; they are not lost, and come in when it can."""
        self._questions: list[tuple[str, Traveller]] = []
        self._asked = asyncio.Event()
        self._under_way: set[asyncio.Task[None]] = set()
        ways = {
            name: (_Way(self, zone), portal.arrival_place) for name, (zone, portal) in exits.items()
        }
        self.travel.open(world.scene.portals, ways)

    def restore(self, parts: Parts, found: Sequence[TravellerRow]) -> None:
        """Go on from what the owner before has left, before the first tick: those who stood in a
        portal may walk again, and those who had gone are taken out."""
        try:
            parts.part("travel", self.travel.save, self.travel.load)
        except CheckpointError as error:
            log.error("actors may stand in portals", why=str(error))  # noqa: TRY400
        zone = self._tenure.claim.zone
        for row in found:
            if row.origin == zone and not row.has_left:
                self._gone.add(row.actor)
                if self.travel.has(row.actor):
                    self.travel.give_up(row.actor)

    def drain(self) -> list[ActorCommand]:
        """Return the inputs of the next tick. Call it between two ticks."""
        questions, self._questions = self._questions, []
        for reply, traveller in questions:
            fault = self.travel.refusal(traveller)
            self._begin(self._tell(reply, "" if fault is None else fault.code.value))
        return self.travel.drain()

    async def answer(self, question: Msg) -> None:
        """Say whether an actor of another zone would be taken in, once that can be seen."""
        try:
            kind, *facts = msgpack.unpackb(question.data)
            if kind == ACTOR_SENT:
                self._asked.set()
            if kind != ACTOR or not question.reply or len(self._questions) >= QUESTIONS:
                return
            traveller = _traveller(*facts)
        except (ValueError, TypeError, msgpack.UnpackException) as error:
            log.debug("a question was not understood", why=str(error))
            return
        self._questions.append((question.reply, traveller))

    async def run(self) -> None:
        """Find those who are to come, until cancelled."""
        while True:
            self._asked.clear()
            try:
                await self._look()
            except StoreError as error:
                log.debug("nobody knows which actors are to come", why=str(error))
            try:
                async with asyncio.timeout(LOOK_S):
                    await self._asked.wait()
            except TimeoutError:
                pass

    def settled(self) -> Any:
        """The change that notes what a checkpoint of this moment knows, in its transaction."""
        left = {actor for actor in self._gone if not self.travel.has(actor)}
        return partial(
            travellers.settle, zone=self._tenure.claim.zone, left=left, came={*self._came}
        )

    async def close(self) -> None:
        """Break off what is under way; the rows say where everybody is."""
        for task in self._under_way:
            task.cancel()
        await asyncio.gather(*self._under_way, return_exceptions=True)

    def go(self, traveller: Traveller, zone: str) -> None:
        """Let an actor go, who stands held in a portal."""
        self._begin(self._go(traveller, zone))

    # --- who goes -----------------------------------------------------------------------------

    async def _go(self, traveller: Traveller, zone: str) -> None:
        spec, parameters = traveller.spec.model_dump_json(), traveller.parameters.model_dump_json()
        actor, fault = str(traveller.spec.id), await self._ask(zone, spec, parameters)
        if fault is None and not await self._sent(zone, actor, spec, parameters):
            fault = Fault(FaultCode.BUSY, "it has not quite come in yet")
        if fault is None:
            self._gone.add(actor)
        traveller.ended(fault)
        if fault is not None:
            log.info("an actor stays", actor=actor, zone=zone, why=fault.text)
            return
        try:
            await self._broker.publish(
                self._subjects.questions(zone), msgpack.packb([ACTOR_SENT, actor])
            )
        except NatsError:
            return  # it is found a second later

    async def _ask(self, zone: str, spec: str, parameters: str) -> Fault | None:
        """Ask whether a zone would take an actor in; the reason if not."""
        packed, subject = msgpack.packb([ACTOR, spec, parameters]), self._subjects.questions(zone)
        for _ in range(ASKED_TIMES):
            try:
                code = (await self._broker.request(subject, packed, timeout=ASK_S)).data.decode()
            except (NatsError, TimeoutError):
                await asyncio.sleep(RETRY_S)
                continue
            return None if not code else Fault(FaultCode(code), f"refused there: {code}")
        return Fault(FaultCode.FAILED, "the zone does not answer")

    async def _sent(self, zone: str, actor: str, spec: str, parameters: str) -> bool:
        """Write that an actor goes; an outcome that nobody knows is read until it is known."""
        claim = self._tenure.claim
        sending = partial(
            travellers.send,
            owner=claim,
            zone=zone,
            actor=actor,
            spec=spec,
            parameters=parameters,
        )
        try:
            return await self._store.write(sending)
        except NotOwnerError:
            self._tenure.renewed(False)
            return False
        except StoreError as error:
            log.warning("nobody knows whether an actor has gone", actor=actor, why=str(error))
        while True:
            await asyncio.sleep(RETRY_S)
            try:
                row = await self._store.read(partial(travellers.traveller, actor=actor))
            except StoreError:
                continue
            return row is not None and (row.origin, row.zone) == (claim.zone, zone)

    # --- who comes ----------------------------------------------------------------------------

    async def _tell(self, reply: str, code: str) -> None:
        try:
            await self._broker.publish(reply, code.encode())
        except NatsError as error:
            log.debug("an answer was not sent", error=str(error))

    async def _look(self) -> None:
        zone, told = self._tenure.claim.zone, self._gone | self._came
        found = await self._store.read(partial(travellers.travellers_of, zone=zone))
        ended = told - {row.actor for row in found}
        self._gone -= ended
        self._came -= ended
        coming = {row.actor: row for row in found if row.zone == zone}
        self._waiting &= coming.keys()
        for actor, row in coming.items():
            if row.has_come or actor in self._came | self._expected:
                continue
            try:
                traveller = _traveller(row.spec, row.parameters)
            except ValueError as error:
                log.error("an actor cannot come in", actor=actor, why=str(error))  # noqa: TRY400
                continue
            self._expected.add(actor)
            self.travel.expect(replace(traveller, ended=partial(self._ended, actor)))

    def _ended(self, actor: str, fault: Fault | None) -> None:
        self._expected.discard(actor)
        if fault is None:
            self._came.add(actor)
        elif actor not in self._waiting:
            self._waiting.add(actor)
            log.warning("an actor cannot come in yet", actor=actor, why=fault.text)

    def _begin(self, work: Any) -> None:
        task = asyncio.create_task(work)
        self._under_way.add(task)
        task.add_done_callback(self._under_way.discard)


class _Way:
    """The way to a zone of another host."""

    def __init__(self, portals: ActorPortals, zone: str) -> None:
        self._portals = portals
        self._zone = zone

    def expect(self, traveller: Traveller) -> None:
        self._portals.go(traveller, self._zone)


def _traveller(spec: str, parameters: str) -> Traveller:
    """A traveller of the text that has gone along.

    Raises
    ------
    ValueError
        This program does not know such actors.
    """
    try:
        return Traveller(
            ActorSpec.model_validate_json(spec),
            ActorParameters.model_validate_json(parameters),
            lambda _: None,
        )
    except ValidationError as error:
        raise ValueError(str(error)) from None
