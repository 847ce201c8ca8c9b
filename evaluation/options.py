"""The options of `esplanade evaluate`."""

import argparse
import math
from pathlib import Path
from typing import Any, Final

from esplanade.evaluation.policies import POLICIES

EXAMPLES: Final = """\
examples:
  esplanade evaluate zara1.csv
  esplanade evaluate eth.csv hotel.csv --policy esplanade discs clairvoyant --json all.json
  esplanade evaluate zara1.csv --episodes 20 --plots failed/
  esplanade evaluate zara1.csv --set risk_weight=12 --set foresight_s=2
  esplanade evaluate eth.csv zara1.csv --prediction --fit
  esplanade evaluate eth.csv zara1.csv --sensitivity --ledger done.jsonl --plots .
  esplanade evaluate eth.csv zara1.csv --tune --vary risk_weight=6,8,12 --ledger done.jsonl

files: CSV with the header t,id,x,y; ETH's obsmat.txt; TrajNet++ .ndjson

exit code: 0 all went well, 1 with --strict: somebody was touched or a goal not reached,
2 wrong usage, or a file that cannot be used
"""


def parser() -> argparse.ArgumentParser:
    """All options, in groups."""
    made = argparse.ArgumentParser(
        prog="esplanade evaluate",
        description="Put an actor among recorded people who do not react, each time in the place "
        "of one of them, and measure how it gets to where that one went; or measure how well "
        "people are predicted.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    made.add_argument("crowds", metavar="CROWD", nargs="+", type=Path, help="recorded crowd")
    files = made.add_argument_group("recordings")
    files.add_argument(
        "--walls", metavar="FILE", type=Path, help="walls [default: NAME.walls.json beside it]"
    )
    files.add_argument(
        "--fps",
        type=_number(1e-3, 1e6),
        help="frames a second, where a file counts frames [default: 15 for obsmat.txt; what the "
        "scenes say for .ndjson]",
    )
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
        choices=list(POLICIES),
        default=["esplanade"],
        help="; ".join(f"{name}: {entry.summary}" for name, entry in POLICIES.items()),
    )
    trips.add_argument(
        "--episodes", metavar="N", type=_whole(1, 100_000), default=100, help="[default: 100]"
    )
    trips.add_argument("--seed", metavar="N", type=_whole(0, 2**32 - 1), default=0, help="[0]")
    trips.add_argument(
        "--a-max",
        metavar="M/S²",
        type=_acceleration,
        default=2.0,
        help="greatest acceleration, or `none` [default: 2.0]",
    )
    trips.add_argument(
        "--set",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        help="change a setting of our actor: a parameter, risk.NAME, prediction.NAME or plan.NAME; "
        "may be given several times",
    )
    trips.add_argument("--processes", metavar="N", type=_whole(1, 64), default=2, help="[2]")
    trips.add_argument("--strict", action="store_true", help="exit with 1 if an episode failed")
    _add_studies(made.add_argument_group("settings of our actor"))
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
    results.add_argument("--json", metavar="FILE", type=Path, help="write every episode there")
    results.add_argument(
        "--ledger",
        metavar="FILE",
        type=Path,
        help="keep scores there as they come; what is there is not walked again",
    )
    results.add_argument("--plots", metavar="FOLDER", type=Path, help="draw episodes there, as PNG")
    results.add_argument(
        "--plot-episodes",
        metavar="failed|N,N,..",
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
        help="compare candidates, choosing without one recording after the other",
    )
    studies.add_argument(
        "--vary",
        metavar="NAME=V1,V2,..",
        action="append",
        default=[],
        help="a setting and its values; may be given several times: --sensitivity takes one at a "
        "time [default: all that make the actor's temper], --tune all combinations",
    )
    studies.add_argument(
        "--candidates",
        metavar="FILE",
        type=Path,
        help='more candidates for --tune, a line each: {"risk_weight": 12, "risk.comfort": 0.1}',
    )


def _number(least: float, most: float) -> Any:
    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text!r} is no number from {least:g} to {most:g}")
        return value

    return read


def _whole(least: int, most: int) -> Any:
    def read(text: str) -> int:
        if not (text.isdecimal() and least <= int(text) <= most):
            raise argparse.ArgumentTypeError(f"{text!r} is no number from {least} to {most}")
        return int(text)

    return read


def _acceleration(text: str) -> float | None:
    limit: float | None = None if text == "none" else _number(0.2, 20.0)(text)
    return limit
