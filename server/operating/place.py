"""The options that say which store a command means: `--data` and `--store`."""

import os
from argparse import ArgumentError, Namespace
from collections.abc import Callable
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Folder, Text

_VARIABLES: Final = {"data": "ESPLANADE_DATA", "store": "ESPLANADE_STORE"}


def add_place(parser: Parser, check_more: Callable[[Namespace], None] | None = None) -> None:
    """Add the options that name a store; `ESPLANADE_DATA` and `ESPLANADE_STORE` name it too.

    `check_more` is called last, as the parser's `check` is.
    """
    group = parser.add_argument_group("where the data are")
    options = {
        "data": group.add_argument(
            "--data",
            metavar="DIR",
            type=Folder(),
            help="the server's folder of data [or ESPLANADE_DATA]",
        ),
        "store": group.add_argument(
            "--store",
            metavar="URL",
            type=Text(),
            help="its PostgreSQL database, postgresql://… [or ESPLANADE_STORE]",
        ),
    }

    def check(found: Namespace) -> None:
        for name, variable in _VARIABLES.items():
            text = os.environ.get(variable)
            if getattr(found, name) is None and text:
                try:
                    setattr(found, name, parser.read(options[name], text))
                except ArgumentError as error:
                    raise UsageError(f"{variable}: {error.message}") from None
        if found.data is None and not found.store:
            raise UsageError("say where the data are: --data DIR or --store URL")
        if check_more is not None:
            check_more(found)

    parser.check = check
