"""The options of `esplanade run`, without anything that runs."""

from argparse import Namespace
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import SEED_LIMIT, InputFile, Number, OutputFile, Whole
from esplanade.commandline.recording_settings import (
    add_reading,
    add_strict,
    check_reading,
    misplaced,
)
from esplanade.commandline.trajectory_files import check_suffix
from esplanade.server.trajectories.rates import ticks_between

SECONDS: Final = 60.0

EPILOG: Final = """\
examples:
  esplanade run scenes/plaza.json --actors 30 --seconds 120 --seed 7 --out plaza.sqlite
  esplanade run --people zara1.csv --actors 5 --out zara1-with-actors.csv
  esplanade run hall.json --people hall.txt --fps 16 --unit cm --out hall.txt --hz 10
  esplanade run scenes/gallery.json --roster night.json --out gallery.parquet

the suffix of --out says in which form:
  .csv      frame, t [s], id, kind, x, y, z [m], vx, vy [m/s], heading [rad]
  .txt      PeTrack's text, id frame x/m y/m z/m: for PedPy
  .sqlite   JuPedSim's trajectories, with the floor: for PedPy and JuPedSim's viewer
  .parquet  the columns of .csv (with `esplanade[recordings]`)
what it comes from, parameters, and every change of them with its tick stand in the file.

the same scene, people, seed and version give the same file. Ctrl-C ends the world; what was written
until then stays.

exit code: 0 all was written, 1 the file cannot be written any more, 2 wrong usage, or a file that
cannot be read, 130 Ctrl-C
"""


def parser() -> Parser:
    """The options of `esplanade run`."""
    made = Parser(
        "esplanade run",
        run="esplanade.server.offline.cli:run",
        check=check,
        description="Run a world without a server, as fast as the machine can, and write where "
        "everybody\nwas.",
        epilog=EPILOG,
    )
    made.add_argument(
        "scene",
        metavar="SCENE",
        nargs="?",
        type=InputFile(),
        help="scene, a JSON file, or a mesh or plan that one is made of; without one the ground is "
        "fitted to --people",
    )
    made.add_argument(
        "--out", metavar="FILE", type=OutputFile(), required=True, help="file to write"
    )
    world = made.add_argument_group("world")
    world.add_argument(
        "--actors",
        metavar="N",
        type=Whole(0, 1000),
        help="computer-run actors that walk about [default: 10]",
    )
    world.add_argument(
        "--roster",
        metavar="FILE",
        type=InputFile(),
        help="which actors walk about instead, what each does and how, a JSON file",
    )
    world.add_argument(
        "--people",
        metavar="CROWD",
        type=InputFile(),
        help="recorded people who walk among them, each along its own track",
    )
    world.add_argument(
        "--walls",
        metavar="FILE",
        type=InputFile(),
        help="walls around the people where there is no scene [default: NAME.walls.json beside it]",
    )
    world.add_argument(
        "--seconds",
        metavar="S",
        type=Number(0.0, 1e6, above=True),
        help=f"how long [default: {SECONDS:g}; with --people, as long as the recording]",
    )
    world.add_argument(
        "--seed",
        metavar="N",
        type=Whole(0, SEED_LIMIT),
        default=0,
        help="seed of everything random in the world [default: 0]",
    )
    world.add_argument(
        "--tick-rate",
        metavar="N",
        type=Whole(5, 60),
        default=20,
        help="ticks a second [default: 20]",
    )
    world.add_argument(
        "--planning-interval",
        metavar="N",
        type=Whole(1, 4),
        help="ticks from one planning of an actor to its next [default: 1]",
    )
    made.add_argument(
        "--hz",
        metavar="X",
        type=Number(0.01, 60.0),
        help="samples a second, a part of the ticks [default: every tick]",
    )
    reading = made.add_argument_group("how the recording is read")
    add_reading(reading)
    add_strict(made)
    return made


def check(options: Namespace) -> None:
    """Whether these options fit together.

    Raises
    ------
    UsageError
        They do not.
    """
    if options.scene is None and options.people is None:
        raise UsageError("give a SCENE, or --people to whom the ground is fitted")
    if options.people is None and (name := misplaced(vars(options))):
        raise UsageError(f"--{name}: it says how recorded people are read, but none are given")
    if options.walls is not None and (options.people is None or options.scene is not None):
        raise UsageError("--walls: they belong to people without a scene")
    if options.roster is not None and options.actors is not None:
        raise UsageError("--roster and --actors: give one of them, not both")
    try:
        check_suffix(options.out)
    except ValueError as error:
        raise UsageError(f"--out: {error}") from None
    try:
        ticks_between(options.tick_rate, options.hz)
    except ValueError as error:
        raise UsageError(f"--hz: {error}") from None
    try:
        check_reading(vars(options))
    except ValueError as error:
        raise UsageError(str(error)) from None
