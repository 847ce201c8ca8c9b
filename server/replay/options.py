"""The options of `esplanade replay`, without anything that runs."""

from argparse import Namespace
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, Moment, Number, OutputFile, Whole
from esplanade.commandline.trajectory_files import check_suffix

EPILOG: Final = """\
examples:
  esplanade serve --record kept              writes kept/Gallery.mcap as the world runs
  esplanade replay kept/Gallery.mcap --verify
  esplanade replay kept/Gallery.mcap --trajectories walks.csv --hz 10
  esplanade replay kept/Gallery.mcap --from 00:12:30 --to 00:13:00 --trajectories walks.csv
  esplanade replay kept/Gallery.mcap --info
  esplanade replay kept/Gallery.mcap --set risk_weight=20 --seeds 20 --report out.html
  esplanade replay kept/Gallery.mcap --from 120 --to 240 --door 'Archive door=closed'

a recording has all inputs of a zone, so that it runs again bit for bit: with the same program, and
on the same kind of processor. --verify compares it with digests that stand in it, each second. A
recording of another program is refused; --other-program runs it all the same, and --verify then
says where it goes another way. A server that was killed leaves a file that is read up to the last
whole second.

with --set, --roster, --door or --scene the stretch is run again as another world and beside it as
recorded, and what became of people and actors is compared. With --seeds, actors' behaviours draw
anew in each run, so that there are intervals.

exit code: 0 done, and with --verify all is equal, 1 something differs, or the file is damaged, 2
wrong usage, a moment or value that cannot be, or a recording of another program, 130 Ctrl-C
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
    _add_what_if(made)
    return made


def _add_what_if(made: Parser) -> None:
    group = made.add_argument_group("something changed")
    group.add_argument(
        "--set",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        help="a parameter of all actors, such as risk_weight=20; may be given several times",
    )
    group.add_argument(
        "--roster",
        metavar="FILE",
        type=InputFile(),
        help="the actors of this roster walk instead of those recorded",
    )
    group.add_argument(
        "--door",
        metavar="NAME=open|closed",
        action="append",
        default=[],
        help="a door that stays so from the beginning; may be given several times",
    )
    group.add_argument(
        "--scene",
        metavar="FILE",
        type=InputFile(),
        help="another scene; actors begin anew in it where they were, and beside it in the own one",
    )
    group.add_argument(
        "--people",
        choices=("recorded", "reacting"),
        help="recorded: people are where they were, whatever actors do; reacting: they evade "
        "actors by a social force model [default: recorded]",
    )
    group.add_argument(
        "--seeds",
        metavar="N",
        type=Whole(1, 1000),
        help="run it N times with and N times without the change [default: once, with what chance "
        "had drawn]",
    )
    group.add_argument(
        "--processes",
        metavar="N",
        type=Whole(1, 256),
        help="processes that share the runs of --seeds [default: one for each core]",
    )
    group.add_argument(
        "--report",
        metavar="FILE",
        type=OutputFile(".html"),
        help="write one page with table, strip of differences and plots there",
    )
    group.add_argument("--json", metavar="FILE", type=OutputFile(), help="write the figures there")


def asks_what_if(options: Namespace) -> bool:
    """Whether something is to be changed."""
    return bool(
        options.set or options.door or options.roster is not None or options.scene is not None
    )


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
    _check_what_if(options)
    if options.trajectories is not None:
        try:
            check_suffix(options.trajectories)
        except ValueError as error:
            raise UsageError(f"--trajectories: {error}") from None


def _check_what_if(options: Namespace) -> None:
    if not asks_what_if(options):
        for name in ("people", "seeds", "processes", "report", "json"):
            if getattr(options, name) is not None:
                raise UsageError(
                    f"--{name}: nothing is changed; give --set, --roster, --door or --scene"
                )
        options.people = "recorded"
        return
    options.people = options.people or "recorded"
    if options.verify or options.info:
        name = "verify" if options.verify else "info"
        raise UsageError(f"--{name}: it is of the recording as it is; leave out what is changed")
    if options.seeds is None and options.processes is not None:
        raise UsageError("--processes: it belongs to --seeds, but none are given")
    if options.seeds is not None and options.trajectories is not None:
        raise UsageError("--trajectories: they are of one run; leave out --seeds")
