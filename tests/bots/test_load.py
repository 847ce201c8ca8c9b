"""A share of a load test against a scripted server."""

import asyncio
from dataclasses import replace

from esplanade.bots.load import LoadJob
from esplanade.bots.looks import look_of
from esplanade.bots.tally import Tally
from esplanade.protocol import ErrorCode, encode
from esplanade.protocol.codes import CloseCode
from esplanade.protocol.messages import Error, Move, Notice, WalkTo
from tests.bots.scripted import ScriptedServer, scripted_server, until
from tests.patience import PATIENCE_S

JOB = LoadJob(url="", count=6, first=0, step=1, seed=1, join_rate=100.0, duration_s=1.0)


def job_for(server: ScriptedServer, **changes: float) -> LoadJob:
    return replace(JOB, url=server.url, **changes)  # type: ignore[arg-type]


async def test_visitors_join_walk_measure_and_leave() -> None:
    tally, stop = Tally(), asyncio.Event()
    clock = asyncio.get_running_loop().time
    async with scripted_server() as server:
        running = asyncio.create_task(job_for(server, duration_s=0.0).run(tally, stop))
        await until(lambda: tally.joined == 6)
        joined_s = clock()
        await until(lambda: tally.round_trip_s.count >= 18 and bool(tally.snapshot_age_s.count))
        stayed_s = clock() - joined_s
        stop.set()
        await running
        await until(lambda: not server.people)
    assert (tally.expected, tally.joined, tally.left) == (6, 6, 6)
    assert tally.well
    assert tally.client_seconds > 6.0 * stayed_s
    heard = [message for person in server.all_people for message in person.heard]
    assert len(heard) == tally.messages_out
    assert any(isinstance(message, Move | WalkTo) for message in heard)
    assert tally.bytes_out == sum(len(encode(message)) for message in heard)
    assert 0 < tally.snapshot_age_s.count <= tally.messages_in
    assert tally.snapshot_interval_s.percentile(50) is not None
    assert {person.hello.name for person in server.all_people} == {
        f"Visitor {number}" for number in range(1, 7)
    }
    looks = {person.hello.name: person.hello.look for person in server.all_people}
    assert looks == {f"Visitor {index + 1}": look_of(JOB.seed, index) for index in range(6)}
    assert len(set(looks.values())) == 6


async def test_visitors_leave_by_themselves_when_the_time_is_over() -> None:
    tally = Tally()
    async with scripted_server() as server:
        began_s = asyncio.get_running_loop().time()
        await job_for(server).run(tally, asyncio.Event())
        assert asyncio.get_running_loop().time() - began_s >= JOB.duration_s
    assert (tally.joined, tally.left) == (6, 6)
    assert tally.well


async def test_shares_make_up_the_whole() -> None:
    async with scripted_server() as server:
        tallies = [Tally(), Tally()]
        await asyncio.gather(
            *(
                job_for(server, count=5, first=first, step=2).run(tally, asyncio.Event())
                for first, tally in enumerate(tallies)
            )
        )
    assert [tally.joined for tally in tallies] == [3, 2]
    assert len({person.hello.name for person in server.all_people}) == 5


async def test_stop_sends_everyone_home() -> None:
    tally, stop = Tally(), asyncio.Event()
    async with scripted_server() as server:
        running = asyncio.create_task(job_for(server, duration_s=0.0).run(tally, stop))
        await until(lambda: tally.joined == 6)
        stop.set()
        await asyncio.wait_for(running, PATIENCE_S)
    assert tally.left == 6
    assert tally.well


async def test_refusals_are_counted_by_code() -> None:
    tally = Tally()
    async with scripted_server() as server:
        server.on_hello = lambda hello: (
            Error(error=ErrorCode.SERVER_FULL, text="full") if server.all_people[3:] else None
        )
        await job_for(server).run(tally, asyncio.Event())
    assert (tally.joined, tally.failed) == (4, 2)
    assert tally.errors == {"server_full": 2}


async def test_nobody_there_is_counted(unused_tcp_port: int) -> None:
    tally = Tally()
    job = replace(JOB, url=f"ws://127.0.0.1:{unused_tcp_port}", duration_s=0.1)
    await job.run(tally, asyncio.Event())
    assert tally.errors == {"unreachable": 6}
    assert tally.client_seconds == 0.0


async def test_lost_connections_and_complaints_are_counted() -> None:
    tally, stop = Tally(), asyncio.Event()
    async with scripted_server() as server:
        running = asyncio.create_task(job_for(server, count=4, duration_s=0.0).run(tally, stop))
        await until(lambda: len(server.people) == 4)
        cut, closed, told, fed = server.all_people
        cut.socket.transport.abort()
        await closed.socket.close(CloseCode.TOO_SLOW)
        await told.socket.send(encode(Error(error=ErrorCode.FLOODING, text="slower")))
        await told.socket.send(encode(Notice(text="hello")))
        await fed.socket.send(b"\x92\x48\x80")  # a pong without its fields
        await until(lambda: tally.lost == 3)
        stop.set()
        await asyncio.wait_for(running, PATIENCE_S)
    assert tally.errors == {
        "closed_1006": 1,
        "closed_too_slow": 1,
        "flooding": 1,
        "nonsense_from_server": 1,
    }
    assert tally.left == 1
    assert not tally.well
