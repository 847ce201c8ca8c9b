"""Reports that people make of others, on their way to the moderators' inbox."""

from collections import OrderedDict
from collections.abc import Callable
from typing import Final

from esplanade.protocol import ErrorCode, NoticeCode, ProtocolError
from esplanade.protocol.messages import Notice, Report
from esplanade.server.moderation import inbox
from esplanade.server.moderation.areas import Place
from esplanade.server.moderation.inbox import InboxFullError
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net import frames
from esplanade.server.net.limits import TokenBucket
from esplanade.server.net.session import Session

EVERY_S: Final = 20.0
AT_ONCE: Final = 3
"""A person may report so often at once, and then once in that time."""
MOST_SPEAKERS: Final = 4096
"""Of more people who have reported, the one who did so longest ago is forgotten."""

PersonNamed = Callable[[int], str | None]
WhereIs = Callable[[int], Place | None]


class Reporting:
    """Takes reports, a few from each person."""

    def __init__(self, kept: ModerationState, name_of: PersonNamed, where: WhereIs) -> None:
        self._kept = kept
        self._name_of = name_of
        self._where = where
        self._buckets: OrderedDict[int, TokenBucket] = OrderedDict()

    def take(self, session: Session, report: Report, now_s: float) -> inbox.Report | None:
        """Put a report into the inbox and tell the person so; None, and a fault, if it cannot be.

        The person must be in the world.
        """
        fault = self._fault(session, report, now_s)
        if fault is not None:
            session.tell(fault)
            return None
        said = self._kept.chat.get(report.line) if report.line is not None else None
        made = inbox.Report(
            id=self._kept.inbox.next_id(),
            at_us=self._kept.now_us(),
            reporter=session.avatar_id or 0,
            reporter_name=session.name,
            person=report.id,
            name=self._name_of(report.id) or "",
            text=report.text,
            place=self._where(report.id),
            line=report.line,
            said=said.text if said is not None and said.id == report.id else None,
        )
        if not self._kept.report(made, session.address):
            session.tell(_full("too many reports wait to be written; please try again later"))
            return None
        text = "Thank you. The people who look after this place can read your report now."
        notice = Notice(text=text, notice=NoticeCode.REPORT_TAKEN, arguments={"id": report.id})
        session.outbox.post(frames.message(notice))
        return made

    def _fault(self, session: Session, report: Report, now_s: float) -> ProtocolError | None:
        reporter = session.avatar_id
        if reporter is None or report.id == reporter or self._name_of(report.id) is None:
            return ProtocolError(ErrorCode.INVALID, f"report: {report.id} is nobody here", None)
        bucket = self._buckets.setdefault(reporter, TokenBucket(1.0 / EVERY_S, AT_ONCE, now_s))
        self._buckets.move_to_end(reporter)
        if len(self._buckets) > MOST_SPEAKERS:
            self._buckets.popitem(last=False)
        if not bucket.take(now_s):
            return _full(f"you report too often; once in {EVERY_S:g} s is enough")
        try:
            self._kept.inbox.check_room(session.address)
        except InboxFullError as error:
            return _full(f"{error}; please try again later")
        return None


def _full(text: str) -> ProtocolError:
    return ProtocolError(ErrorCode.FLOODING, text, None)
