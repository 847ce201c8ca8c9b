"""Completion scripts for shells, made of a parser by shtab."""

from argparse import Action, ArgumentParser
from collections.abc import Iterator

import shtab

from esplanade.commandline.readers import Folder, InputFile, OutputFile


def script(parser: ArgumentParser, shell: str) -> str:
    """The script by which a shell completes a parser's commands, options, choices and files."""
    for action in _actions(parser):
        if isinstance(action.type, InputFile | OutputFile):
            action.complete = shtab.FILE  # type: ignore[attr-defined]
        elif isinstance(action.type, Folder):
            action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
    return shtab.complete(parser, shell=shell)


def _actions(parser: ArgumentParser) -> Iterator[Action]:
    """Every option and argument of a parser and its commands."""
    for action in parser._actions:  # noqa: SLF001 (argparse has no other way, and shtab does so)
        yield action
        if isinstance(action.choices, dict):
            for command in action.choices.values():
                yield from _actions(command)
