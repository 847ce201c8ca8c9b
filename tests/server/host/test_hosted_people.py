"""A host takes in what the newest occupation of a seat wants, nothing older, late or doubled."""

import asyncio
from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from esplanade.protocol import CloseCode, ErrorCode, NoticeCode, ProtocolError, decode_server
from esplanade.protocol.messages import FromServer, Notice, WalkTo
from esplanade.server.accounts.identity import Identity
from esplanade.server.cluster.occupations import SILENCE_S
from esplanade.server.cluster.person_record import PersonRecord, decode_record, encode_record
from esplanade.server.cluster.seats import ClusterSeat
from esplanade.server.host.gateway_batches import GatewayBatches
from esplanade.server.host.guests import SeatsOfZone
from esplanade.server.host.host_moderation import HostModeration
from esplanade.server.host.hosted_people import HostedPeople
from esplanade.server.link.batches import MOVEMENT, Batch
from esplanade.server.metrics import Metrics
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net.chat_gate import ChatGate
from esplanade.server.net.door_commands import DoorCommands
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.reporting import Reporting
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.search_budget import SearchBudget
from esplanade.server.net.waiting_lines import WaitingLines
from esplanade.server.net.walk_outs import WalkOuts
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.world.frame import Frame
from tests.server.worlds import ROOM, Trial

EPOCH = 40
ANN, BEN = 7, 8
PLACE = (3.0, 5.0, 0.0)


class Desk:
    """Takes down what is to be written of seats."""

    def __init__(self) -> None:
        self.told: list[tuple[object, ...]] = []
        self.looks = 0

    def vacate(self, person: int, generation: int) -> None:
        self.told.append(("vacate", person, generation))

    def reoccupy(self, person: int, generation: int, gateway: str) -> None:
        self.told.append(("reoccupy", person, generation, gateway))

    def leave(self, person: int, generation: int) -> None:
        self.told.append(("leave", person, generation))

    def expel(self, person: int) -> None:
        self.told.append(("expel", person))

    def keep(self, person: int, state: bytes) -> None:
        self.told.append(("keep", person, decode_record(state).muted))

    def look(self) -> None:
        self.looks += 1


class Answers:
    """Takes down what is told to single people."""

    def __init__(self) -> None:
        self.told: list[tuple[str, int, int, object]] = []

    def post(self, gateway: str, person: int, generation: int, message: FromServer) -> None:
        self.told.append((gateway, person, generation, message))

    def tell(self, gateway: str, person: int, generation: int, fault: Exception) -> None:
        self.told.append((gateway, person, generation, fault))

    def replaced(self, gateway: str, person: int, generation: int) -> None:
        self.told.append((gateway, person, generation, "replaced"))

    def pass_on(self, gateway: str, person: int, generation: int, frame: bytes) -> None:
        # Before the message there are the head of a WebSocket frame and the length of a long one.
        self.told.append(
            (gateway, person, generation, decode_server(frame[2 + 2 * (frame[1] == 126) :]))
        )

    def dismiss(
        self, gateway: str, person: int, generation: int, frame: bytes, close: int, reason: str
    ) -> None:
        self.told.append((gateway, person, generation, (close, reason)))


class Nobody:
    """A console to which no operator comes."""

    async def carry_out(self, by: Identity, commands: list[object]) -> object:
        raise AssertionError(f"{by.account} commands {commands}")


async def nobody_again(_: Identity) -> Identity | None:
    return None


class Hosted:
    """A room with people of gateways, driven tick by tick."""

    def __init__(self, thread: ThreadPoolExecutor, store: SqlStore) -> None:
        self.trial = Trial(ROOM, max_people=8)
        self.world = self.trial.world
        self.desk, self.answers = Desk(), Answers()
        routes = RouteRequests(self.world, thread, SearchBudget())
        pending = PendingInputs(Metrics())
        self.people = HostedPeople(
            self.world,
            routes,
            pending,
            self.desk,  # type: ignore[arg-type]
            self.answers,  # type: ignore[arg-type]
        )
        self.now_s = 100.0
        state = ModerationState(store)
        people = self.people
        self.moderation = people.moderation = HostModeration(
            state,
            self.world,
            [0.0],
            people.guests,
            SeatsOfZone(people.seat_of),
            people.expel,
            lambda: self.now_s,
            place=3,
        )
        self.moderation.walk_outs = WalkOuts(
            self.world, people.guests, routes, pending.move, self.moderation.has_walked_out
        )
        self.batches = GatewayBatches(
            self.world,
            people,
            routes,
            pending,
            self.answers,  # type: ignore[arg-type]
            EPOCH,
            WaitingLines(self.moderation, ChatGate(state, [0.0]), lambda _: False, Metrics()),
            DoorCommands(Nobody(), nobody_again),
            Reporting(state, self.moderation),
        )
        self._numbers = dict.fromkeys(("east", "west"), 0)

    def seats(self, *seats: ClusterSeat) -> None:
        self.people.take_seats(list(seats), self.now_s)

    def send(self, gateway: str = "east", epoch: int = EPOCH, **wanted: object) -> Batch:
        self._numbers[gateway] += 1
        batch = Batch(gateway, self._numbers[gateway], epoch, **wanted)  # type: ignore[arg-type]
        self.batches.take(batch, self.now_s)
        return batch

    def steer(self, person: int, generation: int, seq: int, gateway: str = "east") -> Batch:
        movement = np.array([(person, generation, seq, 0.0, 1.0)], dtype=MOVEMENT)
        return self.send(gateway, movements=movement)

    def tick(self) -> Frame:
        self.world.begin(self.people.drain(self.batches.lines(), self.now_s))
        frame = self.moderation.numbered(self.world.finish(self.world.think()))
        self.people.told(frame)
        self.now_s += self.world.tick_s
        return frame


def seat(person: int, generation: int, gateway: str | None = "east", name: str = "") -> ClusterSeat:
    """A seat in the room."""
    record = PersonRecord(place=PLACE, anywhere=True, address="10.0.0.7")
    called = name or f"person {person}"
    vacated = None if gateway else 5
    return ClusterSeat(
        person, "room", called, generation, 0, gateway, vacated, encode_record(record)
    )


@pytest.fixture
async def hosted() -> AsyncIterator[Hosted]:
    store = SqlStore(Location.of(None, ""))
    with ThreadPoolExecutor(1) as thread:
        yield Hosted(thread, store)
    await store.close()


async def test_a_seat_makes_an_avatar_with_the_number_of_the_person(hosted: Hosted) -> None:
    hosted.send(held=[(ANN, 1)])
    assert hosted.desk.looks == 1  # a gateway's word alone makes nobody
    assert hosted.tick().joined == []
    hosted.seats(seat(ANN, 1))
    assert hosted.tick().joined == [(1, ANN)]
    assert hosted.world.where(ANN) == pytest.approx(PLACE)
    hosted.seats(seat(ANN, 1))
    assert hosted.tick().joined == []
    hosted.seats()  # the seat is gone, or in another zone
    assert hosted.tick().left == [ANN]


async def test_only_the_newest_generation_steers(hosted: Hosted) -> None:
    hosted.seats(seat(ANN, 2))
    hosted.tick()
    hosted.steer(ANN, 1, 5)
    assert hosted.tick().acks == {}
    hosted.steer(ANN, 2, 6)
    assert hosted.tick().acks == {ANN: 6}
    hosted.send("west", held=[(ANN, 3)])
    assert hosted.tick().attached == [(3, ANN)]
    hosted.steer(ANN, 2, 7)
    assert hosted.tick().acks == {}
    hosted.send("east", held=[(ANN, 2)])
    assert hosted.answers.told == [("east", ANN, 2, "replaced")]
    hosted.steer(ANN, 3, 1, "west")
    assert hosted.tick().acks == {ANN: 1}
    assert hosted.batches.refused["generation"] == 2


async def test_what_an_older_client_wanted_in_the_same_tick_is_void(hosted: Hosted) -> None:
    hosted.seats(seat(ANN, 1))
    hosted.tick()
    hosted.steer(ANN, 1, 5)
    hosted.send("west", held=[(ANN, 2)])
    assert hosted.tick().acks == {}
    assert not hosted.world.moves(ANN)
    hosted.steer(ANN, 2, 1, "west")
    hosted.seats(seat(ANN, 3))
    assert hosted.tick().attached == [(3, ANN)]
    assert not hosted.world.moves(ANN)


async def test_a_batch_that_comes_twice_late_or_for_another_owner_has_no_effect(
    hosted: Hosted,
) -> None:
    hosted.seats(seat(ANN, 1))
    hosted.tick()
    first = hosted.send(lines=[(ANN, 1, "hello")])
    hosted.batches.take(first, hosted.now_s)
    assert [line.text for line in hosted.tick().events.chat] == ["hello"]
    second = hosted.send(lines=[(ANN, 1, "again")])
    hosted.batches.take(first, hosted.now_s)
    hosted.batches.take(second, hosted.now_s)
    assert [line.text for line in hosted.tick().events.chat] == ["again"]
    for epoch in (EPOCH - 1, EPOCH + 1):
        hosted.send(epoch=epoch, lines=[(ANN, 1, "never")])
    assert hosted.tick().events.chat == []
    assert hosted.batches.refused == {"late": 3, "epoch": 2}


async def test_people_of_a_silent_gateway_stand_and_are_there_again(hosted: Hosted) -> None:
    hosted.seats(seat(ANN, 1))
    hosted.tick()
    hosted.steer(ANN, 1, 1)
    hosted.tick()
    assert hosted.world.moves(ANN)
    hosted.now_s += SILENCE_S + 0.1
    assert hosted.tick().detached == [ANN]
    assert not hosted.world.moves(ANN)
    assert hosted.desk.told == [("vacate", ANN, 1)]
    hosted.steer(ANN, 1, 2)
    assert hosted.tick().acks == {}
    hosted.send(held=[(ANN, 1)])
    hosted.steer(ANN, 1, 3)
    assert hosted.tick().acks == {ANN: 3}
    assert hosted.desk.told[1:] == [("reoccupy", ANN, 1, "east")]


async def test_whoever_departs_waits_or_leaves(hosted: Hosted) -> None:
    hosted.seats(seat(ANN, 1), seat(BEN, 4))
    hosted.tick()
    hosted.send(departed=[(ANN, 1, True), (BEN, 3, False)])
    frame = hosted.tick()
    assert (frame.detached, frame.left) == ([ANN], [])
    hosted.send(departed=[(BEN, 4, False)])
    assert hosted.tick().left == [BEN]
    assert hosted.desk.told == [("vacate", ANN, 1), ("leave", BEN, 4)]
    hosted.seats(seat(ANN, 2, "west"))  # she came back at a gateway that has not said so yet
    assert hosted.tick().attached == [(2, ANN)]
    hosted.steer(ANN, 2, 1, "west")
    assert hosted.tick().acks == {ANN: 1}


async def test_a_walk_is_sought_once_however_often_it_comes(hosted: Hosted) -> None:
    hosted.seats(seat(ANN, 1))
    hosted.tick()
    routes = hosted.batches._routes
    finding = asyncio.create_task(routes.run(hosted.people.route_found))
    wish = WalkTo(seq=9, x=3.0, y=9.0)
    for _ in range(3):
        hosted.send(walks=[(ANN, 1, wish)])
    while routes.waiting:  # noqa: ASYNC110 - nothing tells of it
        await asyncio.sleep(0.01)
    finding.cancel()
    assert hosted.tick().acks == {ANN: 9}
    hosted.send(walks=[(ANN, 1, wish)])
    assert routes.waiting == 0
    hosted.send(walks=[(ANN, 1, wish.model_copy(update={"seq": 10}))])
    assert len(routes._latest) == 1


async def test_whoever_hops_is_hidden_and_stays_or_goes(hosted: Hosted) -> None:
    hosted.seats(seat(ANN, 1), seat(BEN, 1))
    hosted.tick()
    for person in (ANN, BEN):
        hosted.people.leave_by(person)
        hosted.steer(person, 1, 5)
    assert hosted.tick().acks == {}
    for person in (ANN, BEN):
        hosted.people.hide(person)
    assert sorted(hosted.tick().left) == [ANN, BEN]
    hosted.seats(seat(ANN, 1), seat(BEN, 1))  # read while their seats are being moved
    assert hosted.tick().joined == []
    hosted.people.moved(ANN, is_here=True, at=PLACE)
    hosted.people.moved(BEN, is_here=False, at=PLACE)
    assert hosted.tick().joined == [(1, ANN)]
    hosted.steer(ANN, 1, 6)
    hosted.steer(BEN, 1, 6)
    assert hosted.tick().acks == {ANN: 6}


async def test_operators_mute_warn_and_send_out_people_of_gateways(hosted: Hosted) -> None:
    hosted.seats(seat(ANN, 1), seat(BEN, 1, "west"))
    hosted.tick()
    care = hosted.moderation
    assert (
        care.name_of(ANN),
        care.within(storey_m=None, polygon=None, centre=None, radius_m=0),
    ) == (
        "person 7",
        [ANN, BEN],
    )
    care.mute(ANN, 30.0, "Please let others speak.")
    care.warn(BEN, "Slowly.")
    said = {person: message for _, person, _, message in hosted.answers.told}
    assert isinstance(said[ANN], Notice)
    assert said[ANN].notice is NoticeCode.MUTED
    assert isinstance(said[BEN], Notice)
    assert said[BEN].notice is NoticeCode.WARNED
    hosted.send(lines=[(ANN, 1, "nobody hears this")])
    hosted.send("west", lines=[(BEN, 1, "and this they do")])
    (line,) = hosted.tick().events.chat
    assert line.text == "and this they do"
    assert line.number == care.lines.latest > care.lines.first
    fault = hosted.answers.told[-1][3]
    assert isinstance(fault, ProtocolError)
    assert fault.code is ErrorCode.MUTED
    assert hosted.people.record_to_go(ANN).silent_s == pytest.approx(30.0, abs=5.0)
    care.kick(BEN, "Go.")
    assert hosted.answers.told[-1] == ("west", BEN, 1, (CloseCode.KICKED, "kicked"))
    assert hosted.desk.told == [("expel", BEN)]
    hosted.seats(seat(ANN, 1), seat(BEN, 1, "west"))  # read before the seat was removed
    assert hosted.tick().left == [BEN]
    assert hosted.tick().joined == []
    gone = care.known(BEN)
    assert gone is not None
    assert gone.name == "person 8"


async def test_mutes_of_operators_and_of_people_come_along(hosted: Hosted) -> None:
    record = PersonRecord(place=PLACE, anywhere=True, silent_s=20.0, muted=(BEN,))
    came = ClusterSeat(ANN, "room", "Ann", 1, 1, "east", None, encode_record(record))
    hosted.seats(came)
    hosted.tick()
    assert hosted.moderation.muted_s(ANN) == pytest.approx(20.0, abs=5.0)
    for _ in range(2):  # the gateway says it again, since a batch may be lost
        hosted.send(muted=[(ANN, 1, [BEN, 12])])
    assert hosted.desk.told == [("keep", ANN, (BEN, 12))]
    assert hosted.people.record_to_go(ANN).muted == (BEN, 12)
    hosted.send(muted=[(ANN, 0, [])])
    assert hosted.people.record_to_go(ANN).muted == (BEN, 12)


async def test_who_is_walked_out_goes_nowhere_else(hosted: Hosted) -> None:
    hosted.seats(seat(ANN, 1))
    hosted.tick()
    finding = asyncio.create_task(hosted.batches._routes.run(hosted.people.route_found))
    hosted.moderation.walk_out(ANN, "This way, please.")
    assert hosted.people.is_walked_out(ANN)
    hosted.steer(ANN, 1, 5)
    while not hosted.world.moves(ANN):
        await asyncio.sleep(0.01)
        assert hosted.tick().acks in ({}, {ANN: 1})
    for _ in range(2000):
        if not hosted.people.is_walked_out(ANN):
            break
        hosted.steer(ANN, 1, 6)
        hosted.send(held=[(ANN, 1)])
        hosted.tick()
    finding.cancel()
    assert hosted.answers.told[-1] == ("east", ANN, 1, (CloseCode.KICKED, "walked_out"))
    assert hosted.desk.told == [("expel", ANN)]
