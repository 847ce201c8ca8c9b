"""The options of `esplanade gait`."""

from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else
from typing import Final

from esplanade.commandline.parser import Parser
from esplanade.commandline.pictures import add_picture
from esplanade.commandline.readers import SEED_LIMIT, Folder, OutputFile, Whole

WALKS: Final = ("flat", "run", "curve", "stairs", "start-stop")
FRAMES_A_SECOND: Final = (10, 20, 25, 50)
"""Rates that GIF can show: it counts in hundredths of a second."""
DEFAULT_FRAMES_A_SECOND: Final = 20

DESCRIPTION: Final = """\
Show how everyone walks: pictures and films of the steps that the server sends, the
cycle of figures that are far away, and the plots of docs/walking.md.
"""
EPILOG: Final = """\
examples:
  esplanade gait render --out pictures
  esplanade gait render --walk stairs --no-film --out pictures
  esplanade gait render --walk curve --seed 7 --out pictures    another body
  esplanade gait cycle --out cycle.json
  esplanade gait plots --out docs/images

of each walk, render writes
  WALK-strip.png   pictures in a row at even times; the camera goes along
  WALK-trail.png   the whole way in one picture, with all footprints
                   (blue: left foot, red: right foot)
  WALK.gif         a film

exit code: 0 all is well, 2 wrong usage, or a file that cannot be written
"""


def parser() -> Parser:
    """The three commands; the help of the whole shows how each is called."""
    made = Parser("esplanade gait", description=DESCRIPTION)
    commands = made.add_subparsers(dest="command", metavar="COMMAND", required=True)
    parts = [_render(commands), _cycle(commands), _plots(commands)]
    usages = "".join(part.format_usage().replace("usage: ", "  ") for part in parts)
    made.epilog = f"usage of each:\n{usages}\n{EPILOG}"
    return made


def _render(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "render",
        run="esplanade.footage.cli:render",
        help="draw walks: strips, trails and films",
        description="Walk and run on level ground, walk round bends, up and down stairs, and with "
        "sudden\nstops and starts; draw each walk as strips and a GIF.",
    )
    _add_folder(made)
    add_picture(made)
    made.add_argument(
        "--walk",
        choices=(*WALKS, "all"),
        default="all",
        help="which one [default: all of them]",
    )
    made.add_argument(
        "--seed",
        metavar="N",
        type=Whole(0, SEED_LIMIT),
        default=0,
        help="whose body walks: its sizes and its cadence [default: 0]",
    )
    made.add_argument(
        "--fps",
        type=Whole(1, max(FRAMES_A_SECOND)),
        choices=FRAMES_A_SECOND,
        default=DEFAULT_FRAMES_A_SECOND,
        help=f"frames a second of films [default: {DEFAULT_FRAMES_A_SECOND}]",
    )
    made.add_argument("--no-film", action="store_true", help="draw strips and trails only")
    return made


def _cycle(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "cycle",
        run="esplanade.footage.cli:cycle",
        help="write the cycle of figures that are far away",
        description="Write the eight key poses that browsers mix for figures too far away to be "
        "told\nsteps of, as JSON.",
    )
    made.add_argument(
        "--out", metavar="FILE", type=OutputFile(), required=True, help="the file to write"
    )
    return made


def _plots(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "plots",
        run="esplanade.footage.cli:plots",
        help="draw the plots of docs/walking.md",
        description="Draw the plots of docs/walking.md anew.",
    )
    _add_folder(made)
    add_picture(made, "svg")
    return made


def _add_folder(made: Parser) -> None:
    made.add_argument(
        "--out",
        metavar="DIR",
        type=Folder(),
        default=".",
        help="where the pictures go [default: here]",
    )
