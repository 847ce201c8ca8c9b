"""A load test tells broken servers from one that is not."""

import asyncio
from pathlib import Path

import pytest

from esplanade.bots.load import LoadJob
from esplanade.bots.series import Series
from esplanade.bots.tally import Tally
from esplanade.bots.thresholds import read_thresholds
from esplanade.bots.verdict import exit_code, warnings
from tests.bots.broken import Closing, Mute, Sleepy, Sparse, Unwelcoming
from tests.bots.scripted import ScriptedServer, listening, scripted_server, until
from tests.bots.test_cli import finish, start

BOTS = 3
RATE = 20


def job(server: ScriptedServer, duration_s: float = 0.0) -> LoadJob:
    return LoadJob(server.url, BOTS, 0, 1, seed=1, join_rate=100.0, duration_s=duration_s)


async def run(server: ScriptedServer, duration_s: float) -> Tally:
    tally = Tally(series=Series())
    await job(server, duration_s).run(tally, asyncio.Event())
    return tally


def ages_above(tally: Tally, age_s: float) -> int:
    """The number of due ticks that are known to have been older than this."""
    whole = tally.snapshot_age_s.count
    return sum(
        (tally.snapshot_age_s.percentile(100.0 * (place + 0.5) / whole) or 0.0) > age_s
        for place in range(whole)
    )


async def test_a_server_that_sends_an_eighth_is_told() -> None:
    async with listening(Sparse()) as server:
        tally = await run(server, 3.0)
    due = tally.client_seconds * RATE
    # A client owes the tick of its welcome, and two at its end, to nobody.
    assert due - 6 * BOTS <= tally.snapshots_due <= due + BOTS
    assert tally.snapshots_received < 0.25 * tally.snapshots_due
    assert tally.snapshots_missing == tally.snapshots_due - tally.snapshots_received
    assert ages_above(tally, 0.1) > 0.5 * tally.snapshots_due
    assert "WARNING: only" in "\n".join(warnings(tally, ()))


@pytest.mark.parametrize("gives_up", [True, False])
async def test_a_server_that_stands_still_is_as_old_as_it_is_still(gives_up: bool) -> None:
    tally, stop = Tally(), asyncio.Event()
    async with listening(Sleepy(gives_up=gives_up)) as server:
        running = asyncio.create_task(job(server).run(tally, stop))
        await until(lambda: tally.snapshots_received > 5 * BOTS)
        stood_s = await server.stand_still(1.5)
        before = tally.snapshots_received
        await until(lambda: tally.snapshots_received > before + 10 * BOTS)
        stop.set()
        await running
    owed = int(stood_s * RATE) * BOTS
    assert tally.snapshots_missing >= 0.8 * owed
    assert tally.snapshot_age_s.greatest >= 0.9 * stood_s
    assert ages_above(tally, stood_s / 2) >= 0.8 * owed / 2
    assert tally.snapshots_due >= tally.client_seconds * RATE - 6 * BOTS
    (verdict,) = [each.verdict(tally) for each in read_thresholds("snapshot_age.p90>200ms")]
    assert exit_code(tally, [verdict], ()) == 3
    # The time between two snapshots tells nothing: that is why it is not what one looks at.
    assert (tally.snapshot_interval_s.percentile(90) or 0.0) < stood_s / 2


async def test_a_server_that_stands_still_until_the_end_is_told() -> None:
    tally, stop = Tally(), asyncio.Event()
    async with listening(Sleepy()) as server:
        running = asyncio.create_task(job(server).run(tally, stop))
        await until(lambda: tally.snapshots_received > 5 * BOTS)
        standing = asyncio.create_task(server.stand_still(30.0))
        await asyncio.sleep(1.0)
        stop.set()
        await running
        standing.cancel()
        server.awake.set()
    assert tally.snapshots_missing >= (RATE - 6) * BOTS
    assert tally.snapshot_age_s.greatest >= 0.7


async def test_pings_that_nothing_answers_are_counted_at_the_end() -> None:
    async with listening(Mute()) as server:
        tally = await run(server, 1.2)
    # Three at the start of each, all longer than half a second ago.
    assert tally.pings_unanswered >= 3 * BOTS
    assert tally.pings_sent >= tally.pings_unanswered == tally.round_trip_s.count
    assert tally.round_trip_s.greatest >= 1.0
    assert tally.snapshots_received > 0


async def test_a_server_that_never_welcomes_fails_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("esplanade.bots.connection.OPEN_TIMEOUT_S", 0.5)
    async with listening(Unwelcoming()) as server:
        tally = await run(server, 0.2)
    assert (tally.joined, tally.failed) == (0, BOTS)
    assert tally.errors == {"join_timed_out": BOTS}
    assert tally.join_s.count == BOTS
    assert (tally.join_s.percentile(50) or 0.0) >= 0.5
    assert list(warnings(tally, ())) == ["none of 3 bots came in"]
    assert exit_code(tally, (), ()) == 1


async def test_a_server_that_closes_everyone_fails_the_run_by_name() -> None:
    async with listening(Closing()) as server:
        process = await start("--url", server.url, "--count", "3", "--duration", "3")
        code, out, _ = await finish(process)
    assert code == 1
    assert "closed_too_slow" in out


async def test_few_snapshots_are_a_warning_and_a_limit_makes_them_a_failure() -> None:
    async with listening(Sparse()) as server:
        arguments = ("--url", server.url, "--count", "2", "--duration", "1.5")
        code, out, err = await finish(await start(*arguments))
        assert code == 0, err
        assert "WARNING: only" in err
        limits = ("--fail-if", "snapshots.received<50%", "--fail-if", "join.p99>300s,errors>0")
        code, out, err = await finish(await start(*arguments, *limits))
    assert code == 3, err
    assert "limit crossed: snapshots.received<50%: it is " in err
    assert out.count(" kept ") == 2
    assert out.count(" crossed ") == 1


async def test_stages_go_up_and_down(tmp_path: Path) -> None:
    async with scripted_server() as server:
        process = await start("--url", server.url, "--stages", "0.5s:4,1s:4,0.5s:0")
        await until(lambda: len(server.people) == 4)
        await until(lambda: len(server.people) < 4)
        code, out, err = await finish(process)
    assert code == 0, err
    assert "4 of 4" in out
    stays = [person.hello.name for person in server.all_people]
    assert sorted(stays) == [f"Visitor {number}" for number in range(1, 5)]
