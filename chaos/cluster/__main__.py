"""Kills and freezes processes of a cluster while bots live in it: `python -m chaos.cluster`."""

import argparse
import asyncio
import signal
import sys
import tempfile
from pathlib import Path
from typing import Final

from tests.server.brokers import nats_server
from tests.server.clustering.clusters import cluster
from tests.server.databases import postgresql_server
from tests.server.zones import write_town

from chaos.cluster.trial import Outcome, drawn, run_trial

AWAY_S: Final = 120.0
"""Nobody's seat is given up in a trial."""


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m chaos.cluster",
        description="Kill and freeze processes of a cluster while bots live in it; exit code 1 if "
        "anybody was lost, doubled or a ghost.",
    )
    parser.add_argument("--seed", type=int, default=0, help="draws faults, and what bots do [0]")
    parser.add_argument("--seconds", type=float, default=120.0, help="of faults [120]")
    parser.add_argument("--bots", type=int, default=20, help="bots that live in it [20]")
    options = parser.parse_args()
    # The end of this process is that of all that it has begun.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with (
        tempfile.TemporaryDirectory(prefix="esplanade-chaos-") as folder,
        nats_server() as broker,
        postgresql_server() as database,
        cluster(database.address, broker, resume_s=AWAY_S) as made,
    ):
        made.init(write_town(Path(folder)))
        made.refill()
        kinds = drawn(options.seed, options.seconds)
        trial = run_trial(made, broker, database, options.seed, options.bots, kinds)
        return report(asyncio.run(trial))


def report(outcome: Outcome) -> int:
    """Print what came of a trial; returns the exit code."""
    print(f"\nseed {outcome.seed}")
    print(f"{'fault':<18}{'times':>6}{'median':>9}{'worst':>8}   seconds without a snapshot")
    for kind, gaps_s in sorted(outcome.gaps_s.items()):
        middle = sorted(gaps_s)[len(gaps_s) // 2]
        print(f"{kind:<18}{len(gaps_s):>6}{middle:>9.1f}{max(gaps_s):>8.1f}")
    print(", ".join(f"{number} {what}" for what, number in sorted(outcome.counts.items())))
    for fault in outcome.faults:
        print(f"FAULT: {fault}")
    print("nobody was lost, doubled or a ghost" if not outcome.faults else "")
    return 1 if outcome.faults else 0


if __name__ == "__main__":
    sys.exit(main())
