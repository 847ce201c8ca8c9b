"""The options of `esplanade recording`."""

from argparse import Namespace
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, Number, OutputFile
from esplanade.commandline.recording_settings import add_reading, add_strict, check_reading

EPILOG: Final = """\
examples:
  esplanade recording check zara1.csv
  esplanade recording check corridor.txt --fps 16 --unit cm --out corridor.png
  esplanade recording check annotations.txt --scale 0.0384 --out little.svg
  esplanade recording check trajectory.sqlite --json
  esplanade recording convert zara1.csv --hz 25 --out zara1.sqlite

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

CONVERT_EPILOG: Final = """\
examples:
  esplanade recording convert annotations.txt --scale 0.0384 --out little.csv
  esplanade recording convert zara1.csv --hz 25 --out zara1.sqlite
  esplanade recording convert zara1.csv --hz 25 --out zara1.txt

exit code: 0 written, 2 wrong usage, or a file that cannot be read or written
"""


def parser() -> Parser:
    """The options of `esplanade recording` and of its command."""
    made = Parser(
        "esplanade recording",
        description="Say how a recorded crowd is read, draw it, write it in another format.",
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
    one.add_argument(
        "recording", metavar="FILE", type=InputFile(folders=True), help="recorded crowd"
    )
    add_reading(one)
    add_strict(one)
    one.add_argument(
        "--out", metavar="PICTURE", type=OutputFile(), help="draw it there: .png, .svg or .pdf"
    )
    one.add_argument("--json", action="store_true", help="print the figures as JSON")
    other = commands.add_parser(
        "convert",
        run="esplanade.trajectories.cli:convert",
        check=check_reading_options,
        help="write a recording as CSV, Jülich text, JuPedSim's SQLite or Parquet",
        description="Write a recording in another format, in seconds, metres, without glitches.\n"
        "What it comes from is written into the file.",
        epilog=CONVERT_EPILOG,
    )
    other.add_argument(
        "recording", metavar="FILE", type=InputFile(folders=True), help="recorded crowd"
    )
    other.add_argument(
        "--out",
        metavar="FILE",
        type=OutputFile(),
        required=True,
        help="file to write; .csv, .txt (PeTrack, for PedPy), .sqlite (JuPedSim) or .parquet",
    )
    other.add_argument(
        "--hz",
        metavar="X",
        type=Number(0.01, 1000.0),
        help="samples a second of everyone [default: those of the recording]",
    )
    add_reading(other)
    add_strict(other)
    return made


def check_reading_options(options: Namespace) -> None:
    """Whether the options on how a recording is read fit together.

    Raises
    ------
    UsageError
        They do not.
    """
    try:
        check_reading(vars(options))
    except ValueError as error:
        raise UsageError(str(error)) from None


def check(options: Namespace) -> None:
    """Whether these options fit together.

    Raises
    ------
    UsageError
        They do not.
    """
    check_reading_options(options)
    if options.out is not None and options.out.suffix.lower() not in {".png", ".svg", ".pdf"}:
        raise UsageError(f"--out: {options.out.name} is no .png, .svg or .pdf file")
