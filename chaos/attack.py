"""An attack, and what its process is given: the server's port, a clock, a place for notes."""

import random
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from chaos.wire import Wire
from esplanade.protocol.messages import FromClient

TOO_MANY: Final = 0.01
"""Seconds that an attacker waits after it was refused: a refusal is quicker than any program."""


@dataclass(frozen=True)
class Target:
    """The server under attack, as an attacker needs to know it."""

    port: int
    operator_key: str
    seconds: float
    seed: int


@dataclass(frozen=True)
class Outcome:
    """The report that an attacker makes at its end."""

    counts: dict[str, int]
    """Counts of its actions, by names of its own."""
    faults: list[str]
    """Things that it was granted and should not have been."""


@dataclass
class Attacker:
    """One hostile process while it works."""

    target: Target
    begin: Callable[[], None]
    """To be called when everything is prepared and the attack proper begins."""
    counts: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.random = random.Random(self.target.seed)
        self._end_s = time.monotonic() + self.target.seconds

    @property
    def port(self) -> int:
        return self.target.port

    @property
    def left_s(self) -> float:
        """Seconds until the attack must end."""
        return self._end_s - time.monotonic()

    @property
    def goes_on(self) -> bool:
        return self.left_s > 0.0

    def start_clock(self) -> None:
        """Say that the attack proper begins; it has its whole time from now on."""
        self._end_s = time.monotonic() + self.target.seconds
        self.begin()

    def wires(self, number: int, name: str, **fields: object) -> list[Wire]:
        """Let this number of clients come in; fewer if the server wants no more of them."""
        made = []
        for k in range(number):
            try:
                wire = Wire(self.port)
                wire.join(f"{name} {k}", **fields)
            except OSError:
                self.refused()
                continue
            made.append(wire)
        self.counts["joined"] += len(made)
        return made

    def send_at(
        self, rate: float, wires: list[Wire], message: Callable[[int, int], FromClient]
    ) -> None:
        """Send at a rate on every wire until the time is over; those that are closed are left out.

        `message` is called with the number of the round and that of the wire.
        """
        turn, next_s = 0, time.monotonic()
        while self.goes_on:
            turn += 1
            for number, wire in enumerate(list(wires)):
                try:
                    wire.discard()
                    wire.send(message(turn, number))
                    self.counts["sent"] += 1
                except OSError:
                    wires.remove(wire)
                    self.counts["closed"] += 1
            next_s += 1.0 / rate
            time.sleep(max(0.0, next_s - time.monotonic()))

    def refused(self) -> None:
        """Note that the server would not, and wait a moment."""
        self.counts["refused"] += 1
        time.sleep(TOO_MANY if self.left_s > TOO_MANY else 0.0)


@dataclass(frozen=True)
class Attack:
    """A kind of attack. `run` returns when its time is over, or when nothing is left to do."""

    name: str
    about: str
    run: Callable[[Attacker], None]
    breaks_limit: bool = True
    """Whether it goes over a limit, so that log and metrics have to name its address."""
    by_speed: bool = False
    """Whether it goes over its limit only on a machine that is fast enough: it is over it once
    the server has refused it something."""
    least_s: float = 0.0
    """It takes this long at least, because what it breaks is a limit of time."""
    serve: tuple[str, ...] = ()
    """Options for the server, besides those that all attacks share."""
