"""The printed tables of the figures of a served world."""

import statistics
from collections.abc import Callable, Iterator
from typing import Final

from benchmarks._live_seen import Seen
from benchmarks._live_ticks import Ticks
from rich import box
from rich.console import Console
from rich.table import Table

BARE: Final = "bare"
LIBRARY: Final = "websockets"
"""Ratios are to these two servers."""


def show(console: Console, seen: Seen) -> None:
    """Print the stages of one scenario, and below them what its clients had and cost."""
    console.print(f"\n{seen.name}: {seen.people} people, {seen.actors} actors", style="bold")
    if seen.ticks is not None:
        console.print(_stages(seen.ticks))
    for line in (*_of_ticks(seen), *_of_clients(seen), *_of_bots(seen)):
        console.print(f"  {line}", highlight=False)
    console.print(f"  load average {seen.load[0]:.2f} to {seen.load[1]:.2f}", highlight=False)


def show_sides(console: Console, rounds: dict[str, list[Seen]]) -> None:
    """Print the servers beside each other: medians of the rounds, and ratios within a round."""
    people = rounds[BARE][0].people
    console.print(f"\nside by side: {people} people, no actors, {_rounds(rounds)}", style="bold")
    table = Table(box=box.SIMPLE, padding=(0, 0, 0, 2))
    table.add_column("", no_wrap=True)
    for name in rounds:
        table.add_column(name, justify="right", no_wrap=True)

    def row(title: str, told: Callable[[str], str]) -> None:
        table.add_row(title, *map(told, rounds))

    row(
        "µs of processor a client-tick", lambda name: f"{_median(rounds[name], 'processor_us'):.1f}"
    )
    row("  of the main thread", lambda name: f"{_median(rounds[name], 'main_thread_us'):.1f}")
    for base in (BARE, LIBRARY):
        row(f"  ratio to {base}", lambda name, base=base: _ratios(rounds[name], rounds[base]))
    row("bytes a client-tick", lambda name: f"{_median(rounds[name], 'bytes_a_client_tick'):.0f}")
    row("snapshots a client and second", lambda name: f"{_middle(rounds[name]):.2f}")
    row("  the fewest", lambda name: f"{_fewest(rounds[name]):.2f}")
    row("memory, kB a client", lambda name: f"{_median(rounds[name], 'memory_kb'):.0f}")
    row("from TCP to welcome p99, ms", lambda name: f"{_welcome_ms(rounds[name]):.1f}")
    row("load average", lambda name: _loads(rounds[name]))
    console.print(table)


def ratios(ours: list[Seen], theirs: list[Seen]) -> list[float]:
    """Processor time of a client-tick to that of another server in the same round, each."""
    return [a.processor_us / b.processor_us for a, b in zip(ours, theirs, strict=True)]


def _ratios(ours: list[Seen], theirs: list[Seen]) -> str:
    found = ratios(ours, theirs)
    middle = statistics.median(found)
    if len(found) == 1 or ours is theirs:
        return f"{middle:.2f}"
    return f"{middle:.2f} ({min(found):.2f}-{max(found):.2f})"


def _median(rounds: list[Seen], figure: str) -> float:
    return float(statistics.median(getattr(seen, figure) for seen in rounds))


def _middle(rounds: list[Seen]) -> float:
    return statistics.median(seen.snapshots_per_s[1] for seen in rounds)


def _fewest(rounds: list[Seen]) -> float:
    return min(seen.snapshots_per_s[0] for seen in rounds)


def _welcome_ms(rounds: list[Seen]) -> float:
    return statistics.median(seen.join_ms[1] for seen in rounds)


def _loads(rounds: list[Seen]) -> str:
    loads = [load for seen in rounds for load in seen.load]
    return f"{min(loads):.1f} to {max(loads):.1f}"


def _rounds(rounds: dict[str, list[Seen]]) -> str:
    count = len(rounds[BARE])
    return "one round" if count == 1 else f"medians of {count} rounds"


def _stages(ticks: Ticks) -> Table:
    table = Table(box=box.SIMPLE, padding=(0, 0, 0, 1))
    table.add_column("")
    columns = {**ticks.stages_ms, "between": ticks.tick_ms - sum(ticks.stages_ms.values())}
    columns |= {"whole": ticks.tick_ms, "p50": ticks.p50_ms, "p99": ticks.p99_ms}
    for name in columns:
        table.add_column(name, justify="right")
    table.add_row("ms a tick", *(f"{ms:.2f}" for ms in columns.values()))
    return table


def _of_ticks(seen: Seen) -> Iterator[str]:
    ticks = seen.ticks
    if ticks is None:
        return
    yield (
        f"{ticks.count / ticks.seconds:.1f} ticks/s, {ticks.late} of {ticks.count} began late, "
        f"{ticks.skipped} snapshots left out"
    )
    if seen.actors:
        stages = ticks.stages_ms
        ratio = (stages["steps"] + stages["contacts"]) / max(stages["actors"], 1e-9)
        avatars = seen.people + seen.actors
        yield (
            f"steps and contacts / planning {ratio:.3f}; an avatar and tick takes "
            f"{1e3 * stages['steps'] / avatars:.1f} µs of steps, "
            f"{1e3 * stages['contacts'] / avatars:.1f} µs of contacts"
        )
        yield f"each actor is planned once in {ticks.interval_ticks} ticks at the end"


def _of_clients(seen: Seen) -> Iterator[str]:
    if seen.client_ticks and seen.ticks is not None:
        told = sum(seen.ticks.stages_ms[name] for name in ("interest", "encode", "write"))
        a_tick = seen.client_ticks / seen.ticks.count
        moved = seen.ticks.tick_ms - told - seen.ticks.stages_ms["actors"]
        yield (
            f"processor time of the server {seen.processor_us:.1f} µs a client-tick, of the event "
            f"loop's thread {seen.main_thread_us:.1f}"
        )
        yield (
            f"by the clock interest, encode and write {1e3 * told / a_tick:.1f} µs, all else but "
            f"planning {1e3 * moved / a_tick:.1f}"
        )
    steps = seen.ticks.step_bytes_out / max(seen.ticks.bytes_out, 1) if seen.ticks else 0.0
    yield f"{seen.bytes_per_s / 1e3:.1f} kB/s a viewer, {100.0 * steps:.0f} % of it steps"
    if seen.snapshots_per_s:
        fewest, middle = seen.snapshots_per_s
        yield (
            f"{middle:.2f} snapshots a client and second, the fewest {fewest:.2f}; "
            f"{seen.sent_per_s:.1f} messages from each; {seen.lost} connections lost"
        )
    if seen.memory_kb is not None:
        first = "of the second half" if seen.name == "idle" else "with what the first brings"
        yield f"memory {seen.memory_kb:.1f} kB a client, {first}"
    if seen.join_ms:
        half, most = seen.join_ms
        yield f"from TCP to welcome p50 {half:.1f} ms, p99 {most:.1f} ms"


def _of_bots(seen: Seen) -> Iterator[str]:
    if seen.bots is None:
        return
    snapshots, age = seen.bots["snapshots"], seen.bots["snapshot_age_ms"]
    yield (
        f"{seen.bots['clients']['joined']} bots: {snapshots['received']} of {snapshots['due']} "
        f"snapshots, {snapshots['late']} late, age p50 {age['p50']} ms, p99 {age['p99']} ms"
    )
