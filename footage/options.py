"""The options of `esplanade gait`."""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Final

WALKS: Final = ("flat", "curve", "stairs", "start-stop")
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


def parser() -> argparse.ArgumentParser:
    """The three commands; the help of the whole shows how each is called."""
    made = argparse.ArgumentParser(
        prog="esplanade gait",
        description=DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    commands = made.add_subparsers(dest="command", metavar="COMMAND", required=True)
    parts = [_render(commands), _cycle(commands), _plots(commands)]
    usages = "".join(part.format_usage().replace("usage: ", "  ") for part in parts)
    made.epilog = f"usage of each:\n{usages}\n{EPILOG}"
    return made


_Commands = argparse._SubParsersAction  # noqa: SLF001 - argparse names the type nowhere else


def _render(commands: "_Commands[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    made = commands.add_parser(
        "render",
        help="draw walks: strips, trails and films",
        description="Walk on level ground, round bends, up and down stairs, and with sudden stops "
        "and starts; draw each walk as PNG strips and a GIF.",
        allow_abbrev=False,
    )
    _add_folder(made)
    made.add_argument(
        "--walk",
        choices=(*WALKS, "all"),
        default="all",
        help="which one [default: all of them]",
    )
    made.add_argument(
        "--seed",
        metavar="N",
        type=_whole(0, 2**32 - 1),
        default=0,
        help="whose body walks: its sizes and its cadence [default: 0]",
    )
    made.add_argument(
        "--fps",
        type=int,
        choices=FRAMES_A_SECOND,
        default=DEFAULT_FRAMES_A_SECOND,
        help=f"frames a second of films [default: {DEFAULT_FRAMES_A_SECOND}]",
    )
    made.add_argument("--no-film", action="store_true", help="draw strips and trails only")
    return made


def _cycle(commands: "_Commands[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    made = commands.add_parser(
        "cycle",
        help="write the cycle of figures that are far away",
        description="Write the eight key poses that browsers mix for figures too far away to be "
        "told steps of, as JSON.",
        allow_abbrev=False,
    )
    made.add_argument("--out", metavar="FILE", type=Path, required=True, help="the file to write")
    return made


def _plots(commands: "_Commands[argparse.ArgumentParser]") -> argparse.ArgumentParser:
    made = commands.add_parser(
        "plots",
        help="draw the plots of docs/walking.md",
        description="Draw the plots of docs/walking.md anew, as SVG.",
        allow_abbrev=False,
    )
    _add_folder(made)
    return made


def _add_folder(made: argparse.ArgumentParser) -> None:
    made.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=Path(),
        help="where the pictures go [default: here]",
    )


def _whole(least: int, most: int) -> Callable[[str], int]:
    def parse(text: str) -> int:
        if not (text.isdecimal() and least <= int(text) <= most):
            raise argparse.ArgumentTypeError(
                f"{text!r} is not a whole number from {least} to {most}"
            )
        return int(text)

    return parse
