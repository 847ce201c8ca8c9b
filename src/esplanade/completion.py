"""`esplanade completion`: what completes commands and options on a shell's command line."""

from argparse import Namespace

from esplanade.cli import COMMANDS, parser_of
from esplanade.commandline import exit_codes
from esplanade.commandline.completion import script
from esplanade.commandline.parser import Parser


def run(options: Namespace) -> int:
    """Print the script for this shell."""
    print(script(whole(), options.shell))
    return exit_codes.OK


def whole() -> Parser:
    """One parser of all commands with all their options."""
    made = Parser("esplanade")
    commands = made.add_subparsers(metavar="COMMAND")
    for name, command in COMMANDS.items():
        part = parser_of(name)
        commands.add_parser(name, help=command.summary, parents=[part], add_help=False)
    return made
