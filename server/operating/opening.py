"""Opens the store that a command means, and puts its faults into words."""

import asyncio
import sys
from argparse import Namespace
from collections.abc import Awaitable, Callable
from typing import Final, TypeVar

from esplanade.commandline.errors import CommandError, UsageError
from esplanade.server.accounts.identity import AccountError
from esplanade.server.store.files import remove_file
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from esplanade.server.store.store import StoreError

Result = TypeVar("Result")

WRITER: Final = "command line"
"""The writer of the audit's rows that are written by commands."""


def in_store(
    options: Namespace,
    work: Callable[[SqlStore], Awaitable[Result]],
    *,
    making: bool = False,
    upgrading: bool = False,
) -> Result:
    """Return the result of work on the store that the options name.

    With `making`, a folder that has no store yet gets one. With `upgrading`, tables of an older
    program are brought to those of this one; without it, they are refused.

    Raises
    ------
    UsageError
        There is no store.
    CommandError
        It cannot be used, or the work says that something cannot be done.
    """
    location = located(options)
    is_new = location.file is not None and not location.file.exists()
    if is_new and not making:
        raise UsageError(f"there is no store in {options.data}: {location} is missing")

    async def run() -> Result:
        async with open_store(location, upgrading=is_new or upgrading) as store:
            result = await work(store)
        if is_new:
            sys.stderr.write(f"{location} is new\n")
        return result

    try:
        return asyncio.run(run())
    except (AccountError, StoreError) as error:
        if is_new and location.file is not None:  # it came to nothing: nothing is left of it
            remove_file(location.file)
        raise CommandError(str(error)) from None


def located(options: Namespace) -> Location:
    """Return the place of the store.

    Raises
    ------
    UsageError
        The address of the database cannot be one.
    """
    try:
        return Location.of(options.data, options.store or "")
    except StoreError as error:
        raise UsageError(str(error)) from None
