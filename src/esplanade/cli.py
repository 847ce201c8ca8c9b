"""The command `esplanade`: picks the part that is asked for and hands it the rest of the line."""

import sys
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

from esplanade.commandline import exit_codes
from esplanade.commandline.parser import Parser, suggestion
from esplanade.commandline.running import imported, run


class Command(NamedTuple):
    """One subcommand: where its parser is made, imported only when it is called."""

    parser: str
    summary: str


COMMANDS: Final = {
    "serve": Command("esplanade.options:serve", "run a world for people and actors"),
    "run": Command("esplanade.options:run", "run a world without a server, into a file"),
    "replay": Command(
        "esplanade.server.replay.options:parser", "run a recorded world again, bit for bit"
    ),
    "bots": Command(
        "esplanade.bots.options:parser", "send people made of code: load, or a recorded crowd"
    ),
    "op": Command(
        "esplanade.options:op", "see to operators and the audit, tune actors while a world runs"
    ),
    "data": Command(
        "esplanade.server.operating.data_options:parser", "back up, restore, upgrade, forget"
    ),
    "zone": Command(
        "esplanade.server.clustering.options:zone", "run a zone of a world on several machines"
    ),
    "gateway": Command(
        "esplanade.server.clustering.options:gateway", "let people into a world on several machines"
    ),
    "cluster": Command(
        "esplanade.server.clustering.cluster_options:parser", "see to a world on several machines"
    ),
    "evaluate": Command(
        "esplanade.evaluation.options:parser", "measure actors among recorded people"
    ),
    "scene": Command(
        "esplanade.scenery.options:parser", "check a scene, draw it, make one of a mesh"
    ),
    "recording": Command(
        "esplanade.trajectories.options:parser", "say how a recorded crowd is read, and draw it"
    ),
    "gait": Command("esplanade.footage.options:parser", "draw and film how everyone walks"),
    "demo": Command("esplanade.options:demo", "run the demo world with actors and a few visitors"),
    "completion": Command(
        "esplanade.options:completion", "complete commands and options in bash, zsh or fish"
    ),
}

USAGE: Final = "usage: esplanade [-h] [--version] COMMAND ..."


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    name = arguments[0] if arguments else "--help"
    if name in {"-h", "--help", "help"}:
        print(_help())
        return exit_codes.OK
    if name in {"-V", "--version"}:
        from esplanade import __version__  # noqa: PLC0415 (it is looked up only when asked for)

        print(f"esplanade {__version__}")
        return exit_codes.OK
    if name not in COMMANDS:
        print(_refusal(name), file=sys.stderr)
        return exit_codes.USAGE
    return run(parser_of(name), arguments[1:])


def parser_of(name: str) -> Parser:
    """The parser of this command."""
    make: Callable[[], Parser] = imported(COMMANDS[name].parser)
    return make()


def _help() -> str:
    lines = [
        USAGE,
        "",
        "A shared place where people and computer-run actors walk among each other.",
        "",
        "commands:",
        *(f"  {name:<10} {command.summary}" for name, command in COMMANDS.items()),
        "",
        "options:",
        "  -h, --help     show this help",
        "  -V, --version  show the version",
        "",
        "examples:",
        "  esplanade demo                           then open http://localhost:8080",
        "  esplanade serve --scene my.json --actors 10",
        "  esplanade serve --data world             keeps operators and the audit",
        "  esplanade op user add olga --role tuner --data world",
        "  esplanade run my.json --actors 10 --seconds 60 --out my.csv",
        "  esplanade replay kept/Gallery.mcap --verify",
        "  esplanade bots --count 200 --duration 60",
        "  esplanade evaluate zara1.csv --policy esplanade straight",
        "  esplanade scene check my.json",
        "  esplanade recording check zara1.csv --out zara1.png",
        "  esplanade gait render --out pictures",
        "  esplanade completion bash                then see `esplanade completion --help`",
        "",
        "`esplanade COMMAND --help` explains a command and all its options.",
    ]
    return "\n".join(lines)


def _refusal(name: str) -> str:
    kind = "option" if name.startswith("-") else "command"
    told = f"esplanade: there is no {kind} {name}{suggestion(name, COMMANDS)}"
    return f"{told}{'' if told.endswith('?') else ';'} see `esplanade --help`"
