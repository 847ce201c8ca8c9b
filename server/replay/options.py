"""The options of `esplanade replay`, without anything that runs."""

from argparse import Namespace
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, Moment, Number, OutputFile
from esplanade.commandline.trajectory_files import check_suffix

EPILOG: Final = """\
examples:
  esplanade serve --record kept              writes kept/gallery.mcap as the world runs
  esplanade replay kept/gallery.mcap --verify
  esplanade replay kept/gallery.mcap --trajectories walks.csv --hz 10
  esplanade replay kept/gallery.mcap --from 00:12:30 --to 00:13:00 --trajectories walks.csv
  esplanade replay kept/gallery.mcap --info

a recording has all inputs of a zone, so that it runs again bit for bit: with the same program, and
on the same kind of processor. --verify compares it with digests that stand in it, each second. A
recording of another program is refused; --other-program runs it all the same, and --verify then
says where it goes another way. A server that was killed leaves a file that is read up to the last
whole second.

exit code: 0 done, and with --verify all is equal, 1 something differs, or the file is damaged, 2
wrong usage, or a recording of another program, 130 Ctrl-C
"""


def parser() -> Parser:
    """The options of `esplanade replay`."""
    made = Parser(
        "esplanade replay",
        run="esplanade.server.replay.cli:run",
        check=check,
        description="Run a recording of a zone again without a server, as fast as the machine can.",
        epilog=EPILOG,
    )
    made.add_argument("file", metavar="FILE", type=InputFile(), help="recording, an .mcap file")
    made.add_argument(
        "--from",
        dest="from_s",
        metavar="TIME",
        type=Moment(),
        help="begin here, after the beginning of the recording, such as 00:12:30 or 750: what lies "
        "before the state that is nearest is not run",
    )
    made.add_argument(
        "--to", dest="to_s", metavar="TIME", type=Moment(), help="end here [default: at its end]"
    )
    made.add_argument(
        "--verify",
        action="store_true",
        help="compare each second with the recording; name the first tick and field that differ",
    )
    made.add_argument(
        "--trajectories",
        metavar="FILE",
        type=OutputFile(),
        help="write where everybody was: .csv, .txt (PedPy), .sqlite (JuPedSim) or .parquet",
    )
    made.add_argument(
        "--hz",
        metavar="X",
        type=Number(0.01, 60.0),
        help="samples a second of --trajectories, a part of the ticks [default: every tick]",
    )
    made.add_argument(
        "--info", action="store_true", help="say what is in the recording, and run nothing"
    )
    made.add_argument(
        "--other-program",
        action="store_true",
        help="run a recording that another program has made: it may go another way",
    )
    return made


def check(options: Namespace) -> None:
    """Whether these options fit together.

    Raises
    ------
    UsageError
        They do not.
    """
    if options.hz is not None and options.trajectories is None:
        raise UsageError("--hz: it belongs to --trajectories, but none is given")
    if options.to_s is not None and options.to_s <= (options.from_s or 0.0):
        raise UsageError("--to: it must be after --from, or after the beginning")
    if options.info and (options.from_s is not None or options.to_s is not None):
        raise UsageError("--info: it tells of the whole recording; leave out --from and --to")
    if options.info and (options.verify or options.trajectories):
        raise UsageError("--info: it runs nothing, so that nothing can be verified or written")
    if options.trajectories is not None:
        try:
            check_suffix(options.trajectories)
        except ValueError as error:
            raise UsageError(f"--trajectories: {error}") from None
