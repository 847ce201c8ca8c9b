"""`esplanade data`: backs up, restores, upgrades, forgets."""

import asyncio
import sys
from argparse import Namespace
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from typing import TypeVar

from sqlalchemy.exc import SQLAlchemyError

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.server.accounts.identity import MACHINE
from esplanade.server.audit.log import AuditLog
from esplanade.server.audit.verifying import verify
from esplanade.server.operating.forgetting import forget as forget_person
from esplanade.server.operating.opening import WRITER, in_store, located
from esplanade.server.recording.errors import ZoneRecordingError
from esplanade.server.store.backup import read_backup, write_backup
from esplanade.server.store.files import empty_journal, remove_file
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.store.store import StoreError
from esplanade.server.store.tables import REVISION
from esplanade.server.store.upgrading import upgrade as upgrade_tables
from esplanade.server.store.writing import in_words

Result = TypeVar("Result")


def backup(options: Namespace) -> int:
    """Write a copy."""

    async def work(store: SqlStore) -> dict[str, int]:
        counts = await store.read(lambda connection: write_backup(connection, options.file))
        await AuditLog(store, WRITER).record(MACHINE.entry("data_backup", rows=counts))
        return counts

    print(f"{options.file}: {_told(in_store(options, work))}")
    return exit_codes.OK


def restore(options: Namespace) -> int:
    """Fill a new store with a copy, and check the audit that came with it."""
    location = located(options)
    is_new = location.file is not None and not location.file.exists()

    async def work(store: SqlStore) -> tuple[dict[str, int], list[str]]:
        counts = await asyncio.to_thread(read_backup, store.engine, location, options.file)
        faults = [str(chain.fault) for chain in await verify(store) if chain.fault is not None]
        await AuditLog(store, WRITER).record(MACHINE.entry("data_restore", rows=counts))
        return counts, faults

    try:
        counts, faults = _with_any_tables(location, work)
    except CommandError:
        if is_new and location.file is not None:
            remove_file(location.file)
        raise
    print(f"{location}: {_told(counts)}")
    for fault in faults:
        print(f"esplanade data restore: the audit: {fault}", file=sys.stderr)
    return exit_codes.FAILED if faults else exit_codes.OK


def upgrade(options: Namespace) -> int:
    """Bring the tables to those of this program."""
    location = located(options)
    if location.file is not None and not location.file.exists():
        raise UsageError(f"there is no store in {options.data}: {location} is missing")

    async def work(store: SqlStore) -> str | None:
        return await asyncio.to_thread(upgrade_tables, store.engine, location)

    before = _with_any_tables(location, work)
    if before == REVISION:
        print(f"{location}: the tables are of revision {REVISION} already")
    else:
        print(f"{location}: the tables were of revision {before or 'none'}, now {REVISION}")
    return exit_codes.OK


def forget(options: Namespace) -> int:
    """Forget a person."""

    async def work(store: SqlStore) -> tuple[dict[str, int], bool]:
        log = AuditLog(store, WRITER)
        counts = await forget_person(store, log, MACHINE, options.person)
        return counts, await asyncio.to_thread(empty_journal, store.engine, store.location)

    counts, is_gone = in_store(options, work)
    if options.recordings is not None:
        counts["recordings"] = _forget_in_recordings(options.recordings, options.person)
    if not any(counts.values()):
        raise CommandError(f"nothing is known of {options.person!r}")
    print(f"forgotten: {_told(counts)}")
    if not is_gone:
        print("a server has the file open: its journal holds the old rows until it is next emptied")
    return exit_codes.OK


def _forget_in_recordings(folder: Path, person: str) -> int:
    try:
        # An extra has the library that reads recordings.
        from esplanade.server.recording.forgetting import forget_in_recordings  # noqa: PLC0415
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        raise CommandError(f"recordings need {package}: install esplanade[record]") from None
    try:
        return forget_in_recordings(folder, person)
    except ZoneRecordingError as error:
        raise CommandError(f"recordings still know {person!r}: {error}") from None


def _with_any_tables(location: Location, work: Callable[[SqlStore], Awaitable[Result]]) -> Result:
    """Return the result of work on a store whose tables may be old or missing.

    Raises
    ------
    CommandError
        The store cannot be used.
    """

    async def run() -> Result:
        store = SqlStore(location)
        try:
            return await work(store)
        except SQLAlchemyError as error:
            raise in_words(error, location) from error
        finally:
            await store.close()

    try:
        return asyncio.run(run())
    except StoreError as error:
        raise CommandError(str(error)) from None


def _told(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{count} in {name}" for name, count in counts.items())
