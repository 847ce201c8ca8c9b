"""The options of the part of `esplanade op` about the time of the world, and its recording."""

from argparse import ArgumentTypeError
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Number, Whole
from esplanade.operators.parts import add_note, add_part

_FACTOR = Number(0.1, 4.0)
_WORDS = ("pause", "go", "step")


def add_time_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    pace = add_part(
        commands,
        "time_commands:pace",
        "pace",
        "Let the time of the world stand, go on by ticks, or run slower or faster.",
        "pace 0.25",
        "pace pause",
        "pace step --ticks 10",
    )
    pace.add_argument(
        "pace",
        metavar="pause|go|step|FACTOR",
        type=wish,
        help="a factor is from 0.1 to 4; 1 is usual",
    )
    pace.add_argument(
        "--ticks", metavar="N", type=Whole(1, 100), default=1, help="of a step [default: 1]"
    )
    add_note(pace)
    record = add_part(
        commands,
        "time_commands:record",
        "record",
        "Begin to record the world into the server's folder, end that, or see how it is.",
        "record start",
        "record",
    )
    record.add_argument(
        "record", metavar="start|stop", nargs="?", choices=("start", "stop"), help="without it, see"
    )
    add_note(record)
    return [pace, record]


def wish(text: str) -> str | float:
    """A word for time, or a factor.

    Raises
    ------
    ArgumentTypeError
        It is neither.
    """
    if text in _WORDS:
        return text
    try:
        return _FACTOR(text)
    except ArgumentTypeError as error:
        words = ", ".join(_WORDS)
        raise ArgumentTypeError(f"{text!r} is none of {words}, and no factor: {error}") from None
