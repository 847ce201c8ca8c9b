"""Rows of moderation in the store, as functions of a connection within a read or a write."""

import json
from collections.abc import Callable, Collection, Mapping
from typing import Any, Final

from sqlalchemy import Connection, Select, Table, delete, func, insert, or_, select, update

from esplanade.server.checkpoint.ids import Block, reserve
from esplanade.server.moderation.bans import Ban
from esplanade.server.moderation.chat_log import MOST_LINES, KeptLine
from esplanade.server.moderation.inbox import Report
from esplanade.server.store.tables import BANS, CHAT_LINES, CHAT_RULES, REPORTS

REPORT_NUMBERS: Final = 1024
"""Numbers of reports that a process reserves at once, and again when half of them are given.

Half of them are more than the reports that may wait for moderators (`inbox.MOST_OPEN`), so that
they last while the store is away.
"""


class NumberTakenError(Exception):
    """A number is that of another row already."""


def put_ban(connection: Connection, zone: str, ban: Ban) -> None:
    """Write a new ban."""
    values = {name: getattr(ban, name) for name in _BAN_FIELDS}
    digests = json.dumps(ban.digests)
    row = {**values, "zone": zone, "account": ban.by, "digests": digests}
    connection.execute(insert(BANS).values(row))


def lift_ban(connection: Connection, zone: str, ban: int, *, lifted: bool) -> None:
    """Write that a ban holds no more, or again."""
    chosen = (BANS.c.zone == zone) & (BANS.c.id == ban)
    connection.execute(update(BANS).where(chosen).values(lifted=lifted))


def put_report(connection: Connection, zone: str, report: Report) -> None:
    """Write a new report, unless that was done already.

    Raises
    ------
    NumberTakenError
        Another report has its number.
    """
    values = {name: getattr(report, name) for name in _REPORT_FIELDS}
    place = None if report.place is None else json.dumps(report.place)
    _put_once(connection, REPORTS, "id", {**values, "zone": zone, "place": place})


def settle_report(
    connection: Connection, zone: str, report: int, state: str, by: str | None
) -> None:
    """Write that a report has been settled, or is open again."""
    chosen = (REPORTS.c.zone == zone) & (REPORTS.c.id == report)
    connection.execute(update(REPORTS).where(chosen).values(state=state, settled_by=by))


def drop_report(connection: Connection, zone: str, report: int) -> None:
    """Forget a report."""
    connection.execute(delete(REPORTS).where(REPORTS.c.zone == zone, REPORTS.c.id == report))


def put_rule(connection: Connection, zone: str, name: str, value: Any) -> None:
    """Write a rule of chat; None takes it away."""
    connection.execute(
        delete(CHAT_RULES).where(CHAT_RULES.c.zone == zone, CHAT_RULES.c.name == name)
    )
    if value is not None:
        row = {"zone": zone, "name": name, "value": json.dumps(value)}
        connection.execute(insert(CHAT_RULES).values(row))


def put_line(connection: Connection, zone: str, line: KeptLine) -> None:
    """Write a line of chat, unless that was done already.

    Raises
    ------
    NumberTakenError
        Another line has its number.
    """
    values = {name: getattr(line, name) for name in _LINE_FIELDS}
    row = {**values, "zone": zone, "avatar": line.id, "seen": json.dumps(line.seen)}
    _put_once(connection, CHAT_LINES, "line", row)


def _put_once(connection: Connection, table: Table, number: str, row: Mapping[str, Any]) -> None:
    """Insert a row, unless it is there: the answer to an earlier attempt may have been lost."""
    numbered = (table.c.zone == row["zone"]) & (table.c[number] == row[number])
    there = connection.execute(select(table.c.at_us, table.c.text).where(numbered)).one_or_none()
    if there is None:
        connection.execute(insert(table).values(row))
    elif tuple(there) != (row["at_us"], row["text"]):
        raise NumberTakenError(f"{table.name}: {row[number]} is the number of another")


def hide_line(connection: Connection, zone: str, line: int) -> None:
    """Write that a line is hidden."""
    chosen = (CHAT_LINES.c.zone == zone) & (CHAT_LINES.c.line == line)
    connection.execute(update(CHAT_LINES).where(chosen).values(hidden=True))


def drop_lines(connection: Connection, zone: str, before_us: int) -> None:
    """Forget lines that are older."""
    connection.execute(
        delete(CHAT_LINES).where(CHAT_LINES.c.zone == zone, CHAT_LINES.c.at_us < before_us)
    )


def drop_old_bans(connection: Connection, zone: str, before_us: int) -> None:
    """Forget bans that were over before a moment, or were lifted and made before it."""
    over = or_(BANS.c.until_us < before_us, BANS.c.lifted & (BANS.c.at_us < before_us))
    connection.execute(delete(BANS).where(BANS.c.zone == zone, over))


def all_bans(connection: Connection, zone: str) -> list[Ban]:
    """Every ban, the oldest first."""
    rows = connection.execute(select(BANS).where(BANS.c.zone == zone).order_by(BANS.c.id)).all()
    return [
        Ban(
            **{name: getattr(row, name) for name in _BAN_FIELDS},
            by=row.account,
            digests=tuple(json.loads(row.digests)),
        )
        for row in rows
    ]


def all_reports(connection: Connection, zone: str) -> list[Report]:
    """Every report, the oldest first."""
    return _reports(connection, select(REPORTS).where(REPORTS.c.zone == zone))


def reserve_reports(connection: Connection, zone: str) -> Block:
    """Reserve numbers of reports that no other process gives."""
    greatest = select(func.max(REPORTS.c.id)).where(REPORTS.c.zone == zone)
    above = connection.execute(greatest).scalar() or 0
    return reserve(connection, zone, "reports", REPORT_NUMBERS, above)


def reports_but(
    connection: Connection, zone: str, known: Collection[int]
) -> tuple[list[Report], dict[int, tuple[str, str | None]]]:
    """The reports that are not known yet, and of all of them the state and who has settled them."""
    columns = REPORTS.c.id, REPORTS.c.state, REPORTS.c.settled_by
    found = connection.execute(select(*columns).where(REPORTS.c.zone == zone)).all()
    states = {row.id: (row.state, row.settled_by) for row in found}
    new = states.keys() - set(known)
    if not new:
        return [], states
    query = select(REPORTS).where(REPORTS.c.zone == zone, REPORTS.c.id.in_(new))
    return _reports(connection, query), states


def _reports(connection: Connection, query: Select[Any]) -> list[Report]:
    return [
        Report(
            **{name: getattr(row, name) for name in _REPORT_FIELDS},
            place=None if row.place is None else tuple(json.loads(row.place)),
        )
        for row in connection.execute(query.order_by(REPORTS.c.at_us, REPORTS.c.id)).all()
    ]


def all_rules(connection: Connection, zone: str) -> dict[str, Any]:
    """Every rule of chat, by its name."""
    rows = connection.execute(select(CHAT_RULES).where(CHAT_RULES.c.zone == zone)).all()
    return {row.name: json.loads(row.value) for row in rows}


def last_lines(connection: Connection, zone: str) -> list[KeptLine]:
    """The last lines of chat, the oldest first."""
    query = select(CHAT_LINES).where(CHAT_LINES.c.zone == zone)
    rows = connection.execute(query.order_by(CHAT_LINES.c.line.desc()).limit(MOST_LINES)).all()
    return [
        KeptLine(
            **{name: getattr(row, name) for name in _LINE_FIELDS},
            id=row.avatar,
            seen=tuple(json.loads(row.seen)),
        )
        for row in reversed(rows)
    ]


def ids(connection: Connection, zone: str, first_line: int) -> tuple[set[int], set[int], set[int]]:
    """The ids of bans and reports, and the numbers of lines from one on, that are there."""
    bans = select(BANS.c.id).where(BANS.c.zone == zone)
    reports = select(REPORTS.c.id).where(REPORTS.c.zone == zone)
    lines = select(CHAT_LINES.c.line).where(
        CHAT_LINES.c.zone == zone, CHAT_LINES.c.line >= first_line
    )
    found = (set(connection.execute(query).scalars()) for query in (bans, reports, lines))
    return next(found), next(found), next(found)


_BAN_FIELDS: Final = ("id", "text", "until_us", "at_us", "name_pattern", "address", "lifted")
_REPORT_FIELDS: Final = (
    *("id", "at_us", "reporter", "reporter_name", "person", "name", "text", "line", "said"),
    *("state", "settled_by"),
)
_LINE_FIELDS: Final = ("line", "at_us", "tick", "name", "text", "hidden")


def _forgetter(
    table: Table, *columns: str, account: str | None = None
) -> Callable[[Connection, str, str], int]:
    """A function that removes the rows in which one of these columns is a person's name.

    Of an account of that name, which stands in the column `account`, only the name goes.
    """

    def forget(connection: Connection, zone: str, person: str) -> int:
        named = or_(*(table.c[column] == person for column in columns))
        count = connection.execute(delete(table).where(table.c.zone == zone, named)).rowcount
        if account is not None:
            done_by = (table.c.zone == zone) & (table.c[account] == person)
            emptied = update(table).where(done_by).values({account: None})
            count += connection.execute(emptied).rowcount
        return int(count)

    return forget


FORGETTERS: Final[Mapping[str, Callable[[Connection, str, str], int]]] = {
    "bans": _forgetter(BANS, "name_pattern", account="account"),
    "reports": _forgetter(REPORTS, "name", "reporter_name", account="settled_by"),
    "chat": _forgetter(CHAT_LINES, "name"),
}
"""Forgetters of these tables, for `esplanade.server.operating.forgetting`."""
