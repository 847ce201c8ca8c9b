"""Frames changed at random, against a real server or against the decoder alone.

    python -m chaos.mutated --frames 100000           over real sockets
    python -m chaos.mutated --in-process 10000000     the decoder alone

Every frame must be taken or refused by a name. The seed and the number that are told with a
fault make the same frame again: `Mutations(seed).framed(number)`.
"""

import argparse
import asyncio
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from rich.console import Console
from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed, WebSocketException

from chaos.canary import greet, opened
from chaos.memory import MEMORY_SHARE, Memory
from chaos.mutations import Mutations
from chaos.server import ServerError, resident_mb, serving, unnamed
from chaos.wire import SERVER
from chaos.wire import frame as framed
from esplanade.commandline.progress import progress
from esplanade.protocol import ProtocolError, decode_server, encode, peek_snapshot
from esplanade.protocol.codec import decode_client
from esplanade.protocol.messages import Error, Ping, Pong

LANES: Final = 20
ANSWER_S: Final = 60.0
UNNAMED: Final = "no answer"
WARM_UP_SHARE: Final = 0.1
"""Memory is compared with what it is after this part of the frames."""

_AT_ONCE: Final = 20_000
_OPTIONS: Final = ("--message-rate", "10000")
"""Sockets come from 127.0.0.1, where only the limit of each connection could slow them down."""

Progress = Callable[[int], None]


@dataclass
class Tally:
    """Counts of what became of the frames."""

    seed: int
    frames: int = 0
    outcomes: Counter[str] = field(default_factory=Counter)
    """Times by outcome: `taken`, an error's name, or how a connection was closed without one."""
    faults: list[str] = field(default_factory=list)
    memory: Memory = field(default_factory=Memory)
    """After the warm-up, and at the end."""

    @property
    def passed(self) -> bool:
        return not self.faults and self.memory.growth <= MEMORY_SHARE


def in_process(number: int, seed: int, advance: Progress = lambda _: None) -> Tally:
    """Give so many frames to the decoder; anything but its own error is a fault."""
    tally = Tally(seed)
    mutations = Mutations(seed)
    outcomes = tally.outcomes
    warm = int(WARM_UP_SHARE * number)
    before_mb = 0.0
    for k in range(number):
        if k == warm:
            before_mb = resident_mb("self")
        try:
            decode_client(mutations.payload(k))
        except ProtocolError as error:
            outcomes[error.code.value] += 1
        except Exception as fault:  # noqa: BLE001  # whatever it is, it is what is looked for
            outcomes[UNNAMED] += 1
            tally.faults.append(f"seed {seed} number {k}: {fault!r}")
        else:
            outcomes["taken"] += 1
        if k % _AT_ONCE == 0:
            advance(min(_AT_ONCE, number - k))
    tally.frames = number
    tally.memory = Memory(before_mb, resident_mb("self"))
    return tally


def over_sockets(
    number: int, seed: int, folder: Path, advance: Progress = lambda _: None, actors: int = 0
) -> Tally:
    """Send so many frames to a real server over connections side by side.

    Raises
    ------
    ServerError
        The server does not start.
    """
    tally = Tally(seed)
    with serving(folder, *_OPTIONS, actors=actors, seed=seed) as server:
        warm = max(1, int(WARM_UP_SHARE * number))
        asyncio.run(_send(server.port, tally, range(warm), advance))
        before_mb = server.memory_mb()
        asyncio.run(_send(server.port, tally, range(warm, number), advance))
        tally.memory = Memory(before_mb, server.memory_mb())
        if not server.alive:
            tally.faults.append("the server has ended")
        tally.faults += unnamed(server.lines())
    return tally


async def _send(port: int, tally: Tally, numbers: range, advance: Progress) -> None:
    """Send frames side by side; half of the connections have said hello before."""
    url = f"ws://{SERVER}:{port}/ws"
    waiting = iter(numbers)
    mutations = Mutations(tally.seed)

    async def lane(greets: bool) -> None:
        number = next(waiting, None)
        while number is not None:
            try:
                async with opened(url) as wire:
                    if greets:
                        await greet(wire, "Mutant")
                    goes_on = True
                    while goes_on and number is not None:
                        outcome, goes_on = await _outcome(wire, mutations.framed(number), number)
                        tally.outcomes[outcome] += 1
                        tally.frames += 1
                        advance(1)
                        if outcome == UNNAMED:
                            tally.faults.append(f"seed {tally.seed} number {number}: {UNNAMED}")
                        number = next(waiting, None)
            except (OSError, WebSocketException) as fault:
                tally.faults.append(f"seed {tally.seed} before number {number}: {fault!r}")
                return

    await asyncio.gather(*(lane(k % 2 == 0) for k in range(LANES)))


async def _outcome(wire: ClientConnection, frame: bytes, number: int) -> tuple[str, bool]:
    """Send a frame and a ping; what became of the frame, and whether the connection goes on."""
    told = ""
    nonce = number & 0xFFFF_FFFF
    wire.transport.write(completed(frame))
    wire.transport.write(framed(encode(Ping(nonce=nonce))))
    try:
        async with asyncio.timeout(ANSWER_S):
            while True:
                message = await wire.recv()
                if not isinstance(message, bytes) or peek_snapshot(message) is not None:
                    continue
                answer = decode_server(message)
                if isinstance(answer, Error):
                    told = str(answer.error)
                elif isinstance(answer, Pong) and answer.nonce == nonce:
                    return f"{told}, goes on" if told else "taken", True
    except ConnectionClosed as closed:
        if told:
            return told, False
        code = closed.rcvd.code if closed.rcvd else None
        return (f"closed with {code}" if code else UNNAMED), False
    except TimeoutError:
        return UNNAMED, False


def completed(data: bytes) -> bytes:
    """The same bytes with zeros behind, so that no frame of up to 32 KiB is left half."""
    at = 0
    while at < len(data):
        head = data[at : at + 10].ljust(10, b"\0")
        size, start = head[1] & 0x7F, at + (6 if head[1] & 0x80 else 2)
        if size == 126:
            size, start = int.from_bytes(head[2:4], "big"), start + 2
        elif size == 127:
            size, start = int.from_bytes(head[2:10], "big"), start + 8
        at = start + size
    return data + bytes(min(at - len(data), 1 << 15))


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m chaos.mutated", description="Changed frames, each to be refused by a name."
    )
    parser.add_argument("--frames", type=int, help="so many over real sockets")
    parser.add_argument("--in-process", type=int, help="so many to the decoder alone")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    console = Console()
    passed = True
    try:
        with tempfile.TemporaryDirectory() as folder:
            if options.in_process:
                with _bar("the decoder alone", options.in_process) as advance:
                    tally = in_process(options.in_process, options.seed, advance)
                passed &= _show(console, "the decoder alone", tally)
            if options.frames or not options.in_process:
                number = options.frames or 100_000
                with _bar("over sockets", number) as advance:
                    tally = over_sockets(number, options.seed, Path(folder), advance)
                passed &= _show(console, "over sockets", tally)
    except ServerError as fault:
        console.print(str(fault), markup=False, style="red", soft_wrap=True)
        return 2
    return 0 if passed else 1


@contextmanager
def _bar(what: str, total: int) -> Iterator[Progress]:
    with progress(time_left=True) as bar:
        task = bar.add_task(what, total=total)
        yield lambda count: bar.advance(task, count)


def _show(console: Console, what: str, tally: Tally) -> bool:
    lines = [
        f"{what}: {tally.frames} frames, seed {tally.seed}",
        *(f"  {name:28} {times}" for name, times in tally.outcomes.most_common()),
        f"  {tally.memory}",
        *(f"  FAULT {fault[:2000]}" for fault in tally.faults[:20]),
        f"  {len(tally.faults)} faults",
    ]
    for line in lines:
        console.print(line, highlight=False, markup=False, soft_wrap=True)
    return tally.passed


if __name__ == "__main__":
    sys.exit(main())
