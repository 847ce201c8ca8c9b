"""The part of `esplanade op` about the time of the world."""

from argparse import Namespace

from esplanade.operators.asking import change

STANDS = {"pause": True, "go": False}


def pace(options: Namespace) -> int:
    """Let time stand, run again, go on by ticks, or run slower or faster."""
    wish = options.pace
    if wish in STANDS:
        return change(options, "pace", pause=STANDS[wish])
    if wish == "step":
        return change(options, "pace", step=options.ticks)
    return change(options, "pace", factor=wish)
