"""Reports that people make of others, on their way to the moderators' inbox."""

from collections import OrderedDict
from typing import Final

import structlog

from esplanade.protocol import ErrorCode, NoticeCode, ProtocolError
from esplanade.protocol.messages import Notice, Report
from esplanade.server.moderation import inbox
from esplanade.server.moderation.inbox import InboxFullError
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net import frames
from esplanade.server.net.guests import Guest
from esplanade.server.net.limits import TokenBucket
from esplanade.server.net.moderation import PeopleModeration

EVERY_S: Final = 20.0
AT_ONCE: Final = 3
"""A person may report so often at once, and then once in that time."""
MOST_SPEAKERS: Final = 4096
"""Of more people who have reported, the one who did so longest ago is forgotten."""
_WAITS: Final = "too many reports wait to be written; please try again later"

log = structlog.get_logger(__name__)


class Reporting:
    """Takes reports, a few from each person."""

    def __init__(self, kept: ModerationState, people: PeopleModeration) -> None:
        self._kept = kept
        self._people = people
        self._buckets: OrderedDict[int, TokenBucket] = OrderedDict()

    def take(self, guest: Guest, report: Report, now_s: float) -> None:
        """Put a report into the inbox, or tell the person why it cannot be taken.

        The person must be in the world.
        """
        fault = self._fault(guest, report, now_s)
        if fault is not None:
            guest.tell(fault)
            return
        number = self._kept.inbox.numbers.take()
        if number is None:
            guest.tell(_full(_WAITS))
            return
        said = self._kept.chat.get(report.line) if report.line is not None else None
        made = inbox.Report(
            id=number,
            at_us=self._kept.now_us(),
            reporter=guest.avatar_id or 0,
            reporter_name=guest.name,
            person=report.id,
            name=self._people.reportable(report.id) or "",
            text=report.text,
            place=self._people.where(report.id),
            line=report.line,
            said=said.text if said is not None and said.id == report.id else None,
        )
        if not self._kept.report(made, guest.address):
            guest.tell(_full(_WAITS))
            return
        text = "Thank you. The people who look after this place can read your report now."
        notice = Notice(text=text, notice=NoticeCode.REPORT_TAKEN, arguments={"id": report.id})
        guest.outbox.post(frames.message(notice))
        log.info("person reported", report=made.id, id=made.person, by=made.reporter)
        about = {
            "report": made.id,
            "who": made.reporter,
            "other": made.person,
            "name": made.name,
            "text": made.text,
            "place": made.place,
        }
        self._people.happened("report", about)

    def _fault(self, guest: Guest, report: Report, now_s: float) -> ProtocolError | None:
        reporter = guest.avatar_id
        unknown = self._people.reportable(report.id) is None
        if reporter is None or report.id == reporter or unknown:
            return ProtocolError(ErrorCode.INVALID, f"report: {report.id} is nobody here", None)
        bucket = self._buckets.setdefault(reporter, TokenBucket(1.0 / EVERY_S, AT_ONCE, now_s))
        self._buckets.move_to_end(reporter)
        if len(self._buckets) > MOST_SPEAKERS:
            self._buckets.popitem(last=False)
        if not bucket.take(now_s):
            return _full(f"you report too often; once in {EVERY_S:g} s is enough")
        try:
            self._kept.inbox.check_room(guest.address)
        except InboxFullError as error:
            return _full(f"{error}; please try again later")
        return None


def _full(text: str) -> ProtocolError:
    return ProtocolError(ErrorCode.FLOODING, text, None)
