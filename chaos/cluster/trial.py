"""A trial of a cluster: bots live in it while faults happen, and then all of it is looked at."""

import asyncio
import random
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from tests.server.brokers import nats_server
from tests.server.clustering.clusters import cluster
from tests.server.databases import postgresql_server
from tests.server.zones import write_town

from chaos.cluster.bots import Bot
from chaos.cluster.faults import Faults
from chaos.cluster.ledger import Ledger

BETWEEN_S: Final = (1.0, 3.0)
"""From the end of a fault to the next one."""
REST_S: Final = 10.0
"""For so long nothing happens before all is looked at."""
BEGIN_S: Final = 60.0


@dataclass
class Outcome:
    """What came of a trial."""

    seed: int
    faults: list[str] = field(default_factory=list)
    """What cannot be: doubles, ghosts, losses; a sentence each."""
    gaps_s: dict[str, list[float]] = field(default_factory=dict)
    """The longest time without a snapshot of any bot around each fault, by its kind."""
    counts: dict[str, int] = field(default_factory=dict)


async def run_trial(
    folder: Path,
    seed: int,
    seconds: float,
    bots: int,
    kinds: Sequence[str] = (),
    tell: Callable[[str], None] = print,
) -> Outcome:
    """Run a trial in a cluster of its own. `kinds` names faults that happen in that order, again
    and again; without them they are drawn by the seed."""
    chance, ledger = random.Random(seed), Ledger()
    outcome = Outcome(seed)
    with (
        nats_server() as broker,
        postgresql_server() as database,
        cluster(database.address, broker, resume_s=120.0) as made,
    ):
        await asyncio.to_thread(made.init, write_town(folder))
        await asyncio.to_thread(made.refill)
        faults = Faults(made, broker, database, chance)
        living = [Bot(f"bot {k}", lambda: made.ports, ledger, seed) for k in range(bots)]
        tasks = [asyncio.create_task(bot.live()) for bot in living]
        try:
            await _all_in(ledger, bots)
            end_s = time.monotonic() + seconds
            number = 0
            while time.monotonic() < end_s:
                await asyncio.sleep(chance.uniform(*BETWEEN_S))
                kind = kinds[number % len(kinds)] if kinds else chance.choice([*faults.kinds])
                number += 1
                ledger.worst_gap_s()
                await faults.kinds[kind]()
                await _all_in(ledger, bots)
                gap_s = ledger.worst_gap_s()
                outcome.gaps_s.setdefault(kind, []).append(gap_s)
                tell(f"{kind}: {gap_s:.1f} s without a snapshot, {len(ledger.faults)} faults")
            for bot in living:
                bot.rests = True
            await asyncio.sleep(REST_S)
            await _all_in(ledger, bots)
            for task in tasks:
                if task.done():
                    task.result()
            ledger.check_rest(made.seats)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
    outcome.faults, outcome.counts = ledger.faults, dict(ledger.counts)
    return outcome


async def _all_in(ledger: Ledger, bots: int) -> None:
    """Wait until every bot is in and is shown something."""
    since_s = time.monotonic()
    while time.monotonic() < since_s + BEGIN_S:
        accounts = ledger.accounts.values()
        shown = [each for each in accounts if each.zone and (each.snapshot_s or 0.0) > since_s]
        if len(shown) == bots:
            return
        await asyncio.sleep(0.05)
    missing = [each.name for each in ledger.accounts.values() if not each.zone]
    why = f"{missing} are not in" if missing else "they are shown nothing"
    ledger.faults.append(f"not everybody is in after {BEGIN_S:g} s: {why}")
