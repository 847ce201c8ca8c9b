"""The options of `esplanade recording`."""

from argparse import Namespace
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, OutputFile
from esplanade.commandline.recording_settings import add_reading, check_reading

EPILOG: Final = """\
examples:
  esplanade recording check zara1.csv
  esplanade recording check corridor.txt --fps 16 --unit cm --out corridor.png
  esplanade recording check annotations.txt --scale 0.0384 --out little.svg
  esplanade recording check trajectory.sqlite --json

what is read, whatever its name ends in, and packed by gzip or not:
  tables      comma, semicolon, tab or space; columns by name (t or frame, id, x, y, also vx, vy)
  PeTrack     Jülich's archive and JPSreport: `# framerate: 25 fps`, `# id frame x/cm y/cm z/cm`
  bare        four columns of TrajNet and Social-GAN, five of Jülich, ETH's obsmat of eight
  others      TrajNet++ ndjson, UCY .vsp, Stanford Drone (pixels), Grand Central and Edinburgh
              (pixels), CITR, Vadere .traj, Viswalk .pp, Pathfinder, crowd:it, JuPedSim SQLite,
              Parquet and HDF5 (with `esplanade[recordings]`)

the rate comes from the file's header, else from its velocities, else it is what sets of this form
have (the line says so); --fps says otherwise. A frame's number counts, whether or not it is in the
file: with every tenth frame of a film of 25 a second, --fps is 25.
the unit comes from the header, else it is taken for the metre; --unit or --scale say otherwise.

exit code: 0 all is as in recordings of people, 1 something is to be looked at, 2 wrong usage, or a
file that cannot be read
"""


def parser() -> Parser:
    """The options of `esplanade recording` and of its command."""
    made = Parser(
        "esplanade recording",
        description="Say how a recorded crowd is read, and draw it.",
        epilog=EPILOG,
    )
    commands = made.add_subparsers(title="commands", metavar="COMMAND", required=True)
    one = commands.add_parser(
        "check",
        run="esplanade.trajectories.cli:check",
        check=check,
        help="say how a file is read: people, seconds, speeds, glitches; draw it",
        description="Say how a recorded crowd is read: how many people and seconds, at which rate "
        "and in\nwhich unit, how fast people are, what was passed over; and what of it is odd.",
        epilog=EPILOG,
    )
    one.add_argument("recording", metavar="FILE", type=InputFile(), help="recorded crowd")
    add_reading(one)
    one.add_argument(
        "--strict", action="store_true", help="refuse glitches of tracking, naming the first one"
    )
    one.add_argument(
        "--out", metavar="PICTURE", type=OutputFile(), help="draw it there: .png, .svg or .pdf"
    )
    one.add_argument("--json", action="store_true", help="print the figures as JSON")
    return made


def check(options: Namespace) -> None:
    """Whether these options fit together.

    Raises
    ------
    UsageError
        They do not.
    """
    try:
        check_reading(vars(options))
    except ValueError as error:
        raise UsageError(str(error)) from None
    if options.out is not None and options.out.suffix.lower() not in {".png", ".svg", ".pdf"}:
        raise UsageError(f"--out: {options.out.name} is no .png, .svg or .pdf file")
