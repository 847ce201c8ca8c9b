"""The command `esplanade`: picks the part that is asked for and hands it the rest of the line."""

import difflib
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Final, NamedTuple, cast

from esplanade import __version__


class Command(NamedTuple):
    """One subcommand: the module whose `run(argv)` does it, imported only when it is called."""

    module: str
    summary: str


COMMANDS: Final = {
    "serve": Command("esplanade.server.cli", "run a world for people and actors"),
    "bots": Command("esplanade.bots.cli", "send people made of code: load, or a recorded crowd"),
    "evaluate": Command("esplanade.evaluation.cli", "measure actors among recorded people"),
    "scene": Command("esplanade.scenery.cli", "check a scene, draw it, make one of a mesh"),
    "gait": Command("esplanade.footage.cli", "draw and film how everyone walks"),
    "demo": Command("esplanade.demo", "run the demo world with actors and a few visitors"),
}

USAGE: Final = "usage: esplanade [-h] [--version] COMMAND ..."
EXIT_USAGE: Final = 2
EXIT_INTERRUPTED: Final = 130


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    name = arguments[0] if arguments else "--help"
    if name in {"-h", "--help", "help"}:
        print(_help())
        return 0
    if name in {"-V", "--version"}:
        print(f"esplanade {__version__}")
        return 0
    if name not in COMMANDS:
        print(_refusal(name), file=sys.stderr)
        return EXIT_USAGE
    run = cast(Callable[[Sequence[str]], int], import_module(COMMANDS[name].module).run)
    try:
        return run(arguments[1:])
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED


def _help() -> str:
    lines = [
        USAGE,
        "",
        "A shared place where people and computer-run actors walk among each other.",
        "",
        "commands:",
        *(f"  {name:<8} {command.summary}" for name, command in COMMANDS.items()),
        "",
        "options:",
        "  -h, --help     show this help",
        "  -V, --version  show the version",
        "",
        "examples:",
        "  esplanade demo                           then open http://localhost:8080",
        "  esplanade serve --scene my.json --actors 10",
        "  esplanade bots --count 200 --duration 60",
        "  esplanade evaluate zara1.csv --policy esplanade straight",
        "  esplanade scene check my.json",
        "  esplanade gait render --out pictures",
        "",
        "`esplanade COMMAND --help` explains a command and all its options.",
    ]
    return "\n".join(lines)


def _refusal(name: str) -> str:
    near = difflib.get_close_matches(name, COMMANDS, n=1)
    kind = "option" if name.startswith("-") else "command"
    suggestion = f" Did you mean `{near[0]}`?" if near else ""
    return f"{USAGE}\nesplanade: unknown {kind} {name!r}.{suggestion} See `esplanade --help`."
