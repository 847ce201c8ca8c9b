"""The end of a run: warnings that it deserves, and its exit code."""

from collections.abc import Iterator, Sequence
from typing import Final

from esplanade.bots.tally import Tally
from esplanade.bots.thresholds import DEFAULT_RULE, Verdict
from esplanade.commandline import exit_codes

FEW_RECEIVED: Final = 0.9
"""Less than this share of the snapshots that were due is told loudly."""

BUSY: Final = 0.85
"""Bots that take more than this share of their cores measure themselves."""


def warnings(tally: Tally, verdicts: Sequence[Verdict]) -> Iterator[str]:
    """Lines that the reader of the report must know, worst first."""
    for each in verdicts:
        if each.failed:
            yield f"limit crossed: {each}"
    if tally.expected and not tally.joined:
        yield f"none of {tally.expected} bots came in"
    elif tally.failed:
        yield f"{tally.failed} of {tally.expected} bots did not come in"
    due, received = tally.snapshots_due, tally.snapshots_received
    if due and received < FEW_RECEIVED * due:
        yield (
            f"WARNING: only {100.0 * received / due:.1f} % of the snapshots that were due came in "
            f"({received:,} of {due:,}); the server does not keep up, or its network does not"
        )
    for fault, times in tally.scenario_faults.most_common():
        yield f"error in the scenario, {times} times: {fault}"
    if tally.run_seconds > 1.0 and tally.cpu_seconds > BUSY * tally.run_seconds:
        yield (
            "WARNING: the bots took nearly all of their processor time, so that the times may be "
            "theirs and not the server's; use more --processes or another machine"
        )


def exit_code(tally: Tally, verdicts: Sequence[Verdict], faults: Sequence[str]) -> int:
    """Return the exit code of the run.

    Without a threshold on them, no bot may fail or be lost, and none be complained of. Nobody in
    the world, an error in the scenario or in a worker process are failures in any case.
    """
    if any(each.failed for each in verdicts):
        return exit_codes.THRESHOLD
    if faults or tally.scenario_faults or (tally.expected and not tally.joined):
        return exit_codes.FAILED
    decided = any(each.threshold.measure in DEFAULT_RULE for each in verdicts)
    return exit_codes.OK if decided or tally.well else exit_codes.FAILED
