"""One trial: a fresh server, a canary, one attack, and what each of them showed."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from chaos.attack import Attack, Target
from chaos.canary import Sighting
from chaos.processes import attacker_process, canary_process
from chaos.server import OPERATOR_KEY, Samples, Server, grown, serving, unnamed
from chaos.wire import ATTACKER

SETTLE_S: Final = 2.0
"""The world runs at least this long with the canary before memory is read."""

MOST_SETTLE_S: Final = 30.0
"""It runs no longer than this before the attack, whatever its memory does."""

STEADY: Final = 0.005
"""Memory is steady if it grows by no more than this part of it in `SETTLE_S`. A server that has
just opened goes on making tables ahead for some seconds, which no attacker is to blame for."""

AFTER_S: Final = 1.0
"""The server has freed the memory of an attack by then."""

NAMING: Final = (
    "esplanade_floods_total",
    "esplanade_sockets_refused_total",
    "esplanade_answers_refused_total",
    "esplanade_closes_total",
    "esplanade_errors_total",
    "esplanade_clients_dropped_slow_total",
)
"""Totals of what the server has refused or ended, each with the reason as its label."""

Progress = Callable[[float], None]


@dataclass(frozen=True)
class Trial:
    """Everything that was seen of one attack; `attack` is empty for the canary alone."""

    attack: str
    before: Sighting
    """The canary's service on this server until the attack began."""
    sighting: Sighting
    memory_before_mb: float
    memory_most_mb: float
    memory_after_mb: float
    ticks_per_s: float
    processor: float
    """The server's use of one core, 1 being all of it."""
    named: Samples
    """The server's counts of the attacker, by metric."""
    lines: list[str]
    """Events of the server's log that name the attacker's address."""
    unnamed: list[str]
    """Log lines of faults that nobody foresaw."""
    counts: dict[str, int] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)
    missed: list[str] = field(default_factory=list)
    """The bars that were missed; see `judging.py`."""


def run(
    attack: Attack | None,
    folder: Path,
    seconds: float,
    seed: int,
    *,
    actors: int = 10,
    progress: Progress = lambda _: None,
) -> Trial:
    """Make one attack, or none, and return what was seen.

    Raises
    ------
    ServerError
        The server does not start, or does not answer.
    ProcessError
        Canary or attacker have failed.
    """
    options = attack.serve if attack else ()
    if attack is not None:
        seconds = max(seconds, attack.least_s)
    with (
        serving(folder, *options, actors=actors, seed=seed) as server,
        canary_process(server.port, seed) as canary,
    ):
        canary.begin()
        _settle(server, progress)
        alone = canary.tell()
        before = server.read()
        counts: dict[str, int] = {}
        faults: list[str] = []
        if attack is None:
            canary.begin()
            most_mb = _pass(seconds, server, progress)
        else:
            target = Target(server.port, OPERATOR_KEY, seconds, seed)
            with attacker_process(attack.name, target) as attacker:
                attacker.wait_until_it_begins()
                canary.begin()
                most_mb = _pass(seconds, server, progress)
                outcome = attacker.outcome()
            if outcome is None:
                faults.append("the attacker had to be killed, or failed")
            else:
                counts, faults = outcome.counts, outcome.faults
        sighting = canary.tell()
        _pass(AFTER_S, server, progress)
        after = server.read()
        lines = server.lines()
    passed_s = after.at_s - before.at_s
    return Trial(
        attack=attack.name if attack else "",
        before=alone,
        sighting=sighting,
        memory_before_mb=before.memory_mb,
        memory_most_mb=max(most_mb, after.memory_mb),
        memory_after_mb=after.memory_mb,
        ticks_per_s=_rate("esplanade_ticks_total", before.metrics, after.metrics, passed_s),
        processor=(after.processor_s - before.processor_s) / passed_s,
        named=grown(before.metrics, after.metrics, NAMING),
        lines=naming(lines),
        unnamed=unnamed(lines),
        counts=counts,
        faults=faults,
    )


def naming(lines: list[dict[str, Any]]) -> list[str]:
    """Lines of the log about the attacker's address: event and reason, each once."""
    said = [line for line in lines if line.get("address") == ATTACKER]
    texts = [" ".join(filter(None, (line.get("event"), line.get("why")))) for line in said]
    return list(dict.fromkeys(texts))


def _settle(server: Server, progress: Progress) -> None:
    """Let time pass until the server's memory is steady."""
    end_s = time.monotonic() + MOST_SETTLE_S
    before_mb = server.memory_mb()
    _pass(SETTLE_S, server, progress)
    while (now_mb := server.memory_mb()) > (1.0 + STEADY) * before_mb:
        if time.monotonic() >= end_s:
            return
        before_mb = now_mb
        _pass(SETTLE_S, server, lambda _: None)


def _pass(seconds: float, server: Server, progress: Progress) -> float:
    """Let time pass, and return the most memory that the server had meanwhile, MB."""
    most_mb = 0.0
    end_s = time.monotonic() + seconds
    while (left_s := end_s - time.monotonic()) > 0.0:
        step_s = min(0.25, left_s)
        time.sleep(step_s)
        progress(step_s)
        most_mb = max(most_mb, server.memory_mb())
    return most_mb


def _rate(name: str, before: Samples, after: Samples, seconds: float) -> float:
    return (after[name] - before[name]) / seconds
