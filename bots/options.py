"""The settings of `esplanade bots`: what they are called, mean and may be, without pydantic."""

from argparse import ArgumentTypeError
from collections.abc import Mapping
from typing import Any, Final

from esplanade.bots.address import websocket_url
from esplanade.bots.stages import read_stages
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import SEED_LIMIT, InputFile, Number, OutputFile, Text, Whole
from esplanade.commandline.recording_settings import READING, check_reading
from esplanade.commandline.settings import Setting, Settings, settings_parser

MEASURES: Final = """\
measures of --fail-if, as in "snapshot_age.p99>200ms" (also >=, < and <=):
  join, round_trip, snapshot_age, snapshot_interval
                           with .p50, .p99.9 or any other percentile, .mean or .max [us, ms, s]
  deviation                the same, of a replay [mm, cm, m]
  clients.joined, clients.failed, clients.lost
  snapshots.received, snapshots.missing, snapshots.late
  pings.unanswered         numbers; with % shares, as in "snapshots.missing>5%"
  errors, errors.NAME      numbers; NAME is that of the table of errors
  bytes.in, bytes.out      of a client [B/s, kB/s, MB/s]
"""

EXAMPLES: Final = f"""\
examples:
  esplanade bots                                   20 visitors walk about for a minute
  esplanade bots --count 200 --duration 60 --json load.json
  esplanade bots --url wss://plaza.example --count 5 --duration 0
  esplanade bots --stages 30s:100,1m:100,30s:0 --fail-if "snapshot_age.p99>200ms" --html load.html
  esplanade bots --scenario tour.py:Tour --count 50
  esplanade bots --replay zara1.csv                148 recorded people, in real time; the server
                                                   runs with `esplanade serve --crowd zara1.csv`
  esplanade bots --replay zara1.csv --speedup 4 --limit 20

{MEASURES}
exit code: 0 all went well, 1 some bots failed or were complained of, 2 wrong usage, 3 a limit of
--fail-if was crossed
Ctrl-C sends everyone home and reports what was measured until then.

A bot that falls behind stops reading, so that the server sees it as slow. By wss:// it has read
some 100 kB more by then, which wait within TLS: the server sees it that much later.

Every option can also be given as an environment variable: --join-rate is
ESPLANADE_BOTS_JOIN_RATE. The command line wins.
"""


class Address:
    """The address of a server, as people type it."""

    metavar = "URL"

    def __call__(self, text: str) -> str:
        try:
            websocket_url(text)
        except ValueError as error:
            raise ArgumentTypeError(str(error)) from None
        return text


class Thresholds:
    """Thresholds with commas between them, as texts; the option may be given again and again."""

    metavar = "LIMIT"
    several = True

    def __call__(self, text: str) -> tuple[str, ...]:
        from esplanade.bots.thresholds import read_thresholds  # noqa: PLC0415 (help needs it not)

        try:
            return tuple(each.text for each in read_thresholds(text))
        except ValueError as error:
            raise ArgumentTypeError(str(error)) from None


class Stages:
    """Stages of a load test, like 30s:100,1m:500,30s:0."""

    metavar = "TIME:BOTS,..."

    def __call__(self, text: str) -> str:
        try:
            read_stages(text)
        except ValueError as error:
            raise ArgumentTypeError(str(error)) from None
        return text


class ScenarioPlace:
    """A class in a Python file, FILE:CLASS; the file is there."""

    metavar = "FILE:CLASS"

    def __call__(self, text: str) -> str:
        file, _, name = text.rpartition(":")
        if not file or not name.isidentifier():
            raise ArgumentTypeError(f"{text!r} is no scenario, expected FILE:CLASS like my.py:Tour")
        InputFile()(file)
        return text


_LOAD: Final = {
    "count": Setting("visitors that join and walk about", Whole(1, 10_000), 20),
    "duration": Setting(
        "how long they stay once all are there; 0 means until Ctrl-C", Number(0.0, 1e6), 60.0, "s"
    ),
    "seed": Setting("the same seed walks the same ways", Whole(0, SEED_LIMIT), 0),
    "join_rate": Setting("visitors that join", Number(0.1, 10_000.0), 50.0, "per second"),
    "stages": Setting(
        "ramp to that many visitors over that time, and so on, instead of --count, --duration and "
        "--join-rate; like 30s:100,1m:500,30s:0",
        Stages(),
    ),
    "scenario": Setting(
        "visitors do what this class of a Python file says instead of walking about",
        ScenarioPlace(),
    ),
    "processes": Setting(
        "processes that share the visitors; without it, as many as they need", Whole(1, 64)
    ),
}
_REPLAY: Final = {
    "replay": Setting(
        "send in the people of this recording instead of visitors; docs/files.md lists the formats",
        InputFile(folders=True),
    ),
    "speedup": Setting(
        "how many times faster than they were recorded", Number(0.1, 20.0), 1.0, "times"
    ),
    "limit": Setting("only so many of them, in the order in which they come", Whole(1)),
    "linger": Setting(
        "how long each stands at the end of the way before leaving", Number(0.0, 3600.0), 0.0, "s"
    ),
    **READING,
}


def check(given: Mapping[str, Any]) -> None:
    """Check that these settings fit together.

    Raises
    ------
    ValueError
        They do not; the message says which.
    """
    given = {name: value for name, value in given.items() if value is not False}
    replays = given.get("replay") is not None
    misplaced = sorted(given.keys() & (_LOAD if replays else _REPLAY).keys() - {"replay"})
    if misplaced and replays:
        raise ValueError(f"{misplaced[0]}: belongs to a load test, not to a replay")
    if misplaced:
        raise ValueError(f"{misplaced[0]}: belongs to a replay, but none is given")
    check_reading(given)
    staged = sorted(given.keys() & {"count", "duration", "join_rate"})
    if staged and given.get("stages") is not None:
        raise ValueError(f"{staged[0]}: stages say that already, only one of the two can be given")
    if not replays and any(text.startswith("deviation") for text in given.get("fail_if") or ()):
        raise ValueError("fail_if: deviation is measured of a replay, but none is given")


SETTINGS: Final = Settings(
    "ESPLANADE_BOTS_",
    {
        "server": {
            "url": Setting(
                "where the server is; the path /ws is added when absent",
                Address(),
                "ws://localhost:8080",
            ),
            "trust": Setting(
                "trust exactly this certificate of a wss:// server, PEM, whatever name is in it; "
                "without it, those that the machine trusts",
                InputFile(),
            ),
            "token": Setting(
                "token of a bot, for a closed world or a rate of its own; better set in the "
                "environment than here",
                Text(),
                "",
            ),
        },
        "load test (without --replay)": _LOAD,
        "replay of a recorded crowd": _REPLAY,
        "result": {
            "fail_if": Setting(
                "fail with exit code 3 if this holds at the end; may be given several times",
                Thresholds(),
                (),
            ),
            "json_file": Setting(
                "also write all figures here, as JSON", OutputFile(), option="json"
            ),
            "csv_file": Setting(
                "also write the course of the run here, a line a second", OutputFile(), option="csv"
            ),
            "html_file": Setting(
                "also write a page with tables and plots here", OutputFile(), option="html"
            ),
        },
    },
    check,
)


def parser() -> Parser:
    """The options of `esplanade bots`."""
    return settings_parser(
        "esplanade bots",
        SETTINGS,
        run="esplanade.bots.cli:run",
        description="Send people made of code into a world: visitors that walk about and measure "
        "how the\nserver bears them, or everyone of a recorded crowd, each a client of its own.",
        epilog=EXAMPLES,
    )
