"""Kills and freezes processes of a cluster while bots live in it: `python -m chaos.cluster`."""

import argparse
import asyncio
import signal
import sys
import tempfile
from pathlib import Path
from typing import Final

from tests.server.brokers import Brokers, nats_servers
from tests.server.clustering.clusters import Cluster, cluster
from tests.server.databases import PostgresqlServer, postgresql_server
from tests.server.zones import write_town

from chaos.cluster.deaths import cases, die
from chaos.cluster.faults import KINDS, OF_SEVERAL_BROKERS
from chaos.cluster.herd import restart_gateways
from chaos.cluster.trial import Outcome, drawn, run_trial

AWAY_S: Final = 120.0
"""Nobody's seat is given up in a trial."""
LEGS: Final = ("hops", "herd", "faults")


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m chaos.cluster",
        description="Kill and freeze processes of a cluster while people are in it; exit code 1 if "
        "anybody was lost, doubled or a ghost. Three legs: each death within a hop, the restart of "
        "all gateways of a herd, and faults that are drawn while bots live in the cluster.",
    )
    parser.add_argument("--seed", type=int, default=0, help="draws faults, and what bots do [0]")
    parser.add_argument("--seconds", type=float, default=120.0, help="of faults [120]")
    parser.add_argument("--bots", type=int, default=20, help="bots that live in it [20]")
    parser.add_argument("--herd", type=int, default=1000, help="people of the herd [1000]")
    parser.add_argument("--brokers", type=int, default=3, help="brokers that are one [3]")
    parser.add_argument("--legs", nargs="+", choices=LEGS, default=LEGS, help="[all of them]")
    options = parser.parse_args()
    # The end of this process is that of all that it has begun.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with (
        tempfile.TemporaryDirectory(prefix="esplanade-chaos-") as folder,
        nats_servers(options.brokers) as broker,
        postgresql_server() as database,
        cluster(database.address, broker, resume_s=AWAY_S) as made,
    ):
        made.init(write_town(Path(folder)))
        made.refill()
        codes = []
        if "hops" in options.legs:
            codes.append(deaths(made))
        if "herd" in options.legs:
            codes.append(herd(made, options.herd))
        if "faults" in options.legs:
            codes.append(faults(made, broker, database, options))
        return max(codes)


def deaths(cluster: Cluster) -> int:
    """Run each death within a hop; returns the exit code."""
    print(f"{'step':<10}{'victim':<13}{'is in':<10}{'s':>6}   until the person walks again")
    found = []
    for step, victim in cases():
        cluster.settle()
        death = asyncio.run(die(cluster, step, victim))
        print(f"{step.value:<10}{victim.value:<13}{death.zone:<10}{death.walks_s:6.1f}", flush=True)
        found += death.faults
    return told(found)


def herd(cluster: Cluster, people: int) -> int:
    """Restart the gateways of a herd; returns the exit code."""
    cluster.settle()
    done = asyncio.run(restart_gateways(cluster, people))
    refusals = ", ".join(f"{name} {number}" for name, number in done.refusals.items()) or "none"
    print(f"\nherd of {people}: all back after {done.seconds:.1f} s; refusals: {refusals}")
    return told(done.faults)


def faults(
    cluster: Cluster, broker: Brokers, database: PostgresqlServer, options: argparse.Namespace
) -> int:
    """Let faults happen while bots live in the cluster; returns the exit code."""
    cluster.settle()
    kinds = [*KINDS, OF_SEVERAL_BROKERS] if options.brokers > 1 else KINDS
    chosen = drawn(options.seed, options.seconds, kinds)
    trial = run_trial(cluster, broker, database, options.seed, options.bots, chosen)
    return report(asyncio.run(trial))


def report(outcome: Outcome) -> int:
    """Print what came of a trial; returns the exit code."""
    print(f"\nseed {outcome.seed}")
    print(f"{'fault':<18}{'times':>6}{'median':>9}{'worst':>8}   seconds without a snapshot")
    for kind, gaps_s in sorted(outcome.gaps_s.items()):
        middle = sorted(gaps_s)[len(gaps_s) // 2]
        print(f"{kind:<18}{len(gaps_s):>6}{middle:>9.1f}{max(gaps_s):>8.1f}")
    print(", ".join(f"{number} {what}" for what, number in sorted(outcome.counts.items())))
    return told(outcome.faults)


def told(found: list[str]) -> int:
    """Print faults; returns the exit code."""
    for fault in found:
        print(f"FAULT: {fault}")
    if not found:
        print("nobody was lost, doubled or a ghost", flush=True)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
