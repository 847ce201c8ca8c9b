"""A trial of a cluster: bots live in it while faults happen, and then all of it is looked at."""

import asyncio
import random
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from tests.server.brokers import Brokers
from tests.server.clustering.clusters import Cluster
from tests.server.databases import PostgresqlServer

from chaos.cluster.bots import Bot, end
from chaos.cluster.faults import Faults
from chaos.cluster.ledger import Ledger

BETWEEN_S: Final = (1.0, 3.0)
"""From the end of a fault to the next one."""
REST_S: Final = 10.0
"""For so long nothing happens before all is looked at, unless somebody says otherwise."""
BEGIN_S: Final = 60.0


@dataclass
class Outcome:
    """The outcome of a trial."""

    seed: int
    faults: list[str] = field(default_factory=list)
    """Things that cannot be: doubles, ghosts, losses; a sentence each."""
    gaps_s: dict[str, list[float]] = field(default_factory=dict)
    """The longest time without a snapshot of any bot around each fault, by its kind."""
    counts: dict[str, int] = field(default_factory=dict)


async def run_trial(
    cluster: Cluster,
    broker: Brokers,
    database: PostgresqlServer,
    seed: int,
    bots: int,
    kinds: Iterable[str],
    tell: Callable[[str], None] = print,
    rest_s: float = REST_S,
) -> Outcome:
    """Run a trial in a cluster that has all of its processes; `kinds` names the faults."""
    chance, ledger = random.Random(seed), Ledger()
    outcome = Outcome(seed)
    faults = Faults(cluster, broker, database, chance)
    living = [Bot(f"bot {k}", lambda: cluster.ports, ledger, seed) for k in range(bots)]
    tasks = [asyncio.create_task(bot.live()) for bot in living]
    try:
        await _all_in(ledger, bots)
        for kind in kinds:
            await asyncio.sleep(chance.uniform(*BETWEEN_S))
            ledger.worst_gap_s()
            await faults.kinds[kind]()
            await _all_in(ledger, bots)
            gap_s = ledger.worst_gap_s()
            outcome.gaps_s.setdefault(kind, []).append(gap_s)
            tell(f"{kind}: {gap_s:.1f} s without a snapshot, {len(ledger.faults)} faults")
        for bot in living:
            bot.rests = True
        await asyncio.sleep(rest_s)
        await _all_in(ledger, bots)
        ledger.check_rest(await asyncio.to_thread(lambda: cluster.seats))
    finally:
        await end(tasks)
    outcome.faults, outcome.counts = ledger.faults, dict(ledger.counts)
    return outcome


def drawn(seed: int, seconds: float, kinds: Sequence[str]) -> Iterator[str]:
    """Faults of these kinds that are drawn by a seed, for so long."""
    chance, end_s = random.Random(f"faults {seed}"), time.monotonic() + seconds
    while time.monotonic() < end_s:
        yield chance.choice(kinds)


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
