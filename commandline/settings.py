"""Settings of a command that has many: one table, of which its options and variables are made.

The table holds plain values only, so that `--help` and every fault of usage come without pydantic:
its import alone takes ten times as long as a bare interpreter. The frozen object of the settings
takes its defaults, limits and descriptions from the same table (`esplanade.commandline.fields`).
"""

import os
from argparse import SUPPRESS, Action, ArgumentError, Namespace
from collections.abc import Callable, Collection, Mapping
from typing import Any, NamedTuple

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser


class Setting(NamedTuple):
    """One setting: `read` is its reader, `option` its name on the command line if that differs.

    A reader with `several` returns a tuple; its option may be given again, and the tuples add up.
    A reader with `alone` says what its option means when no word follows it.
    """

    text: str
    read: Any
    default: Any = None
    unit: str = ""
    option: str = ""

    @property
    def help(self) -> str:
        """The description with unit, range and default."""
        is_told = self.default not in (None, "", ()) and self.default is not False
        default = f"default {self.default}" if is_told else ""
        facts = (self.unit, getattr(self.read, "range", ""), default)
        told = ", ".join(fact for fact in facts if fact)
        return (f"{self.text} [{told}]" if told else self.text).replace("%", "%%")


class Settings(NamedTuple):
    """All settings of a command, in groups, and the prefix of their variables.

    `check` is given the values that differ from the defaults by name, and raises `ValueError`
    where they do not fit together.
    """

    prefix: str
    groups: Mapping[str, Mapping[str, Setting]]
    check: Callable[[Mapping[str, Any]], None]

    def setting(self, name: str) -> Setting:
        return next(group[name] for group in self.groups.values() if name in group)

    def group_of(self, name: str) -> str:
        return next(title for title, group in self.groups.items() if name in group)

    def variable(self, name: str) -> str:
        """The variable of the environment that has the same meaning."""
        return self.prefix + name.upper()


def settings_parser(
    prog: str,
    settings: Settings,
    *,
    run: str,
    explained: Collection[str] | None = None,
    **more: Any,
) -> Parser:
    """One option for every setting, in their groups.

    Settings that are not given are not in the result. With `explained`, the help is silent about
    all others.
    """
    options: dict[str, Action] = {}

    def check(found: Namespace) -> None:
        _add_environment(parser, settings, options, found)
        given = {name: value for name, value in vars(found).items() if name in options}
        try:
            settings.check(given)
        except ValueError as error:
            raise UsageError(str(error)) from None

    parser = Parser(
        prog,
        run=run,
        check=check,
        usage=f"{prog} [options]",
        argument_default=SUPPRESS,
        **more,
    )
    for title, group in settings.groups.items():
        shown = parser.add_argument_group(title)
        for name, setting in group.items():
            alone = getattr(setting.read, "alone", None)
            options[name] = shown.add_argument(
                "--" + (setting.option or name.replace("_", "-")),
                dest=name,
                metavar=setting.read.metavar,
                type=setting.read,
                **({} if alone is None else {"nargs": "?", "const": alone}),
                action="extend" if getattr(setting.read, "several", False) else "store",
                choices=getattr(setting.read, "choices", None),
                help=setting.help if explained is None or name in explained else SUPPRESS,
            )
    return parser


def given_settings(options: Namespace, settings: Settings) -> dict[str, Any]:
    """The settings among the options, by name."""
    names = {name for group in settings.groups.values() for name in group}
    return {name: value for name, value in vars(options).items() if name in names}


def _add_environment(
    parser: Parser, settings: Settings, options: Mapping[str, Action], found: Namespace
) -> None:
    """Values of variables, where the option is not given; case does not matter in their names."""
    present = {name.upper(): text for name, text in os.environ.items()}
    for name, action in options.items():
        variable = settings.variable(name)
        if variable in present and not hasattr(found, name):
            try:
                setattr(found, name, parser.read(action, present[variable]))
            except ArgumentError as error:
                raise UsageError(f"{variable}: {error.message}") from None
