"""The part of `esplanade op` about the time of the world, and its recording."""

from argparse import Namespace

from esplanade.commandline import exit_codes
from esplanade.operators.asking import asked, change

STANDS = {"pause": True, "go": False}


def pace(options: Namespace) -> int:
    """Let time stand, run again, go on by ticks, or run slower or faster."""
    wish = options.pace
    if wish in STANDS:
        return change(options, "pace", pause=STANDS[wish])
    if wish == "step":
        return change(options, "pace", step=options.ticks)
    return change(options, "pace", factor=wish)


def record(options: Namespace) -> int:
    """Begin a recording, end it, or tell of it."""
    if options.record is not None:
        return change(options, "record", on=options.record == "start")
    told = asked(options, "/world").get("recording")
    if told is None:
        print("the server has no folder for recordings")
    elif told["state"] == "off":
        print("the world is not recorded")
    else:
        size = f"{told['bytes'] / 1e6:.3g} MB, {told['seconds']} s of the world"
        why = f": {told['fault']}" if told["fault"] else ""
        print(f"{told['state']}: {told['file']}, {size}{why}")
    return exit_codes.OK
