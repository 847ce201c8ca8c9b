"""Movement: routes asked for without end, and clients that freeze while they walk."""

import math
import multiprocessing
import os
import signal
import time
from itertools import pairwise
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import Wire
from esplanade.protocol.messages import Enter, FromClient, Move, Snapshot, WalkTo
from esplanade.protocol.snapshot import positions_m, unpack_block

CLIENTS: Final = 30
RATE: Final = 25.0
"""Requests a second of each client; its rate allows 60."""

CORNERS: Final = ((5.5, 17.25, 3.5), (33.5, 11.25, 3.5), (6.0, 28.0, 3.5), (39.5, -5.5, 0.0))
"""Far places on both floors of the gallery."""

STANDS_WITHIN_S: Final = 4.0
"""Silence is noticed after a second, and ends a movement after two more; a second is for slack."""

FROZEN_S: Final = 8.0
"""A frozen avatar is watched this long."""


def _walk_to(attacker: Attacker) -> None:
    wires = attacker.wires(CLIENTS, "Rover")
    attacker.start_clock()

    def elsewhere(turn: int, number: int) -> FromClient:
        x, y, z = CORNERS[(turn + number) % len(CORNERS)]
        return WalkTo(seq=turn, x=x + attacker.random.random(), y=y, z=z)

    attacker.send_at(RATE, wires, elsewhere)


def _frozen(attacker: Attacker) -> None:
    """Watch an avatar whose client is stopped while it walks: it must stand soon."""
    spawning = multiprocessing.get_context("spawn")
    here, there = spawning.Pipe()
    client = spawning.Process(target=_walk_until_stopped, args=(attacker.port, there), daemon=True)
    client.start()
    try:
        avatar = int(here.recv())
        with Wire(attacker.port) as watcher:
            welcome = watcher.join("Watcher")
            os.kill(client.pid or 0, signal.SIGSTOP)
            attacker.start_clock()
            _judge_standing(attacker, watcher, avatar, welcome.origin)
    finally:
        client.kill()


def _judge_standing(
    attacker: Attacker, watcher: Wire, avatar: int, origin: tuple[float, float]
) -> None:
    places: list[tuple[float, float]] = []
    stopped_s = moved_s = time.monotonic()
    while attacker.goes_on and time.monotonic() - stopped_s < FROZEN_S:
        message = watcher.receive()
        if isinstance(message, Enter):
            places += [(each.x, each.y) for each in message.entities if each.id == avatar]
        elif isinstance(message, Snapshot):
            records = unpack_block(message.block)
            found = positions_m(records, origin)[records["id"] == avatar].tolist()
            if found and found[0] != (places[-1] if places else None):
                places.append((found[0][0], found[0][1]))
                moved_s = time.monotonic()
    walked_s = moved_s - stopped_s
    walked_m = sum(math.dist(a, b) for a, b in pairwise(places))
    attacker.counts["frozen_ms_walked"] = round(1e3 * walked_s)
    attacker.counts["frozen_cm_walked"] = round(1e2 * walked_m)
    if walked_s > STANDS_WITHIN_S:
        attacker.faults.append(
            f"the avatar of a frozen client walked on for {walked_s:.1f} s and {walked_m:.1f} m"
        )


def _walk_until_stopped(port: int, parent: object) -> None:
    """Walk in circles so that no wall ends it: a child of the attacker, which stops it."""
    wire = Wire(port)
    welcome = wire.join("Frozen")
    wire.send(Move(seq=1, direction=0.0, speed=1.0))
    parent.send(welcome.id)  # type: ignore[attr-defined]
    wire.send(WalkTo(seq=2, x=CORNERS[0][0], y=CORNERS[0][1], z=CORNERS[0][2]))
    while True:
        wire.receive()


ATTACKS: Final = (
    Attack(
        "walk-to",
        f"{CLIENTS} clients ask for routes {RATE:g} times a second, within their rate",
        _walk_to,
        breaks_limit=False,
    ),
    Attack(
        "frozen",
        "a client is stopped while it walks",
        _frozen,
        breaks_limit=False,
        least_s=FROZEN_S,
    ),
)
