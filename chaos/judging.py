"""The bars that a trial has to clear."""

from dataclasses import dataclass
from typing import Final

from chaos.attack import Attack
from chaos.canary import Sighting
from chaos.memory import MEMORY_SHARE, Memory
from chaos.trial import Trial

GAP_MS: Final = 150.0
WAY_MS: Final = 300.0


@dataclass(frozen=True)
class Bars:
    """The worst service that the canary may have; times in milliseconds."""

    gap_ms: float
    way_ms: float

    @classmethod
    def beside(cls, alone: Sighting) -> "Bars":
        """Fixed times, or twice what the canary sees alone, whichever is more."""
        return cls(GAP_MS, WAY_MS).raised(alone)

    def raised(self, alone: Sighting) -> "Bars":
        """The same bars for a machine that has become busier since."""
        return Bars(max(self.gap_ms, 2.0 * alone.gap_ms), max(self.way_ms, 2.0 * alone.way_ms))


def missed(trial: Trial, attack: Attack, bars: Bars) -> list[str]:
    """Every bar that a trial has missed, in words.

    The bars are raised to twice what the canary saw in the seconds before this attack.
    """
    return [
        *_canary(trial.sighting, bars.raised(trial.before)),
        *_server(trial),
        *_naming(trial, attack),
        *trial.faults,
    ]


def _canary(seen: Sighting, bars: Bars) -> list[str]:
    found = []
    if seen.lost:
        found.append(f"the canary lost its connection: {seen.lost}")
    if seen.gap_ms > bars.gap_ms:
        found.append(f"{seen.gap_ms:.0f} ms without a snapshot, bar {bars.gap_ms:.0f}")
    if seen.dropped:
        found.append(f"{seen.dropped} snapshots were left out")
    if seen.way_ms > bars.way_ms:
        found.append(f"{seen.way_ms:.0f} ms until walk_to counted, bar {bars.way_ms:.0f}")
    if seen.unheard:
        found.append(f"{seen.unheard} lines of chat were not heard")
    if seen.turned_away:
        found.append(f"{seen.turned_away} newcomers were not let in")
    return found


def _server(trial: Trial) -> list[str]:
    found = []
    growth = Memory(trial.memory_before_mb, trial.memory_most_mb).growth
    if growth > MEMORY_SHARE:
        found.append(f"memory grew by {100 * growth:.0f} %, bar {100 * MEMORY_SHARE:.0f} %")
    if trial.unnamed:
        found.append(f"{len(trial.unnamed)} unforeseen faults in the log: {trial.unnamed[0][:200]}")
    return found


def _naming(trial: Trial, attack: Attack) -> list[str]:
    if not attack.breaks_limit or (attack.by_speed and not trial.counts.get("refused")):
        return []
    found = []
    if not trial.lines:
        found.append("no log line names the attacker")
    if not trial.named:
        found.append("no metric counts the attacker")
    return found
