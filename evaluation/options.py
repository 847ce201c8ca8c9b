"""The options of `esplanade evaluate`, without anything that evaluates."""

from argparse import ArgumentTypeError, Namespace
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlsplit

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser, suggestion
from esplanade.commandline.pictures import PICTURES
from esplanade.commandline.readers import (
    SEED_LIMIT,
    Folder,
    InputFile,
    Number,
    OutputFile,
    Whole,
)
from esplanade.commandline.recording_settings import add_reading, check_reading
from esplanade.commandline.trajectory_files import check_suffix
from esplanade.evaluation.guideline_names import GUIDELINES
from esplanade.evaluation.policy_options import WITH_OPTIONS, has_options
from esplanade.evaluation.setting_names import NAMES
from esplanade.policies.names import address_of, is_outside, label_of, option_value

POLICIES: Final = {
    "esplanade": "the project's own actor",
    "straight": "straight on, ignoring people",
    "discs": "constant velocities, hard discs, space-time A*",
    "oracle": "the same search, given the true future",
    "human": "the recorded pedestrian's own trajectory",
    "orca": "ORCA, reciprocal collision avoidance",
    "jupedsim-speed": "JuPedSim, collision-free speed",
    "jupedsim-anticipation": "JuPedSim, anticipation velocity",
    "jupedsim-forces": "JuPedSim, social forces",
}
"""Names and summaries of `esplanade.evaluation.policies`, which imports numpy."""

REPORTS: Final = (".html", ".tex", ".csv")

EXAMPLES: Final = """\
examples:
  esplanade evaluate zara1.csv
  esplanade evaluate eth.csv hotel.csv --policy esplanade discs oracle --json all.json
  esplanade evaluate zara1.csv --episodes 20 --plots failed/
  esplanade evaluate zara1.csv --people reacting --policy esplanade straight discs
  esplanade evaluate zara1.csv --policy my_policy.py:MyPolicy esplanade --policy-option gain=2
  esplanade evaluate zara1.csv --set risk_weight=12 --set foresight_s=2
  esplanade evaluate eth.csv zara1.csv --prediction --fit
  esplanade evaluate eth.csv zara1.csv --sensitivity --score-cache done.jsonl --plots .
  esplanade evaluate eth.csv zara1.csv --tune --vary risk_weight=6,8,12 --score-cache done.jsonl

files: CSV, PeTrack, obsmat, TrajNet, JuPedSim and others; see `esplanade recording check --help`

exit code: 0 all went well, 1 with --strict: somebody was touched or a goal not reached,
2 wrong usage, or a file that cannot be used
"""


def parser() -> Parser:
    """All options, in groups."""
    made = Parser(
        "esplanade evaluate",
        run="esplanade.evaluation.cli:run",
        check=check,
        description="Put an actor among recorded people, who may react to it, each time in the "
        "place of one\nof them, and measure how it gets to where that one went; or measure how "
        "well people\nare predicted.",
        epilog=EXAMPLES,
    )
    made.add_argument(
        "crowds", metavar="CROWD", nargs="+", type=InputFile(folders=True), help="recorded crowd"
    )
    files = made.add_argument_group("recordings")
    files.add_argument(
        "--walls",
        metavar="FILE",
        type=InputFile(),
        help="walls [default: NAME.walls.json beside it]",
    )
    add_reading(files)
    files.add_argument(
        "--interp",
        choices=("linear", "cubic"),
        default="linear",
        help="how people go from sample to sample [default: linear]",
    )
    trips = made.add_argument_group("episodes")
    trips.add_argument(
        "--policy",
        metavar="NAME",
        nargs="+",
        type=_policy,
        default=["esplanade"],
        help="; ".join(f"{name}: {summary}" for name, summary in POLICIES.items())
        + "; FILE.py:CLASS or MODULE:CLASS: one of your own, or NAME of an entry point in the "
        "group esplanade.policies; tcp://HOST:PORT/NAME: one that listens there",
    )
    trips.add_argument(
        "--policy-option",
        metavar="NAME=VALUE",
        type=_policy_option,
        action="append",
        default=[],
        help="a keyword for policies of your own, and for orca; of one of several as "
        "CLASS.NAME=VALUE; VALUE is JSON or else text; may be given several times",
    )
    trips.add_argument(
        "--episodes",
        metavar="N",
        type=Whole(1, 100_000),
        default=100,
        help="most episodes of each recording [default: 100]",
    )
    trips.add_argument(
        "--seed",
        metavar="N",
        type=Whole(0, SEED_LIMIT),
        default=0,
        help="seed of everything drawn by chance [default: 0]",
    )
    trips.add_argument(
        "--a-max",
        metavar="M/S²",
        type=_acceleration,
        default=2.0,
        help="greatest acceleration, or `none` [default: 2.0]",
    )
    trips.add_argument(
        "--people",
        choices=("recorded", "reacting"),
        default="recorded",
        help="recorded: people walk as they did; reacting: they evade the robot and each other by "
        "a social force model [default: recorded]",
    )
    trips.add_argument(
        "--reaction",
        metavar="SCALE",
        type=Number(0.0, 10.0),
        help="how strongly reacting people react, as a factor [default: 1.0]",
    )
    trips.add_argument(
        "--set",
        metavar="NAME=VALUE",
        type=_change,
        action="append",
        default=[],
        help="change a setting of our actor: a parameter, risk.NAME, prediction.NAME, plan.NAME or "
        "rules.NAME; may be given several times",
    )
    trips.add_argument(
        "--processes",
        metavar="N",
        type=Whole(1, 64),
        default=2,
        help="processes that share the episodes [default: 2]",
    )
    trips.add_argument(
        "--on",
        metavar="dask://HOST:PORT",
        type=_scheduler,
        help="let the workers of a Dask cluster walk the episodes, by the address of its scheduler",
    )
    trips.add_argument(
        "--strict",
        action="store_true",
        help="exit with 1 if an episode failed; refuse recordings with glitches of tracking",
    )
    _add_studies(made.add_argument_group("studies of our actor, or of a policy of your own"))
    forecasts = made.add_argument_group("prediction")
    forecasts.add_argument(
        "--prediction", action="store_true", help="measure predictions instead of episodes"
    )
    forecasts.add_argument(
        "--fit", action="store_true", help="also fit the deviation; implies --prediction"
    )
    forecasts.add_argument(
        "--sample-s",
        type=float,
        choices=(0.1, 0.2, 0.4),
        default=0.4,
        help="time between the places that are seen [default: 0.4]",
    )
    results = made.add_argument_group("results")
    results.add_argument(
        "--json", metavar="FILE", type=OutputFile(), help="write every episode there"
    )
    results.add_argument(
        "--report",
        metavar="FILE",
        type=_report,
        help="write the tables there: .html, one page with plots; .tex, for papers; .csv, a row "
        "for each figure",
    )
    results.add_argument(
        "--measures",
        metavar="NAME,NAME,..|all",
        type=_measures,
        default=(),
        help="more rows, measures of the guidelines for social navigation: "
        + "; ".join(f"{name}: {title}" for name, title in GUIDELINES.items())
        + " (docs/evaluation.md has their definitions)",
    )
    results.add_argument(
        "--score-cache",
        metavar="FILE",
        type=OutputFile(),
        help="cache scores there; episodes whose score is there are not run again",
    )
    results.add_argument(
        "--trajectories",
        metavar="FILE",
        type=OutputFile(),
        help="write where the robot and everybody was, .csv, .txt (for PedPy), .sqlite (JuPedSim) "
        "or .parquet: a file for each episode, with recording, policy and number in its name",
    )
    results.add_argument("--plots", metavar="FOLDER", type=Folder(), help="draw episodes there")
    results.add_argument(
        "--picture",
        choices=PICTURES,
        help="form of the pictures [default: png, and svg of --sensitivity]",
    )
    results.add_argument(
        "--plot-episodes",
        metavar="failed|N,N,..",
        type=_episode_numbers,
        default="failed",
        help="which ones [default: failed]",
    )
    return made


def _add_studies(studies: Any) -> None:
    kinds = studies.add_mutually_exclusive_group()
    kinds.add_argument(
        "--sensitivity",
        action="store_true",
        help="vary one setting after the other, instead of walking once; --plots draws a picture",
    )
    kinds.add_argument(
        "--tune",
        action="store_true",
        help="compare candidates, choosing without one place after the other",
    )
    studies.add_argument(
        "--place",
        metavar="PLACE=NAME,NAME",
        type=_place,
        action="append",
        default=[],
        help="recordings that were made at one place and count as one in a study; may be given "
        "several times [default: each at its own]",
    )
    studies.add_argument(
        "--vary",
        metavar="NAME=V1,V2,..",
        action="append",
        default=[],
        help="a setting and its values, or a --policy-option of your own policy; may be given "
        "several times: --sensitivity takes one at a time [default: all that make the actor's "
        "temper], --tune all combinations",
    )
    studies.add_argument(
        "--candidates",
        metavar="FILE",
        type=InputFile(),
        help='more candidates for --tune, a line each: {"risk_weight": 12, "risk.comfort": 0.1}',
    )


def check(options: Namespace) -> None:
    """Whether these options fit together; nothing is asked for that would be left aside.

    Raises
    ------
    UsageError
        They do not.
    """
    _check_policies(options)
    _check_studies(options)
    if options.trajectories is not None:
        if options.sensitivity or options.tune or options.prediction or options.fit:
            raise UsageError("--trajectories is for episodes that are walked once")
        if options.on is not None:
            raise UsageError("--trajectories is for episodes that this machine walks, without --on")
        try:
            check_suffix(options.trajectories)
        except ValueError as error:
            raise UsageError(f"--trajectories: {error}") from None
    if options.reaction is not None and options.people != "reacting":
        raise UsageError("--reaction is for --people reacting")
    if options.walls is not None and len(options.crowds) > 1:
        raise UsageError("--walls belongs to one recording; name them NAME.walls.json beside each")
    try:
        check_reading(vars(options))
    except ValueError as error:
        raise UsageError(str(error)) from None


def _check_studies(options: Namespace) -> None:
    """Whether a study has what it needs, and nothing is given for one that is not asked for."""
    studies = options.sensitivity or options.tune
    if options.report is not None and (studies or options.prediction or options.fit):
        raise UsageError("--report is for episodes that are walked once")
    if options.vary and not studies:
        raise UsageError("--vary is for --sensitivity and --tune")
    if options.place and not studies:
        raise UsageError("--place is for --sensitivity and --tune")
    if options.candidates is not None and not options.tune:
        raise UsageError("--candidates is for --tune")
    if studies:
        _check_subject(options)
    if studies and options.score_cache is None:
        raise UsageError("a study takes long: keep its scores with --score-cache FILE")
    if options.tune and not (options.vary or options.candidates):
        raise UsageError("--tune needs candidates: --vary NAME=V1,V2,.. or --candidates FILE")
    if options.tune and not all("=" in text for text in options.vary):
        raise UsageError("--vary: --tune needs values, as NAME=V1,V2,..")


def _check_subject(options: Namespace) -> None:
    """Whether a study is of one policy that has the settings."""
    name, *others = dict.fromkeys(options.policy)
    if others:
        raise UsageError("--policy: a study is of one policy")
    if has_options(name):
        if options.set:
            raise UsageError("--set is for our own actor; others have --policy-option NAME=VALUE")
        if options.sensitivity and not options.vary:
            raise UsageError(f"--sensitivity of {label_of(name)} needs --vary NAME=V1,V2,..")
        return
    if name != "esplanade":
        raise UsageError(f"--policy: {name} has no settings that a study could vary")
    for text in options.vary:
        try:
            _of_setting(text)
        except ArgumentTypeError as error:
            raise UsageError(f"--vary: {error}") from None


def _check_policies(options: Namespace) -> None:
    """Whether policies have different names in tables and files, and take the options."""
    takers = [name for name in options.policy if has_options(name)]
    if options.policy_option and not takers:
        raise UsageError(
            "--policy-option is for policies of your own, --policy FILE.py:CLASS, and for "
            f"{', '.join(WITH_OPTIONS)}"
        )
    for option, _ in options.policy_option:
        owner = option.rpartition(".")[0]
        if owner and owner not in map(label_of, takers):
            raise UsageError(f"--policy-option: there is no policy {owner} among those of --policy")
    labels = [label_of(name) for name in dict.fromkeys(options.policy)]
    for label in labels:
        if labels.count(label) > 1:
            raise UsageError(f"--policy: two of them are called {label}; give one another name")


def _measures(text: str) -> tuple[str, ...]:
    if text == "all":
        return tuple(GUIDELINES)
    names = tuple(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in GUIDELINES:
            raise ArgumentTypeError(
                f"{name!r} is no measure{suggestion(name, GUIDELINES)}; there are "
                f"{', '.join(GUIDELINES)}, and all"
            )
    return names


def _scheduler(text: str) -> str:
    """The address of a scheduler as Dask has it, from `dask://HOST:PORT`."""
    parts = urlsplit(text)
    try:
        whole = parts.scheme == "dask" and parts.hostname and parts.port and not parts.path
    except ValueError:
        whole = False
    if not whole:
        raise ArgumentTypeError(f"{text!r} is not like dask://127.0.0.1:8786")
    return f"tcp://{parts.netloc}"


def _policy(text: str) -> str:
    if text not in POLICIES and not is_outside(text):
        raise ArgumentTypeError(
            f"{text!r} is no policy{suggestion(text, POLICIES)}; there are {', '.join(POLICIES)}, "
            "and your own as FILE.py:CLASS"
        )
    try:
        if address_of(text) is not None:
            return text
    except ValueError as error:
        raise ArgumentTypeError(str(error)) from None
    place, _, name = text.rpartition(":")
    if ":" in text and not (place and name.isidentifier()):
        raise ArgumentTypeError(f"{text}: a policy of your own is FILE.py:CLASS or MODULE:CLASS")
    return text


def _policy_option(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not equals or not all(part.isidentifier() for part in name.split(".")):
        raise ArgumentTypeError(f"{text!r} is not NAME=VALUE or CLASS.NAME=VALUE")
    try:
        return name, option_value(value)
    except ValueError as error:
        raise ArgumentTypeError(str(error)) from None


def _change(text: str) -> str:
    if "=" not in text:
        raise ArgumentTypeError(f"{text!r} is not NAME=VALUE")
    return _of_setting(text)


def _of_setting(text: str) -> str:
    name = text.partition("=")[0]
    if name not in NAMES:
        raise ArgumentTypeError(f"{name}: there is no such setting{suggestion(name, NAMES)}")
    return text


def _report(text: str) -> Path:
    path = OutputFile()(text)
    if path.suffix not in REPORTS:
        raise ArgumentTypeError(f"{path.name} is none of {', '.join(REPORTS)}")
    return path


def _place(text: str) -> tuple[str, tuple[str, ...]]:
    place, equals, names = text.partition("=")
    recordings = tuple(filter(None, names.split(",")))
    if not (place and equals and recordings):
        raise ArgumentTypeError(f"{text!r} is not PLACE=NAME,NAME, as zara=zara1,zara2")
    return place, recordings


def _acceleration(text: str) -> float | None:
    limit: float | None = None if text == "none" else Number(0.2, 20.0)(text)
    return limit


def _episode_numbers(text: str) -> frozenset[int] | None:
    """Numbers of episodes; None for those that failed."""
    if text == "failed":
        return None
    try:
        return frozenset(int(part) for part in text.split(","))
    except ValueError:
        raise ArgumentTypeError(f"{text!r} is neither `failed` nor numbers") from None
