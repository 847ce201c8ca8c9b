"""Settings of every command that reads a recording: what the file does not say, or says wrongly."""

import sys
from collections.abc import Mapping, Sequence
from typing import Any, Final, Protocol

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Choice, Flag, Number, Text
from esplanade.commandline.settings import Setting

UNITS: Final = ("m", "dm", "cm", "mm", "km", "ft", "in", "yd")

FPS: Final = Setting(
    "frame numbers of the recording in a second, where its file counts frames and does not say it",
    Number(1e-3, 1e6),
)
UNIT: Final = Setting(
    "unit of the recording's coordinates, where its file does not say it", Choice(*UNITS)
)
SCALE: Final = Setting(
    "metres in one unit of the recording's coordinates, as in pixels, instead of --unit",
    Number(1e-6, 1e6),
)
STRICT: Final = Setting(
    "refuse a recording with glitches of tracking, instead of passing them over",
    Flag(),
    default=False,
)
COLUMNS: Final = Setting(
    "names of the recording's columns, whatever its header says, as frame,id,,x/cm,y/cm or, for "
    "those that count, t=Zeit/ms,id=Wer,x=Ost,y=Nord",
    Text(),
)
READING: Final = {"fps": FPS, "unit": UNIT, "scale": SCALE, "columns": COLUMNS, "strict": STRICT}


def check_reading(given: Mapping[str, Any]) -> None:
    """Check that these settings fit together.

    Raises
    ------
    ValueError
        They do not; the message says which.
    """
    if given.get("unit") is not None and given.get("scale") is not None:
        raise ValueError("unit and scale: give one of them, not both")


def misplaced(given: Mapping[str, Any]) -> str | None:
    """The first of these settings that is given, for commands where no recording is read."""
    return next((name for name in READING if given.get(name)), None)


def add_reading(parser: Any) -> None:
    """Add `--fps`, `--unit`, `--scale` and `--columns` to a parser or a group of it."""
    for name in ("fps", "unit", "scale", "columns"):
        setting = READING[name]
        parser.add_argument(
            f"--{name}",
            metavar=setting.read.metavar,
            type=setting.read,
            choices=getattr(setting.read, "choices", None),
            help=setting.help,
        )


def add_strict(parser: Parser) -> None:
    """Add `--strict` to a parser."""
    parser.add_argument("--strict", action="store_true", help=STRICT.text)


class Told(Protocol):
    """The remarks on a recording that was read."""

    @property
    def line(self) -> str: ...
    @property
    def remarks(self) -> Sequence[str]: ...
    @property
    def warnings(self) -> Sequence[str]: ...


def tell_recording(command: str, name: str, report: Told | None) -> None:
    """Say on the stream of errors how a recording was understood, and what is odd about it."""
    if report is None:
        return
    lines = [report.line, *report.remarks, *(f"warning: {text}" for text in report.warnings)]
    sys.stderr.writelines(f"{command}: {name}: {line}\n" for line in lines)
