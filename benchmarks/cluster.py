"""A world on several processes of this machine: what a crowded zone takes, and the scale model.

    python -m benchmarks.cluster crowd         one zone: people, viewers and gateways grow
    python -m benchmarks.cluster crowd --people 1000 --gateways 1 2
    python -m benchmarks.cluster check         three zones of 100 people beside the scale model

Database, broker, hosts and gateways are real processes; people stand on an open field of 100 m and
70 % of them walk. Viewers are connections of this process, which decode next to nothing; whoever
only walks is steered over the broker, as by a gateway that takes no frames. All figures of
processors are processor time for each tick that was run, so that a busy machine changes little;
those of pauses are not.
"""

import argparse
import asyncio
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from benchmarks._cluster_people import viewers, walkers
from benchmarks._cluster_world import Seat, World, grown, make_seats, taken, ticked, world
from benchmarks._scale_check import compared, print_check
from chaos.cluster.herd import Herd

TICK_HZ: Final = 20.0
SETTLE_S: Final = 15.0
"""Processes that have just begun make tables for later and take in who is there."""
EACH: Final = 500
"""Viewers of a gateway."""
WANTED: Final = (10_000, 10)
"""The crowd whose costs are worked out from the measured ones: people, and gateways."""


@dataclass(frozen=True)
class Row:
    """The figures of a crowd in one zone."""

    people: int
    viewers: int
    gateways: int
    host_ms: float
    """Processor time of the host for each tick."""
    gateway_ms: float
    """Of each gateway, mean."""
    broker_ms: float
    inside_mb_s: float
    """From the broker to hosts and gateways, at the usual pace."""
    shown_hz: float
    """Snapshots of each viewer a second."""
    late: float
    """Part of the ticks that began late."""


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    if options.what == "check":
        return print_check(compared(options.seconds))
    rows = []
    print(
        f"{'people':>7}{'viewers':>9}{'gateways':>10}{'host':>9}{'gateway':>10}{'broker':>9}"
        f"{'inside':>9}{'shown':>8}{'late':>8}"
    )
    print(f"{'ms a tick of processor time':>54}{'MB/s':>9}{'Hz':>8}")
    for people, gateways in sizes(options.people, options.gateways):
        row = crowd(people, gateways, options.viewers, options.seconds)
        rows.append(row)
        print(
            f"{row.people:7d}{row.viewers:9d}{row.gateways:10d}{row.host_ms:9.2f}"
            f"{row.gateway_ms:10.2f}{row.broker_ms:9.2f}{row.inside_mb_s:9.2f}{row.shown_hz:8.1f}"
            f"{row.late:8.1%}",
            flush=True,
        )
    if len({row.people for row in rows}) > 2:
        print_growth(rows)
    return 0


def parser() -> argparse.ArgumentParser:
    """The options."""
    made = argparse.ArgumentParser(prog="python -m benchmarks.cluster", description=__doc__)
    made.formatter_class = argparse.RawDescriptionHelpFormatter
    made.add_argument("what", choices=("crowd", "check"))
    made.add_argument(
        "--people", type=int, nargs="+", default=[0, 1000, 2000, 4000], help="[0 1000 2000 4000]"
    )
    made.add_argument("--gateways", type=int, nargs="+", default=[1, 2, 4], help="[1 2 4]")
    made.add_argument("--viewers", type=int, default=EACH, help=f"of each gateway [{EACH}]")
    made.add_argument("--seconds", type=float, default=15.0, help="of each row [15]")
    return made


def sizes(people: Sequence[int], gateways: Sequence[int]) -> list[tuple[int, int]]:
    """The crowds of the rows: people grow at the first number of gateways, then gateways."""
    return [(each, gateways[0]) for each in people] + [(people[-1], more) for more in gateways[1:]]


def crowd(people: int, gateways: int, each: int, seconds: float) -> Row:
    """Measure a crowd in one zone."""
    with world(1) as made:
        seats = make_seats(made.cluster, made.zones[0], people)
        looking = min(people, each * gateways)
        made.begin_hosts(1, max(people, 1))
        made.hosts[0].wait_for("open")
        made.begin_gateways(gateways, each + EACH)
        return asyncio.run(_watched(made, seats, looking, seconds))


async def _watched(made: World, seats: Sequence[Seat], looking: int, seconds: float) -> Row:
    """Measure while some people look, the first of them, and the others only walk."""
    number = len(seats)
    async with (
        walkers(made, seats[looking:], seed=number),
        viewers(made, seats[:looking], seed=number) as herd,
    ):
        return await _measured(made, herd, number, seconds)


async def _measured(made: World, herd: Herd, people: int, seconds: float) -> Row:
    await asyncio.sleep(SETTLE_S)
    loop = asyncio.get_running_loop()
    before, shown, since_s = await asyncio.to_thread(made.read), _shown(herd), loop.time()
    await asyncio.sleep(seconds)
    after, shown_after = await asyncio.to_thread(made.read), _shown(herd)
    taken_s = loop.time() - since_s
    ticks = ticked(before, after)
    hosts, gateways, broker = taken(before, after)
    number = len(herd.people)
    inside = after.traffic["out_bytes"] - before.traffic["out_bytes"]
    return Row(
        people=people,
        viewers=number,
        gateways=len(gateways),
        host_ms=1e3 * sum(hosts) / ticks,
        gateway_ms=1e3 * sum(gateways) / len(gateways) / ticks,
        broker_ms=1e3 * broker / ticks,
        inside_mb_s=1e-6 * inside * TICK_HZ / ticks,
        shown_hz=(shown_after - shown) / taken_s / max(number, 1),
        late=grown(before, after, "esplanade_ticks_late_total") / ticks,
    )


def _shown(herd: Herd) -> int:
    return sum(each.connection.snapshots for each in herd.people if each.connection is not None)


def print_growth(rows: Sequence[Row]) -> None:
    """Print how costs grow, and the costs of a larger crowd by that.

    The least squares of the rows: the host's tick grows with people and gateways, a gateway's with
    people and its viewers.
    """
    ones = np.ones(len(rows))
    people = np.array([row.people for row in rows])
    own = np.array([row.viewers / row.gateways for row in rows])
    host = np.array([row.host_ms for row in rows])
    gateway = np.array([row.gateway_ms for row in rows])
    (host_ms, person_ms), *_ = np.linalg.lstsq(np.stack([ones, people], 1), host, rcond=None)
    (base_ms, viewer_ms, read_ms), *_ = np.linalg.lstsq(
        np.stack([ones, own, people], 1), gateway, rcond=None
    )
    print(f"\nhost: {host_ms:.2f} ms + {1e3 * person_ms:.2f} µs a person")
    print(
        f"gateway: {base_ms:.2f} ms + {1e3 * viewer_ms:.2f} µs a viewer"
        f" + {1e3 * read_ms:.2f} µs a person in the zone"
    )
    many, gateways = WANTED
    wanted_ms = host_ms + person_ms * many
    edge_ms = base_ms + viewer_ms * many / gateways + read_ms * many
    print(
        f"{many} people at {gateways} gateways: {wanted_ms:.0f} ms of a tick of {1e3 / TICK_HZ:.0f}"
        f" for the host, {edge_ms:.0f} ms for each gateway of {many // gateways}"
    )


if __name__ == "__main__":
    sys.exit(main())
